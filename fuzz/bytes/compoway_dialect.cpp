// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// CompoWay/F as OMRON I548-E1 has it, sections 2-1 to 2-4.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "dialect.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using wire::Bytes;
using wire::Parsed;
using wire::Request;

constexpr std::uint8_t STX = 0x02;
constexpr std::uint8_t ETX = 0x03;
constexpr std::size_t BUFFER = 40;

Request makeRequest(std::uint8_t station, const std::string& text)
{
  Request request;
  request.station = station;
  request.pdu.assign(text.begin(), text.end());
  request.response_timeout = seconds(0.25);
  return request;
}

std::vector<Request> makeRequests()
{
  std::vector<Request> requests{
    makeRequest(1, "0101C00001000001"),
    makeRequest(1, "0101C00001000002"),
    makeRequest(1, "0102C100000000010000012C"),
    makeRequest(0, "0503"),
    makeRequest(1, "0601"),
    makeRequest(1, "0801A55A"),
    makeRequest(1, "0801ABCDEFGHIJKLMNOPQRSTUVW"),
    makeRequest(99, "30050100"),
    makeRequest(1, "0101C00000000000"),
  };
  requests.push_back(makeRequest(0, "0102C1000000000100000000"));
  requests.back().broadcast = true;
  requests.back().expects_reply = false;
  requests.push_back(makeRequest(7, "0101C30006000002"));
  requests.back().quiet_before = seconds(0.005);
  return requests;
}

std::uint8_t bccOf(const std::string& text)
{
  unsigned bcc = 0;
  for (const char character : text)
  {
    bcc ^= static_cast<unsigned char>(character);
  }
  return static_cast<std::uint8_t>(bcc);
}

std::string node(const Request& request)
{
  char digits[8];
  std::snprintf(digits, sizeof digits, "%02d", request.station % 100);
  return request.broadcast ? "XX" : digits;
}

std::string textOf(const Request& request)
{
  return std::string(request.pdu.begin(), request.pdu.end());
}

bool isHex(const std::string& text)
{
  return text.find_first_not_of("0123456789ABCDEF") == std::string::npos;
}

/// Characters of data in the normal reply; -1: any number.
int dataSize(const std::string& command)
{
  const std::string service = command.substr(0, 4);
  if (service == "0101")
  {
    return 8 * static_cast<int>(std::strtol(command.substr(12, 4).c_str(), nullptr, 16));
  }
  if (service == "0503")
  {
    return 14;
  }
  if (service == "0801")
  {
    return static_cast<int>(command.size()) - 4;
  }
  return service == "0102" || service == "3005" ? 0 : -1;
}

bool dataFits(const std::string& command, const std::string& data)
{
  const int wanted = dataSize(command);
  if (wanted >= 0 && data.size() != static_cast<std::size_t>(wanted))
  {
    return false;
  }
  const bool echo = command.compare(0, 4, "0801") == 0;
  const bool values = command.compare(0, 4, "0101") == 0;
  return (!echo || data == command.substr(4)) && (!values || isHex(data));
}

/// \p text of an answer that consists of its end code.
Dialect::Answer judgeEndCode(const std::string& end_code)
{
  Dialect::Answer answer;
  if (!isHex(end_code) || end_code == "00" || end_code == "0F")
  {
    return answer;
  }
  const long value = std::strtol(end_code.c_str(), nullptr, 16);
  answer.kind = value >= 0x10 && value <= 0x13 ? Parsed::Kind::NotUnderstood : Parsed::Kind::Exception;
  answer.error_id = static_cast<std::uint16_t>(value);
  return answer;
}

Dialect::Answer judgeText(const std::string& command, const std::string& end_code, const std::string& text)
{
  Dialect::Answer answer;
  if (text.size() < 8 || text.compare(0, 4, command, 0, 4) != 0)
  {
    return answer;
  }
  const std::string code = text.substr(4, 4);
  const std::string data = text.substr(8);
  if (end_code == "00" && code == "0000" && dataFits(command, data))
  {
    answer.kind = Parsed::Kind::Reply;
  }
  else if (end_code == "0F" && data.empty() && isHex(code) && code != "0000")
  {
    answer.kind = Parsed::Kind::Exception;
    answer.error_id = static_cast<std::uint16_t>(std::strtol(code.c_str(), nullptr, 16));
  }
  return answer;
}

/// What stands between STX and ETX.
Dialect::Answer judge(const Request& request, const std::string& body)
{
  if (request.broadcast || body.size() < 6 || body.compare(0, 2, node(request)) != 0)
  {
    return {};
  }
  const std::string end_code = body.substr(4, 2);
  if (body.compare(2, 2, "00") != 0 && end_code != "16")
  {
    return {};
  }
  return body.size() == 6 ? judgeEndCode(end_code) : judgeText(textOf(request), end_code, body.substr(6));
}

class CompowayDialect : public Dialect
{
public:
  std::unique_ptr<wire::Protocol> makeProtocol() const override
  {
    return wire::makeCompowayF();
  }

  const std::vector<Request>& requests() const override
  {
    static const std::vector<Request> REQUESTS = makeRequests();
    return REQUESTS;
  }

  bool isFrame(const std::uint8_t* data, std::size_t length) const override
  {
    if (length < 7 || length > BUFFER || data[0] != STX || data[length - 2] != ETX)
    {
      return false;
    }
    const std::string checked(data + 1, data + length - 1);
    const std::string body(data + 1, data + length - 2);
    const bool printable = std::none_of(body.begin(), body.end(), [](unsigned char c) { return c < ' '; });
    const bool addressed = body.compare(0, 2, "XX") == 0 || (std::isdigit(data[1]) != 0 && std::isdigit(data[2]) != 0);
    return printable && addressed && bccOf(checked) == data[length - 1];
  }

  Answer answerAt(const Request& request, std::size_t /*number*/, const std::uint8_t* data,
                  std::size_t size) const override
  {
    const std::uint8_t* const etx = std::find(data, data + size, ETX);
    const std::size_t length = static_cast<std::size_t>(etx - data) + 2;
    if (length > size || !isFrame(data, length))
    {
      return {};
    }
    Answer answer = judge(request, std::string(data + 1, etx));
    answer.length = answer.kind == Parsed::Kind::Incomplete ? 0 : length;
    return answer;
  }

  Bytes contentOf(const Bytes& frame) const override
  {
    // Texts shorter than MRC, SRC and response code make no response.
    return frame.size() < 17 ? Bytes() : Bytes(frame.begin() + 7, frame.end() - 2);
  }

  Bytes reply(const Request& request, std::size_t number, const Bytes& fill) const override
  {
    const std::string command = textOf(request);
    const int wanted = dataSize(command);
    std::string data(wanted < 0 ? 4 : static_cast<std::size_t>(wanted), '0');
    const bool values = command.compare(0, 4, "0101") == 0 || wanted < 0;
    for (std::size_t i = 0; i < std::min(fill.size(), data.size()); ++i)
    {
      const char printable = static_cast<char>(' ' + fill[i] % ('\x7F' - ' '));
      data[i] = values ? "0123456789ABCDEF"[fill[i] % 16] : printable;
    }
    data = command.compare(0, 4, "0801") == 0 ? command.substr(4) : data;
    return sealText(node(request) + "0000" + command.substr(0, 4) + "0000" + data, number);
  }

  Bytes refusal(const Request& request, std::size_t number, std::uint8_t code) const override
  {
    char digits[8];
    std::snprintf(digits, sizeof digits, "%02X", code);
    const bool text = code >= 0x80;
    return sealText(
        text ? node(request) + "000F" + textOf(request).substr(0, 4) + "11" + digits : node(request) + "00" + digits,
        number);
  }

  Bytes seal(const Bytes& bytes, std::size_t /*number*/) const override
  {
    std::string text(bytes.begin(), bytes.end());
    text += static_cast<char>(ETX);
    const std::string frame = static_cast<char>(STX) + text + static_cast<char>(bccOf(text));
    return Bytes(frame.begin(), frame.end());
  }

private:
  Bytes sealText(const std::string& text, std::size_t number) const
  {
    return seal(Bytes(text.begin(), text.end()), number);
  }
};
}  // namespace

std::unique_ptr<Dialect> makeCompowayDialect()
{
  return std::make_unique<CompowayDialect>();
}
}  // namespace fuzz
}  // namespace inverter_bus
