// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "support/heap_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace inverter_bus
{
namespace heap
{
namespace
{
/// Precedes each block. As large as the strictest alignment that plain operator new promises.
struct alignas(std::max_align_t) Header
{
  std::size_t size;
  Owner owner;
};

struct Counter
{
  std::atomic<long long> bytes{ 0 };
  std::atomic<long long> blocks{ 0 };
};

/// Used before and after main(): constant initialisation, trivial destruction.
Counter counters[OWNERS];
thread_local Owner current = Owner::OTHERS;

Counter& counterOf(Owner owner)
{
  return counters[static_cast<std::size_t>(owner)];
}
}  // namespace

Live live(Owner owner)
{
  Live result;
  result.bytes = counterOf(owner).bytes;
  result.blocks = counterOf(owner).blocks;
  return result;
}

Scope::Scope(Owner owner) : before_(current)
{
  current = owner;
}

Scope::~Scope()
{
  current = before_;
}

namespace
{
void* take(std::size_t size)
{
  void* memory = std::malloc(sizeof(Header) + size);
  if (memory == nullptr)
  {
    throw std::bad_alloc();
  }
  auto* header = new (memory) Header{ size, current };
  counterOf(current).bytes += static_cast<long long>(size);
  ++counterOf(current).blocks;
  return header + 1;
}

void giveBack(void* block) noexcept
{
  if (block == nullptr)
  {
    return;
  }
  Header* header = static_cast<Header*>(block) - 1;
  Counter& counter = counterOf(header->owner);
  counter.bytes -= static_cast<long long>(header->size);
  --counter.blocks;
  std::free(header);
}
}  // namespace
}  // namespace heap
}  // namespace inverter_bus

// All of them but those for stricter alignment, which nothing here uses: a sanitizer would bring its own for the rest.
void* operator new(std::size_t size)
{
  return inverter_bus::heap::take(size);
}

void* operator new[](std::size_t size)
{
  return inverter_bus::heap::take(size);
}

void operator delete(void* block) noexcept
{
  inverter_bus::heap::giveBack(block);
}

void operator delete(void* block, std::size_t) noexcept
{
  inverter_bus::heap::giveBack(block);
}

void operator delete[](void* block) noexcept
{
  inverter_bus::heap::giveBack(block);
}

void operator delete[](void* block, std::size_t) noexcept
{
  inverter_bus::heap::giveBack(block);
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
  try
  {
    return inverter_bus::heap::take(size);
  }
  catch (const std::bad_alloc&)
  {
    return nullptr;
  }
}

void operator delete(void* block, const std::nothrow_t&) noexcept
{
  inverter_bus::heap::giveBack(block);
}

void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept
{
  return operator new(size, tag);
}

void operator delete[](void* block, const std::nothrow_t&) noexcept
{
  inverter_bus::heap::giveBack(block);
}
