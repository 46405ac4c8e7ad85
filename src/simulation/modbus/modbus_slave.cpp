// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/modbus/modbus_slave.h"

#include <utility>

#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr std::uint8_t READ_COILS = 0x01;
constexpr std::uint8_t READ_REGISTERS = 0x03;
constexpr std::uint8_t WRITE_COIL = 0x05;
constexpr std::uint8_t WRITE_REGISTER = 0x06;
constexpr std::uint8_t LOOP_BACK = 0x08;
constexpr std::uint8_t WRITE_COILS = 0x0F;
constexpr std::uint8_t WRITE_REGISTERS = 0x10;
constexpr std::uint8_t READ_WRITE = 0x17;

/// The frame is as long as its function code and byte count say; else there is no answer.
bool lengthFits(const Bytes& frame)
{
  const std::size_t size = frame.size();
  switch (frame[1])
  {
    case READ_COILS:
    case READ_REGISTERS:
    case WRITE_COIL:
    case WRITE_REGISTER:
    case LOOP_BACK:
      return size == 8;
    case WRITE_COILS:
    case WRITE_REGISTERS:
      return size >= 9 && size == 9U + frame[6];
    case READ_WRITE:
      return size >= 13 && size == 13U + frame[10];
    default:
      return true;
  }
}

std::vector<std::uint16_t> words(const Bytes& frame, std::size_t offset, std::size_t count)
{
  std::vector<std::uint16_t> values;
  for (std::size_t i = 0; i < count; ++i)
  {
    values.push_back(modbusWord(frame, offset + 2 * i));
  }
  return values;
}

void appendHead(const Bytes& frame, Bytes& reply, std::size_t size)
{
  reply.insert(reply.end(), frame.begin() + 2, frame.begin() + static_cast<std::ptrdiff_t>(size));
}
}  // namespace

ModbusSlave::ModbusSlave(std::string name, int station, std::uint64_t seed, TimePoint start, ModbusLimits limits)
  : SimulatedDrive(std::move(name), station, seed, start), limits_(std::move(limits))
{
}

ModbusException ModbusSlave::readCoils(std::uint16_t /*wire*/, std::uint16_t /*count*/, std::vector<bool>& /*values*/)
{
  return ModbusException::FunctionNotSupported;
}

ModbusException ModbusSlave::writeCoils(std::uint16_t /*wire*/, const std::vector<bool>& /*values*/)
{
  return ModbusException::FunctionNotSupported;
}

bool ModbusSlave::isGroup(std::uint8_t station) const
{
  return station == 0;
}

bool ModbusSlave::takesBroadcast(const Bytes& /*frame*/) const
{
  return true;
}

bool ModbusSlave::isBroadcast(const Bytes& frame) const
{
  return frame[0] != station();
}

bool ModbusSlave::addressedBy(const Bytes& frame) const
{
  return !frame.empty() && (frame[0] == station() || isGroup(frame[0]));
}

bool ModbusSlave::isWholeFrame(const Bytes& frame) const
{
  return modbusCrcFits(frame) && lengthFits(frame);
}

std::optional<int> ModbusSlave::functionOf(const Bytes& frame) const
{
  return frame.size() > 1 ? std::optional<int>(frame[1]) : std::nullopt;
}

Access ModbusSlave::accessOf(const Bytes& frame) const
{
  constexpr int LOOPBACK = 0x08;
  constexpr int LAST_READ = 0x04;
  const int function = functionOf(frame).value_or(LOOPBACK);
  return function == LOOPBACK ? Access::Neither : function <= LAST_READ ? Access::Read : Access::Write;
}

Answer ModbusSlave::exceptionAnswer(const Bytes& frame, int code)
{
  const Bytes reply{ frame[0], static_cast<std::uint8_t>(frame[1] | 0x80U), static_cast<std::uint8_t>(code) };
  return Answer{ withModbusCrc(reply), replyDelay(), true };
}

int ModbusSlave::largestException() const
{
  return 0xFF;
}

Bytes ModbusSlave::foreignReply(const Bytes& reply, bool other_station)
{
  Bytes body(reply.begin(), reply.end() - 2);
  if (other_station)
  {
    body[0] = static_cast<std::uint8_t>(body[0] % 247U + 1U);
  }
  else if (body[1] == READ_REGISTERS || body[1] == READ_WRITE || body[1] == READ_COILS)
  {
    body[2] = static_cast<std::uint8_t>(body[2] + 2U);  // a read of one register more
    appendModbusWord(body, 0);
  }
  else
  {
    body = Bytes{ body[0], READ_REGISTERS, 2, 0, 0 };
  }
  return withModbusCrc(body);
}

std::optional<Answer> ModbusSlave::answer(const Bytes& frame, TimePoint /*now*/, bool& good)
{
  const bool for_all = isBroadcast(frame);
  if (for_all && (limits_.broadcast_functions.count(frame[1]) == 0 || !takesBroadcast(frame)))
  {
    return std::nullopt;
  }
  good = true;
  heard(frame[1]);
  Bytes reply{ frame[0], frame[1] };
  const ModbusException exception = execute(frame, reply);
  if (for_all)
  {
    return std::nullopt;
  }
  if (exception != ModbusException::None)
  {
    return exceptionAnswer(frame, static_cast<int>(exception));
  }
  return Answer{ withModbusCrc(reply), replyDelay(), false };
}

ModbusException ModbusSlave::execute(const Bytes& frame, Bytes& reply)
{
  if (limits_.functions.count(frame[1]) == 0)
  {
    return ModbusException::FunctionNotSupported;
  }
  switch (frame[1])
  {
    case READ_COILS:
      return executeReadCoils(frame, reply);
    case READ_REGISTERS:
      return executeReadRegisters(modbusWord(frame, 2), modbusWord(frame, 4), reply);
    case WRITE_COIL:
      return executeWriteCoil(frame, reply);
    case WRITE_REGISTER:
      return executeWriteRegister(frame, reply);
    case LOOP_BACK:
      if (modbusWord(frame, 2) != 0)
      {
        return limits_.loop_back_refusal;
      }
      appendHead(frame, reply, 6);
      return ModbusException::None;
    case WRITE_COILS:
      return executeWriteCoils(frame, reply);
    case WRITE_REGISTERS:
      return executeWriteRegisters(frame, reply);
    case READ_WRITE:
      return executeReadWrite(frame, reply);
    default:
      return ModbusException::FunctionNotSupported;
  }
}

ModbusException ModbusSlave::executeReadCoils(const Bytes& frame, Bytes& reply)
{
  const std::uint16_t count = modbusWord(frame, 4);
  if (count == 0 || count > limits_.coils)
  {
    return ModbusException::FormatNotAcceptable;
  }
  std::vector<bool> values;
  const ModbusException exception = readCoils(modbusWord(frame, 2), count, values);
  if (exception != ModbusException::None)
  {
    return exception;
  }
  Bytes packed((count + 7U) / 8U, 0);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    packed[i / 8] = static_cast<std::uint8_t>(packed[i / 8] | (values[i] ? 1U << (i % 8) : 0U));
  }
  reply.push_back(static_cast<std::uint8_t>(packed.size()));
  reply.insert(reply.end(), packed.begin(), packed.end());
  return ModbusException::None;
}

ModbusException ModbusSlave::executeWriteCoil(const Bytes& frame, Bytes& reply)
{
  const std::uint16_t value = modbusWord(frame, 4);
  if (value != 0xFF00U && value != 0x0000U)
  {
    return ModbusException::FormatNotAcceptable;
  }
  appendHead(frame, reply, 6);
  return writeCoils(modbusWord(frame, 2), { value != 0 });
}

ModbusException ModbusSlave::executeWriteCoils(const Bytes& frame, Bytes& reply)
{
  const std::uint16_t count = modbusWord(frame, 4);
  // More data bytes than the coils need are accepted: a real MX2 took 2 bytes for 5 coils.
  if (count == 0 || count > limits_.coils || frame[6] * 8U < count)
  {
    return ModbusException::FormatNotAcceptable;
  }
  std::vector<bool> values;
  for (std::size_t i = 0; i < count; ++i)
  {
    values.push_back(((frame[7 + i / 8] >> (i % 8)) & 1U) != 0);
  }
  appendHead(frame, reply, 6);
  return writeCoils(modbusWord(frame, 2), values);
}

ModbusException ModbusSlave::executeReadRegisters(std::uint16_t wire, std::uint16_t count, Bytes& reply)
{
  if (count == 0 || count > limits_.read_registers)
  {
    return ModbusException::FormatNotAcceptable;
  }
  std::vector<std::uint16_t> values;
  const ModbusException exception = readRegisters(wire, count, values);
  if (exception != ModbusException::None)
  {
    return exception;
  }
  reply.push_back(static_cast<std::uint8_t>(values.size() * 2));
  for (const std::uint16_t value : values)
  {
    appendModbusWord(reply, value);
  }
  return ModbusException::None;
}

ModbusException ModbusSlave::executeWriteRegister(const Bytes& frame, Bytes& reply)
{
  appendHead(frame, reply, 6);
  return writeRegisters(modbusWord(frame, 2), words(frame, 4, 1), WRITE_REGISTER);
}

ModbusException ModbusSlave::executeWriteRegisters(const Bytes& frame, Bytes& reply)
{
  const std::uint16_t count = modbusWord(frame, 4);
  if (count == 0 || count > limits_.write_registers || frame[6] != count * 2U)
  {
    return ModbusException::FormatNotAcceptable;
  }
  appendHead(frame, reply, 6);
  return writeRegisters(modbusWord(frame, 2), words(frame, 7, count), WRITE_REGISTERS);
}

ModbusException ModbusSlave::executeReadWrite(const Bytes& frame, Bytes& reply)
{
  const std::uint16_t read_count = modbusWord(frame, 4);
  const std::uint16_t count = modbusWord(frame, 8);
  if (count == 0 || count > limits_.write_registers || frame[10] != count * 2U || read_count == 0 ||
      read_count > limits_.read_registers)
  {
    return ModbusException::FormatNotAcceptable;
  }
  // Modbus V1.1b3, 6.17: the write comes before the read.
  const ModbusException exception = writeRegisters(modbusWord(frame, 6), words(frame, 11, count), READ_WRITE);
  return exception != ModbusException::None ? exception : executeReadRegisters(modbusWord(frame, 2), read_count, reply);
}
}  // namespace simulation
}  // namespace inverter_bus
