// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/telnet_filter.h"

#include <algorithm>

namespace inverter_bus
{
namespace wire
{
namespace
{
/// RFC 854, pages 14 and 15.
constexpr std::uint8_t IAC = 0xFF;
constexpr std::uint8_t WILL = 0xFB;
constexpr std::uint8_t DONT = 0xFE;
constexpr std::uint8_t SUBNEGOTIATION = 0xFA;
constexpr std::uint8_t SUBNEGOTIATION_END = 0xF0;
/// One could be noise; a server begins with more.
constexpr unsigned NEGOTIATIONS_THAT_TELL = 2;

bool isNegotiation(std::uint8_t command)
{
  return command >= WILL && command <= DONT;
}
}  // namespace

void TelnetFilter::forget()
{
  *this = TelnetFilter();
}

void TelnetFilter::proven()
{
  looking_ = false;
}

bool TelnetFilter::found() const
{
  return found_;
}

void TelnetFilter::receive(Bytes& buffer, std::size_t begin)
{
  const auto is_telnets = [this](std::uint8_t byte) { return !takes(byte); };
  const auto from = [&buffer](std::size_t place) { return buffer.begin() + static_cast<std::ptrdiff_t>(place); };
  if (found_)
  {
    buffer.erase(std::remove_if(from(begin), buffer.end(), is_telnets), buffer.end());
    return;
  }
  // Bytes stay as they are while it is not known: only the negotiations are counted.
  for (std::size_t i = begin; looking_ && i < buffer.size(); ++i)
  {
    takes(buffer[i]);
  }
  if (looking_ && negotiations_ >= NEGOTIATIONS_THAT_TELL)
  {
    found_ = true;
    state_ = State::Data;
    buffer.erase(std::remove_if(buffer.begin(), buffer.end(), is_telnets), buffer.end());
  }
}

Bytes TelnetFilter::sent(const Bytes& frame) const
{
  Bytes bytes;
  bytes.reserve(2 * frame.size());
  for (const std::uint8_t byte : frame)
  {
    bytes.insert(bytes.end(), found_ && byte == IAC ? 2 : 1, byte);
  }
  return bytes;
}

bool TelnetFilter::takes(std::uint8_t byte)
{
  const State before = state_;
  switch (before)
  {
    case State::Data:
      state_ = byte == IAC ? State::Command : State::Data;
      return byte != IAC;
    case State::Command:
      state_ = isNegotiation(byte) ? State::Option : byte == SUBNEGOTIATION ? State::Subnegotiation : State::Data;
      return byte == IAC;
    case State::Option:
      ++negotiations_;
      state_ = State::Data;
      return false;
    case State::Subnegotiation:
      state_ = byte == IAC ? State::SubnegotiationCommand : State::Subnegotiation;
      return false;
    case State::SubnegotiationCommand:
      state_ = byte == SUBNEGOTIATION_END ? State::Data : State::Subnegotiation;
      return false;
  }
  return true;
}
}  // namespace wire
}  // namespace inverter_bus
