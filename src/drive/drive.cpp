// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/drive/drive.h"

#include <cmath>

#include "codec.h"
#include "numbers.h"
#include "read_plan.h"
#include "status_fields.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
enum class Pace
{
  Fast,
  Slow,
  Faulted
};

Pace paceOf(const std::string& field, const Profile& profile)
{
  if (profile.when_faulted.count(field) != 0)
  {
    return Pace::Faulted;
  }
  return profile.slow.count(field) != 0 ? Pace::Slow : Pace::Fast;
}

std::vector<ReadBlock> planStatus(const Profile& profile, Pace pace)
{
  std::map<std::string, Item> items;
  for (const auto& [field, item] : profile.status)
  {
    if (item.unconfirmed.empty() && paceOf(field, profile) == pace)
    {
      items[field] = item;
    }
  }
  return planReads(items, profile);
}

std::optional<ReadBlock> planRunRead(const Profile& profile)
{
  for (const char* field : { "run_seen", "running" })
  {
    const auto found = profile.status.find(field);
    if (found != profile.status.end() && found->second.unconfirmed.empty())
    {
      return planReads({ { found->first, found->second } }, profile).front();
    }
  }
  return std::nullopt;
}

wire::Request request(std::uint8_t station, wire::Bytes pdu)
{
  wire::Request result;
  result.station = station;
  result.pdu = std::move(pdu);
  result.broadcast = station == 0;
  result.expects_reply = !result.broadcast;
  return result;
}

std::optional<bool> flagValue(const Item& item, std::uint32_t raw)
{
  if (item.values.empty())
  {
    return raw != 0;
  }
  const auto value = meaning(item, raw);
  return value ? std::optional<bool>(*value != 0) : std::nullopt;
}

void decodeCode(const std::string& field, std::uint32_t raw, Monitor& monitor)
{
  if (field == "raw_status")
  {
    monitor.raw_status = raw;
  }
  else if (field == "fault_code")
  {
    monitor.fault_code = static_cast<std::uint16_t>(raw);
  }
  else if (field == "warning_code")
  {
    monitor.warning_code = raw;
  }
}

void decodeField(const std::string& field, const Item& item, std::uint32_t raw, Monitor& monitor)
{
  const auto flag = flagFields().find(field);
  const auto quantity = quantityFields().find(field);
  if (flag != flagFields().end())
  {
    monitor.*(flag->second) = flagValue(item, raw);
  }
  else if (quantity != quantityFields().end())
  {
    monitor.*(quantity->second) = scaled(item, raw);
  }
  else if (field == "direction")
  {
    monitor.direction = meaning(item, raw);
  }
  else
  {
    decodeCode(field, raw, monitor);
  }
}

void collectMissing(const std::string& name, const Profile& profile, std::set<std::string>& missing)
{
  const auto found = profile.sequences.find(name);
  if (found == profile.sequences.end())
  {
    return;
  }
  if (!found->second.unconfirmed.empty())
  {
    missing.insert(found->second.unconfirmed);
  }
  for (const Step& step : found->second.steps)
  {
    const auto point = profile.points.find(step.point);
    if (point != profile.points.end() && !point->second.item.unconfirmed.empty())
    {
      missing.insert(point->second.item.unconfirmed);
    }
  }
}
}  // namespace

Drive::Drive(Profile profile)
  : profile_(std::move(profile))
  , fast_blocks_(planStatus(profile_, Pace::Fast))
  , slow_blocks_(planStatus(profile_, Pace::Slow))
  , fault_blocks_(planStatus(profile_, Pace::Faulted))
  , run_block_(planRunRead(profile_))
{
}

const Profile& Drive::profile() const
{
  return profile_;
}

const std::vector<ReadBlock>& Drive::fastBlocks() const
{
  return fast_blocks_;
}

const std::vector<ReadBlock>& Drive::slowBlocks() const
{
  return slow_blocks_;
}

const std::vector<ReadBlock>& Drive::faultBlocks() const
{
  return fault_blocks_;
}

const std::optional<ReadBlock>& Drive::runBlock() const
{
  return run_block_;
}

wire::Request Drive::read(std::uint8_t station, const ReadBlock& block) const
{
  return request(station, encodeRead(block.space, block.address, block.count));
}

void Drive::decode(const ReadBlock& block, const wire::Bytes& reply, Monitor& monitor) const
{
  for (const std::string& field : block.fields)
  {
    const auto item = profile_.status.find(field);
    if (item == profile_.status.end())
    {
      continue;
    }
    if (const auto raw = extractRaw(item->second, block.number, reply))
    {
      decodeField(field, item->second, *raw, monitor);
    }
  }
}

bool Drive::reports(const std::string& field) const
{
  const auto item = profile_.status.find(field);
  return item != profile_.status.end() && item->second.unconfirmed.empty();
}

const Sequence* Drive::sequence(const std::string& name) const
{
  const auto found = profile_.sequences.find(name);
  return found == profile_.sequences.end() || !missingFor(name).empty() ? nullptr : &found->second;
}

std::string Drive::missingFor(const std::string& name) const
{
  std::set<std::string> missing;
  collectMissing(name, profile_, missing);
  if ((name == "forward" || name == "reverse") && profile_.sequences.count(name) != 0)
  {
    // What can't be stopped for certain must not be set running.
    collectMissing("stop", profile_, missing);
  }
  std::string names;
  for (const std::string& entry : missing)
  {
    names += (names.empty() ? "" : ", ") + entry;
  }
  return names;
}

wire::Request Drive::write(std::uint8_t station, const std::string& point, std::uint32_t raw) const
{
  const auto found = profile_.points.find(point);
  return request(station,
                 found == profile_.points.end() ? wire::Bytes() : encodeWrite(found->second.item, raw, profile_));
}

std::uint32_t Drive::frequencyCounts(double frequency_hz) const
{
  const double counts = std::round(toCounts(frequency_hz, frequencyResolution()));
  // The comparison is also false for NaN; callers have checked the range before.
  return counts > 0.0 && counts <= 4294967295.0 ? static_cast<std::uint32_t>(counts) : 0;
}

double Drive::frequencyResolution() const
{
  const auto point = profile_.points.find("frequency");
  return point == profile_.points.end() ? 1.0 : point->second.item.resolution;
}

std::optional<wire::Request> Drive::loopback(std::uint8_t station, std::uint16_t number) const
{
  if (profile_.functions.count(DIAGNOSTICS) == 0)
  {
    return std::nullopt;
  }
  return request(station, { DIAGNOSTICS, 0x00, 0x00, static_cast<std::uint8_t>(number >> 8),
                            static_cast<std::uint8_t>(number & 0xFF) });
}

std::optional<wire::Request> Drive::readStoreBusy(std::uint8_t station) const
{
  if (!profile_.store_busy || !profile_.store_busy->unconfirmed.empty())
  {
    return std::nullopt;
  }
  const Item& item = *profile_.store_busy;
  return request(station, encodeRead(item.space, item.address, item.size));
}

bool Drive::decodeStoreBusy(const wire::Bytes& reply) const
{
  if (!profile_.store_busy)
  {
    return false;
  }
  return extractRaw(*profile_.store_busy, profile_.store_busy->number, reply).value_or(0) != 0;
}
}  // namespace drive
}  // namespace inverter_bus
