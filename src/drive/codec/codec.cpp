// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/codec/codec.h"

#include <algorithm>
#include <cstddef>

#include "drive/codec/compoway_codec.h"
#include "drive/profile/numbers.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr unsigned COILS_PER_WORD = 16;
constexpr std::size_t HEADER = 2;  // function code, byte count

void append(wire::Bytes& bytes, std::uint32_t word)
{
  bytes.push_back(static_cast<std::uint8_t>((word >> 8) & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFF));
}

bool isModbus(Space space)
{
  return space == Space::Coil || space == Space::Register;
}

bool isReplyTo(Space space, const wire::Bytes& reply)
{
  if (reply.size() < HEADER || reply.size() < HEADER + reply[1])
  {
    return false;
  }
  return space == Space::Coil ? reply[0] == READ_COILS : reply[0] == READ_REGISTERS || reply[0] == READ_WRITE_REGISTERS;
}

/// Which word of the reply holds the item.
std::optional<std::size_t> indexIn(const ReadBlock& block, const Item& item, const Profile& profile)
{
  if (!block.chosen.empty())
  {
    const auto found = std::find(block.chosen.begin(), block.chosen.end(), item.number);
    if (found == block.chosen.end() || item.size != 1)
    {
      return std::nullopt;
    }
    return static_cast<std::size_t>(found - block.chosen.begin());
  }
  if (item.space != block.space || item.area != block.area || item.number < block.number)
  {
    return std::nullopt;
  }
  return item.space == Space::Register ? profile.position(item.number) - profile.position(block.number)
                                       : static_cast<std::size_t>(item.number - block.number);
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

/// Coils that lie in registers of a block.
std::optional<std::uint32_t> extractMirroredCoils(const Item& item, const ReadBlock& block, const wire::Bytes& reply)
{
  std::uint32_t raw = 0;
  for (unsigned i = 0; i < item.size; ++i)
  {
    const unsigned coil = item.number + i;
    const auto word = std::find_if(block.mirrors.begin(), block.mirrors.end(), [coil](const MirroredCoils& one) {
      return coil >= one.first_coil && coil < one.first_coil + COILS_PER_WORD;
    });
    const auto bits = word == block.mirrors.end()
                          ? std::nullopt
                          : extractRegisters(static_cast<std::size_t>(word->number - block.number), 1, reply);
    if (!bits)
    {
      return std::nullopt;
    }
    raw |= ((*bits >> (coil - word->first_coil)) & 1U) << i;
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

wire::Bytes encodeRead(const ReadBlock& block)
{
  if (!isModbus(block.space))
  {
    return encodeVariableRead(block);
  }
  wire::Bytes pdu = { block.space == Space::Coil ? READ_COILS : READ_REGISTERS };
  append(pdu, block.address);
  append(pdu, block.count);
  return pdu;
}

ReadBlock blockAround(const Item& item)
{
  ReadBlock block;
  block.space = item.space;
  block.area = item.area;
  block.number = item.number;
  block.address = item.address;
  block.count = item.size;
  return block;
}

wire::Bytes encodeWriteRegisters(std::uint16_t address, const std::vector<std::uint16_t>& words)
{
  wire::Bytes pdu = { WRITE_REGISTERS };
  append(pdu, address);
  append(pdu, static_cast<std::uint32_t>(words.size()));
  pdu.push_back(static_cast<std::uint8_t>(words.size() * 2));
  for (const std::uint16_t word : words)
  {
    append(pdu, word);
  }
  return pdu;
}

wire::Bytes encodeReadWrite(const ReadBlock& block, std::uint16_t write_address,
                            const std::vector<std::uint16_t>& words)
{
  wire::Bytes pdu = { READ_WRITE_REGISTERS };
  append(pdu, block.address);
  append(pdu, block.count);
  const wire::Bytes write = encodeWriteRegisters(write_address, words);
  pdu.insert(pdu.end(), write.begin() + 1, write.end());
  return pdu;
}

wire::Bytes encodeWrite(const Item& item, std::uint32_t raw, const Profile& profile)
{
  if (!isModbus(item.space))
  {
    return encodeVariableWrite(item, raw);
  }
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
  const auto low = static_cast<std::uint16_t>(raw & 0xFFFF);
  const auto high = static_cast<std::uint16_t>(raw >> 16);
  return encodeWriteRegisters(
      item.address, item.size == 2 ? std::vector<std::uint16_t>{ high, low } : std::vector<std::uint16_t>{ low });
}

std::optional<std::uint32_t> extractRaw(const Item& item, const ReadBlock& block, const wire::Bytes& reply,
                                        const Profile& profile)
{
  if (item.space == Space::Coil && block.space == Space::Register)
  {
    const auto coils = isReplyTo(block.space, reply) ? extractMirroredCoils(item, block, reply) : std::nullopt;
    return coils ? std::optional<std::uint32_t>(item.bit ? (*coils >> *item.bit) & 1U : *coils & item.mask) : coils;
  }
  const auto index = indexIn(block, item, profile);
  if (!index)
  {
    return std::nullopt;
  }
  std::optional<std::uint32_t> raw;
  if (!isModbus(item.space))
  {
    raw = extractElement(item.space, *index, reply);
  }
  else if (isReplyTo(item.space, reply))
  {
    raw =
        item.space == Space::Coil ? extractCoils(*index, item.size, reply) : extractRegisters(*index, item.size, reply);
  }
  const bool hole = raw && item.space == Space::Register && block.chosen.empty() && block.count > 1 && profile.hole &&
                    *raw == *profile.hole;
  if (!raw || hole)
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
    const bool wide = item.size == 2 || item.space == Space::Variable;
    counts = wide ? static_cast<double>(static_cast<std::int32_t>(raw))
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
