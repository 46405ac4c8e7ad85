// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef SIMULATION_TEST_BUS_H
#define SIMULATION_TEST_BUS_H

#include <map>
#include <sstream>
#include <string>

#include "inverter_bus/simulation/simulated_bus.h"
#include "simulation/compoway/compoway_frame.h"
#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace simulation
{
/// A simulated bus and a polite master in virtual time: frames go in and out as hexadecimal text.
class TestBus
{
public:
  explicit TestBus(const std::string& yaml, LineOptions options = LineOptions())
    : now(TimePoint() + std::chrono::hours(1)), bus(busConfigFromText(yaml), options, now)
  {
  }

  /// Sends the frame as it is, waits until the line is at rest, and returns everything that came back.
  std::string askRaw(const std::string& hex)
  {
    bus.send(*fromHex(hex), now);
    const std::string reply = listen();
    now += bus.line().options().settings.frameGap() + std::chrono::microseconds(10);
    return reply;
  }

  /// The same with the CRC added to the request and (when right) taken off the reply.
  std::string ask(const std::string& hex)
  {
    Bytes reply = *fromHex(askRaw(toHex(withModbusCrc(*fromHex(hex)))));
    if (modbusCrcFits(reply))
    {
      reply.resize(reply.size() - 2);
      return toHex(reply);
    }
    return toHex(reply);
  }

  /// CompoWay/F: packs the body of a request and returns the body of the reply, or what came instead as hexadecimal text.
  std::string askBody(const std::string& body)
  {
    const std::string reply = askRaw(toHex(compowayFrame(body)));
    const std::optional<Bytes> frame = findCompowayFrame(*fromHex(reply));
    const bool good = frame && compowayBccFits(*frame) && toHex(*frame) == reply;
    return good ? compowayBody(*frame) : reply;
  }

  /// All that comes out until nothing is under way any more.
  std::string listen()
  {
    Bytes heard;
    for (auto next = bus.nextEvent(); next; next = bus.nextEvent())
    {
      now = std::max(now, *next);
      bus.advance(now);
      for (const Delivery& delivery : bus.takeOutput(now))
      {
        first_byte = heard.empty() ? delivery.time : first_byte;
        last_byte = delivery.time;
        heard.insert(heard.end(), delivery.bytes.begin(), delivery.bytes.end());
      }
    }
    return toHex(heard);
  }

  void wait(double time)
  {
    now += seconds(time);
    bus.advance(now);
  }

  std::string command(const std::string& line)
  {
    return bus.command(line, now);
  }

  /// One value of `NAME show`.
  std::string shown(const std::string& name, const std::string& key)
  {
    std::istringstream words(command(name + " show"));
    for (std::string word; words >> word;)
    {
      if (word.compare(0, key.size() + 1, key + "=") == 0)
      {
        return word.substr(key.size() + 1);
      }
    }
    return "no " + key;
  }

  double number(const std::string& name, const std::string& key)
  {
    return std::stod(shown(name, key));
  }

  TimePoint now;
  TimePoint first_byte{};
  TimePoint last_byte{};
  SimulatedBus bus;
};

/// One MX2 at station 1 named m: 50 Hz in 5 s up and down.
inline std::string oneMx2(const std::string& parameters = "")
{
  return "baud_rate: 19200\nscan_list: [{name: m, node: 1, drive: omron_mx2}]\n"
         "simulation: {m: {parameters: {F002: 5.0, F003: 5.0" +
         (parameters.empty() ? "" : ", " + parameters) + "}}}\n";
}

/// The same as an RX.
inline std::string oneRx(const std::string& parameters = "")
{
  return "baud_rate: 19200\nscan_list: [{name: m, node: 1, drive: omron_rx}]\n"
         "simulation: {m: {parameters: {F002: 5.0, F003: 5.0" +
         (parameters.empty() ? "" : ", " + parameters) + "}}}\n";
}

const char* const RUN = "01 05 00 00 FF 00";
const char* const STOP = "01 05 00 00 00 00";
const char* const FORWARD = "01 05 00 01 00 00";
const char* const REVERSE = "01 05 00 01 FF 00";
const char* const RESET_ON = "01 05 00 03 FF 00";
const char* const RESET_OFF = "01 05 00 03 00 00";
const char* const SPEED_50 = "01 10 00 00 00 02 04 00 00 13 88";
const char* const SPEED_20 = "01 10 00 00 00 02 04 00 00 07 D0";
const char* const READ_STATUS = "01 03 00 02 00 03";
}  // namespace simulation
}  // namespace inverter_bus

#endif  // SIMULATION_TEST_BUS_H
