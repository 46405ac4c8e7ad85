// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/program/bus_commands.h"

#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include "inverter_bus/simulation/simulated_bus.h"
#include "simulation/compoway/compoway_frame.h"
#include "simulation/drives/command_words.h"
#include "simulation/modbus/modbus_frame.h"
#include "util/text.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr double LONGEST = 86400.0;  // [s] of any duration

const char* const HELP =
    "help; list; bus show|frames [N]|unplug [S]|plug|echo on/off|silent on/off/S|noise [N]|foreign HEX (CompoWay/F: "
    "BODY) [now] "
    "[raw]|reset; "
    "NAME show|get CODE|set CODE X|offline [S]|online|trip N [state S]|clear|busy S|power_cycle [S]|power on/off|panel "
    "HZ|"
    "panel_release|panel_stop|sto on/off|load X|damaged|truncated [BYTES]|noise [BYTES]|late S|foreign station/shape|"
    "exception N|lost_request|lost_reply [count N] [for S] [function F] [writes|reads] [longer BYTES]";

std::string joined(const KeyValues& values)
{
  std::string text;
  for (const auto& value : values)
  {
    text += " " + value.first + "=" + value.second;
  }
  return text;
}

void check(const Refusal& refusal)
{
  if (refusal)
  {
    throw CommandError(*refusal);
  }
}

/// A command: takes the rest of the words, returns what follows "ok".
using BusAction = std::function<std::string(SimulatedBus&, CommandWords&, TimePoint)>;
using DriveAction = std::function<std::string(SimulatedDrive&, CommandWords&, TimePoint)>;

std::optional<TimePoint> takeEnd(CommandWords& words, TimePoint now)
{
  if (words.empty())
  {
    return std::nullopt;
  }
  return now + seconds(words.takeNumber("duration", 0.0, LONGEST));
}

std::string showBus(SimulatedBus& bus)
{
  const LineCounters& line = bus.line().counters();
  const LineSettings& master = bus.line().options().settings;
  return joined({ { "plugged_in", bus.pluggedIn() ? "1" : "0" },
                  { "master", std::to_string(master.baud_rate) + "/" + std::to_string(master.data_bits) +
                                  letterOf(master.parity) + std::to_string(master.stop_bits) },
                  { "requests", std::to_string(line.requests) },
                  { "replies", std::to_string(line.replies) },
                  { "lost_gap", std::to_string(line.lost_gap) },
                  { "early", std::to_string(line.early) },
                  { "damaged", std::to_string(line.damaged) },
                  { "collisions", std::to_string(line.collisions) },
                  { "foreign", std::to_string(line.foreign) } });
}

std::string showFrames(SimulatedBus& bus, CommandWords& words)
{
  const std::size_t wanted = static_cast<std::size_t>(words.takeNumberOr(10, "number of frames", 1, 200));
  const auto& frames = bus.frames();
  std::string text;
  for (std::size_t i = frames.size() - std::min(wanted, frames.size()); i < frames.size(); ++i)
  {
    text += (text.empty() ? " " : " | ") + frameText(frames[i], bus.start());
  }
  return text;
}

std::string cutLine(SimulatedBus& bus, CommandWords& words, TimePoint now)
{
  if (words.takeIf("off"))
  {
    bus.cutLine(false, std::nullopt, now);
  }
  else if (words.takeIf("on"))
  {
    bus.cutLine(true, std::nullopt, now);
  }
  else
  {
    bus.cutLine(true, now + seconds(words.takeNumber("on, off or duration", 0.0, LONGEST)), now);
  }
  return "";
}

Bytes foreignFrame(const std::string& text, bool raw, Protocol protocol)
{
  if (!raw && protocol == Protocol::CompowayF && !text.empty())
  {
    return compowayFrame(text);
  }
  const std::optional<Bytes> frame = fromHex(text);
  if (!frame || frame->empty())
  {
    const std::string body = protocol == Protocol::CompowayF ? ", or a body such as 010000601 without raw" : "";
    throw CommandError("frame " + text + " (allowed: hexadecimal bytes such as 01 03 10 00 00 02" + body + ")");
  }
  return raw ? *frame : withModbusCrc(*frame);
}

std::string sendForeign(SimulatedBus& bus, CommandWords& words, TimePoint now)
{
  std::string text;
  bool at_once = false;
  bool raw = false;
  while (!words.empty())
  {
    if (words.takeIf("now"))
    {
      at_once = true;
    }
    else if (words.takeIf("raw"))
    {
      raw = true;
    }
    else
    {
      text += words.take("frame");
    }
  }
  const Bytes sent = foreignFrame(text, raw, bus.line().options().settings.protocol);
  bus.line().sendForeign(sent, !at_once, now);
  return " frame=" + toHex(sent);
}

const std::map<std::string, BusAction>& busActions()
{
  static const std::map<std::string, BusAction> ACTIONS = {
    { "show", [](SimulatedBus& bus, CommandWords&, TimePoint) { return showBus(bus); } },
    { "frames", [](SimulatedBus& bus, CommandWords& words, TimePoint) { return showFrames(bus, words); } },
    { "unplug",
      [](SimulatedBus& bus, CommandWords& words, TimePoint now) {
        bus.unplug(takeEnd(words, now), now);
        return std::string();
      } },
    { "plug",
      [](SimulatedBus& bus, CommandWords&, TimePoint now) {
        bus.plugIn(now);
        return std::string();
      } },
    { "echo",
      [](SimulatedBus& bus, CommandWords& words, TimePoint) {
        bus.line().setEcho(words.takeOnOff("echo"));
        return std::string();
      } },
    { "silent", cutLine },
    { "noise",
      [](SimulatedBus& bus, CommandWords& words, TimePoint now) {
        bus.line().sendNoise(static_cast<std::size_t>(words.takeNumberOr(8, "number of bytes", 1, 256)), now);
        return std::string();
      } },
    { "foreign", sendForeign },
    { "reset",
      [](SimulatedBus& bus, CommandWords&, TimePoint) {
        bus.line().clearCounters();
        for (const auto& drive : bus.drives())
        {
          drive->clearCounters();
        }
        return std::string();
      } },
  };
  return ACTIONS;
}

/// The words after a fault: how often, how long, for which exchanges.
void takeScope(CommandWords& words, Fault& fault, TimePoint now)
{
  while (!words.empty())
  {
    if (words.takeIf("count"))
    {
      fault.count = static_cast<int>(words.takeNumber("count", 0, 1000000));
    }
    else if (words.takeIf("for"))
    {
      fault.until = now + seconds(words.takeNumber("duration", 0.0, LONGEST));
      fault.count = 0;
    }
    else if (words.takeIf("function"))
    {
      fault.function = static_cast<int>(words.takeNumber("function", 0, 65535));
    }
    else if (words.takeIf("writes"))
    {
      fault.access = Access::Write;
    }
    else if (words.takeIf("reads"))
    {
      fault.access = Access::Read;
    }
    else if (words.takeIf("longer"))
    {
      fault.longer_than = static_cast<std::size_t>(words.takeNumber("bytes", 1, 255));
    }
    else
    {
      throw CommandError("unexpected word " + words.peek() +
                         " (allowed: count N, for S, function F, writes, reads, longer BYTES)");
    }
  }
  const bool before_reply = fault.kind == FaultKind::LostRequest || fault.kind == FaultKind::Exception;
  if (before_reply && fault.longer_than > 0)
  {
    throw CommandError("longer BYTES is for faults of a reply, not for lost_request and exception");
  }
}

std::string spoil(SimulatedDrive& drive, CommandWords& words, TimePoint now, FaultKind kind, double value)
{
  Fault fault;
  fault.kind = kind;
  fault.value = value;
  takeScope(words, fault, now);
  drive.inject(fault);
  return "";
}

FaultKind takeForeignKind(CommandWords& words)
{
  if (words.takeIf("shape"))
  {
    return FaultKind::ForeignShape;
  }
  words.takeIf("station");
  return FaultKind::ForeignStation;
}

std::string powerCycle(SimulatedDrive& drive, CommandWords& words, TimePoint now)
{
  if (words.empty())
  {
    drive.powerCycle(now);
    return "";
  }
  drive.powerOff(now, takeEnd(words, now));
  return "";
}

std::map<std::string, DriveAction> faultActions()
{
  return {
    { "damaged",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) { return spoil(d, w, now, FaultKind::Damaged, 0); } },
    { "truncated",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        const double bytes = w.takeNumberOr(4, "bytes", 0, 256);
        return spoil(d, w, now, FaultKind::Truncated, bytes);
      } },
    { "noise",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        const double bytes = w.takeNumberOr(3, "bytes", 1, 256);
        return spoil(d, w, now, FaultKind::Noise, bytes);
      } },
    { "late",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        const double delay = w.takeNumber("delay", 0.0, 3600.0);
        return spoil(d, w, now, FaultKind::Late, delay);
      } },
    { "foreign",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        const FaultKind kind = takeForeignKind(w);
        return spoil(d, w, now, kind, 0);
      } },
    { "exception",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        const double code = w.takeNumber("exception code", 1, d.largestException());
        return spoil(d, w, now, FaultKind::Exception, code);
      } },
    { "lost_request",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) { return spoil(d, w, now, FaultKind::LostRequest, 0); } },
    { "lost_reply",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) { return spoil(d, w, now, FaultKind::LostReply, 0); } },
  };
}

std::map<std::string, DriveAction> connectionActions()
{
  return {
    { "clear",
      [](SimulatedDrive& d, CommandWords&, TimePoint) {
        d.clearFaults();
        return std::string();
      } },
    { "offline",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        d.setOffline(takeEnd(w, now));
        return std::string();
      } },
    { "online",
      [](SimulatedDrive& d, CommandWords&, TimePoint) {
        d.setOnline();
        return std::string();
      } },
    { "power_cycle", powerCycle },
    { "power",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        if (w.takeOnOff("power"))
        {
          d.powerOn(now);
        }
        else
        {
          d.powerOff(now, std::nullopt);
        }
        return std::string();
      } },
  };
}

std::map<std::string, DriveAction> handActions()
{
  return {
    { "show", [](SimulatedDrive& d, CommandWords&, TimePoint) { return joined(d.describe()); } },
    { "get",
      [](SimulatedDrive& d, CommandWords& w, TimePoint) {
        KeyValues values;
        const std::string code = w.take("parameter code");
        check(d.parameter(code, values));
        return " " + code + joined(values);
      } },
    { "set",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        const std::string code = w.take("parameter code");
        check(d.setParameter(code, w.takeNumber("value", 0.0, 4294967295.0), now));
        return std::string();
      } },
    { "trip",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        check(d.trip(static_cast<int>(w.takeNumber("trip code", 1, 65535)), now));
        if (w.takeIf("state"))
        {
          check(d.showTripAs(static_cast<unsigned>(w.takeNumber("state", 0, 65535))));
        }
        return std::string();
      } },
    { "busy",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        d.setBusy(now + seconds(w.takeNumber("duration", 0.0, LONGEST)), now);
        return std::string();
      } },
    { "panel",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        check(d.takeOverAtPanel(w.takeNumber("frequency", -1000.0, 1000.0), now));
        return std::string();
      } },
    { "panel_release",
      [](SimulatedDrive& d, CommandWords&, TimePoint now) {
        check(d.releasePanel(now));
        return std::string();
      } },
    { "panel_stop",
      [](SimulatedDrive& d, CommandWords&, TimePoint now) {
        check(d.pressStopKey(now));
        return std::string();
      } },
    { "sto",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        check(d.setSafeStop(w.takeOnOff("sto"), now));
        return std::string();
      } },
    { "load",
      [](SimulatedDrive& d, CommandWords& w, TimePoint now) {
        check(d.setLoad(w.takeNumber("load", 0.0, 3.0), now));
        return std::string();
      } },
  };
}

const std::map<std::string, DriveAction>& driveActions()
{
  static const std::map<std::string, DriveAction> ACTIONS = [] {
    std::map<std::string, DriveAction> actions = faultActions();
    for (const auto& more : { connectionActions(), handActions() })
    {
      actions.insert(more.begin(), more.end());
    }
    return actions;
  }();
  return ACTIONS;
}

template <typename Actions>
const typename Actions::mapped_type& find(const Actions& actions, const std::string& word)
{
  const auto found = actions.find(word);
  if (found == actions.end())
  {
    std::vector<std::string> allowed;
    allowed.reserve(actions.size());
    for (const auto& action : actions)
    {
      allowed.push_back(action.first);
    }
    throw CommandError("unknown command " + word + " (allowed: " + util::joined(allowed) + ")");
  }
  return found->second;
}

std::string names(SimulatedBus& bus, bool with_stations)
{
  std::string text;
  for (const auto& drive : bus.drives())
  {
    text += " " + drive->name() + (with_stations ? "=" + std::to_string(drive->station()) : "");
  }
  return text;
}

std::string run(SimulatedBus& bus, CommandWords& words, TimePoint now)
{
  const std::string target = words.take("command");
  if (target == "help")
  {
    return std::string(" ") + HELP;
  }
  if (target == "list")
  {
    return names(bus, true);
  }
  if (target == "bus")
  {
    std::string answer = find(busActions(), words.take("command"))(bus, words, now);
    words.finish();
    return answer;
  }
  SimulatedDrive* drive = bus.drive(target);
  if (drive == nullptr)
  {
    throw CommandError("unknown target " + target + " (allowed: help list bus" + names(bus, false) + ")");
  }
  drive->advance(now);
  std::string answer = find(driveActions(), words.take("command"))(*drive, words, now);
  words.finish();
  return answer;
}
}  // namespace

std::string runCommand(SimulatedBus& bus, const std::string& line, TimePoint now)
{
  CommandWords words(line);
  if (words.empty())
  {
    return "";
  }
  try
  {
    return "ok" + run(bus, words, now);
  }
  catch (const CommandError& error)
  {
    const std::string reason = error.what();
    return "error: " + reason + (reason.find('(') == std::string::npos ? " (see help)" : "");
  }
}
}  // namespace simulation
}  // namespace inverter_bus
