// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The part of Drive that knows why the motor stands: trip memory, warnings, exceptions.

#include <cstdio>

#include "codec.h"
#include "inverter_bus/drive/drive.h"
#include "read_plan.h"
#include "status_fields.h"

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
    const auto raw = item == entry.end() ? std::nullopt : extractRaw(item->second, block.number, reply);
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

std::string Drive::warningText(std::uint32_t code) const
{
  if (code == 0)
  {
    return "";
  }
  const auto text = code <= 0xFFFF ? profile_.warnings.find(static_cast<std::uint16_t>(code)) : profile_.warnings.end();
  return text != profile_.warnings.end() ? text->second : "warning " + std::to_string(code);
}

std::string Drive::exceptionText(std::uint16_t error_id) const
{
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
  char number[8];
  std::snprintf(number, sizeof(number), "%02XH", code);
  return std::string("exception ") + number + ": " + meaning;
}
}  // namespace drive
}  // namespace inverter_bus
