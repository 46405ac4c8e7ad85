// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bench/profile_memory.h"

namespace inverter_bus
{
namespace bench
{
namespace
{
bool lies(const drive::Item& item)
{
  return !item.missing && (item.space == drive::Space::Register || item.space == drive::Space::Coil);
}
}  // namespace

ProfileMemory::ProfileMemory(const drive::Profile& profile)
{
  for (const auto& point : profile.points)
  {
    add(point.second.item);
  }
  for (const auto& field : profile.status)
  {
    add(field.second);
  }
  for (const auto& parameter : profile.parameters)
  {
    add(parameter.second.item);
  }
  for (const auto& entry : profile.history.entries)
  {
    for (const auto& field : entry)
    {
      add(field.second);
    }
  }
  for (const auto& item : { profile.store_busy, profile.keep_alive })
  {
    if (item)
    {
      add(*item);
    }
  }
  for (const auto& span : profile.register_spans)
  {
    addSpan(drive::Space::Register, span, profile.first_register);
  }
  for (const auto& span : profile.coil_spans)
  {
    addSpan(drive::Space::Coil, span, profile.first_register);
  }
}

void ProfileMemory::add(const drive::Item& item)
{
  for (unsigned i = 0; lies(item) && i < item.size; ++i)
  {
    (item.space == drive::Space::Coil ? coils_ : registers_).emplace(static_cast<std::uint16_t>(item.address + i), 0);
  }
}

void ProfileMemory::addSpan(drive::Space space, const std::pair<unsigned, unsigned>& span, unsigned offset)
{
  for (unsigned number = span.first; number <= span.second; ++number)
  {
    (space == drive::Space::Coil ? coils_ : registers_).emplace(static_cast<std::uint16_t>(number - offset), 0);
  }
}

const ProfileMemory::Words& ProfileMemory::words(drive::Space space) const
{
  return space == drive::Space::Coil ? coils_ : registers_;
}

bool ProfileMemory::has(drive::Space space, std::uint16_t address) const
{
  return words(space).count(address) != 0;
}

std::uint16_t ProfileMemory::word(drive::Space space, std::uint16_t address) const
{
  const auto found = words(space).find(address);
  return found == words(space).end() ? std::uint16_t{ 0 } : found->second;
}

void ProfileMemory::setWord(drive::Space space, std::uint16_t address, std::uint16_t word)
{
  (space == drive::Space::Coil ? coils_ : registers_)[address] = word;
}

std::uint32_t ProfileMemory::whole(const drive::Item& item) const
{
  std::uint32_t raw = 0;
  for (unsigned i = 0; lies(item) && i < item.size; ++i)
  {
    const std::uint32_t one = word(item.space, static_cast<std::uint16_t>(item.address + i));
    raw = item.space == drive::Space::Coil ? raw | one << i : raw << 16U | one;
  }
  return raw;
}

void ProfileMemory::setWhole(const drive::Item& item, std::uint32_t raw)
{
  for (unsigned i = 0; lies(item) && i < item.size; ++i)
  {
    const unsigned shift = item.space == drive::Space::Coil ? i : 16U * (item.size - 1 - i);
    const std::uint32_t bits = item.space == drive::Space::Coil ? 1U : 0xFFFFU;
    setWord(item.space, static_cast<std::uint16_t>(item.address + i), static_cast<std::uint16_t>(raw >> shift & bits));
  }
}

void ProfileMemory::put(const drive::Item& item, std::uint32_t raw)
{
  const std::uint32_t mask = item.bit ? 1U << *item.bit : item.mask;
  const std::uint32_t bits = item.bit ? raw << *item.bit : raw;
  setWhole(item, (whole(item) & ~mask) | (bits & mask));
}

bool ProfileMemory::covers(const drive::Item& item, drive::Space space, std::uint16_t address)
{
  return lies(item) && item.space == space && address >= item.address &&
         address - item.address < static_cast<int>(item.size);
}
}  // namespace bench
}  // namespace inverter_bus
