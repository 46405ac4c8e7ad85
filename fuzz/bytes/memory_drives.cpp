// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Functions of Modbus application protocol V1.1b3, section 6; coils of the 3G3MX2 (I585), registers of the VF-S15 (E6581913).
#include "memory_drives.h"

#include "checks.h"
#include "inverter_bus/wire/protocol.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using wire::Bytes;

// On the wire, one less than printed.
constexpr unsigned MX2_RUN = 0x0000;
constexpr unsigned MX2_OPERATION = 0x000E;
constexpr unsigned MX2_READY = 0x0010;
constexpr unsigned MX2_RUNNING = 0x0012;
constexpr unsigned MX2_FAULTED = 0x0017;

constexpr unsigned VFS15_COMMAND = 0xFA00;
constexpr unsigned VFS15_STATUS = 0xFD01;
constexpr unsigned VFS15_MODEL_CODE = 0xFB07;
constexpr std::uint16_t VFS15_MODEL = 224;
constexpr unsigned VFS15_RUN_BIT = 0x0400;
constexpr unsigned VFS15_TRIPPED_BIT = 0x2000;

unsigned word(const Bytes& bytes, std::size_t place)
{
  return place + 1 < bytes.size() ? static_cast<unsigned>(bytes[place]) << 8 | bytes[place + 1] : 0;
}
}  // namespace

MemoryDrives::MemoryDrives(wire::VirtualClock& clock) : FakePort(clock)
{
}

void MemoryDrives::setDeaf(bool deaf)
{
  deaf_ = deaf;
}

void MemoryDrives::setTripped(bool tripped)
{
  tripped_ = tripped;
}

const std::set<Bytes>& MemoryDrives::writes() const
{
  return writes_;
}

bool MemoryDrives::coil(const Memory& memory, unsigned address) const
{
  if (address == MX2_FAULTED)
  {
    return tripped_;
  }
  const bool running = address == MX2_OPERATION || address == MX2_RUNNING;
  const auto found = memory.coils.find(running ? MX2_RUN : address);
  return address == MX2_READY || (found != memory.coils.end() && found->second);
}

std::uint16_t MemoryDrives::value(const Memory& memory, unsigned address) const
{
  if (address == VFS15_MODEL_CODE)
  {
    return VFS15_MODEL;
  }
  const auto found = memory.registers.find(address == VFS15_STATUS ? VFS15_COMMAND : address);
  const unsigned held = found == memory.registers.end() ? 0U : found->second;
  return static_cast<std::uint16_t>(
      address == VFS15_STATUS ? (held & VFS15_RUN_BIT) | (tripped_ ? VFS15_TRIPPED_BIT : 0U) : held);
}

Bytes MemoryDrives::readCoils(const Memory& memory, unsigned address, unsigned count) const
{
  Bytes pdu{ 0x01, static_cast<std::uint8_t>((count + 7) / 8) };
  pdu.resize(2 + (count + 7) / 8);
  for (unsigned i = 0; i < count; ++i)
  {
    pdu[2 + i / 8] = static_cast<std::uint8_t>(pdu[2 + i / 8] | (coil(memory, address + i) ? 1U : 0U) << i % 8);
  }
  return pdu;
}

Bytes MemoryDrives::readRegisters(const Memory& memory, std::uint8_t function, unsigned address, unsigned count) const
{
  Bytes pdu{ function, static_cast<std::uint8_t>(count * 2) };
  for (unsigned i = 0; i < count; ++i)
  {
    const unsigned held = value(memory, address + i);
    pdu.push_back(static_cast<std::uint8_t>(held >> 8));
    pdu.push_back(static_cast<std::uint8_t>(held & 0xFFU));
  }
  return pdu;
}

void MemoryDrives::write(Memory& memory, unsigned address, const Bytes& data, std::size_t from)
{
  for (std::size_t place = from; place + 1 < data.size(); place += 2)
  {
    memory.registers[address++] = static_cast<std::uint16_t>(word(data, place));
  }
}

bool MemoryDrives::send(const Bytes& frame)
{
  require(frame.size() >= 4 && frame.size() <= 256, "a frame of a length that Modbus does not have");
  if (!FakePort::send(frame))
  {
    return false;
  }
  const Bytes pdu = answer(Bytes(frame.begin(), frame.end() - 2));
  if (!deaf_ && frame[0] != 0 && !pdu.empty())
  {
    Bytes reply{ frame[0] };
    reply.insert(reply.end(), pdu.begin(), pdu.end());
    const std::uint16_t crc = wire::modbusCrc(reply.data(), reply.size());
    reply.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    reply.push_back(static_cast<std::uint8_t>(crc >> 8));
    deliver(std::chrono::milliseconds(5), reply);
  }
  return true;
}

/// \p frame without its check sum; empty: no answer.
Bytes MemoryDrives::answer(const Bytes& frame)
{
  const Bytes request(frame.begin() + 1, frame.end());
  const std::uint8_t function = request[0];
  const unsigned address = word(request, 1);
  const unsigned count = word(request, 3);
  if (function == 0x05 || function == 0x06 || function == 0x0F || function == 0x10 || function == 0x17)
  {
    const std::size_t place = function == 0x17 ? 5 : 1;
    writes_.insert({ frame[0], function, request[place], request[place + 1] });
  }
  if (deaf_)
  {
    return {};
  }
  Memory& memory = stations_[frame[0]];
  switch (function)
  {
    case 0x01:
      return readCoils(memory, address, count);
    case 0x03:
      return readRegisters(memory, function, address, count);
    case 0x05:
      memory.coils[address] = count != 0;
      return request;
    case 0x06:
      write(memory, address, request, 3);
      return request;
    case 0x08:
      return request;
    case 0x0F:
      for (unsigned i = 0; i < count; ++i)
      {
        memory.coils[address + i] = (request[6 + i / 8] >> i % 8 & 1U) != 0;
      }
      return Bytes(request.begin(), request.begin() + 5);
    case 0x10:
      write(memory, address, request, 6);
      return Bytes(request.begin(), request.begin() + 5);
    case 0x17:
      write(memory, word(request, 5), request, 10);
      return readRegisters(memory, function, address, count);
    default:
      return { static_cast<std::uint8_t>(function | 0x80U), 0x01 };
  }
}
}  // namespace fuzz
}  // namespace inverter_bus
