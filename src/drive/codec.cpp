// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "codec.h"

#include <cstddef>

#include "numbers.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr std::size_t HEADER = 2;  // function code, byte count

void append(wire::Bytes& bytes, std::uint32_t word)
{
  bytes.push_back(static_cast<std::uint8_t>((word >> 8) & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFF));
}

bool isReplyTo(Space space, const wire::Bytes& reply)
{
  const std::uint8_t function = space == Space::Coil ? READ_COILS : READ_REGISTERS;
  return reply.size() >= HEADER && reply[0] == function && reply.size() >= HEADER + reply[1];
}

std::optional<std::uint32_t> extractCoils(std::size_t index, unsigned count, const wire::Bytes& reply)
{
  if (index + count > static_cast<std::size_t>(reply[1]) * 8)
  {
    return std::nullopt;
  }
  std::uint32_t raw = 0;
  for (unsigned i = 0; i < count; ++i)
  {
    const std::size_t bit = index + i;
    raw |= static_cast<std::uint32_t>((reply[HEADER + bit / 8] >> (bit % 8)) & 1) << i;
  }
  return raw;
}

std::optional<std::uint32_t> extractRegisters(std::size_t index, unsigned count, const wire::Bytes& reply)
{
  if ((index + count) * 2 > reply[1])
  {
    return std::nullopt;
  }
  std::uint32_t raw = 0;
  for (std::size_t i = index * 2; i < (index + count) * 2; ++i)
  {
    raw = (raw << 8) | reply[HEADER + i];
  }
  return raw;
}

wire::Bytes encodeCoil(const Item& item, std::uint32_t raw, const Profile& profile)
{
  if (profile.functions.count(WRITE_COIL) != 0)
  {
    wire::Bytes pdu = { WRITE_COIL };
    append(pdu, item.address);
    append(pdu, raw != 0 ? 0xFF00 : 0x0000);
    return pdu;
  }
  wire::Bytes pdu = { WRITE_COILS };
  append(pdu, item.address);
  append(pdu, 1);
  pdu.push_back(1);
  pdu.push_back(raw != 0 ? 1 : 0);
  return pdu;
}
}  // namespace

wire::Bytes encodeRead(Space space, std::uint16_t address, unsigned count)
{
  wire::Bytes pdu = { space == Space::Coil ? READ_COILS : READ_REGISTERS };
  append(pdu, address);
  append(pdu, count);
  return pdu;
}

wire::Bytes encodeWrite(const Item& item, std::uint32_t raw, const Profile& profile)
{
  if (item.space == Space::Coil)
  {
    return encodeCoil(item, raw, profile);
  }
  if (item.size == 1 && profile.functions.count(WRITE_REGISTER) != 0)
  {
    wire::Bytes pdu = { WRITE_REGISTER };
    append(pdu, item.address);
    append(pdu, raw);
    return pdu;
  }
  wire::Bytes pdu = { WRITE_REGISTERS };
  append(pdu, item.address);
  append(pdu, item.size);
  pdu.push_back(static_cast<std::uint8_t>(item.size * 2));
  if (item.size == 2)
  {
    append(pdu, raw >> 16);
  }
  append(pdu, raw);
  return pdu;
}

std::optional<std::uint32_t> extractRaw(const Item& item, std::uint16_t first, const wire::Bytes& reply)
{
  if (!isReplyTo(item.space, reply) || item.number < first)
  {
    return std::nullopt;
  }
  const std::size_t index = static_cast<std::size_t>(item.number - first);
  const auto raw =
      item.space == Space::Coil ? extractCoils(index, item.size, reply) : extractRegisters(index, item.size, reply);
  if (!raw)
  {
    return std::nullopt;
  }
  return item.bit ? (*raw >> *item.bit) & 1U : *raw & item.mask;
}

double scaled(const Item& item, std::uint32_t raw)
{
  double counts = raw;
  if (item.is_signed)
  {
    counts = item.size == 2 ? static_cast<double>(static_cast<std::int32_t>(raw))
                            : static_cast<double>(static_cast<std::int16_t>(raw & 0xFFFF));
  }
  return scaleCounts(counts, item.resolution);
}

std::optional<int> meaning(const Item& item, std::uint32_t raw)
{
  const auto found = item.values.find(raw);
  return found == item.values.end() ? std::nullopt : std::optional<int>(found->second);
}
}  // namespace drive
}  // namespace inverter_bus
