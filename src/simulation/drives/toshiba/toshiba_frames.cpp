// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// What is special about the frames of a VF-S15: requests without a reply, 17h, 2Bh (E6581913 p. 24, 35-38).

#include <cmath>
#include <string>

#include "simulation/drives/toshiba/toshiba_numbers.h"
#include "simulation/drives/toshiba/toshiba_vfs15.h"
#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace simulation
{
using namespace toshiba;  // NOLINT: the numbers of this drive

namespace
{
constexpr std::uint8_t READ_WRITE = 0x17;
constexpr std::uint8_t IDENTIFY = 0x2B;
constexpr std::size_t IDENTIFY_LENGTH = 7;
constexpr std::uint8_t MEI_DEVICE_ID = 0x0E;
constexpr std::uint8_t LAST_DEVICE_ID_CODE = 0x03;

/// Sizes of the VF-S15: rated current [0.1 A] (M = from memory, but 4.8 A), FB05 (p. 74), type (2037PM: p. 38, else M).
struct Size
{
  std::uint32_t current;
  int code;
  const char* type;
};
constexpr Size SIZES_240[] = { { 33, 2, "2004PM" },   { 48, 4, "2007PM" },    { 80, 6, "2015PM" },
                               { 110, 7, "2022PM" },  { 175, 9, "2037PM" },   { 275, 10, "2055PM" },
                               { 330, 11, "2075PM" }, { 540, 108, "2110PM" }, { 0xFFFF, 109, "2150PM" } };
constexpr Size SIZES_500[] = { { 15, 34, "4004PL" },  { 23, 36, "4007PL" },  { 41, 38, "4015PL" },
                               { 55, 39, "4022PL" },  { 95, 41, "4037PL" },  { 143, 42, "4055PL" },
                               { 170, 43, "4075PL" }, { 277, 44, "4110PL" }, { 0xFFFF, 45, "4150PL" } };

const Size& sizeOf(std::uint32_t current, std::uint32_t voltage)
{
  const Size* size = voltage < 3000 ? SIZES_240 : SIZES_500;
  while (size->current < current)
  {
    ++size;
  }
  return *size;
}

void appendObject(Bytes& reply, std::uint8_t number, const std::string& text)
{
  reply.push_back(number);
  reply.push_back(static_cast<std::uint8_t>(text.size()));
  reply.insert(reply.end(), text.begin(), text.end());
}
}  // namespace

std::optional<Answer> ToshibaVfs15::answer(const Bytes& frame, TimePoint now, bool& good)
{
  silent_ = false;
  stored_ = false;
  timer_renewed_ = false;
  std::optional<Answer> reply;
  if (isBroadcast(frame))
  {
    return ModbusSlave::answer(frame, now, good);
  }
  if (model_.blocks && frame[1] == IDENTIFY)
  {
    good = frame.size() == IDENTIFY_LENGTH;
    reply = good ? std::optional<Answer>(identify(frame)) : std::nullopt;
  }
  else if (fixedFieldsWrong(frame))
  {
    reply = exceptionAnswer(frame, static_cast<int>(ModbusException::FormatNotAcceptable));
  }
  else
  {
    reply = ModbusSlave::answer(frame, now, good);
  }
  if (reply && reply->bytes[1] == frame[1] && !timer_renewed_)
  {
    watchdog_.feed(clock());
  }
  return silent_ ? std::nullopt : reply;
}

bool ToshibaVfs15::fixedFieldsWrong(const Bytes& frame) const
{
  if (!model_.blocks || frame[1] != READ_WRITE)
  {
    return false;
  }
  const std::uint16_t read_count = modbusWord(frame, 4);
  return modbusWord(frame, 2) != BLOCK_READ || read_count < 2 || read_count > 5 ||
         modbusWord(frame, 6) != BLOCK_WRITE || modbusWord(frame, 8) != 2 || frame[10] != 4;
}

Answer ToshibaVfs15::identify(const Bytes& frame)
{
  if (frame[2] != MEI_DEVICE_ID)
  {
    return exceptionAnswer(frame, static_cast<int>(ModbusException::FunctionNotSupported));
  }
  if (frame[3] > LAST_DEVICE_ID_CODE || frame[4] != 0)
  {
    return exceptionAnswer(frame, static_cast<int>(ModbusException::FormatNotAcceptable));
  }
  // Code, conformity, nothing follows, first object of a next frame, objects.
  Bytes reply{ frame[0], frame[1], frame[2], frame[3], 0x01, 0x00, 0x00, 0x03 };
  appendObject(reply, 0, "TOSHIBA");
  appendObject(reply, 1, std::string("VFS15-") + sizeOf(raw(FE70), raw(FE71)).type);
  appendObject(reply, 2, "0100");
  return Answer{ withModbusCrc(reply), replyDelay() };
}

int ToshibaVfs15::capacityCode() const
{
  return sizeOf(raw(FE70), raw(FE71)).code;
}
}  // namespace simulation
}  // namespace inverter_bus
