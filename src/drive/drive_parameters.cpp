// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The part of Drive that reads and writes the drive's parameters.

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>

#include "config/numerals.h"
#include "drive/codec/codec.h"
#include "drive/profile/numbers.h"
#include "inverter_bus/drive/drive.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// A value that lies this close to a whole count is meant to be it (0.1 + 0.2 is not 0.3 in a double).
constexpr double COUNT_TOLERANCE = 1e-6;

bool isWide(const Item& item)
{
  return item.size == 2 || item.space == Space::Variable;
}

/// "C3/0005": variable type and address as the CompoWay/F manuals write them.
bool isVariable(const std::string& name)
{
  static const std::regex FORM("[0-9A-F]{2}/[0-9A-F]{4}");
  return std::regex_match(name, FORM);
}

/// A place in the drive instead of a name of the table.
bool isPlace(const std::string& name)
{
  const bool number = name.size() > 2 && name[0] == '0' && (name[1] == 'x' || name[1] == 'X');
  return number || isVariable(name);
}

std::optional<Parameter> rawVariable(const std::string& name)
{
  if (!isVariable(name))
  {
    return std::nullopt;
  }
  Parameter parameter;
  parameter.name = name;
  parameter.read_only = true;
  parameter.item.space = Space::Variable;
  parameter.item.area = static_cast<std::uint8_t>(std::stoul(name.substr(0, 2), nullptr, 16));
  parameter.item.number = static_cast<std::uint16_t>(std::stoul(name.substr(3), nullptr, 16));
  parameter.item.address = parameter.item.number;
  return parameter;
}

/// Any register may be read by the number printed in the manual, whether the table knows it or not.
std::optional<Parameter> rawRegister(const std::string& name, const Profile& profile)
{
  if (profile.protocol == "compoway_f")
  {
    return rawVariable(name);
  }
  const auto number = config::parseInteger(name);
  if (!number || *number > 0xFFFF || *number < profile.first_register)
  {
    return std::nullopt;
  }
  Parameter parameter;
  parameter.name = name;
  parameter.read_only = true;
  parameter.item.number = static_cast<std::uint16_t>(*number);
  parameter.item.address = static_cast<std::uint16_t>(*number - profile.first_register);
  return parameter;
}

std::optional<Parameter> findByNumber(const std::string& name, const Profile& profile)
{
  auto raw = rawRegister(name, profile);
  if (!raw)
  {
    return raw;
  }
  const auto same_place = [&raw](const auto& entry) {
    const Item& item = entry.second.item;
    return item.number == raw->item.number && item.area == raw->item.area && item.unconfirmed.empty();
  };
  const auto found = std::find_if(profile.parameters.begin(), profile.parameters.end(), same_place);
  return found == profile.parameters.end() ? raw : std::optional<Parameter>(found->second);
}

std::string withUnit(double value, const Item& item)
{
  return util::withUnit(util::exactText(value), item.unit);
}

std::string outside(const Parameter& parameter, double value, double lowest, double highest, const std::string& why)
{
  return parameter.name + ": " + withUnit(value, parameter.item) + " is outside " + util::exactText(lowest) + " to " +
         withUnit(highest, parameter.item) + why;
}

/// The value's neighbours on the drive's scale, for the refusal of one that lies between them.
std::string betweenCounts(const Parameter& parameter, double value, double counts)
{
  const Item& item = parameter.item;
  return parameter.name + ": " + withUnit(value, item) + " is not a multiple of the resolution " +
         withUnit(item.resolution, item) + ": the nearest are " +
         util::exactText(scaleCounts(std::floor(counts), item.resolution)) + " and " +
         withUnit(scaleCounts(std::ceil(counts), item.resolution), item);
}

std::pair<double, double> countLimits(const Item& item)
{
  const double counts = isWide(item) ? 4294967296.0 : 65536.0;
  const double lowest = item.is_signed ? -counts / 2.0 : 0.0;
  return { lowest, lowest + counts - 1.0 };
}

std::string refusal(const Parameter& parameter, double value, double counts)
{
  const Item& item = parameter.item;
  if (parameter.read_only)
  {
    return parameter.name + " is read-only";
  }
  if (!std::isfinite(value))
  {
    return parameter.name + ": the value is not a finite number";
  }
  const bool limited = parameter.range && !parameter.range_unconfirmed;
  // Half a tolerance of slack: 3600.0 must not fail because 360000 / 100 is a hair beyond.
  const double slack = COUNT_TOLERANCE * item.resolution;
  if (limited && (value < parameter.range->first - slack || value > parameter.range->second + slack))
  {
    return outside(parameter, value, parameter.range->first, parameter.range->second, "");
  }
  const auto limits = countLimits(item);
  if (counts < limits.first - COUNT_TOLERANCE || counts > limits.second + COUNT_TOLERANCE)
  {
    return outside(parameter, value, scaleCounts(limits.first, item.resolution),
                   scaleCounts(limits.second, item.resolution), ", what the register can hold");
  }
  return std::fabs(counts - std::round(counts)) > COUNT_TOLERANCE ? betweenCounts(parameter, value, counts) : "";
}
}  // namespace

std::optional<Parameter> Drive::findParameter(const std::string& name, bool for_write) const
{
  if (isPlace(name))
  {
    return for_write ? std::nullopt : findByNumber(name, profile_);
  }
  const auto found = profile_.parameters.find(name);
  if (found == profile_.parameters.end() || !found->second.item.unconfirmed.empty() ||
      (for_write && found->second.read_only))
  {
    return std::nullopt;
  }
  return found->second;
}

std::string Drive::missingForParameter(const std::string& name) const
{
  const auto found = profile_.parameters.find(name);
  return found == profile_.parameters.end() ? "" : found->second.item.unconfirmed;
}

std::string Drive::parameterRefusal(const std::string& name, bool for_write) const
{
  if (findParameter(name, for_write))
  {
    return "";
  }
  const std::string missing = missingForParameter(name);
  if (!missing.empty())
  {
    return "parameter " + name + " is not confirmed for this drive: check it in the drive's manual, then add " +
           missing + " to confirm";
  }
  if (profile_.parameters.count(name) != 0)
  {
    return "parameter " + name + " is read-only";
  }
  if (isPlace(name))
  {
    return for_write ? "register numbers are for reading only: a write needs a name from the profile"
                     : "register " + name + " does not exist";
  }
  return "parameter " + name + " is not in the profile " + profile_.name;
}

wire::Request Drive::readParameter(std::uint8_t station, const Parameter& parameter) const
{
  wire::Request request;
  request.station = station;
  request.pdu = encodeRead(blockAround(parameter.item));
  return request;
}

double Drive::decodeParameter(const Parameter& parameter, const wire::Bytes& reply) const
{
  const auto raw = extractRaw(parameter.item, blockAround(parameter.item), reply, profile_);
  return raw ? scaled(parameter.item, *raw) : std::numeric_limits<double>::quiet_NaN();
}

std::uint32_t Drive::rawParameter(const Parameter& parameter, const wire::Bytes& reply) const
{
  return extractRaw(parameter.item, blockAround(parameter.item), reply, profile_).value_or(0);
}

Encoded Drive::encodeParameter(const Parameter& parameter, double value) const
{
  Encoded encoded;
  const double counts = toCounts(value, parameter.item.resolution);
  encoded.error = refusal(parameter, value, counts);
  encoded.ok = encoded.error.empty();
  if (encoded.ok)
  {
    // Through 64 bits: a negative count becomes two's complement of the register's size.
    const auto whole = static_cast<std::uint64_t>(std::llround(counts));
    encoded.raw = static_cast<std::uint32_t>(whole & (isWide(parameter.item) ? 0xFFFFFFFFULL : 0xFFFFULL));
  }
  return encoded;
}

wire::Request Drive::writeParameter(std::uint8_t station, const Parameter& parameter, std::uint32_t raw) const
{
  wire::Request request;
  request.station = station;
  request.pdu = encodeWrite(parameter.item, raw, profile_);
  return request;
}
}  // namespace drive
}  // namespace inverter_bus
