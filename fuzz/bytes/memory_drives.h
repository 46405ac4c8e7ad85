// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_MEMORY_DRIVES_H
#define INVERTER_BUS_FUZZ_MEMORY_DRIVES_H

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>

#include "support/fake_port.h"

namespace inverter_bus
{
namespace fuzz
{
/// A port behind which every station is a piece of memory that speaks Modbus RTU: what was written is read back, and RUN
/// shows as running. No motor, no time on the wire: the cheapest bus on which commands and services succeed.
class MemoryDrives : public wire::FakePort
{
public:
  explicit MemoryDrives(wire::VirtualClock& clock);

  bool send(const wire::Bytes& frame) override;

  /// Nobody answers any more, or again.
  void setDeaf(bool deaf);
  /// The drives trip, or their trips are over.
  void setTripped(bool tripped);

  /// Station, function and address of each write so far.
  const std::set<wire::Bytes>& writes() const;

private:
  struct Memory
  {
    std::map<unsigned, bool> coils;
    std::map<unsigned, std::uint16_t> registers;
  };
  wire::Bytes answer(const wire::Bytes& frame);
  wire::Bytes readCoils(const Memory& memory, unsigned address, unsigned count) const;
  wire::Bytes readRegisters(const Memory& memory, std::uint8_t function, unsigned address, unsigned count) const;
  void write(Memory& memory, unsigned address, const wire::Bytes& data, std::size_t from);
  bool coil(const Memory& memory, unsigned address) const;
  std::uint16_t value(const Memory& memory, unsigned address) const;

  std::map<std::uint8_t, Memory> stations_;
  std::set<wire::Bytes> writes_;
  bool deaf_ = false;
  bool tripped_ = false;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_MEMORY_DRIVES_H
