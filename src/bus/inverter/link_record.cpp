// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/link_record.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using Part = std::pair<std::uint64_t, std::string>;

std::uint64_t total(const std::map<std::uint16_t, std::uint64_t>& counts)
{
  std::uint64_t sum = 0;
  for (const auto& entry : counts)
  {
    sum += entry.second;
  }
  return sum;
}

std::string gatewayText(std::uint8_t code)
{
  return "without a reply, as the gateway reports (exception " + util::hexText(code, 2) + "H)";
}

std::string exceptionText(const drive::Drive& drive, std::uint16_t error_id)
{
  const std::string text = drive.exceptionText(error_id);
  return "answered by " + (text.empty() ? errorText(error_id) : text);
}
}  // namespace

void LinkRecord::note(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::PortLost)
  {
    return;
  }
  ++requests_;
  switch (reply.outcome)
  {
    case wire::Outcome::Ok:
      ++answered_;
      break;
    case wire::Outcome::Exception:
      // Codes come from outside, but there are no more than 256 of them per function.
      ++exceptions_[reply.error_id];
      break;
    case wire::Outcome::Damaged:
      ++damaged_;
      break;
    default:
      reply.gateway_code != 0 ? ++gateway_[reply.gateway_code] : ++timeouts_;
      break;
  }
}

void LinkRecord::noteLate()
{
  ++late_;
}

void LinkRecord::restart()
{
  *this = LinkRecord();
}

bool LinkRecord::empty() const
{
  return requests_ == 0;
}

std::string LinkRecord::text(const drive::Drive& drive) const
{
  constexpr std::size_t MOST_PARTS = 5;
  std::vector<Part> parts{ { timeouts_, "without a reply" }, { damaged_, "damaged or foreign" } };
  for (const auto& entry : gateway_)
  {
    parts.emplace_back(entry.second, gatewayText(entry.first));
  }
  for (const auto& entry : exceptions_)
  {
    parts.emplace_back(entry.second, exceptionText(drive, entry.first));
  }
  parts.emplace_back(answered_, "answered without a complete status");
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t index = 0; index < std::min(parts.size(), MOST_PARTS) && parts[index].first > 0; ++index)
  {
    text += (text.empty() ? "of " + std::to_string(requests_) + " requests " : ", ") +
            std::to_string(parts[index].first) + " " + parts[index].second;
  }
  return text + (late_ == 0 || text.empty() ? "" : "; " + std::to_string(late_) + " came too late");
}

std::string LinkRecord::advice() const
{
  const std::uint64_t most = std::max(total(exceptions_), std::max(damaged_, lost()));
  if (most == 0 || lost() == most)
  {
    return late_ > 0 ? "raise response_timeout"
                     : "check supply, wiring, station number and serial settings; if it answers when it is alone, it "
                       "needs silence before a request (timing: quiet_before)";
  }
  return damaged_ == most
             ? "check baud rate, parity, stop bits, termination, and whether two drives have this station number"
             : "check that this drive is the one of the profile, and what it refuses";
}

std::uint64_t LinkRecord::lost() const
{
  std::uint64_t sum = timeouts_;
  for (const auto& entry : gateway_)
  {
    sum += entry.second;
  }
  return sum;
}
}  // namespace bus
}  // namespace inverter_bus
