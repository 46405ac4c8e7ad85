// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_STREAMS_H
#define INVERTER_BUS_FUZZ_STREAMS_H

#include <string>
#include <vector>

#include "fuzz/bus/stage.h"

namespace inverter_bus
{
namespace fuzz
{
/// Publishers that repeat velocities as users' programs do: at most one for each inverter.
class Streams
{
public:
  explicit Streams(Stage& stage);

  double anySpeed(std::size_t index);
  std::string anyPublisher();
  /// A steady or drifting stream of any speed, for a moment.
  void begin(std::size_t index);
  /// One that changes with every message, for \p duration; \p grouped: in one message with those beside it.
  void beginWavering(std::size_t index, double period, Duration duration, bool grouped);
  /// One of a new speed until it is stopped; false: its first velocity is refused.
  bool beginSteady(std::size_t index, const std::string& publisher);
  void pause(std::size_t index);
  /// After a pause, with a new speed.
  void resumeSteady(std::size_t index, const std::string& publisher);
  bool isOn(std::size_t index) const;
  /// [Hz] signed.
  double hertz(std::size_t index) const;

  void send(std::size_t index, double hertz, const std::string& publisher);
  /// Any speed from any publisher, once.
  void sendAny(std::size_t index);
  /// Too small to be called a movement, in the user's unit.
  double nearZero(std::size_t index);

private:
  struct Stream
  {
    bool on = false;
    unsigned number = 0;
    double hertz = 0.0;
    double drift = 0.0;
    bool wavers = false;  ///< changes with every message and stays in its range
    bool grouped = false;
    unsigned sent = 0;
    double period = 0.1;
    bool dips = false;  ///< goes near zero now and then, as a controller does
    TimePoint until;
    std::string publisher;
  };

  void tick(std::size_t index, unsigned number);
  void sendOne(std::size_t index);
  void sendGroup(std::size_t index);
  void sendNearZero(std::size_t index);

  Stage& stage_;
  std::vector<Stream> streams_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_STREAMS_H
