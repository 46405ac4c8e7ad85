// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_BUS_RUNNER_H
#define INVERTER_BUS_SIMULATION_BUS_RUNNER_H

#include <poll.h>

#include <atomic>
#include <cstddef>
#include <ctime>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "inverter_bus/simulation/pseudo_terminal.h"
#include "inverter_bus/simulation/punctuality.h"
#include "inverter_bus/simulation/simulated_bus.h"

namespace inverter_bus
{
namespace simulation
{
/// Plays a bus on a pseudo-terminal in real time (steady clock). run() blocks in one thread; command() may be called
/// from any other; stop() also from a signal handler.
class BusRunner
{
public:
  /// Opens the terminal under the name \p link. \p bus must outlive the runner, is not used elsewhere while run() runs, and
  /// should start now. \throws std::runtime_error when terminal or link can't be made
  BusRunner(SimulatedBus& bus, const std::string& link);
  ~BusRunner();
  BusRunner(const BusRunner&) = delete;
  BusRunner& operator=(const BusRunner&) = delete;

  /// Also reads commands, one a line, from this descriptor; its end does not end the program. \p answer gets the answer
  /// to each, in the thread of run(). Call it before run().
  void readCommands(int descriptor, std::function<void(const std::string&)> answer);

  /// The parity that the client is taken to use, whatever its terminal shows (see terminal_settings.h). Call it before run().
  void assumeParity(Parity parity);

  /// The last \p lead seconds of each wait are spent polling the clock, which is less late than the kernel's timers and
  /// costs that much of a core; 0: never. Call it before run().
  void spin(double lead);

  /// Returns after stop(). \p realtime_priority 1 to 99: SCHED_FIFO for the calling thread, where that is permitted; 0: as
  /// the thread is.
  void run(int realtime_priority = 0);
  void stop() noexcept;
  std::string command(const std::string& line);
  const PseudoTerminal& terminal() const;
  /// How late the wire was; 0 before run(). Call it after run().
  const Punctuality& punctuality() const;

private:
  void step(bool readable);
  void matchPort();
  void matchSettings(TimePoint now);
  void handOver();
  void readCommandBytes();
  timespec waitTime() const;
  void wait(pollfd* watched, std::size_t count);

  SimulatedBus& bus_;
  PseudoTerminal terminal_;
  std::mutex mutex_;
  int wake_;
  std::atomic<bool> stop_{ false };
  std::optional<Parity> assumed_parity_;
  std::optional<LineSettings> master_;  ///< as seen last
  int command_descriptor_ = -1;
  std::string command_text_;
  std::function<void(const std::string&)> answer_;
  Duration lead_ = Duration::zero();
  Punctuality punctuality_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_BUS_RUNNER_H
