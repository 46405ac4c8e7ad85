// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/compoway/compoway_frame.h"

#include <algorithm>
#include <cstdio>

namespace inverter_bus
{
namespace simulation
{
namespace
{
/// Up to \p end, the BCC, which doesn't count.
std::uint8_t bccOf(Bytes::const_iterator begin, Bytes::const_iterator end)
{
  std::uint8_t bcc = 0;
  std::for_each(begin, end, [&bcc](std::uint8_t byte) { bcc = static_cast<std::uint8_t>(bcc ^ byte); });
  return bcc;
}
}  // namespace

Bytes compowayFrame(const std::string& body)
{
  Bytes frame{ COMPOWAY_STX };
  for (const char character : body)
  {
    frame.push_back(static_cast<std::uint8_t>(character));
  }
  frame.push_back(COMPOWAY_ETX);
  frame.push_back(bccOf(frame.begin() + 1, frame.end()));
  return frame;
}

std::optional<Bytes> findCompowayFrame(const Bytes& stream)
{
  auto start = stream.end();
  for (auto byte = stream.begin(); byte != stream.end(); ++byte)
  {
    if (*byte == COMPOWAY_STX)
    {
      start = byte;
    }
    const bool last = start != stream.end() && *byte == COMPOWAY_ETX;
    if (last && byte + 1 != stream.end())
    {
      return Bytes(start, byte + 2);
    }
  }
  return std::nullopt;
}

std::string compowayBody(const Bytes& frame)
{
  return std::string(frame.begin() + 1, frame.end() - 2);
}

bool compowayBccFits(const Bytes& frame)
{
  return bccOf(frame.begin() + 1, frame.end() - 1) == frame.back();
}

std::string hexDigits(std::uint32_t value, int digits)
{
  char text[9];
  std::snprintf(text, sizeof(text), "%08X", value);
  return std::string(text + 8 - digits);
}

std::optional<std::uint32_t> fromHexDigits(const std::string& text)
{
  const bool good =
      !text.empty() && text.size() <= 8 && text.find_first_not_of("0123456789ABCDEF") == std::string::npos;
  if (!good)
  {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(std::stoul(text, nullptr, 16));
}
}  // namespace simulation
}  // namespace inverter_bus
