// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_HEAP_COUNT_H
#define INVERTER_BUS_HEAP_COUNT_H

#include <cstddef>

// Counts what lives on the heap of this program: heap_count.cpp replaces operator new and delete.

namespace inverter_bus
{
namespace heap
{
/// The owner of a block; it counts as the owner's until it is freed, no matter where.
enum class Owner
{
  OTHERS,
  DRIVER,
  SIMULATION
};
constexpr std::size_t OWNERS = 3;

struct Live
{
  long long bytes = 0;
  long long blocks = 0;
};

Live live(Owner owner);

/// What this thread takes from the heap during the life of this object is \p owner's.
class Scope
{
public:
  explicit Scope(Owner owner);
  ~Scope();

  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

private:
  Owner before_;
};
}  // namespace heap
}  // namespace inverter_bus

#endif  // INVERTER_BUS_HEAP_COUNT_H
