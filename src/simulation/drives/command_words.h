// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_COMMAND_WORDS_H
#define INVERTER_BUS_SIMULATION_COMMAND_WORDS_H

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace inverter_bus
{
namespace simulation
{
/// A command that can't be carried out; the text is the answer without "error: ".
class CommandError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// The words of a command, taken one by one.
class CommandWords
{
public:
  explicit CommandWords(const std::string& line);

  bool empty() const;
  const std::string& peek() const;
  /// The next word; \p what names it where it is missing. \throws CommandError when there is none left
  std::string take(const std::string& what);
  /// Takes the next word if it is this one.
  bool takeIf(const std::string& word);
  /// \throws CommandError when the word is no number from \p minimum to \p maximum
  double takeNumber(const std::string& what, double minimum, double maximum);
  /// \p fallback where no word is left or the next one is no number. \throws CommandError as takeNumber() for a number
  double takeNumberOr(double fallback, const std::string& what, double minimum, double maximum);
  bool takeOnOff(const std::string& what);
  /// \throws CommandError when a word is left
  void finish() const;

private:
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_COMMAND_WORDS_H
