// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_MODBUS_SLAVE_H
#define INVERTER_BUS_SIMULATION_MODBUS_SLAVE_H

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "inverter_bus/simulation/simulated_drive.h"

namespace inverter_bus
{
namespace simulation
{
/// Exception codes. 01-03: Modbus Application Protocol V1.1b3, 7; 21h-23h: OMRON I578 and
/// the MX2 manual's chapter 6; 26h: Hitachi SJ700D; 31h, 32h: I585 p. 440, Hitachi WJ200 p. 551, 569. A brand with others
/// casts its number.
enum class ModbusException : std::uint8_t
{
  None = 0x00,
  FunctionNotSupported = 0x01,
  AddressNotFound = 0x02,
  FormatNotAcceptable = 0x03,
  ValueOutOfRange = 0x21,
  NotAllowedNow = 0x22,
  ReadOnly = 0x23,
  EepromBusy = 0x26,
  MappingFault = 0x31,
  MappedHalf = 0x32
};

/// What a brand's Modbus offers.
struct ModbusLimits
{
  std::set<std::uint8_t> functions;            ///< of 01 03 05 06 08 0F 10 17 (hexadecimal) and the brand's own
  std::set<std::uint8_t> broadcast_functions;  ///< executed (and never answered) when sent to all
  std::uint16_t coils = 0;                     ///< most coils of one request
  std::uint16_t read_registers = 0;            ///< most registers of one read
  std::uint16_t write_registers = 0;           ///< most registers of one write
  /// To an 08h with another sub-code than 0000h.
  ModbusException loop_back_refusal = ModbusException::FormatNotAcceptable;
};

/// A Modbus RTU slave: check sum, lengths, function codes and limits; a brand adds its coils and registers. Addresses
/// are those of the frame ("wire"), not the printed numbers.
class ModbusSlave : public SimulatedDrive
{
public:
  using Limits = ModbusLimits;

  ModbusSlave(std::string name, int station, std::uint64_t seed, TimePoint start, ModbusLimits limits);

  bool addressedBy(const Bytes& frame) const override;
  bool isWholeFrame(const Bytes& frame) const override;
  int largestException() const override;

protected:
  std::optional<Answer> answer(const Bytes& frame, TimePoint now, bool& good) override;
  bool isBroadcast(const Bytes& frame) const override;
  std::optional<int> functionOf(const Bytes& frame) const override;
  Access accessOf(const Bytes& frame) const override;
  Answer exceptionAnswer(const Bytes& frame, int code) override;
  Bytes foreignReply(const Bytes& reply, bool other_station) override;

  /// \p station addresses several drives and this one is among them; plain Modbus: 0.
  virtual bool isGroup(std::uint8_t station) const;
  /// False for a broadcast that the drive ignores although its function code is one for broadcasts.
  virtual bool takesBroadcast(const Bytes& frame) const;
  /// From the end of the request's silence to the reply.
  virtual Duration replyDelay() const = 0;
  /// A good request was heard (the drive's communication watchdog lives on this); before it is executed.
  virtual void heard(std::uint8_t function) = 0;

  /// A brand without coils leaves these two as they are.
  virtual ModbusException readCoils(std::uint16_t wire, std::uint16_t count, std::vector<bool>& values);
  virtual ModbusException writeCoils(std::uint16_t wire, const std::vector<bool>& values);
  virtual ModbusException readRegisters(std::uint16_t wire, std::uint16_t count,
                                        std::vector<std::uint16_t>& values) = 0;
  /// All of it or nothing. \p function is 06h, 10h or 17h, for drives that tell them apart.
  virtual ModbusException writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                         std::uint8_t function) = 0;

private:
  ModbusException execute(const Bytes& frame, Bytes& reply);
  ModbusException executeReadCoils(const Bytes& frame, Bytes& reply);
  ModbusException executeWriteCoil(const Bytes& frame, Bytes& reply);
  ModbusException executeWriteCoils(const Bytes& frame, Bytes& reply);
  ModbusException executeReadRegisters(std::uint16_t wire, std::uint16_t count, Bytes& reply);
  ModbusException executeWriteRegister(const Bytes& frame, Bytes& reply);
  ModbusException executeWriteRegisters(const Bytes& frame, Bytes& reply);
  ModbusException executeReadWrite(const Bytes& frame, Bytes& reply);

  ModbusLimits limits_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_MODBUS_SLAVE_H
