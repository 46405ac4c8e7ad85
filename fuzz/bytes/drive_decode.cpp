// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Replies that passed the wire, decoded by every shipped profile. The input: the profile (all as shipped, then all with
// everything confirmed), what is asked, which one of them, then the reply's data; or, where the second byte has bit 7, the
// reply's content as it is, which the wire lets pass only where it fits.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "checks.h"
#include "dialect.h"
#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using drive::Drive;
using drive::Monitor;
using drive::Parameter;
using drive::ReadBlock;
using wire::Bytes;
using wire::Request;

const std::string PROFILES = INVERTER_BUS_ROOT "/config/drives";
constexpr std::uint8_t STATION = 1;

/// A profile with all that it can ask for.
struct Subject
{
  explicit Subject(drive::Profile profile) : drive(std::move(profile))
  {
    dialect = drive.profile().protocol == "compoway_f" ? makeCompowayDialect() : makeModbusRtuDialect();
    protocol = dialect->makeProtocol();
    for (const auto* plan : { &drive.fastBlocks(), &drive.slowBlocks(), &drive.faultBlocks() })
    {
      blocks.insert(blocks.end(), plan->begin(), plan->end());
    }
    if (drive.runBlock())
    {
      blocks.push_back(*drive.runBlock());
    }
    for (const std::vector<int>& codes : std::vector<std::vector<int>>{ { 1, 2, 3, 4, 14 }, { 5, 6, 7, 8, 9 }, { 1 } })
    {
      if (const auto block = drive.chosenRead(codes))
      {
        chosen.push_back(*block);
      }
    }
    for (const auto& entry : drive.profile().parameters)
    {
      if (const auto parameter = drive.findParameter(entry.first, false))
      {
        parameters.push_back(*parameter);
      }
    }
    for (const char* place : { "0x0001", "0x1103", "C0/0001" })
    {
      if (const auto parameter = drive.findParameter(place, false))
      {
        parameters.push_back(*parameter);
      }
    }
  }

  Drive drive;
  std::unique_ptr<Dialect> dialect;
  std::unique_ptr<wire::Protocol> protocol;
  std::vector<ReadBlock> blocks;
  std::vector<ReadBlock> chosen;
  std::vector<Parameter> parameters;
};

std::vector<Subject> loadSubjects()
{
  std::vector<Subject> subjects;
  drive::ProfileChanges all;
  all.place = "fuzz";
  all.confirm = { "all" };
  for (const drive::ProfileChanges& changes : { drive::ProfileChanges(), all })
  {
    for (const std::string& name : drive::knownProfiles(PROFILES))
    {
      subjects.emplace_back(drive::loadProfile(name, PROFILES, changes));
    }
  }
  require(!subjects.empty(), "no profiles");
  return subjects;
}

/// The reply's content as it leaves the wire; nothing if it doesn't pass.
std::optional<Bytes> pass(const Subject& subject, const Request& request, bool raw, const Bytes& data)
{
  Bytes frame = subject.dialect->reply(request, 1, data);
  if (raw)
  {
    Bytes content = data;
    if (subject.drive.profile().protocol != "compoway_f")
    {
      content.insert(content.begin(), request.station);
    }
    frame = subject.dialect->seal(content, 1);
  }
  const wire::Parsed parsed = subject.protocol->parse(frame.data(), frame.size(), &request);
  const bool reply = parsed.kind == wire::Parsed::Kind::Reply;
  require(raw || reply, "a good reply did not pass");
  return reply ? std::optional<Bytes>(parsed.pdu) : std::nullopt;
}

void checkText(const std::string& text)
{
  const bool printable = std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= 0x20 && c != 0x7F; });
  require(printable, "control characters in a text");
}

void checkMonitor(const Drive& drive, const Monitor& monitor)
{
  for (const auto& quantity : { monitor.output_frequency, monitor.output_current, monitor.output_voltage,
                                monitor.dc_voltage, monitor.torque, monitor.temperature })
  {
    require(!quantity || (std::isfinite(*quantity) && std::abs(*quantity) < 1e9), "a quantity beyond reason");
  }
  require(!monitor.direction || std::abs(*monitor.direction) <= 1, "no direction");
  if (monitor.fault_code)
  {
    require(drive.faultText(*monitor.fault_code).empty() == (*monitor.fault_code == 0), "a trip without a text");
  }
  if (monitor.warning_code)
  {
    const std::string text = drive.warningText(*monitor.warning_code);
    require(text.empty() == (*monitor.warning_code == 0), "a warning without a text");
    checkText(text);
  }
}

void decodeBlock(const Subject& subject, const ReadBlock& block, bool raw, const Bytes& data)
{
  const auto reply = pass(subject, subject.drive.read(STATION, block), raw, data);
  if (!reply)
  {
    return;
  }
  drive::Ratings ratings;
  Monitor monitor;
  subject.drive.decode(block, *reply, monitor, ratings);
  checkMonitor(subject.drive, monitor);
  ratings.current = 4.8;
  ratings.voltage = 200.0;
  subject.drive.decode(block, *reply, monitor, ratings);
  checkMonitor(subject.drive, monitor);
  if (!block.chosen.empty())
  {
    for (const auto& value : subject.drive.chosenValues(block, *reply, ratings))
    {
      require(!value.first.empty() && !value.second.empty(), "a chosen value without a text");
      checkText(value.second);
    }
  }
}

void decodeTrip(const Subject& subject, std::size_t index, bool raw, const Bytes& data)
{
  if (subject.drive.faultEntries() == 0)
  {
    return;
  }
  index %= subject.drive.faultEntries();
  drive::FaultRecord record;
  for (const ReadBlock& block : subject.drive.faultReads(index))
  {
    if (const auto reply = pass(subject, subject.drive.read(STATION, block), raw, data))
    {
      subject.drive.decodeFault(index, block, *reply, record);
    }
  }
  require(record.text.empty() == (record.code == 0), "a recorded trip without a text");
}

void decodeParameter(const Subject& subject, const Parameter& parameter, bool raw, const Bytes& data)
{
  const auto reply = pass(subject, subject.drive.readParameter(STATION, parameter), raw, data);
  if (!reply)
  {
    return;
  }
  const double value = subject.drive.decodeParameter(parameter, *reply);
  const bool controller_status = parameter.item.space == drive::Space::ControllerStatus;
  require(std::isfinite(value) || controller_status, "a parameter that is no number");
  subject.drive.rawParameter(parameter, *reply);
  const drive::Encoded encoded = subject.drive.encodeParameter(parameter, value);
  require(encoded.ok == encoded.error.empty(), "a refusal without a reason");
}

void decodeRest(const Subject& subject, bool raw, const Bytes& data)
{
  if (const auto request = subject.drive.readStoreBusy(STATION))
  {
    if (const auto reply = pass(subject, *request, raw, data))
    {
      subject.drive.decodeStoreBusy(*reply);
    }
  }
  if (const auto request = subject.drive.readAttributes(STATION))
  {
    if (const auto reply = pass(subject, *request, raw, data))
    {
      const std::string model = subject.drive.decodeModel(*reply);
      const bool ascii = std::all_of(model.begin(), model.end(), [](char c) { return c >= ' ' && c < '\x7F'; });
      require(ascii, "a model name that is no ASCII text");
    }
  }
  const auto code = static_cast<std::uint16_t>(data.size() < 2 ? 0 : data[0] * 256 + data[1]);
  checkText(subject.drive.exceptionText(code));
}
}  // namespace
}  // namespace fuzz
}  // namespace inverter_bus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace inverter_bus::fuzz;
  static const std::vector<Subject> SUBJECTS = loadSubjects();
  ByteSource source(data, size);
  const std::uint8_t which = source.byte();
  const Subject& subject = SUBJECTS[which % SUBJECTS.size()];
  const std::uint8_t what = source.byte();
  const std::size_t index = source.byte();
  const bool raw = (what & 0x80) != 0;
  const inverter_bus::wire::Bytes rest = source.rest();
  switch (what & 7)
  {
    case 0:
    case 1:
    case 2:
      if (!subject.blocks.empty())
      {
        decodeBlock(subject, subject.blocks[index % subject.blocks.size()], raw, rest);
      }
      break;
    case 3:
      decodeTrip(subject, index, raw, rest);
      break;
    case 4:
      if (!subject.chosen.empty())
      {
        decodeBlock(subject, subject.chosen[index % subject.chosen.size()], raw, rest);
      }
      break;
    case 5:
      decodeRest(subject, raw, rest);
      break;
    default:
      decodeParameter(subject, subject.parameters[index % subject.parameters.size()], raw, rest);
  }
  return 0;
}
