// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The part of Drive that knows why the motor has stopped: trip memory, warnings, exceptions.

#include <string>
#include <vector>

#include "drive/codec/codec.h"
#include "drive/codec/read_plan.h"
#include "drive/profile/status_fields.h"
#include "inverter_bus/drive/drive.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// Modbus application protocol V1.1b3, section 7: for drives whose profile doesn't say more.
const std::map<unsigned, std::string>& commonExceptions()
{
  static const std::map<unsigned, std::string> TEXTS = {
    { 0x01, "function not supported" },     { 0x02, "address not found" },
    { 0x03, "illegal value or count" },     { 0x04, "device failure" },
    { 0x05, "accepted, takes long" },       { 0x06, "device busy" },
    { 0x0A, "gateway path not available" }, { 0x0B, "gateway: no answer from the device" },
  };
  return TEXTS;
}

void decodeRecordField(const std::string& field, const Item& item, std::uint32_t raw, const Drive& drive,
                       FaultRecord& record)
{
  if (field == "code")
  {
    record.code = static_cast<std::uint16_t>(raw);
    record.text = drive.faultText(record.code);
    return;
  }
  const auto quantity = recordFields().find(field);
  if (quantity != recordFields().end())
  {
    record.*(quantity->second) = scaled(item, raw);
  }
}
}  // namespace

std::vector<ReadBlock> Drive::faultReads(std::size_t index) const
{
  std::map<std::string, Item> items;
  if (index < profile_.history.entries.size())
  {
    for (const auto& [field, item] : profile_.history.entries[index])
    {
      if (item.unconfirmed.empty())
      {
        items[field] = item;
      }
    }
  }
  return planReads(items, profile_);
}

std::size_t Drive::faultEntries() const
{
  return profile_.history.entries.size();
}

void Drive::decodeFault(std::size_t index, const ReadBlock& block, const wire::Bytes& reply, FaultRecord& record) const
{
  if (index >= profile_.history.entries.size())
  {
    return;
  }
  const auto& entry = profile_.history.entries[index];
  for (const std::string& field : block.fields)
  {
    const auto item = entry.find(field);
    const auto raw = item == entry.end() ? std::nullopt : extractRaw(item->second, block, reply, profile_);
    if (raw)
    {
      decodeRecordField(field, item->second, *raw, *this, record);
    }
  }
}

std::string Drive::faultText(std::uint16_t code) const
{
  const auto text = profile_.faults.find(code);
  if (code == 0)
  {
    return "";
  }
  return text != profile_.faults.end() ? text->second : "unknown trip " + std::to_string(code);
}

std::string Drive::tripText(const Monitor& monitor) const
{
  const std::uint16_t code = monitor.fault_code.value_or(0);
  if (!monitor.unknown_trip)
  {
    return "trip " + std::to_string(code) + ": " + (code == 0 ? "no reason given" : faultText(code));
  }
  return "unknown state " + std::to_string(*monitor.unknown_trip) + " (" + util::hexNumber(*monitor.unknown_trip) +
         ") of faulted, which is in no table and counts as a trip" +
         (code == 0 ? "" : "; trip " + std::to_string(code) + ": " + faultText(code));
}

namespace
{
std::string warningBits(std::uint32_t code, const FaultTable& table)
{
  std::vector<std::string> texts;
  std::uint32_t rest = code;
  for (const auto& [bits, text] : table)
  {
    if ((code & bits) == bits)
    {
      texts.push_back(text);
      rest &= ~static_cast<std::uint32_t>(bits);
    }
  }
  if (rest != 0)
  {
    texts.push_back("warning " + std::to_string(rest));
  }
  return util::joined(texts);
}
}  // namespace

std::string Drive::warningText(std::uint32_t code) const
{
  if (code == 0)
  {
    return "";
  }
  if (profile_.warning_bits)
  {
    return warningBits(code, profile_.warnings);
  }
  const auto text = code <= 0xFFFF ? profile_.warnings.find(static_cast<std::uint16_t>(code)) : profile_.warnings.end();
  return text != profile_.warnings.end() ? text->second : "warning " + std::to_string(code);
}

namespace
{
/// CompoWay/F: 0x1103 is a response code, 0x0013 an end code.
std::string compowayText(std::uint16_t error_id, const std::map<unsigned, std::string>& own)
{
  constexpr unsigned LAST_END_CODE = 0x00FF;
  const auto meaning = own.find(error_id);
  const bool end_code = error_id <= LAST_END_CODE;
  if (error_id == 0 || (meaning == own.end() && error_id >= 0x0200 && error_id < 0x0300))
  {
    return "";  // 0x0205 to 0x0207 are the bus's own
  }
  return (end_code ? "end code " + util::hexText(error_id, 2) : "response code " + util::hexText(error_id, 4)) + ": " +
         (meaning == own.end() ? "unknown to the profile" : meaning->second);
}
}  // namespace

std::string Drive::exceptionText(std::uint16_t error_id) const
{
  if (profile_.protocol == "compoway_f" && error_id < 0x8000)
  {
    return compowayText(error_id, profile_.exceptions);
  }
  if (error_id < 0x8001 || error_id > 0x9FFF)
  {
    return "";
  }
  const unsigned code = error_id & 0xFFU;
  const auto own = profile_.exceptions.find(code);
  const auto common = commonExceptions().find(code);
  std::string meaning = "unknown to the profile";
  if (own != profile_.exceptions.end())
  {
    meaning = own->second;
  }
  else if (common != commonExceptions().end())
  {
    meaning = common->second;
  }
  return "exception " + util::hexText(code, 2) + "H: " + meaning;
}
}  // namespace drive
}  // namespace inverter_bus
