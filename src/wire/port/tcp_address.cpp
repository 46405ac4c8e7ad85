// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/system/error_code.hpp>
#include <cctype>

#include "inverter_bus/wire/tcp_port.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
constexpr std::size_t LONGEST_HOST_NAME = 253;
constexpr std::size_t MOST_PORT_DIGITS = 5;
constexpr unsigned long HIGHEST_PORT = 65535;

bool isDigit(char character)
{
  return character >= '0' && character <= '9';
}

bool mayStandInName(char character)
{
  return std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '-' || character == '.' ||
         character == '_';
}

/// Digits in its last part: not a name, but an IPv4 address or meant as one.
bool looksLikeIpv4(const std::string& host)
{
  const std::string last = host.substr(host.rfind('.') + 1);
  return std::all_of(last.begin(), last.end(), isDigit);
}

/// What is wrong with \p host; empty if nothing is.
std::string checkHost(const std::string& host, bool in_brackets)
{
  boost::system::error_code refused;
  if (in_brackets)
  {
    boost::asio::ip::make_address_v6(host, refused);
    return refused ? "'" + util::printable(host) + "' is not an IPv6 address" : "";
  }
  if (host.empty())
  {
    return "the host is missing";
  }
  if (!std::all_of(host.begin(), host.end(), mayStandInName) || host.size() > LONGEST_HOST_NAME)
  {
    return "'" + util::printable(host) + "' is not a host name";
  }
  if (looksLikeIpv4(host))
  {
    // The system would take 10.1 and 010.0.0.1 for addresses too, other ones than the user means.
    boost::asio::ip::make_address_v4(host, refused);
  }
  return refused ? "'" + host + "' is not an IPv4 address" : "";
}

std::optional<std::uint16_t> parsePort(const std::string& text)
{
  const bool digits =
      !text.empty() && text.size() <= MOST_PORT_DIGITS && std::all_of(text.begin(), text.end(), isDigit);
  const unsigned long port = digits ? std::stoul(text) : 0;
  return port >= 1 && port <= HIGHEST_PORT ? std::optional<std::uint16_t>(static_cast<std::uint16_t>(port))
                                           : std::nullopt;
}

/// Host and, behind it, nothing or a colon and the port.
struct Parts
{
  std::string host;
  bool in_brackets = false;
  std::string rest;
};

std::optional<Parts> split(const std::string& text, std::string& error)
{
  Parts parts;
  parts.in_brackets = !text.empty() && text[0] == '[';
  const std::size_t end = parts.in_brackets ? text.find(']') : std::min(text.find(':'), text.size());
  if (end == std::string::npos)
  {
    error = "a closing bracket is missing";
    return std::nullopt;
  }
  parts.host = parts.in_brackets ? text.substr(1, end - 1) : text.substr(0, end);
  parts.rest = text.substr(end + (parts.in_brackets ? 1 : 0));
  if (parts.rest.find(':', 1) != std::string::npos)
  {
    error = "an IPv6 address is written in brackets: [::1]:502";
    return std::nullopt;
  }
  return parts;
}
}  // namespace

std::optional<TcpAddress> parseTcpAddress(const std::string& text, std::uint16_t default_port, std::string& error)
{
  const auto parts = split(text, error);
  if (!parts)
  {
    return std::nullopt;
  }
  error = checkHost(parts->host, parts->in_brackets);
  if (!error.empty())
  {
    return std::nullopt;
  }
  if (parts->rest.empty())
  {
    error = default_port == 0 ? "the port number is missing (host:port)" : "";
    return default_port == 0 ? std::nullopt : std::make_optional(TcpAddress{ parts->host, default_port });
  }
  const auto port = parts->rest[0] == ':' ? parsePort(parts->rest.substr(1)) : std::nullopt;
  if (!port)
  {
    error = "the host must be followed by a colon and a port number from 1 to 65535, not '" +
            util::printable(parts->rest) + "'";
    return std::nullopt;
  }
  return TcpAddress{ parts->host, *port };
}

std::vector<std::string> resolveName(const std::string& host, std::string& error)
{
  using boost::asio::ip::tcp;
  boost::asio::io_context context;
  boost::system::error_code refused;
  const auto found = tcp::resolver(context).resolve(host, "", tcp::resolver::flags(), refused);
  std::vector<std::string> addresses;
  for (const auto& entry : found)
  {
    addresses.push_back(entry.endpoint().address().to_string());
  }
  error = refused ? refused.message() : "";
  return addresses;
}
}  // namespace wire
}  // namespace inverter_bus
