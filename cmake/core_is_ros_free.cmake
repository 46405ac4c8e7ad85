# Fails when a file of the core includes anything of ROS, or a room includes one that it may not enter.
file(GLOB_RECURSE CORE_FILES
  ${ROOT}/include/inverter_bus/config/*.h ${ROOT}/src/config/*
  ${ROOT}/include/inverter_bus/wire/*.h ${ROOT}/src/wire/*
  ${ROOT}/include/inverter_bus/drive/*.h ${ROOT}/src/drive/*
  ${ROOT}/include/inverter_bus/bus/*.h ${ROOT}/src/bus/*
  ${ROOT}/include/inverter_bus/simulation/*.h ${ROOT}/src/simulation/*
  ${ROOT}/include/inverter_bus/bench/*.h ${ROOT}/src/bench/*)
foreach(FILE ${CORE_FILES})
  file(STRINGS ${FILE} INCLUDES REGEX "^[ \t]*#[ \t]*include")
  foreach(INCLUDE ${INCLUDES})
    if(INCLUDE MATCHES "[<\"](ros|std_msgs|std_srvs|diagnostic_[a-z]+|xmlrpcpp|XmlRpc[A-Za-z]*)[/.]"
        OR INCLUDE MATCHES "inverter_bus/(ros/|[A-Z])")
      message(FATAL_ERROR "${FILE}: the core must not include ROS: ${INCLUDE}")
    endif()
    # bench/ alone sees both: it has the scan list judged by the driver's rules, and plays what only a profile tells.
    if(INCLUDE MATCHES "inverter_bus/bench/" AND NOT FILE MATCHES "/bench/")
      message(FATAL_ERROR "${FILE}: bench/ is for the programs that simulate: ${INCLUDE}")
    endif()
    if(INCLUDE MATCHES "inverter_bus/simulation/" AND NOT FILE MATCHES "/(simulation|bench)/")
      message(FATAL_ERROR "${FILE}: the driver must stay independent of the simulation: ${INCLUDE}")
    endif()
    if(FILE MATCHES "/simulation/" AND INCLUDE MATCHES "inverter_bus/(wire|drive|bus)/")
      message(FATAL_ERROR "${FILE}: the simulation must stay independent of the driver: ${INCLUDE}")
    endif()
    if(FILE MATCHES "/config/" AND INCLUDE MATCHES "inverter_bus/(wire|drive|bus|simulation|bench)/")
      message(FATAL_ERROR "${FILE}: config/ must not know any other room: ${INCLUDE}")
    endif()
    if(FILE MATCHES "/wire/" AND INCLUDE MATCHES "inverter_bus/(drive|bus)/")
      message(FATAL_ERROR "${FILE}: wire/ must not know drive/ or bus/: ${INCLUDE}")
    endif()
    if(FILE MATCHES "/drive/" AND INCLUDE MATCHES "inverter_bus/bus/")
      message(FATAL_ERROR "${FILE}: drive/ must not know bus/: ${INCLUDE}")
    endif()
    if(INCLUDE MATCHES "modbus\\.h|<modbus/" AND NOT FILE MATCHES "/src/wire/modbus_transmitter\\.cpp$")
      message(FATAL_ERROR "${FILE}: libmodbus is included in src/wire/modbus_transmitter.cpp only")
    endif()
  endforeach()
endforeach()
