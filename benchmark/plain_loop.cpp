// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The loop that one writes first: libmodbus, two reads per drive, one drive after the other, nothing else. It knows of no dead
// drive, no lock and no priority; what it takes is what a driver has to be measured against.
//
//   plain_loop --device PATH [--inverters 5] [--baud 19200] [--drive omron_mx2] [--gap legal|none] --seconds 10
//
// A line "stop N" on standard input takes RUN off at station N when its turn comes, before its reads.

#include <fcntl.h>
#include <modbus/modbus.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <boost/program_options.hpp>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "benchmark/figures.h"
#include "benchmark/scene.h"

namespace
{
using namespace inverter_bus::benchmark;
namespace po = boost::program_options;
using Clock = std::chrono::steady_clock;

struct Options
{
  std::string device;
  Scene scene;
  std::string gap = "legal";
  double seconds = 10.0;
};

struct Free
{
  void operator()(modbus_t* context) const
  {
    modbus_close(context);
    modbus_free(context);
  }
};

class Loop
{
public:
  explicit Loop(const Options& options)
    : options_(options)
    , context_(modbus_new_rtu(options.device.c_str(), static_cast<int>(options.scene.baud), 'N', 8, 1))
  {
    if (!context_ || modbus_connect(context_.get()) != 0)
    {
      throw std::runtime_error(options.device + ": " + modbus_strerror(errno));
    }
    ::fcntl(STDIN_FILENO, F_SETFL, O_NONBLOCK);
  }

  void run()
  {
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options_.seconds));
    while (Clock::now() < end)
    {
      for (unsigned station = 1; station <= options_.scene.inverters; ++station)
      {
        readCommands();
        serve(static_cast<int>(station));
      }
    }
  }

  Json figures() const
  {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto time = [](const timeval& value) {
      return static_cast<double>(value.tv_sec) + 1e-6 * static_cast<double>(value.tv_usec);
    };
    Json json;
    json.number("exchanges", exchanges_).number("failed", failed_);
    json.number("cpu", time(usage.ru_utime) + time(usage.ru_stime));
    return json;
  }

private:
  void serve(int station)
  {
    modbus_set_slave(context_.get(), station);
    if (stops_.erase(station) != 0)
    {
      ended(modbus_write_bit(context_.get(), 0, 0));
    }
    std::uint16_t words[8];
    if (options_.scene.drive == "toshiba_vfs15")
    {
      ended(modbus_read_registers(context_.get(), 0x1875, 5, words));
      return;
    }
    std::uint8_t bits[24];
    ended(modbus_read_bits(context_.get(), 0, 24, bits));
    ended(modbus_read_registers(context_.get(), 0x1000, 4, words));
  }

  /// Counts, and keeps the silence before the next request where it shall be legal.
  void ended(int result)
  {
    ++exchanges_;
    failed_ += result < 0 ? 1 : 0;
    if (result < 0)
    {
      modbus_flush(context_.get());
    }
    if (options_.gap == "legal")
    {
      std::this_thread::sleep_for(std::chrono::duration<double>(silence(options_.scene.baud)));
    }
  }

  void readCommands()
  {
    char buffer[256];
    const ssize_t size = ::read(STDIN_FILENO, buffer, sizeof buffer);
    text_.append(buffer, size > 0 ? static_cast<std::size_t>(size) : 0);
    for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n'))
    {
      if (text_.compare(0, 5, "stop ") == 0)
      {
        stops_.insert(std::atoi(text_.c_str() + 5));
      }
      text_.erase(0, end + 1);
    }
  }

  Options options_;
  std::unique_ptr<modbus_t, Free> context_;
  std::set<int> stops_;
  std::string text_;
  unsigned exchanges_ = 0;
  unsigned failed_ = 0;
};

Options readOptions(int argc, char** argv)
{
  Options options;
  po::options_description description("plain_loop");
  description.add_options()("help", "this text")("device", po::value(&options.device)->required(), "serial port")(
      "inverters", po::value(&options.scene.inverters)->default_value(5), "stations 1 to N")(
      "baud", po::value(&options.scene.baud)->default_value(19200), "baud rate, 8N1")(
      "drive", po::value(&options.scene.drive)->default_value("omron_mx2"), "omron_mx2 or toshiba_vfs15")(
      "gap", po::value(&options.gap)->default_value("legal"), "legal or none")(
      "seconds", po::value(&options.seconds)->default_value(10.0), "how long");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, description), values);
  if (values.count("help") != 0)
  {
    std::cout << description << std::endl;
    std::exit(EXIT_SUCCESS);
  }
  po::notify(values);
  return options;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
    Loop loop(readOptions(argc, argv));
    loop.run();
    std::cout << loop.figures().str() << std::endl;
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::cerr << "plain_loop: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
