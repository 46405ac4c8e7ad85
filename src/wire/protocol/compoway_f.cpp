// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <string>

#include "inverter_bus/wire/protocol.h"
#include "wire/protocol/compoway_frames.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using compoway::Response;

/// Characters of silence before a request. The protocol needs none: STX begins a frame. It separates late bytes from
/// the request.
constexpr double GAP_CHARACTERS = 3.5;
/// Node and sub-address.
constexpr std::size_t SHORTEST_BODY = 4;
/// Status (2) and related information (2) in the response to 0601.
constexpr std::size_t STATUS_LENGTH = 4;
/// Places in the text between STX and ETX, behind node and sub-address.
constexpr std::size_t END_CODE_POSITION = 4;
constexpr std::size_t SERVICE_POSITION = 6;
/// Places of ETX that the longest frame leaves: it needs one more character, the BCC.
constexpr std::size_t ETX_LIMIT = compoway::LONGEST_FRAME - 1;

constexpr const char* SUB_ADDRESS = "00";
constexpr const char* NORMAL = "00";
/// The text could not be executed, and says why.
constexpr const char* COMMAND_ERROR = "0F";
constexpr const char* SUB_ADDRESS_ERROR = "16";
constexpr const char* SUCCESS = "0000";
/// Parity, framing, overrun and BCC error: the wire has damaged the command.
constexpr std::uint16_t FIRST_LINE_ERROR = 0x10;
constexpr std::uint16_t LAST_LINE_ERROR = 0x13;

Parsed garbage(std::size_t count)
{
  Parsed parsed;
  parsed.kind = Parsed::Kind::Garbage;
  parsed.consumed = count;
  return parsed;
}

bool isDigit(char character)
{
  return character >= '0' && character <= '9';
}

/// Where the next frame may begin behind the head.
std::size_t nextStx(const std::uint8_t* data, std::size_t size)
{
  return static_cast<std::size_t>(std::find(data + 1, data + size, compoway::STX) - data);
}

/// Two digits or XX, and nothing that only control characters could be.
bool isBody(const std::string& body)
{
  const bool node =
      body.size() >= SHORTEST_BODY && ((isDigit(body[0]) && isDigit(body[1])) || body.compare(0, 2, "XX") == 0);
  return node && std::all_of(body.begin(), body.end(), [](char c) { return static_cast<unsigned char>(c) >= ' '; });
}

std::uint8_t stationOf(const std::string& body)
{
  return isDigit(body[0]) ? static_cast<std::uint8_t>(10 * (body[0] - '0') + (body[1] - '0')) : std::uint8_t{ 0 };
}

/// 0 for a normal end.
std::uint16_t errorIdOf(const Response& response)
{
  const auto reason =
      response.service.empty() ? compoway::hexValue(response.end_code) : compoway::hexValue(response.response_code);
  return reason.value_or(0);
}

/// The response text as it was received.
Bytes textOf(const Response& response)
{
  const std::string text = response.service + response.response_code + response.data;
  return Bytes(text.begin(), text.end());
}

/// The kind of a response that comes with text.
Parsed::Kind kindOfText(const Request& request, const Response& response)
{
  if (response.service != compoway::serviceOf(request))
  {
    return Parsed::Kind::Foreign;
  }
  if (response.end_code == NORMAL && response.response_code == SUCCESS)
  {
    return compoway::dataFits(request, response.data) ? Parsed::Kind::Reply : Parsed::Kind::Foreign;
  }
  const bool refused = response.end_code == COMMAND_ERROR && response.data.empty() && errorIdOf(response) != 0;
  return refused ? Parsed::Kind::Exception : Parsed::Kind::Foreign;
}

/// The kind of a response that consists of its end code.
Parsed::Kind kindOfEndCode(const Response& response)
{
  const std::uint16_t end_code = errorIdOf(response);
  if (end_code == 0 || response.end_code == COMMAND_ERROR)
  {
    return Parsed::Kind::Foreign;
  }
  const bool damaged = end_code >= FIRST_LINE_ERROR && end_code <= LAST_LINE_ERROR;
  return damaged ? Parsed::Kind::NotUnderstood : Parsed::Kind::Exception;
}

Parsed::Kind kindOf(const Request& request, const Response& response)
{
  // A refusal because of the sub-address comes back with the sub-address that arrived.
  const bool own = response.sub_address == SUB_ADDRESS || response.end_code == SUB_ADDRESS_ERROR;
  if (response.node != compoway::nodeOf(request) || !own)
  {
    return Parsed::Kind::Foreign;
  }
  return response.service.empty() ? kindOfEndCode(response) : kindOfText(request, response);
}

/// A valid frame of \p length characters.
Parsed wholeFrame(const std::string& body, std::size_t length, const Request* request)
{
  Parsed parsed;
  parsed.kind = Parsed::Kind::Foreign;
  parsed.consumed = length;
  parsed.station = stationOf(body);
  if (const auto response = compoway::takeApart(body))
  {
    parsed.kind = request != nullptr ? kindOf(*request, *response) : Parsed::Kind::Foreign;
    parsed.pdu = textOf(*response);
    parsed.error_id = errorIdOf(*response);
  }
  return parsed;
}

/// True if \p head, what has come behind STX, is the beginning of the response to \p request.
bool hasBegun(const Request& request, const std::string& head)
{
  if (head.size() < SERVICE_POSITION + compoway::SERVICE_LENGTH)
  {
    return false;
  }
  const std::string end_code = head.substr(END_CODE_POSITION, SERVICE_POSITION - END_CODE_POSITION);
  return head.compare(0, END_CODE_POSITION, compoway::nodeOf(request) + SUB_ADDRESS) == 0 &&
         (end_code == NORMAL || end_code == COMMAND_ERROR) &&
         head.compare(SERVICE_POSITION, compoway::SERVICE_LENGTH, compoway::serviceOf(request)) == 0;
}

/// \p size bytes behind an STX to which more may come.
Parsed incomplete(const std::uint8_t* data, std::size_t size, const Request* request)
{
  Parsed parsed;
  parsed.own = request != nullptr && hasBegun(*request, std::string(data + 1, data + size));
  return parsed;
}

/// Place of the control character that ends the text behind the STX at the head; at most \p size and ETX_LIMIT.
std::size_t endOfText(const std::uint8_t* data, std::size_t size)
{
  const std::uint8_t* const limit = data + std::min(size, ETX_LIMIT);
  const auto ends = [](std::uint8_t byte) { return byte == compoway::STX || byte == compoway::ETX; };
  return static_cast<std::size_t>(std::find_if(data + 1, limit, ends) - data);
}

/// A frame whose ETX is at \p etx.
Parsed parseEnd(const std::uint8_t* data, std::size_t size, std::size_t etx, const Request* request)
{
  // One byte behind ETX is the BCC, whatever it looks like.
  const std::size_t length = etx + 2;
  if (size < length)
  {
    return incomplete(data, size, request);
  }
  const std::string body(data + 1, data + etx);
  const bool valid = compoway::bcc(data + 1, etx) == data[etx + 1] && isBody(body);
  // The byte in the place of a wrong BCC may be the STX of the next frame.
  return valid ? wholeFrame(body, length, request) : garbage(etx + 1);
}

class CompowayF : public Protocol
{
public:
  Bytes frame(const Request& request) override
  {
    const std::string head = compoway::nodeOf(request) + SUB_ADDRESS + "0";
    Bytes frame;
    frame.reserve(head.size() + request.pdu.size() + 3);
    frame.push_back(compoway::STX);
    frame.insert(frame.end(), head.begin(), head.end());
    frame.insert(frame.end(), request.pdu.begin(), request.pdu.end());
    frame.push_back(compoway::ETX);
    frame.push_back(compoway::bcc(frame.data() + 1, frame.size() - 1));
    return frame;
  }

  Parsed parse(const std::uint8_t* data, std::size_t size, const Request* request) const override
  {
    if (size == 0)
    {
      return Parsed();
    }
    if (data[0] != compoway::STX)
    {
      return garbage(nextStx(data, size));
    }
    const Request* const awaited = request != nullptr && !request->broadcast ? request : nullptr;
    const std::size_t end = endOfText(data, size);
    if (end < ETX_LIMIT && end == size)
    {
      return incomplete(data, size, awaited);
    }
    const bool ended = end < ETX_LIMIT && data[end] == compoway::ETX;
    return ended ? parseEnd(data, size, end, awaited) : garbage(nextStx(data, size));
  }

  std::size_t requestLength(const Request& request) const override
  {
    return compoway::COMMAND_OVERHEAD + request.pdu.size();
  }

  std::size_t replyLength(const Request& request) const override
  {
    if (request.broadcast)
    {
      return 0;
    }
    const std::string service = compoway::serviceOf(request);
    const std::size_t longest = compoway::LONGEST_FRAME - compoway::RESPONSE_OVERHEAD;
    const std::size_t unknown = service == compoway::READ_STATUS ? STATUS_LENGTH : longest;
    return compoway::RESPONSE_OVERHEAD + compoway::dataLength(request).value_or(unknown);
  }

  /// Station and service: a reply repeats nothing else, but for the data of an echoback test.
  std::string shape(const Request& request) const override
  {
    const std::string service = compoway::serviceOf(request);
    const std::string shape = static_cast<char>(request.station) + service;
    return service == compoway::ECHOBACK ? shape + compoway::dataOf(request) : shape;
  }

  std::string shapeOfReply(const Parsed& reply) const override
  {
    const std::string station(1, static_cast<char>(reply.station));
    constexpr std::size_t DATA_POSITION = compoway::SERVICE_LENGTH + compoway::RESPONSE_CODE_LENGTH;
    if (reply.pdu.size() < DATA_POSITION)
    {
      return reply.error_id != 0 ? station : std::string();
    }
    const std::string text(reply.pdu.begin(), reply.pdu.end());
    const std::string service = text.substr(0, compoway::SERVICE_LENGTH);
    const bool repeats = service == compoway::ECHOBACK && reply.error_id == 0;
    return station + service + (repeats ? text.substr(DATA_POSITION) : "");
  }

  bool isLoopback(const Request& request) const override
  {
    return !request.broadcast && compoway::serviceOf(request) == compoway::ECHOBACK &&
           !compoway::dataOf(request).empty();
  }

  double gapCharacters() const override
  {
    return GAP_CHARACTERS;
  }
};
}  // namespace

std::unique_ptr<Protocol> makeCompowayF()
{
  return std::make_unique<CompowayF>();
}
}  // namespace wire
}  // namespace inverter_bus
