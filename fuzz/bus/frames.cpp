// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/frames.h"

#include <string>

#include "simulation/compoway/compoway_frame.h"
#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using simulation::Bytes;
using simulation::modbusWord;

// Modbus functions.
constexpr unsigned READ_COILS = 0x01;
constexpr unsigned READ_REGISTERS = 0x03;
constexpr unsigned WRITE_COIL = 0x05;
constexpr unsigned WRITE_REGISTER = 0x06;
constexpr unsigned LOOPBACK = 0x08;
constexpr unsigned WRITE_REGISTERS = 0x10;
constexpr unsigned WRITE_AND_READ = 0x17;
constexpr unsigned EXCEPTION_BIT = 0x80;

// Wire addresses. MX2 and RX: I585, I578 (printed number less one).
constexpr unsigned COIL_RUN = 0x0000;
constexpr unsigned COIL_DIRECTION = 0x0001;
constexpr unsigned COIL_RESET = 0x0003;
constexpr unsigned F001 = 0x0000;
constexpr unsigned D001 = 0x1000;
constexpr unsigned HITACHI_STATUS_END = 0x1100;  // below it the monitors, above it parameters
constexpr unsigned HITACHI_TRIPS = 0x0011;
constexpr unsigned A001 = 0x1200;
constexpr unsigned A002 = 0x1201;
constexpr unsigned C076 = 0x144F;  // of the MX2
constexpr unsigned C077 = 0x1450;
// VF-S15: E6581913.
constexpr unsigned FA00 = 0xFA00;
constexpr unsigned FA01 = 0xFA01;
constexpr unsigned FA87 = 0xFA87;  // whether set-points go to the EEPROM
constexpr unsigned FD00 = 0xFD00;
constexpr unsigned F803 = 0x0803;
constexpr unsigned F804 = 0x0804;
constexpr unsigned BLOCK_WRITE = 0x1870;
constexpr unsigned BLOCK_READ = 0x1875;
constexpr unsigned TOSHIBA_RUN = 0x0400;
constexpr unsigned TOSHIBA_REVERSE = 0x0200;
constexpr unsigned TOSHIBA_RESET = 0x2000;
// 7200MA, as the simulated drive was set up: bits of 0000H, monitors from 0020H on.
constexpr unsigned TECO_COMMAND = 0x0000;
constexpr unsigned TECO_FREQUENCY = 0x0001;
constexpr unsigned TECO_RUN_BITS = 0x0003;
constexpr unsigned TECO_REVERSE = 0x0002;
constexpr unsigned TECO_RESET = 0x0008;
constexpr unsigned TECO_OUTPUT_FREQUENCY = 0x0024;
// d090, d012 and what follows; output voltage, DC voltage, torque, alarms of the VF-S15.
constexpr unsigned D090 = 0x004D;
constexpr unsigned D012 = 0x100F;
constexpr unsigned FC91 = 0xFC91;
constexpr unsigned FD04 = 0xFD04;
constexpr unsigned FD05 = 0xFD05;
constexpr unsigned FD18 = 0xFD18;
constexpr unsigned TECO_PARAMETERS = 0x0300;

std::optional<std::size_t> find(const Scene& scene, unsigned node)
{
  for (std::size_t index = 0; index < scene.inverters.size(); ++index)
  {
    if (scene.inverters[index].node == node)
    {
      return index;
    }
  }
  return std::nullopt;
}

bool covers(unsigned address, unsigned count, unsigned wanted)
{
  return address <= wanted && wanted < address + count;
}

void readHitachi(const Bytes& frame, unsigned function, RequestFacts& facts)
{
  const unsigned value = modbusWord(frame, 4);
  if (function == WRITE_COIL)
  {
    facts.run = facts.address == COIL_RUN && value == 0xFF00;
    facts.stop = facts.address == COIL_RUN && value != 0xFF00;
    facts.direction = facts.address == COIL_DIRECTION;
    facts.reset = facts.address == COIL_RESET && value == 0xFF00;
  }
  else if (function == WRITE_REGISTERS && facts.address == F001)
  {
    facts.set_hertz = (modbusWord(frame, 7) * 65536.0 + modbusWord(frame, 9)) / 100.0;
  }
  else if (function == WRITE_AND_READ && modbusWord(frame, 6) == F001)
  {
    facts.set_hertz = (modbusWord(frame, 11) * 65536.0 + modbusWord(frame, 13)) / 100.0;
    facts.reads_frequency = covers(facts.address, value, D001);
  }
  else if (function == READ_REGISTERS)
  {
    facts.reads_frequency = covers(facts.address, value, D001);
    facts.reads_slow = facts.address == D090 || (facts.address >= D012 && facts.address < HITACHI_STATUS_END);
    facts.reads_parameter = facts.address >= HITACHI_STATUS_END;
  }
  else if (function == READ_COILS)
  {
    facts.reads_run = covers(facts.address, value, COIL_RUN);
  }
}

void takeToshibaCommand(unsigned word, RequestFacts& facts)
{
  facts.run = (word & TOSHIBA_RUN) != 0;
  facts.stop = !facts.run;
  facts.reset = (word & TOSHIBA_RESET) != 0;
  // E6581913 p52: the reset is executed without a reply.
  facts.expects_reply = !facts.reset;
  facts.reverse = (word & TOSHIBA_REVERSE) != 0;
}

void readToshiba(const Bytes& frame, unsigned function, RequestFacts& facts)
{
  if (function == WRITE_REGISTER && facts.address == FA00)
  {
    takeToshibaCommand(modbusWord(frame, 4), facts);
  }
  else if (function == WRITE_REGISTER && facts.address == FA01)
  {
    facts.set_hertz = modbusWord(frame, 4) / 100.0;
  }
  else if (function == WRITE_REGISTER && facts.address == FA87)
  {
    facts.writes_setting = true;
  }
  else if (function == WRITE_REGISTERS && facts.address == BLOCK_WRITE)
  {
    takeToshibaCommand(modbusWord(frame, 7), facts);
    facts.set_hertz = modbusWord(frame, 9) / 100.0;
  }
  else if (function == WRITE_AND_READ)
  {
    takeToshibaCommand(modbusWord(frame, 11), facts);
    facts.set_hertz = modbusWord(frame, 13) / 100.0;
    facts.with_read = true;
    facts.reads_frequency = true;
  }
  else if (function == READ_REGISTERS)
  {
    const unsigned count = modbusWord(frame, 4);
    facts.reads_frequency = facts.address == BLOCK_READ || covers(facts.address, count, FD00);
    facts.reads_run = covers(facts.address, count, FA00);
    facts.reads_slow = facts.address == FC91 || facts.address == FD04 || facts.address == FD05 || facts.address == FD18;
    const unsigned page = facts.address >> 8U;
    facts.reads_parameter = facts.address != BLOCK_READ && page != 0xFA && page != 0xFC && page != 0xFD;
  }
}

void readTeco(const Bytes& frame, unsigned function, RequestFacts& facts)
{
  if (function == WRITE_REGISTERS && facts.address == TECO_COMMAND)
  {
    const unsigned word = modbusWord(frame, 7);
    facts.run = (word & TECO_RUN_BITS) != 0;
    facts.stop = !facts.run;
    facts.reset = (word & TECO_RESET) != 0;
    facts.reverse = (word & TECO_REVERSE) != 0;
  }
  else if (function == WRITE_REGISTERS && facts.address == TECO_FREQUENCY)
  {
    facts.set_hertz = modbusWord(frame, 7) / 100.0;
  }
  else if (function == READ_REGISTERS)
  {
    facts.reads_frequency = covers(facts.address, modbusWord(frame, 4), TECO_OUTPUT_FREQUENCY);
    facts.reads_parameter = facts.address >= TECO_PARAMETERS;
  }
}

RequestFacts readModbus(const Scene& scene, const Bytes& frame)
{
  RequestFacts facts;
  if (frame.size() < 8)
  {
    return facts;
  }
  const unsigned function = frame[1];
  facts.broadcast = frame[0] == 0;
  facts.inverter = facts.broadcast ? std::optional<std::size_t>() : find(scene, frame[0]);
  facts.expects_reply = !facts.broadcast;
  facts.loopback = function == LOOPBACK;
  facts.address = modbusWord(frame, 2);
  facts.reads = function == READ_COILS || function == READ_REGISTERS || function == WRITE_AND_READ;
  const std::size_t judge = facts.inverter.value_or(0);
  switch (scene.inverters[judge].brand)
  {
    case Brand::HITACHI:
      readHitachi(frame, function, facts);
      facts.reads_parameter = facts.reads_parameter || (function == READ_REGISTERS && facts.address == HITACHI_TRIPS);
      break;
    case Brand::TOSHIBA:
      readToshiba(frame, function, facts);
      break;
    default:
      readTeco(frame, function, facts);
      break;
  }
  facts.expects_reply = facts.expects_reply && !facts.broadcast;
  return facts;
}

unsigned compowayStation(const std::string& body)
{
  return static_cast<unsigned>(std::strtoul(body.substr(0, 2).c_str(), nullptr, 10));
}

/// CompoWay/F: I548, sections 2 and 3; the codes of service 30 05 are those of the scene.
RequestFacts readCompoway(const Scene& scene, const Bytes& frame)
{
  RequestFacts facts;
  const auto found = simulation::findCompowayFrame(frame);
  const std::string body = found ? simulation::compowayBody(*found) : std::string();
  if (body.size() < 9)
  {
    return facts;
  }
  facts.broadcast = body.substr(0, 2) == "XX";
  facts.expects_reply = !facts.broadcast;
  facts.inverter = facts.broadcast ? std::optional<std::size_t>() : find(scene, compowayStation(body));
  // Node, subaddress and SID take five characters.
  const std::string service = body.substr(5, 4);
  const std::string text = body.substr(9);
  facts.loopback = service == "0801";
  facts.reads = service == "0101" || service == "0601" || service == "0503";
  if (service == "3005")
  {
    facts.run = text == "1101" || text == "1102";
    facts.reverse = text == "1102";
    facts.stop = text == "1100";
    facts.reset = text == "1201";
  }
  else if (service == "0102" && text.compare(0, 6, "C10000") == 0 && text.size() >= 20)
  {
    const auto value = simulation::fromHexDigits(text.substr(text.size() - 8));
    facts.set_hertz = value ? std::optional<double>(*value / 10.0) : std::nullopt;
  }
  else if (service == "0101" && text.size() >= 12)
  {
    const auto address = simulation::fromHexDigits(text.substr(2, 4));
    const auto count = simulation::fromHexDigits(text.substr(text.size() - 4));
    facts.address = address.value_or(0);
    facts.reads_frequency = text.compare(0, 2, "C0") == 0 && covers(facts.address, count.value_or(0), 1);
    facts.reads_parameter = text.compare(0, 2, "C3") == 0;
  }
  return facts;
}

ReplyKind readModbusReply(const Bytes& request, const Bytes& reply, unsigned& refusal)
{
  if (reply.size() < 5 || !simulation::modbusCrcFits(reply) || reply[0] != request[0])
  {
    return ReplyKind::OTHER;
  }
  if (reply[1] == (request[1] | EXCEPTION_BIT))
  {
    refusal = reply[2];
    return ReplyKind::REFUSAL;
  }
  if (reply[1] != request[1])
  {
    return ReplyKind::OTHER;
  }
  const unsigned count = modbusWord(request, 4);
  if (request[1] == READ_REGISTERS || request[1] == WRITE_AND_READ)
  {
    return reply.size() == 5 + 2 * count ? ReplyKind::NORMAL : ReplyKind::OTHER;
  }
  if (request[1] == READ_COILS)
  {
    return reply.size() == 5 + (count + 7) / 8 ? ReplyKind::NORMAL : ReplyKind::OTHER;
  }
  // Writes and the loop-back answer with the beginning of the request.
  return reply.size() == 8 && std::equal(reply.begin(), reply.begin() + 6, request.begin()) ? ReplyKind::NORMAL
                                                                                            : ReplyKind::OTHER;
}

ReplyKind readCompowayReply(const Bytes& request, const Bytes& reply, unsigned& refusal)
{
  const auto asked = simulation::findCompowayFrame(request);
  const auto found = simulation::findCompowayFrame(reply);
  if (!asked || !found || !simulation::compowayBccFits(*found))
  {
    return ReplyKind::OTHER;
  }
  const std::string question = simulation::compowayBody(*asked);
  const std::string body = simulation::compowayBody(*found);
  // Node, subaddress, end code, service, response code. End code 0F: not carried out, and the response code says why.
  const bool told = body.size() >= 14 && (body.substr(4, 2) == "00" || body.substr(4, 2) == "0F");
  if (!told || question.size() < 9 || body.substr(0, 2) != question.substr(0, 2) ||
      body.substr(6, 4) != question.substr(5, 4))
  {
    return ReplyKind::OTHER;
  }
  refusal = static_cast<unsigned>(std::strtoul(body.substr(10, 4).c_str(), nullptr, 16));
  return refusal == 0 ? ReplyKind::NORMAL : ReplyKind::REFUSAL;
}
}  // namespace

std::optional<std::size_t> inverterAt(const Scene& scene, unsigned station)
{
  return find(scene, station);
}

std::optional<std::size_t> bearerOf(const Scene& scene, const Bytes& reply)
{
  if (!scene.compoway)
  {
    return reply.empty() ? std::nullopt : find(scene, reply.front());
  }
  const auto found = simulation::findCompowayFrame(reply);
  return found ? find(scene, compowayStation(simulation::compowayBody(*found))) : std::nullopt;
}

RequestFacts readRequest(const Scene& scene, const Bytes& frame)
{
  return scene.compoway ? readCompoway(scene, frame) : readModbus(scene, frame);
}

std::set<unsigned> settingsOf(const InverterFacts& facts)
{
  if (facts.brand == Brand::HITACHI)
  {
    return facts.drive == "omron_mx2" ? std::set<unsigned>{ A001, A002, C076, C077 } : std::set<unsigned>{ A001, A002 };
  }
  return facts.brand == Brand::TOSHIBA ? std::set<unsigned>{ F803, F804 } : std::set<unsigned>{};
}

bool tellsTimeout(const InverterFacts& facts, unsigned address)
{
  return settingsOf(facts).count(address) != 0 && (address == C077 || address == F803);
}

ReplyKind readReply(const Scene& scene, const Bytes& request, const Bytes& reply, unsigned& refusal)
{
  return scene.compoway ? readCompowayReply(request, reply, refusal) : readModbusReply(request, reply, refusal);
}
}  // namespace fuzz
}  // namespace inverter_bus
