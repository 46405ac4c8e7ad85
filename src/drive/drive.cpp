// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/drive/drive.h"

#include <algorithm>
#include <cmath>

#include "drive/codec/codec.h"
#include "drive/codec/compoway_codec.h"
#include "drive/codec/read_plan.h"
#include "drive/profile/numbers.h"
#include "drive/profile/status_fields.h"
#include "util/text.h"

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

bool usable(const Item& item)
{
  return item.unconfirmed.empty();
}

std::vector<ReadBlock> planStatus(const Profile& profile, Pace pace, const std::vector<std::string>& without = {})
{
  std::map<std::string, Item> items;
  for (const auto& [field, item] : profile.status)
  {
    const bool brought = std::find(without.begin(), without.end(), field) != without.end();
    if (usable(item) && paceOf(field, profile) == pace && !brought)
    {
      items[field] = item;
    }
  }
  return planReads(items, profile);
}

/// A drive that reports nothing is still asked for something: it must hear the bus, and the bus must hear it.
std::vector<ReadBlock> planFast(const Profile& profile)
{
  std::vector<ReadBlock> blocks = planStatus(profile, Pace::Fast);
  if (blocks.empty() && profile.keep_alive)
  {
    blocks.push_back(blockAround(*profile.keep_alive));
  }
  return blocks;
}

std::optional<ReadBlock> planRunRead(const Profile& profile)
{
  // Not `running`: a motor that still ramps down after a stop is not a RUN.
  const auto found = profile.status.find("run_seen");
  if (found == profile.status.end() || !usable(found->second))
  {
    return std::nullopt;
  }
  return planReads({ { found->first, found->second } }, profile).front();
}

wire::Request request(std::uint8_t station, wire::Bytes pdu)
{
  wire::Request result;
  result.station = station;
  result.pdu = std::move(pdu);
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

/// In SI units; empty where the drive counts in percent of an unknown rating.
std::optional<double> quantity(const Item& item, std::uint32_t raw, const Ratings& ratings)
{
  const double value = scaled(item, raw);
  if (item.base == Base::None)
  {
    return value;
  }
  const auto& rating = item.base == Base::RatedCurrent ? ratings.current : ratings.voltage;
  return rating ? std::optional<double>(value / 100.0 * *rating) : std::nullopt;
}

void decodeField(const std::string& field, const Item& item, std::uint32_t raw, const Ratings& ratings,
                 Monitor& monitor)
{
  const auto flag = flagFields().find(field);
  const auto amount = quantityFields().find(field);
  if (flag != flagFields().end())
  {
    const std::optional<bool> value = flagValue(item, raw);
    monitor.*(flag->second) = value;
    if (field == "faulted" && !value)
    {
      monitor.unknown_trip = raw;
    }
  }
  else if (amount != quantityFields().end())
  {
    monitor.*(amount->second) = quantity(item, raw, ratings);
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
    if (!step.unconfirmed.empty())
    {
      missing.insert(step.unconfirmed);
    }
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
  , fast_blocks_(planFast(profile_))
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
  return request(station, encodeRead(block));
}

void Drive::decode(const ReadBlock& block, const wire::Bytes& reply, Monitor& monitor, const Ratings& ratings) const
{
  for (const std::string& field : block.fields)
  {
    const auto item = profile_.status.find(field);
    if (item == profile_.status.end())
    {
      continue;
    }
    if (const auto raw = extractRaw(item->second, block, reply, profile_))
    {
      decodeField(field, item->second, *raw, ratings, monitor);
    }
  }
}

ReadBlock Drive::blockOf(const std::vector<std::string>& fields) const
{
  ReadBlock block = blockAround(profile_.status.at(fields.front()));
  const auto position = [this](const ReadBlock& around) {
    return around.space == Space::Register ? profile_.position(around.number) : around.number;
  };
  unsigned end = 0;
  for (const std::string& field : fields)
  {
    const ReadBlock around = blockAround(profile_.status.at(field));
    end = std::max(end, position(around) + around.count);
    if (position(around) < position(block))
    {
      block.number = around.number;
      block.address = around.address;
    }
  }
  block.count = end - position(block);
  block.fields = fields;
  return block;
}

bool Drive::tellsRun() const
{
  return run_block_.has_value();
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
    // A motor that can't be stopped for certain must not be started.
    collectMissing("stop", profile_, missing);
  }
  return util::joined(missing);
}

bool Drive::runsWithoutStop() const
{
  const auto armed = [this](const char* name) {
    std::set<std::string> missing;
    collectMissing(name, profile_, missing);
    return profile_.sequences.count(name) != 0 && missing.empty();
  };
  return (armed("forward") || armed("reverse")) && !armed("stop");
}

std::string Drive::armingAdvice(const std::string& name) const
{
  std::set<std::string> missing;
  collectMissing(name, profile_, missing);
  if (name == "forward" || name == "reverse")
  {
    collectMissing("stop", profile_, missing);
  }
  return adviceFor(missing);
}

std::string Drive::unconfirmedText() const
{
  const std::string unneeded = skippableUnconfirmed();
  return profile_.unconfirmed.empty()
             ? ""
             : util::joined(profile_.unconfirmed) + "; " + adviceFor(profile_.unconfirmed) +
                   (unneeded.empty() ? "" : "; fields that are not needed can be left out: skip: [" + unneeded + "]");
}

/// Names for `skip` in which something is unconfirmed.
std::string Drive::skippableUnconfirmed() const
{
  std::set<std::string> names;
  for (const auto& [field, item] : profile_.status)
  {
    if (!item.unconfirmed.empty() && skippableFields().count(field) != 0)
    {
      names.insert(field);
    }
  }
  if (profile_.store_busy && !profile_.store_busy->unconfirmed.empty())
  {
    names.insert("store_busy");
  }
  for (const auto& entry : profile_.history.entries)
  {
    const bool open = std::any_of(entry.begin(), entry.end(), [](const auto& field) {
      return field.first != "code" && !field.second.unconfirmed.empty();
    });
    if (open)
    {
      names.insert("trip_memory");
    }
  }
  return util::joined(names);
}

/// A value that is known but unproven must be confirmed; one that is unknown must be set.
std::string Drive::adviceFor(const std::set<std::string>& marks) const
{
  std::string known;
  std::string unknown;
  for (const std::string& mark : marks)
  {
    const auto constant = std::find_if(profile_.constants.begin(), profile_.constants.end(), [&](const auto& entry) {
      return entry.second.unconfirmed == mark && !entry.second.value;
    });
    if (constant == profile_.constants.end())
    {
      known += (known.empty() ? "'" : ", '") + mark + "'";
      continue;
    }
    unknown += (unknown.empty() ? "'" : ", '") + constant->first + "'";
    unknown += constant->second.where.empty() ? "" : " (see " + constant->second.where + ")";
  }
  std::string advice = known.empty() ? "" : "check " + known + " in the drive's manual or on the drive, then confirm";
  advice += advice.empty() || unknown.empty() ? "" : "; ";
  return advice + (unknown.empty() ? "" : "set " + unknown + " under overrides");
}

wire::Request Drive::command(std::uint8_t station, const Step& step, std::uint32_t setpoint) const
{
  wire::Request result = write(station, step.point, step.value.value_or(setpoint));
  result.expects_reply = result.expects_reply && step.expects_reply;
  return result;
}

bool Drive::wears(const std::string& point) const
{
  const auto found = profile_.points.find(point);
  return found != profile_.points.end() && found->second.wears;
}

wire::Request Drive::write(std::uint8_t station, const std::string& point, std::uint32_t raw) const
{
  const auto found = profile_.points.find(point);
  return request(station,
                 found == profile_.points.end() ? wire::Bytes() : encodeWrite(found->second.item, raw, profile_));
}

wire::Request Drive::broadcast(const std::string& point, std::uint32_t raw) const
{
  wire::Request result = write(0, point, raw);
  result.broadcast = true;
  result.expects_reply = false;
  return result;
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
  if (profile_.protocol == "compoway_f")
  {
    return profile_.functions.count(ECHOBACK) == 0
               ? std::nullopt
               : std::optional<wire::Request>(request(station, encodeService(ECHOBACK, hexDigits(number, 4))));
  }
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
  return request(station, encodeRead(blockAround(*profile_.store_busy)));
}

bool Drive::decodeStoreBusy(const wire::Bytes& reply) const
{
  if (!profile_.store_busy)
  {
    return false;
  }
  const Item& item = *profile_.store_busy;
  return extractRaw(item, blockAround(item), reply, profile_).value_or(0) != 0;
}

std::optional<wire::Request> Drive::readAttributes(std::uint8_t station) const
{
  if (profile_.protocol != "compoway_f" || profile_.functions.count(READ_ATTRIBUTES) == 0)
  {
    return std::nullopt;
  }
  return request(station, encodeService(READ_ATTRIBUTES));
}

std::string Drive::decodeModel(const wire::Bytes& reply) const
{
  constexpr std::size_t MODEL = 10;  // characters, padded with spaces
  std::string model = responseData(READ_ATTRIBUTES, reply).value_or("").substr(0, MODEL);
  model.erase(model.find_last_not_of(' ') + 1);
  // ROS messages want UTF-8, and a damaged byte is not a letter.
  std::replace_if(
      model.begin(), model.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return model;
}
}  // namespace drive
}  // namespace inverter_bus
