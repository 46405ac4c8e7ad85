# The core without ROS, instrumented like the targets.

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Kind of build" FORCE)
endif()
set(FUZZ_LIBFUZZER AUTO CACHE STRING "libFuzzer instead of the driver in standalone_main.cpp: AUTO, ON or OFF")
set(FUZZ_SANITIZE AUTO CACHE STRING "Sanitizers; AUTO: address,undefined,float-cast-overflow with libFuzzer, else none")

find_package(Boost REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(MODBUS REQUIRED IMPORTED_TARGET libmodbus)
pkg_check_modules(YAML_CPP REQUIRED IMPORTED_TARGET yaml-cpp)
find_package(Threads REQUIRED)

set(LIBFUZZER ${FUZZ_LIBFUZZER})
if(FUZZ_LIBFUZZER STREQUAL "AUTO")
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS "-fsanitize=fuzzer")
  check_cxx_source_compiles("
    #include <cstddef>
    #include <cstdint>
    extern \"C\" int LLVMFuzzerTestOneInput(const std::uint8_t*, std::size_t) { return 0; }" HAS_LIBFUZZER)
  unset(CMAKE_REQUIRED_FLAGS)
  set(LIBFUZZER ${HAS_LIBFUZZER})
endif()
set(SANITIZE ${FUZZ_SANITIZE})
if(SANITIZE STREQUAL "AUTO")
  set(SANITIZE "")
  if(LIBFUZZER)
    set(SANITIZE address,undefined,float-cast-overflow)
  endif()
endif()

add_library(fuzz_options INTERFACE)
target_compile_options(fuzz_options INTERFACE -Wall -Wextra -Wconversion)
if(SANITIZE)
  target_compile_options(fuzz_options INTERFACE
    -fsanitize=${SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(fuzz_options INTERFACE -fsanitize=${SANITIZE})
endif()
if(LIBFUZZER)
  target_compile_options(fuzz_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

file(GLOB_RECURSE CORE_SOURCES CONFIGURE_DEPENDS ${ROOT}/src/util/*.cpp ${ROOT}/src/config/*.cpp ${ROOT}/src/wire/*.cpp
  ${ROOT}/src/drive/*.cpp ${ROOT}/src/bus/*.cpp)
list(FILTER CORE_SOURCES EXCLUDE REGEX "_main\\.cpp$")
add_library(fuzz_core STATIC ${CORE_SOURCES})
target_include_directories(fuzz_core PUBLIC ${ROOT}/include ${ROOT}/src)
target_compile_definitions(fuzz_core PRIVATE INVERTER_BUS_SOURCE_SHARE="${ROOT}" INVERTER_BUS_INSTALL_SHARE="${ROOT}")
target_link_libraries(fuzz_core PUBLIC PkgConfig::MODBUS PkgConfig::YAML_CPP Boost::boost Threads::Threads fuzz_options)
