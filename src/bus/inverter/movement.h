// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_MOVEMENT_H
#define INVERTER_BUS_BUS_MOVEMENT_H

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bus/rules/velocity_range.h"
#include "inverter_bus/bus/configuration.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What an accepted velocity command wants of the drive.
struct Target
{
  /// A command of 0 or near it: RUN off, nothing else.
  bool zero = false;
  /// Not exactly 0: for the lock no return to neutral, but silence (contract, 8.5).
  bool near_zero = false;
  bool reverse = false;
  /// Set-point in counts of the drive.
  std::uint32_t counts = 0;
  /// In the user's unit, after clamping.
  double velocity = 0.0;
};

/// A velocity that was judged: a target, or the reason for the refusal.
struct JudgedVelocity
{
  std::uint16_t error_id = 0;
  std::string text;
  Target target;
};

/// One frame of a velocity command.
struct Write
{
  std::string point;
  std::uint32_t raw = 0;
  /// Further words in the same frame (block write).
  std::vector<drive::Word> more;
  wire::Request request;
  /// Puts RUN on: from its first byte on the motor counts as running.
  bool starts = false;
  /// It completes the target: what a newer target asks for after it is a command of its own.
  bool last = false;
};

/// The way from an accepted velocity to the words that the drive has confirmed (contract, sections 2 and 3.5): sends what
/// differs, in the order of the profile's sequence, and nothing that is confirmed already. A newer target simply replaces
/// the older one, also between two frames.
class Movement
{
public:
  Movement(const drive::Drive& drive, const InverterConfig& config);

  /// Range and arming (A000, B004, B006); no state. \p factor of the whole command, see VelocityRange.
  JudgedVelocity judge(double velocity, double factor = 1.0) const;
  /// What may be commanded at all.
  const VelocityRange& range() const;

  void aim(const Target& target);
  /// Drops the target: a stop, a fault, the inverter offline.
  void drop();
  const std::optional<Target>& target() const;
  /// An accepted command has not been confirmed yet.
  bool active() const;

  /// The next frame towards the target; nothing: all confirmed.
  std::optional<Write> next() const;
  /// The same with all command words in one frame, where the drive's block write has exactly these; \p read is what
  /// comes back in the same exchange (17H), if anything.
  std::optional<Write> nextCombined(const std::optional<drive::ReadBlock>& read) const;
  /// The words of the confirmed command while it is in force, for a keep-alive that repeats them (rule 4.1), the one that
  /// starts the motor last; empty: none, or not all confirmed.
  std::vector<drive::Word> wordsInForce() const;
  void sent(const Write& write);
  void confirmed(const Write& write, TimePoint now);
  /// No valid answer: it is unknown whether the drive took it.
  void doubtful(const Write& write, TimePoint now = TimePoint());
  /// The command failed: nothing more is sent for it. A motor that runs goes on as before.
  void giveUp();

  /// The drive has confirmed that RUN is off. The next start writes everything again: a drive that was switched off
  /// meanwhile has forgotten its set-point.
  void stopped(TimePoint now);
  /// A stop frame was acknowledged, but RUN has not been seen off yet.
  void forgetWords();

  /// Last RUN sent.
  bool runCommand() const;
  /// RUN may be on: a RUN frame has left and no stop was confirmed since.
  bool runPossible() const;
  /// RUN was acknowledged and is in force.
  bool runConfirmed() const;
  /// When the frame that was to reverse a running motor got lost; nothing: none did, or the motor was seen running
  /// since. Until then RUN is not sent again: a drive that was switched off meanwhile would start by it.
  std::optional<TimePoint> turnLostAt() const;
  void seenRunning();
  /// When this node last changed RUN; evidence from requests before that says nothing about it.
  TimePoint runChangedAt() const;
  /// A command of 0 was acknowledged: the next status decides whether RUN is off.
  bool zeroUnverified() const;

private:
  const std::string& sequenceName() const;
  std::vector<drive::Word> wantedWords() const;
  bool isConfirmed(const drive::Word& word) const;
  bool startsWith(const drive::Word& word) const;
  void sentWord(const drive::Word& word);
  void confirmedWord(const drive::Word& word, TimePoint now);

  const drive::Drive& drive_;
  const InverterConfig& config_;
  const VelocityRange range_;
  std::map<std::string, std::uint32_t> stop_values_;
  std::map<std::string, std::uint32_t> words_;
  std::optional<Target> target_;
  /// The last one that the drive has confirmed.
  std::optional<Target> confirmed_target_;
  bool active_ = false;
  /// Frequencies that the drive has confirmed since this command (or a stream of them) began.
  unsigned frequencies_told_ = 0;
  bool run_command_ = false;
  bool run_possible_ = false;
  bool run_confirmed_ = false;
  bool zero_unverified_ = false;
  TimePoint run_changed_at_;
  std::optional<TimePoint> turn_lost_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_MOVEMENT_H
