// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/gateway_record.h"

#include <algorithm>
#include <string>
#include <vector>

#include "util/text.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// Contract, 8.8.
constexpr unsigned REPLIES_FOR_TRUST = 3;
/// As rule 3.9 has it: no repetition behind a lost request.
constexpr std::chrono::seconds BAR_TIME{ 1 };
/// Where numbers distinguish replies, what is owed is forgotten after this time, and in any case the oldest of so many.
constexpr std::chrono::seconds MEMORY{ 60 };
constexpr std::size_t MOST_OWED = 256;
/// Requests of the connection whose numbers are told from numbers that a gateway has made up.
constexpr std::size_t REMEMBERED_NUMBERS = 1000;
/// Numbers run from 1, since one that a gateway has put to 0 must differ from every number that was sent.
constexpr unsigned HIGHEST_NUMBER = 0xFFFF;

bool beginsWith(const std::string& text, const std::string& beginning)
{
  return text.compare(0, beginning.size(), beginning) == 0;
}

bool isIn(NumberHabit habit, unsigned habits)
{
  return (static_cast<unsigned>(habit) & habits) != 0;
}

/// How many requests ago \p number was used, if the last one had \p last.
unsigned stepsBack(std::uint16_t number, std::uint16_t last)
{
  return (last + HIGHEST_NUMBER - number) % HIGHEST_NUMBER;
}
}  // namespace

NumberHabit numberHabit(std::uint16_t asked, std::uint16_t replied)
{
  const auto swapped = static_cast<std::uint16_t>(asked << 8 | asked >> 8);
  if (replied == asked)
  {
    return NumberHabit::Same;
  }
  if (replied == static_cast<std::uint16_t>(asked + 1))
  {
    return NumberHabit::PlusOne;
  }
  if (replied == 0)
  {
    return NumberHabit::Zero;
  }
  return replied == swapped ? NumberHabit::Swapped : NumberHabit::None;
}

UnitHabit unitHabit(std::uint8_t asked, std::uint8_t replied)
{
  if (replied == asked)
  {
    return UnitHabit::Same;
  }
  switch (replied)
  {
    case 0:
      return UnitHabit::Zero;
    case 1:
      return UnitHabit::One;
    case 255:
      return UnitHabit::Last;
    default:
      return UnitHabit::None;
  }
}

bool GatewayRecord::Clash::with(const Answer& answer) const
{
  return answer.exception ? exception : normal;
}

void GatewayRecord::opened()
{
  owed_.clear();
  current_ = Asked();
  asked_ = 0;
  exact_replies_ = 0;
  trusted_ = false;
  quirky_ = false;
  mixed_ = false;
  habits_ = 0;
}

void GatewayRecord::setTimeout(Duration timeout)
{
  timeout_ = timeout;
}

TimePoint GatewayRecord::mayAskAt(const std::string& shape, TimePoint now) const
{
  if (trusted_)
  {
    return now;
  }
  TimePoint at = now;
  for (const Asked& owed : owed_)
  {
    if (owed.silent || owed.shape != shape)
    {
      continue;
    }
    if (quirky_)
    {
      // Not then either: the connection is to be opened again by then.
      at = std::max({ at, owed.request_end + timeout_, now + BAR_TIME });
    }
    else if (owed.number == current_.number)
    {
      // The next number is the one that a gateway which adds 1 would give to the answer.
      at = std::max(at, owed.request_end + BAR_TIME);
    }
  }
  return at;
}

void GatewayRecord::add(Clash& clash, const Asked& owed, const Asked& current)
{
  clash.normal = clash.normal || owed.shape == current.shape;
  clash.exception = clash.exception || owed.shape.substr(0, 1) == current.shape.substr(0, 1);
}

void GatewayRecord::asked(const Asked& request, TimePoint now)
{
  forgetOld(now);
  const std::uint16_t previous = current_.number;
  current_ = request;
  ++asked_;
  any_ = broadcast_ = previous_ = Clash();
  for (const Asked& owed : owed_)
  {
    const bool broadcast = owed.silent && owed.station == 0;
    add(broadcast ? broadcast_ : any_, owed, request);
    if (!broadcast && owed.number == previous)
    {
      add(previous_, owed, request);
      previous_station_ = owed.station;
    }
  }
}

bool GatewayRecord::takes(const Answer& answer)
{
  const NumberHabit number = acceptableNumber(answer);
  const UnitHabit unit = unitHabit(current_.station, answer.unit);
  // Numbers that have proved right decide from then on: a reply with another one answers no request of this node.
  const bool foreign = trusted_ && number != NumberHabit::Same;
  if (mixed_ || foreign || number == NumberHabit::None || unit == UnitHabit::None)
  {
    return false;
  }
  const bool exact = number == NumberHabit::Same && unit == UnitHabit::Same;
  if (!exact)
  {
    noteQuirk(number, unit);
  }
  if (clashes(answer, exact))
  {
    mixed_ = mixed_ || !quirky_;
    return false;
  }
  habits_ |= static_cast<unsigned>(number);
  answered(answer, exact);
  return true;
}

/// How the number of \p answer comes from that of the request on its way; None if it speaks for an earlier one.
NumberHabit GatewayRecord::acceptableNumber(const Answer& answer) const
{
  const NumberHabit number = numberHabit(current_.number, answer.number);
  // Where 1 is added, the right number is that of the request before.
  const bool one_behind = number == NumberHabit::Same && isIn(NumberHabit::PlusOne, habits_);
  const bool earlier = number != NumberHabit::Same && !isIn(number, habits_) && numberWasUsed(answer.number);
  return one_behind || earlier ? NumberHabit::None : number;
}

bool GatewayRecord::numberWasUsed(std::uint16_t number) const
{
  return number != 0 && stepsBack(number, current_.number) < std::min(asked_, REMEMBERED_NUMBERS);
}

bool GatewayRecord::clashes(const Answer& answer, bool exact) const
{
  if (trusted_)
  {
    return false;
  }
  if (!quirky_)
  {
    // The number is right, unless the gateway adds 1 and has only now done with the request before.
    return exact && previous_.with(answer) && unitHabit(previous_station_, answer.unit) != UnitHabit::None;
  }
  const bool like_a_broadcast = answer.unit == 0 || answer.unit != current_.station;
  return any_.with(answer) || (like_a_broadcast && broadcast_.with(answer));
}

void GatewayRecord::answered(const Answer& answer, bool exact)
{
  if (trusted_)
  {
    return;
  }
  // A gateway answers in order: earlier requests will not be answered any more.
  const auto passed = [this, &answer](const Asked& owed) {
    return answer.exception ? owed.shape.substr(0, 1) != current_.shape.substr(0, 1) : owed.shape != current_.shape;
  };
  const bool alone = std::all_of(owed_.begin(), owed_.end(), [](const Asked& owed) { return owed.silent; });
  owed_.erase(std::remove_if(owed_.begin(), owed_.end(), passed), owed_.end());
  exact_replies_ += exact && alone ? 1 : 0;
  trusted_ = !quirky_ && exact_replies_ >= REPLIES_FOR_TRUST;
}

void GatewayRecord::noteQuirk(NumberHabit number, UnitHabit unit)
{
  wrong_numbers_ |= number == NumberHabit::Same ? 0 : static_cast<unsigned>(number);
  wrong_units_ |= unit == UnitHabit::Same ? 0 : static_cast<unsigned>(unit);
  // A number that has proved right shows whose answer it is, whatever the unit.
  quirky_ = quirky_ || !trusted_;
}

void GatewayRecord::givenUp(TimePoint now)
{
  forgetOld(now);
  owed_.push_back(current_);
  if (owed_.size() > MOST_OWED)
  {
    owed_.pop_front();
  }
}

/// The owed requests that \p answer could belong to, oldest first.
std::vector<std::deque<GatewayRecord::Asked>::iterator> GatewayRecord::findOwed(const Answer& answer)
{
  // What the gateway is known to do, and nothing else; as long as nothing is known, anything.
  const unsigned habits = trusted_ ? static_cast<unsigned>(NumberHabit::Same) : habits_ == 0 ? ~0U : habits_;
  std::vector<std::deque<Asked>::iterator> found;
  for (auto owed = owed_.begin(); owed != owed_.end(); ++owed)
  {
    if (!answer.shape.empty() && beginsWith(owed->shape, answer.shape) &&
        unitHabit(owed->station, answer.unit) != UnitHabit::None &&
        isIn(numberHabit(owed->number, answer.number), habits))
    {
      found.push_back(owed);
    }
  }
  return found;
}

std::optional<GatewayRecord::Asked> GatewayRecord::takeLate(const Answer& answer)
{
  const auto found = findOwed(answer);
  if (found.empty())
  {
    return std::nullopt;
  }
  Asked request = *found.front();
  owed_.erase(found.front());
  const NumberHabit number = numberHabit(request.number, answer.number);
  const UnitHabit unit = unitHabit(request.station, answer.unit);
  if (found.size() > 1)
  {
    // Most likely the oldest one's, but replies can no longer be assigned for certain.
    mixed_ = true;
    request.ticket = 0;
    return request;
  }
  habits_ |= static_cast<unsigned>(number);
  if (number != NumberHabit::Same || (unit != UnitHabit::Same && !request.silent))
  {
    noteQuirk(number, unit);
  }
  else if (stepsBack(request.number, current_.number) == 1)
  {
    // The request before has its answer, with its own number: the one on its way can't be given that.
    previous_ = Clash();
  }
  return request;
}

std::vector<Outstanding> GatewayRecord::outstanding() const
{
  std::vector<Outstanding> requests;
  for (const Asked& owed : owed_)
  {
    if (!owed.silent)
    {
      requests.push_back({ owed.ticket, owed.station, owed.sent_at });
    }
  }
  return requests;
}

bool GatewayRecord::owes() const
{
  return !owed_.empty();
}

bool GatewayRecord::trusted() const
{
  return trusted_;
}

std::string GatewayRecord::quirk() const
{
  std::vector<std::string> habits;
  const auto number = [&](NumberHabit habit, const char* words) {
    if (isIn(habit, wrong_numbers_))
    {
      habits.emplace_back(words);
    }
  };
  number(NumberHabit::Zero, "transaction number 0");
  number(NumberHabit::PlusOne, "the transaction number plus 1");
  number(NumberHabit::Swapped, "the transaction number with its two bytes exchanged");
  const auto unit = [&](UnitHabit habit, const char* words) {
    if ((static_cast<unsigned>(habit) & wrong_units_) != 0)
    {
      habits.emplace_back(words);
    }
  };
  unit(UnitHabit::Zero, "unit 0");
  unit(UnitHabit::One, "unit 1");
  unit(UnitHabit::Last, "unit 255");
  return habits.empty() ? "" : "its replies carry " + util::joined(habits, " and ") + " instead of what was asked";
}

std::string GatewayRecord::mustReopen(TimePoint now) const
{
  if (mixed_)
  {
    return "two requests could have got the same reply";
  }
  const bool overdue = std::any_of(owed_.begin(), owed_.end(), [this, now](const Asked& owed) {
    return !owed.silent && owed.request_end + timeout_ <= now;
  });
  return quirky_ && overdue ? "a request to the gateway was not answered, and " + quirk() : "";
}

void GatewayRecord::forgetOld(TimePoint now)
{
  const auto is_old = [this, now](const Asked& owed) {
    return owed.silent ? owed.request_end + timeout_ < now : trusted_ && owed.request_end + MEMORY < now;
  };
  owed_.erase(std::remove_if(owed_.begin(), owed_.end(), is_old), owed_.end());
}
}  // namespace wire
}  // namespace inverter_bus
