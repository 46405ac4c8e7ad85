// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/types.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr std::uint8_t LAST_LASTING_EXCEPTION = 0x03;
}  // namespace

bool isAnswered(const wire::Reply& reply)
{
  return reply.outcome == wire::Outcome::Ok || reply.outcome == wire::Outcome::Exception;
}

bool isLastingRefusal(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Exception && reply.error_id < 0x8000)
  {
    // CompoWay/F: service, length, area, address and count (0401, 10xx, 11xx) and read-only items (3003) concern the
    // request; an operation error (2203) concerns the moment.
    const unsigned main_code = reply.error_id >> 8U;
    return main_code == 0x04 || main_code == 0x10 || main_code == 0x11 || main_code == 0x30;
  }
  return reply.outcome == wire::Outcome::Exception && reply.pdu.size() > 1 && reply.pdu[1] <= LAST_LASTING_EXCEPTION;
}

TraceEvent traceEvent(TimePoint time, const std::string& text)
{
  TraceEvent event;
  event.time = time;
  std::copy_n(text.begin(), std::min(text.size(), event.text.size() - 1), event.text.begin());
  return event;
}

std::string errorIdText(std::uint16_t error_id)
{
  return util::hexNumber(error_id);
}

std::string lockedText(bool tripped)
{
  const std::string neutral = "send 0, or stay silent for a moment, before the next movement";
  return tripped ? "locked, since the drive has tripped: remove the cause and call reset, then " + neutral
                 : "locked: " + neutral;
}

std::string errorText(std::uint16_t error_id, std::uint8_t gateway_code)
{
  if (error_id == wire::ERROR_TIMEOUT && gateway_code != 0)
  {
    return "no reply in time (the gateway answered with exception " + util::hexText(gateway_code, 2) + "H)";
  }
  switch (error_id)
  {
    case ERROR_NONE:
      return "normal completion";
    case wire::ERROR_TIMEOUT:
      return "no reply in time";
    case wire::ERROR_DAMAGED:
      return "damaged or foreign reply";
    case wire::ERROR_PORT_LOST:
      return "the port is gone";
    case ERROR_OUT_OF_RANGE:
      return "an input is out of range";
    case ERROR_OFFLINE:
      return "the inverter is offline";
    case ERROR_CANCELLED:
      return "cancelled by a stop";
    case ERROR_SHUTTING_DOWN:
      return "the node is shutting down";
    case ERROR_NOT_OFFERED:
      return "not offered by this drive";
    case ERROR_LOCKED:
      return lockedText(false);
    case ERROR_NOT_ARMED:
      return "not armed: values of the profile are missing or unconfirmed";
    default:
      break;
  }
  return error_id >= 0x8000 ? "the drive answered exception " + util::hexText(error_id & 0xFFU, 2) + "H"
                            : "response code " + util::hexText(error_id, 4);
}
}  // namespace bus
}  // namespace inverter_bus
