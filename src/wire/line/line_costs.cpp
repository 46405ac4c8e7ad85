// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>

#include "inverter_bus/wire/line.h"

namespace inverter_bus
{
namespace wire
{
Duration Line::cost(const Request& request, Duration drive_delay) const
{
  if (request.broadcast)
  {
    return timeToSend(request);
  }
  const double reply_length = request.expects_reply ? static_cast<double>(protocol_.replyLength(request)) : 0.0;
  return timeToSend(request) + gap() + drive_delay + timing_.characters(reply_length);
}

Duration Line::costUnanswered(const Request& request) const
{
  if (request.broadcast || !request.expects_reply)
  {
    return cost(request, Duration{ 0 });
  }
  return timeToSend(request) + gap() + heldBack(request) + request.reply_delay + request.response_timeout;
}

std::optional<AdapterLatency> Line::adapterLatency() const
{
  return port_.isOpen() ? port_.adapterLatency() : std::nullopt;
}

Duration Line::patience() const
{
  return timing_.patience(protocol_.gapCharacters());
}

Duration Line::gap() const
{
  return timing_.gap(protocol_.gapCharacters());
}

Duration Line::gatewayGap() const
{
  return timing_.gap(protocol_.gatewayGapCharacters());
}

/// Time that passes on the line behind a gateway before the first byte of a reply can be received.
Duration Line::heldBack(const Request& request) const
{
  const bool gateway = protocol_.gatewayGapCharacters() > 0.0;
  return gateway ? timing_.characters(static_cast<double>(protocol_.replyLength(request))) : Duration{ 0 };
}

/// From the last byte on the line to the end of \p request.
Duration Line::timeToSend(const Request& request) const
{
  const auto length = static_cast<double>(protocol_.requestLength(request));
  return std::max(gap(), request.quiet_before) + timing_.characters(length) + gatewayGap();
}
}  // namespace wire
}  // namespace inverter_bus
