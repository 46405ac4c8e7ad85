// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_PSEUDO_TERMINAL_H
#define INVERTER_BUS_SIMULATION_PSEUDO_TERMINAL_H

#include <string>

#include "inverter_bus/simulation/bytes.h"
#include "inverter_bus/simulation/line_settings.h"

namespace inverter_bus
{
namespace simulation
{
/// A raw pseudo-terminal with a link to it, in place of the serial port of an adapter. The far side is kept open
/// here too, so that a client that closes doesn't hang it up. Not for several threads at once.
class PseudoTerminal
{
public:
  /// Opens the terminal under the name \p link; an older link of that name is replaced. \p settings are what it is set to
  /// until a client sets it. \throws std::runtime_error when no terminal is available, or the link can't be made; the
  /// text says why
  explicit PseudoTerminal(const std::string& link, const LineSettings& settings = LineSettings());
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// As after plugging the adapter in: a new terminal under the same link. \throws as the constructor
  void open();
  /// As after pulling it out: link and terminal are gone, clients get a hang-up.
  void close();
  bool isOpen() const;

  int descriptor() const;           ///< for poll(); -1 while closed
  const std::string& path() const;  ///< the terminal's own name
  const std::string& link() const;

  /// What clients have written; empty where nothing waits. Never blocks.
  Bytes read();
  /// Never blocks: unread bytes beyond what fits are lost, as on a wire.
  void write(const Bytes& bytes);

private:
  void makeLink();
  void removeLink();

  std::string link_;
  std::string path_;
  LineSettings settings_;
  int near_ = -1;
  int far_ = -1;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_PSEUDO_TERMINAL_H
