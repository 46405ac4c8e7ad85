// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/compoway/compoway_slave.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "simulation/compoway/compoway_frame.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
// Places in the body (station 2, sub-address 2, SID 1, text) and in the text of a read or write.
constexpr std::size_t SUB_ADDRESS = 2;
constexpr std::size_t SID = 4;
constexpr std::size_t TEXT = 5;
constexpr std::size_t SERVICE_SIZE = 4;
constexpr std::size_t TYPE = 4;
constexpr std::size_t ADDRESS = 6;
constexpr std::size_t BIT_POSITION = 10;
constexpr std::size_t COUNT = 12;
constexpr std::size_t DATA = 16;
constexpr std::size_t ELEMENT = 8;  // [digits] of a double word
constexpr std::size_t OPERATION_SIZE = 8;

const char* const READ = "0101";
const char* const WRITE = "0102";
const char* const ATTRIBUTES = "0503";
const char* const STATUS = "0601";
const char* const ECHO = "0801";
const char* const OPERATION = "3005";
const char* const TO_ALL = "XX";
const char* const NORMAL_END = "00";
const char* const FINS_ERROR = "0F";
const char* const BCC_ERROR = "13";
const char* const FORMAT_ERROR = "14";
const char* const SUB_ADDRESS_ERROR = "16";
const char* const LENGTH_ERROR = "18";

std::string bodyOf(const Bytes& stream)
{
  const std::optional<Bytes> frame = findCompowayFrame(stream);
  return frame ? compowayBody(*frame) : std::string();
}

std::string textOf(const std::string& body)
{
  return body.size() > TEXT ? body.substr(TEXT) : std::string();
}

/// Only for text that was checked to be hexadecimal.
std::uint32_t numberAt(const std::string& text, std::size_t place, std::size_t digits)
{
  return fromHexDigits(text.substr(place, digits)).value_or(0);
}

std::uint8_t typeOf(const std::string& text)
{
  return static_cast<std::uint8_t>(numberAt(text, TYPE, 2));
}

bool echoable(char character, bool eight_bits)
{
  const unsigned int code = static_cast<unsigned char>(character);
  return (code >= 0x20U && code <= 0x7EU) || (eight_bits && code >= 0xA1U && code <= 0xFEU);
}
}  // namespace

CompowaySlave::CompowaySlave(std::string name, int station, std::uint64_t seed, TimePoint start, CompowayLimits limits)
  : SimulatedDrive(std::move(name), station, seed, start), limits_(std::move(limits))
{
}

std::string CompowaySlave::stationText() const
{
  char text[16];
  std::snprintf(text, sizeof(text), "%02d", station());
  return text;
}

bool CompowaySlave::addressedBy(const Bytes& frame) const
{
  const std::string address = bodyOf(frame).substr(0, SUB_ADDRESS);
  return address == stationText() || address == TO_ALL;
}

bool CompowaySlave::isBroadcast(const Bytes& frame) const
{
  return bodyOf(frame).substr(0, SUB_ADDRESS) == TO_ALL;
}

bool CompowaySlave::isWholeFrame(const Bytes& frame) const
{
  const std::optional<Bytes> found = findCompowayFrame(frame);
  return found && found->size() <= limits_.buffer && compowayBccFits(*found);
}

bool CompowaySlave::answersDamaged() const
{
  return true;
}

int CompowaySlave::largestException() const
{
  return 0xFFFF;
}

std::optional<int> CompowaySlave::functionOf(const Bytes& frame) const
{
  const std::string text = textOf(bodyOf(frame));
  const auto service = fromHexDigits(text.substr(0, SERVICE_SIZE));
  return text.size() >= SERVICE_SIZE && service ? std::optional<int>(static_cast<int>(*service)) : std::nullopt;
}

Access CompowaySlave::accessOf(const Bytes& frame) const
{
  constexpr int WRITE_VARIABLES = 0x0102;
  constexpr int OPERATION = 0x3005;
  constexpr int ECHOBACK = 0x0801;
  const int service = functionOf(frame).value_or(ECHOBACK);
  const bool writes = service == WRITE_VARIABLES || service == OPERATION;
  return service == ECHOBACK ? Access::Neither : writes ? Access::Write : Access::Read;
}

Answer CompowaySlave::reply(const std::string& body, bool exception) const
{
  return Answer{ compowayFrame(body), replyDelay(), exception };
}

Answer CompowaySlave::exceptionAnswer(const Bytes& frame, int code)
{
  const std::string head = stationText() + "00";
  if (code < 0x100)
  {
    return reply(head + hexDigits(static_cast<std::uint32_t>(code), 2), true);
  }
  const std::string service = textOf(bodyOf(frame)).substr(0, SERVICE_SIZE);
  return reply(head + FINS_ERROR + service + hexDigits(static_cast<std::uint32_t>(code), 4), true);
}

Bytes CompowaySlave::foreignReply(const Bytes& reply, bool other_station)
{
  std::string body = compowayBody(reply);
  if (other_station)
  {
    char other[16];
    std::snprintf(other, sizeof(other), "%02d", (station() + 1) % 100);
    return compowayFrame(body.replace(0, SUB_ADDRESS, other));
  }
  const std::string read_head = stationText() + "00" + NORMAL_END + READ + "0000";
  const bool is_read = body.compare(0, read_head.size(), read_head) == 0;
  return compowayFrame((is_read ? body : read_head) + "00000000");  // a read of one element more
}

/// The end code; \p sub_address becomes the one that comes back.
std::string CompowaySlave::endCodeOf(const Bytes& frame, std::string& sub_address) const
{
  const std::string body = compowayBody(frame);
  const std::string received = body.substr(SUB_ADDRESS, SID - SUB_ADDRESS);
  sub_address = "00";
  if (frame.size() > limits_.buffer)
  {
    return LENGTH_ERROR;
  }
  if (!compowayBccFits(frame))
  {
    return BCC_ERROR;
  }
  if (received != "00")
  {
    sub_address = received.size() == 2 ? received : sub_address;
    return SUB_ADDRESS_ERROR;
  }
  const bool service = body.size() >= TEXT + SERVICE_SIZE && body[SID] == '0' && fromHexDigits(body.substr(TEXT, 4));
  return service ? NORMAL_END : FORMAT_ERROR;
}

std::optional<Answer> CompowaySlave::answer(const Bytes& frame, TimePoint /*now*/, bool& good)
{
  good = true;
  const bool for_all = isBroadcast(frame);
  std::string sub_address;
  std::string end_code = endCodeOf(frame, sub_address);
  Result result;
  const std::string text = textOf(compowayBody(frame));
  if (end_code == NORMAL_END)
  {
    result = execute(text, for_all);
    end_code = result.garbage ? FORMAT_ERROR : (result.code == Response::Normal ? NORMAL_END : FINS_ERROR);
  }
  if (for_all || result.silent)
  {
    return std::nullopt;
  }
  std::string body = stationText() + sub_address + end_code;
  if (end_code == NORMAL_END || end_code == FINS_ERROR)
  {
    body += text.substr(0, SERVICE_SIZE) + hexDigits(static_cast<std::uint32_t>(result.code), 4) + result.data;
  }
  return reply(body, end_code != NORMAL_END);
}

CompowaySlave::Result CompowaySlave::execute(const std::string& text, bool for_all)
{
  const std::string service = text.substr(0, SERVICE_SIZE);
  if (for_all && service != WRITE && service != OPERATION)
  {
    return Result();
  }
  if (service == ECHO)
  {
    return echo(text);
  }
  Result result;
  if (text.find_first_not_of("0123456789ABCDEF") != std::string::npos)
  {
    result.garbage = true;
  }
  else if (service == READ)
  {
    result = read(text);
  }
  else if (service == WRITE)
  {
    result = write(text);
  }
  else if (service == OPERATION)
  {
    result.code = text.size() > OPERATION_SIZE   ? Response::CommandTooLong
                  : text.size() < OPERATION_SIZE ? Response::CommandTooShort
                                                 : operate(text.substr(SERVICE_SIZE));
  }
  else if (service != ATTRIBUTES && service != STATUS)
  {
    result.code = Response::UnsupportedCommand;
  }
  else if (text.size() > SERVICE_SIZE)
  {
    result.code = Response::CommandTooLong;
  }
  else
  {
    result.data = service == STATUS ? controllerStatus()
                                    : limits_.model + hexDigits(static_cast<std::uint32_t>(limits_.buffer), 4);
  }
  return result;
}

CompowaySlave::Result CompowaySlave::echo(const std::string& text) const
{
  Result result;
  const std::string data = text.substr(SERVICE_SIZE);
  result.silent = data.find('@') != std::string::npos;
  result.garbage = !std::all_of(data.begin(), data.end(),
                                [this](char character) { return echoable(character, limits_.eight_bits); });
  if (data.size() > limits_.echo_bytes)
  {
    result.code = Response::CommandTooLong;
    return result;
  }
  result.data = data;
  return result;
}

CompowayResponse CompowaySlave::checkRead(const std::string& text) const
{
  if (text.size() != DATA)
  {
    return text.size() > DATA ? Response::CommandTooLong : Response::CommandTooShort;
  }
  const std::uint8_t type = typeOf(text);
  const std::uint32_t address = numberAt(text, ADDRESS, 4);
  const std::uint32_t count = numberAt(text, COUNT, 4);
  if (!hasArea(type))
  {
    return Response::AreaTypeError;
  }
  if (!hasAddress(type, address))
  {
    return Response::StartOutOfRange;
  }
  if (count > limits_.elements)
  {
    return Response::ResponseTooLong;
  }
  if (numberAt(text, BIT_POSITION, 2) != 0)
  {
    return Response::ParameterError;
  }
  const bool inside = count == 0 || hasAddress(type, address + count - 1);
  return inside ? Response::Normal : Response::StartOutOfRange;
}

CompowaySlave::Result CompowaySlave::read(const std::string& text)
{
  Result result;
  result.code = checkRead(text);
  if (result.code != Response::Normal)
  {
    return result;
  }
  std::vector<std::uint32_t> values;
  result.code = readVariables(typeOf(text), numberAt(text, ADDRESS, 4), numberAt(text, COUNT, 4), values);
  for (const std::uint32_t value : values)
  {
    result.data += hexDigits(value, static_cast<int>(ELEMENT));
  }
  return result;
}

CompowayResponse CompowaySlave::checkWrite(const std::string& text, std::vector<std::uint32_t>& values) const
{
  if (text.size() < DATA)
  {
    return Response::CommandTooShort;
  }
  const std::uint8_t type = typeOf(text);
  const std::uint32_t address = numberAt(text, ADDRESS, 4);
  const std::uint32_t count = numberAt(text, COUNT, 4);
  if (!hasArea(type))
  {
    return Response::AreaTypeError;
  }
  if (!hasAddress(type, address))
  {
    return Response::StartOutOfRange;
  }
  if (count > 0 && !hasAddress(type, address + count - 1))
  {
    return Response::EndOutOfRange;
  }
  if (text.size() != DATA + ELEMENT * count || count > limits_.elements)
  {
    return Response::CountMismatch;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    values.push_back(numberAt(text, DATA + ELEMENT * i, ELEMENT));
  }
  if (numberAt(text, BIT_POSITION, 2) != 0 || !accepts(type, address, values))
  {
    return Response::ParameterError;
  }
  return readOnly(type) ? Response::ReadOnly : Response::Normal;
}

CompowaySlave::Result CompowaySlave::write(const std::string& text)
{
  Result result;
  std::vector<std::uint32_t> values;
  result.code = checkWrite(text, values);
  if (result.code == Response::Normal)
  {
    result.code = writeVariables(typeOf(text), numberAt(text, ADDRESS, 4), values);
  }
  return result;
}
}  // namespace simulation
}  // namespace inverter_bus
