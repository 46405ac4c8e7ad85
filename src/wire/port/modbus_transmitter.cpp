// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The only file that knows libmodbus, which is here since the package is to send through it (contract, section 1).
// Used of it: sending with CRC and the RTS switching. Not used: its connect, which
// fails on a pseudo-terminal with parity, and its receiving, which takes any late reply of the same shape for the
// answer.

#include <modbus.h>

#include <cerrno>

#include "wire/port/poll_descriptor.h"
#include "wire/port/transmitter.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// libmodbus puts it on.
constexpr std::size_t CRC_LENGTH = 2;
/// For a port whose buffer is full: more than any frame of a healthy one.
constexpr std::chrono::milliseconds WRITE_SLACK{ 50 };

class ModbusTransmitter : public Transmitter
{
public:
  explicit ModbusTransmitter(const SerialSettings& settings) : settings_(settings)
  {
  }

  ~ModbusTransmitter() override
  {
    ModbusTransmitter::detach();
  }

  ModbusTransmitter(const ModbusTransmitter&) = delete;
  ModbusTransmitter& operator=(const ModbusTransmitter&) = delete;

  bool attach(int tty, bool switch_rts) override
  {
    detach();
    context_ =
        modbus_new_rtu(settings_.device.c_str(), static_cast<int>(settings_.baud_rate), parityLetter(settings_.parity),
                       static_cast<int>(settings_.data_bits), static_cast<int>(settings_.stop_bits));
    if (context_ == nullptr || modbus_set_socket(context_, tty) != 0)
    {
      return false;
    }
    tty_ = tty;
    const int rts = settings_.rs485 == Rs485::RtsHigh ? MODBUS_RTU_RTS_UP : MODBUS_RTU_RTS_DOWN;
    return !switch_rts || modbus_rtu_set_rts(context_, rts) == 0;
  }

  void detach() override
  {
    if (context_ != nullptr)
    {
      // Without a descriptor nothing in libmodbus can close ours.
      modbus_set_socket(context_, -1);
      modbus_free(context_);
      context_ = nullptr;
    }
  }

  bool send(const Bytes& frame) override
  {
    const TimePoint deadline = std::chrono::steady_clock::now() + timeOnLine(settings_, frame.size()) + WRITE_SLACK;
    // A frame that the tty takes only in part is an error to libmodbus: begin when there is room.
    while (context_ != nullptr && frame.size() > CRC_LENGTH && waitUntilWritable(tty_, deadline))
    {
      const int length = static_cast<int>(frame.size() - CRC_LENGTH);
      if (modbus_send_raw_request(context_, frame.data(), length) == static_cast<int>(frame.size()))
      {
        return true;
      }
      if (errno != EAGAIN && errno != EINTR)
      {
        return false;
      }
    }
    return false;
  }

private:
  SerialSettings settings_;
  modbus_t* context_ = nullptr;
  int tty_ = -1;
};
}  // namespace

std::unique_ptr<Transmitter> makeModbusTransmitter(const SerialSettings& settings)
{
  return std::make_unique<ModbusTransmitter>(settings);
}
}  // namespace wire
}  // namespace inverter_bus
