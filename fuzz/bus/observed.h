// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_OBSERVED_H
#define INVERTER_BUS_FUZZ_OBSERVED_H

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fuzz/bus/frames.h"
#include "fuzz/bus/scene.h"
#include "inverter_bus/bus/types.h"
#include "inverter_bus/simulation/bytes.h"

// What could be seen of a bus from outside so far, as far as more than one check needs it. Only the Recorder writes it.

namespace inverter_bus
{
namespace fuzz
{
// Contract, rule 4.2.
constexpr double SHORTEST_SILENCE_S = 0.5;
constexpr double SILENCE_TOLERANCE_S = 1e-3;

/// The exchange in flight, or the last one.
struct Exchange
{
  bool in_flight = false;
  std::uint64_t number = 0;
  TimePoint began;
  simulation::Bytes request;
  RequestFacts facts;
  bool answered = false;
  TimePoint request_end;  ///< its last byte
  TimePoint heard_at;     ///< the last bytes since; the epoch: none
  /// It was given up before its time: a stop has cut the wait.
  bool cut = false;
  /// It is sent to an inverter that was shown as offline.
  bool to_offline = false;
  /// It carries a RUN that the drive has acknowledged already.
  bool repeats_run = false;
  /// It may have been decided before the newest command of its inverter came.
  bool precedes_command = false;
};

/// One publisher of velocities for one inverter.
struct Stream
{
  TimePoint last;         ///< that broke a silence
  Duration spacing{ 0 };  ///< between the last two
  TimePoint zeroed_at;
  std::set<std::string> topics;
};

/// What the newest accepted command of an inverter wants.
struct Order
{
  bool valid = false;  ///< nothing has ended it
  TimePoint ended_at;
  TimePoint accepted_at;
  double hertz = 0.0;            ///< signed, as the drive is to turn
  std::optional<TimePoint> fed;  ///< the command watchdog counts from here
  std::string publisher;
};

/// What of it was sent, and what the drive has acknowledged.
struct Words
{
  bool run_sent = false;
  bool run_answered = false;
  bool run_reverse = false;
  std::optional<double> set_answered;  ///< [Hz]
  bool settled = false;                ///< all of the order
  bool shown = false;                  ///< the last exchange succeeded and showed RUN in force
  int run_copies = 0;
  int set_copies = 0;
  int run_set_copies = 0;  ///< in one frame with RUN
};

/// The last stop of an inverter.
struct StopRecord
{
  bool active = false;  ///< it was requested, or the node says that it is under way
  TimePoint sent;
  TimePoint acknowledged;
};

/// What the node has published of an inverter.
struct Told
{
  bool any = false;
  bool online = false;
  bus::InverterStatus status;  ///< the last one
};

/// The drive at its end of the line.
struct LinkRecord
{
  std::optional<TimePoint> last_heard;  ///< end of a request, by which its own time-out counts
  bool timeout_known = false;           ///< the driver has read how long that is
  TimePoint lost_at;                    ///< the last exchange without an answer
  TimePoint imitated_at;                ///< another drive has answered under its station
  TimePoint deaf_until;                 ///< after a reset
  TimePoint cut_at;                     ///< of its supply, the last time
};

struct InverterRecord
{
  std::map<std::string, Stream> streams;
  Order order;
  Words words;
  StopRecord stop;
  Told told;
  LinkRecord link;
};

struct Observed
{
  explicit Observed(const Scene& scene);

  const Scene& scene;
  Exchange exchange;
  std::vector<InverterRecord> inverters;
  bool connected = false;
  TimePoint connected_since;
  bool shutting_down = false;
  TimePoint disturbed_at;      ///< by noise, a second master or a lost port
  TimePoint heard_in_between;  ///< the last bytes while no exchange was in flight

  /// Shown as online, and the port is there.
  bool online(std::size_t index) const;
  /// A latched message that this publisher had sent before it reconnected.
  bool isRepeat(std::size_t index, const bus::Publisher& publisher) const;
  /// Silence that a 3G3JE wants between the decision and the first byte.
  Duration quiet() const;
  /// How much longer than usual the line may be listened to before a request.
  Duration babble(TimePoint now) const;
  /// What goes at \p now may have been decided before \p time: what comes late in the silence before a frame prolongs
  /// it.
  bool decidedBefore(TimePoint now, TimePoint time) const;
  /// A frame that is due waits no longer than this: an exchange in flight, the gap, and what a broadcast takes.
  Duration longestWait(TimePoint now) const;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_OBSERVED_H
