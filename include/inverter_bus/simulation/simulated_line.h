// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_SIMULATED_LINE_H
#define INVERTER_BUS_SIMULATION_SIMULATED_LINE_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/simulation/bytes.h"
#include "inverter_bus/simulation/line_settings.h"
#include "inverter_bus/simulation/simulated_drive.h"
#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
class Wire;
struct Transmission;

/// What happens to a request whose first byte comes before the line was silent for LineSettings::frameGap().
enum class GapRule
{
  Enforce,  ///< no drive hears it, as on a real line
  Ignore    ///< it is served and counted: for masters such as plain libmodbus that don't wait
};

struct LineOptions
{
  LineSettings settings;
  GapRule gap = GapRule::Enforce;
  Duration gap_tolerance = std::chrono::microseconds(300);  ///< a request may come this much early
  /// Bytes for the master come out together for as long as this, never before their time; zero: a frame in one piece at
  /// its end (fastest, for virtual time).
  Duration delivery_step = Duration::zero();
  std::uint64_t seed = 1;
};

/// Bytes that came out of the line for the master.
struct Delivery
{
  TimePoint time;  ///< end of the last byte on the wire
  Bytes bytes;
};

/// One frame that was on the wire.
struct FrameRecord
{
  enum class Source
  {
    Master,
    Drive,
    ForeignMaster,
    Noise
  };
  TimePoint time;  ///< start of its first byte
  Source source = Source::Master;
  std::string drive;    ///< the drive that sent it, if any
  std::string station;  ///< as the frame says: "1"; CompoWay/F: "01", "XX"; empty: it doesn't say
  Bytes bytes;          ///< as on the wire: damage included
  std::string remark;   ///< "lost: gap", "damaged: collision", ...; empty: all well
};

struct LineCounters
{
  std::uint64_t requests = 0;    ///< frames of the master
  std::uint64_t replies = 0;     ///< frames of drives
  std::uint64_t lost_gap = 0;    ///< requests lost to the missing gap
  std::uint64_t early = 0;       ///< requests without the gap that were served (GapRule::Ignore)
  std::uint64_t damaged = 0;     ///< requests that arrived with a wrong check sum or length
  std::uint64_t collisions = 0;  ///< transmissions damaged by another
  std::uint64_t foreign = 0;     ///< frames of the second master
};

/// An RS-485 line with drives on it, one master and, at will, a second one; event driven, in the time that is passed
/// in.
///
/// - Each byte occupies the wire for start + data + parity + stop bits; bytes handed over together follow back to back.
/// - A Modbus frame ends with 3.5 characters of silence, a CompoWay/F frame with the byte after ETX, whatever pauses are
///   in it; then the drives get it, and the answering one starts after its delay.
/// - Two transmissions at once damage each other's bytes where they overlap.
/// - A request that comes before the line was silent for LineSettings::frameGap() is lost (GapRule).
/// - With 7 data bits the eighth bit of a byte is not sent.
///
/// **The gap in real time.** A process is woken late, never early. What the master writes is stamped when it is read,
/// so its stamp is late or right. What the master reads it can have seen no earlier than it was handed over; that, not
/// the ideal end of the byte on the wire, is what takeOutput() takes as the end of the line's activity: a master that
/// reads the last byte late and then waits its time is always in time, one that doesn't wait is caught
/// however late this process was. `gap_tolerance` covers the granularity of the master's own timer and a late stamp on
/// a frame that is not answered (after it the master waits far longer anyway).
///
/// Not for several threads at once.
class SimulatedLine
{
public:
  SimulatedLine(const LineOptions& options, TimePoint start);
  ~SimulatedLine();

  /// \p drive must outlive the line.
  void attach(SimulatedDrive& drive);
  /// Called for every frame once it is over (replies: in the order of their ends).
  void setObserver(std::function<void(const FrameRecord&)> observer);

  /// The master sends: the first byte is on the wire from now on, or after the master's previous one.
  void receive(const Bytes& bytes, TimePoint now);
  /// When something is due next; nothing: the line is at rest.
  std::optional<TimePoint> nextEvent() const;
  /// Does everything that is due up to now.
  void advance(TimePoint now);
  /// What has come out for the master since the last call. \p now is when the master can see it.
  std::vector<Delivery> takeOutput(TimePoint now);

  /// The master's port is set otherwise; drives with other settings hear garbage from now on.
  void setMaster(const LineSettings& settings, TimePoint now);
  /// The master's adapter is unplugged: what it was sending breaks off, and it hears nothing.
  void setConnected(bool connected, TimePoint now);
  /// The adapter sends everything back to the master that the master sends (no echo suppression).
  void setEcho(bool on);
  /// The line between master and drives is cut: neither side hears anything.
  void setSilent(bool on);
  /// A second master sends a frame, as it is. \p wait: as soon as the line is silent; else at once.
  void sendForeign(const Bytes& frame, bool wait, TimePoint now);
  /// Bytes from no sender (noise).
  void sendNoise(std::size_t count, TimePoint now);

  const LineCounters& counters() const;
  void clearCounters();
  const LineOptions& options() const;
  /// Nothing is on the wire or owed.
  bool idle() const;

private:
  struct Owed
  {
    TimePoint start;
    SimulatedDrive* drive;
    Bytes bytes;
  };

  struct WaitingForeign
  {
    TimePoint start;
    Bytes bytes;
  };

  TimePoint dueTime(const Transmission& transmission) const;
  void send(Transmission& transmission, const Bytes& bytes, TimePoint start);
  void process(TimePoint time);
  void processForeign(TimePoint time);
  void processOwed(TimePoint time);
  void processTransmission(Transmission& transmission, TimePoint time);
  void deliver(Transmission& transmission, TimePoint time);
  void finishRequest(Transmission& transmission);
  bool takeFrame(Bytes& bytes);
  void serve(const Transmission& transmission, const Bytes& frame, TimePoint time, std::string& remark);
  void finishReply(Transmission& transmission);
  void report(const Transmission& transmission, const std::string& remark);
  bool owes(const SimulatedDrive* drive) const;
  bool wholeForAny(const Bytes& frame) const;

  LineOptions options_;
  Duration gap_;  // before a request
  Duration end_;  // after a request
  std::vector<SimulatedDrive*> drives_;
  std::function<void(const FrameRecord&)> observer_;
  std::unique_ptr<Wire> wire_;
  std::vector<Owed> owed_;
  std::vector<WaitingForeign> waiting_;
  std::vector<Delivery> output_;
  TimePoint last_seen_;  // handed over to the master
  bool connected_ = true;
  bool echo_ = false;
  bool silent_ = false;
  Bytes unfinished_;  // CompoWay/F: heard by the drives, and no end of a frame in it
  LineCounters counters_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_SIMULATED_LINE_H
