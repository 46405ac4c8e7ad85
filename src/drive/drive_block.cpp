// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The part of Drive that reads words of the user's choice and writes command words beside them.

#include <algorithm>

#include "drive/codec/codec.h"
#include "drive/codec/read_plan.h"
#include "inverter_bus/drive/drive.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr unsigned COILS_PER_WORD = 16;
constexpr unsigned LEAST_WORDS = 2;  // VF-S15: E6581913 p27, 2 to 5 words

const Item* itemOf(const Profile& profile, int code)
{
  const auto found = code < 0 ? profile.block->codes.end() : profile.block->codes.find(static_cast<unsigned>(code));
  return found == profile.block->codes.end() || !found->second.item ? nullptr : &*found->second.item;
}

bool isBrought(const ReadBlock& block, const std::string& field)
{
  return std::find(block.fields.begin(), block.fields.end(), field) != block.fields.end();
}

std::vector<ReadBlock> planBeside(const Profile& profile, const ReadBlock& block, bool slow)
{
  std::map<std::string, Item> items;
  for (const auto& [field, item] : profile.status)
  {
    const bool wanted = (profile.slow.count(field) != 0) == slow && profile.when_faulted.count(field) == 0;
    if (wanted && item.unconfirmed.empty() && !isBrought(block, field))
    {
      items[field] = item;
    }
  }
  return planReads(items, profile);
}

std::vector<std::uint16_t> inSlotOrder(const Block& block, const std::vector<Word>& words)
{
  std::vector<std::uint16_t> values;
  for (const auto& entry : block.select)
  {
    const auto word = std::find_if(words.begin(), words.end(),
                                   [&entry](const Word& candidate) { return candidate.first == entry.first; });
    values.push_back(static_cast<std::uint16_t>(word == words.end() ? 0 : word->second & 0xFFFF));
  }
  return values;
}

wire::Request request(std::uint8_t station, wire::Bytes pdu)
{
  wire::Request result;
  result.station = station;
  result.pdu = std::move(pdu);
  return result;
}
}  // namespace

std::optional<ReadBlock> Drive::chosenRead(const std::vector<int>& codes) const
{
  if (!profile_.block)
  {
    return std::nullopt;
  }
  ReadBlock block = blockAround(profile_.block->read);
  std::size_t last = 0;
  for (std::size_t slot = 0; slot < codes.size() && slot < profile_.block->read_slots.size(); ++slot)
  {
    if (codes[slot] != 0 && itemOf(profile_, codes[slot]) == nullptr)
    {
      return std::nullopt;
    }
    const Item* item = itemOf(profile_, codes[slot]);
    block.chosen.push_back(item == nullptr ? std::uint16_t{ 0 } : item->number);
    last = item == nullptr ? last : slot + 1;
  }
  block.count = std::max<unsigned>(LEAST_WORDS, static_cast<unsigned>(last));
  block.chosen.resize(block.count, 0);
  for (const auto& [field, item] : profile_.status)
  {
    const bool there = std::find(block.chosen.begin(), block.chosen.end(), item.number) != block.chosen.end();
    if (there && item.unconfirmed.empty() && item.space == Space::Register && item.size == 1 &&
        profile_.when_faulted.count(field) == 0)
    {
      block.fields.push_back(field);
    }
  }
  return last == 0 ? std::nullopt : std::optional<ReadBlock>(block);
}

std::optional<ReadBlock> Drive::mappedRead() const
{
  if (!profile_.map || !profile_.map->unconfirmed.empty())
  {
    return std::nullopt;
  }
  const RegisterMap& map = *profile_.map;
  ReadBlock block = blockAround(map.read);
  block.mirrors = map.words;
  const auto mirrored = [&block](unsigned coil) {
    return std::any_of(block.mirrors.begin(), block.mirrors.end(), [coil](const MirroredCoils& word) {
      return coil >= word.first_coil && coil < word.first_coil + COILS_PER_WORD;
    });
  };
  const auto hidden = [&block](unsigned number) {
    return std::any_of(block.mirrors.begin(), block.mirrors.end(),
                       [number](const MirroredCoils& word) { return word.number == number; });
  };
  for (const auto& [field, item] : profile_.status)
  {
    bool there = item.unconfirmed.empty() && profile_.slow.count(field) == 0 && profile_.when_faulted.count(field) == 0;
    for (unsigned number = item.number; number < item.number + item.size; ++number)
    {
      const bool in_read = number >= block.number && number < block.number + block.count && !hidden(number);
      there = there && (item.space == Space::Coil ? mirrored(number) : item.space == Space::Register && in_read);
    }
    if (there)
    {
      block.fields.push_back(field);
    }
  }
  return block;
}

std::vector<ReadBlock> Drive::mapTableReads() const
{
  std::map<std::uint16_t, ReadBlock> by_number;
  for (const auto& entry : profile_.map ? profile_.map->table : std::vector<std::pair<std::string, std::uint32_t>>())
  {
    const Item& item = profile_.parameters.at(entry.first).item;
    by_number[item.number] = blockAround(item);
  }
  std::vector<ReadBlock> reads;
  for (const auto& [number, block] : by_number)
  {
    const bool follows = !reads.empty() && reads.back().number + reads.back().count == number &&
                         reads.back().count < profile_.read_registers;
    if (follows)
    {
      ++reads.back().count;
    }
    else
    {
      reads.push_back(block);
    }
  }
  return reads;
}

std::optional<std::uint32_t> Drive::mapEntry(const std::string& name, const ReadBlock& block,
                                             const wire::Bytes& reply) const
{
  const Item& item = profile_.parameters.at(name).item;
  const bool there = item.number >= block.number && item.number < block.number + block.count;
  return there ? extractRaw(item, block, reply, profile_) : std::nullopt;
}

std::vector<ReadBlock> Drive::fastBlocksBeside(const ReadBlock& block) const
{
  return planBeside(profile_, block, false);
}

std::vector<ReadBlock> Drive::slowBlocksBeside(const ReadBlock& block) const
{
  return planBeside(profile_, block, true);
}

std::optional<ReadBlock> Drive::variantOf(const ReadBlock& block) const
{
  ReadBlock variant = block;
  if (!block.mirrors.empty())
  {
    return std::nullopt;
  }
  if (!block.chosen.empty())
  {
    --variant.count;
    return variant.count < LEAST_WORDS ? std::nullopt : std::optional<ReadBlock>(variant);
  }
  ++variant.count;
  const unsigned last = block.number + block.count;
  const bool spanned = std::any_of(profile_.register_spans.begin(), profile_.register_spans.end(),
                                   [&](const auto& span) { return span.first <= block.number && last <= span.second; });
  const bool possible = block.space == Space::Register && spanned && variant.count <= profile_.read_registers;
  return possible ? std::optional<ReadBlock>(variant) : std::nullopt;
}

bool Drive::fitsBlockWrite(const std::vector<Word>& words) const
{
  if (!profile_.block || words.size() != profile_.block->select.size())
  {
    return false;
  }
  return std::all_of(profile_.block->select.begin(), profile_.block->select.end(), [&words](const auto& entry) {
    return std::any_of(words.begin(), words.end(), [&entry](const Word& word) { return word.first == entry.first; });
  });
}

wire::Request Drive::writeChosen(std::uint8_t station, const std::vector<Word>& words) const
{
  return request(station, encodeWriteRegisters(profile_.block->write.address, inSlotOrder(*profile_.block, words)));
}

wire::Request Drive::writeAndRead(std::uint8_t station, const std::vector<Word>& words, const ReadBlock& block) const
{
  if (profile_.block)
  {
    return request(station, encodeReadWrite(block, profile_.block->write.address, inSlotOrder(*profile_.block, words)));
  }
  const Item& item = profile_.points.at(words.front().first).item;
  const std::uint32_t raw = words.front().second;
  const auto high = static_cast<std::uint16_t>(raw >> 16U);
  const auto low = static_cast<std::uint16_t>(raw & 0xFFFFU);
  return request(station, encodeReadWrite(block, item.address,
                                          item.size == 2 ? std::vector<std::uint16_t>{ high, low }
                                                         : std::vector<std::uint16_t>{ low }));
}

std::vector<std::pair<std::string, std::string>> Drive::chosenValues(const ReadBlock& block, const wire::Bytes& reply,
                                                                     const Ratings& ratings) const
{
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& entry : profile_.block->codes)
  {
    const auto& item = entry.second.item;
    const bool shown = item && std::any_of(block.fields.begin(), block.fields.end(), [&](const std::string& field) {
                         return profile_.status.at(field).number == item->number;
                       });
    const auto raw = item && !shown ? extractRaw(*item, block, reply, profile_) : std::nullopt;
    if (!raw)
    {
      continue;
    }
    double value = scaled(*item, *raw);
    std::string unit = item->unit;
    const auto& rating = item->base == Base::RatedVoltage ? ratings.voltage : ratings.current;
    if (item->base != Base::None && rating)
    {
      value = value / 100.0 * *rating;
      unit = item->base == Base::RatedVoltage ? "V" : "A";
    }
    values.emplace_back(entry.second.title, util::withUnit(util::exactText(value), unit));
  }
  return values;
}
}  // namespace drive
}  // namespace inverter_bus
