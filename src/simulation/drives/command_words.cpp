// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/command_words.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "util/text.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
bool parse(const std::string& word, double& value)
{
  char* end = nullptr;
  value = std::strtod(word.c_str(), &end);
  return !word.empty() && *end == '\0' && std::isfinite(value);
}
}  // namespace

CommandWords::CommandWords(const std::string& line)
{
  std::istringstream stream(line.substr(0, line.find('#')));
  for (std::string word; stream >> word;)
  {
    words_.push_back(word);
  }
}

bool CommandWords::empty() const
{
  return next_ >= words_.size();
}

const std::string& CommandWords::peek() const
{
  return words_[next_];
}

std::string CommandWords::take(const std::string& what)
{
  if (empty())
  {
    throw CommandError(what + " is missing");
  }
  return words_[next_++];
}

bool CommandWords::takeIf(const std::string& word)
{
  const bool found = !empty() && peek() == word;
  next_ += found ? 1 : 0;
  return found;
}

double CommandWords::takeNumber(const std::string& what, double minimum, double maximum)
{
  const std::string word = take(what);
  double value = 0.0;
  if (!parse(word, value) || value < minimum || value > maximum)
  {
    throw CommandError(what + " " + word + " (allowed: " + util::numberText(minimum) + " to " +
                       util::numberText(maximum) + ")");
  }
  return value;
}

double CommandWords::takeNumberOr(double fallback, const std::string& what, double minimum, double maximum)
{
  double value = 0.0;
  return empty() || !parse(peek(), value) ? fallback : takeNumber(what, minimum, maximum);
}

bool CommandWords::takeOnOff(const std::string& what)
{
  const std::string word = take(what);
  if (word != "on" && word != "off")
  {
    throw CommandError(what + " " + word + " (allowed: on, off)");
  }
  return word == "on";
}

void CommandWords::finish() const
{
  if (!empty())
  {
    throw CommandError("unexpected word " + peek() + " (allowed: nothing more here; see help)");
  }
}
}  // namespace simulation
}  // namespace inverter_bus
