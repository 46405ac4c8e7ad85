// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_SIMULATED_DRIVE_H
#define INVERTER_BUS_SIMULATION_SIMULATED_DRIVE_H

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/simulation/bytes.h"
#include "inverter_bus/simulation/fault_queue.h"
#include "inverter_bus/simulation/line_settings.h"
#include "inverter_bus/simulation/random.h"
#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
class Motor;

/// A reply and how long the drive takes for it.
struct Answer
{
  Bytes bytes;
  Duration
      delay{};  ///< from the end of the request (Modbus: of its 3.5-character silence) to the reply's first start bit
  bool exception = false;  ///< the drive refuses the request
};

/// What a drive saw of the bus.
struct ExchangeCounters
{
  std::uint64_t exchanges = 0;   ///< requests to this station that were answered, exceptions included
  std::uint64_t broadcasts = 0;  ///< broadcasts that were executed
  std::uint64_t exceptions = 0;  ///< answers that were exceptions
  std::uint64_t damaged = 0;     ///< frames to this station with a wrong check sum or length
  std::uint64_t unheard = 0;     ///< requests while off, offline, starting up or silent after a reset
  std::uint64_t lost_gap = 0;    ///< requests lost because they came before the silence (LineSettings::frameGap())
  std::uint64_t early = 0;       ///< the same, but served (--gap ignore)
  std::uint64_t lost_busy = 0;   ///< requests lost because the drive still owed an earlier reply
};

/// Why an operation at the drive was refused; nothing: done.
using Refusal = std::optional<std::string>;
using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// One drive on the bus with its motor: answers request frames, moves its motor and its timers as time goes on, and can
/// be operated "by hand" (panel, mains switch, load). Time comes in as an argument only and must never go back; chance
/// comes from the seed only. Not for several threads at once.
///
/// Derive from it for a protocol (ModbusSlave, CompowaySlave) and from that for a brand (HitachiDrive).
class SimulatedDrive
{
public:
  /// At \p start the drive has been on long enough to answer. \p seed of all its chance.
  SimulatedDrive(std::string name, int station, std::uint64_t seed, TimePoint start);
  virtual ~SimulatedDrive();
  SimulatedDrive(const SimulatedDrive&) = delete;
  SimulatedDrive& operator=(const SimulatedDrive&) = delete;

  const std::string& name() const;
  int station() const;

  /// A complete frame was heard; called at its end (Modbus: of its 3.5-character silence). The reply, or nothing: another
  /// station, a broadcast, damaged, deaf, a fault.
  std::optional<Answer> handle(const Bytes& frame, TimePoint now);

  /// Moves motor, watchdog and all other timers to `now`, exactly, however far ahead that is.
  void advance(TimePoint now);

  /// The frame is meant for this drive: it bears its station number, or is a broadcast that it takes part in.
  virtual bool addressedBy(const Bytes& frame) const = 0;
  /// The frame is complete and its check sum right.
  virtual bool isWholeFrame(const Bytes& frame) const = 0;
  /// The largest number that can be injected as an exception.
  virtual int largestException() const = 0;

  /// False while the drive has no power or its connection to the bus is cut: a reply that it owes won't come.
  bool canSend() const;
  bool powered() const;
  /// How the master talks from now on; until the first call exactly as the drive understands it.
  void setLine(const LineSettings& line);
  /// False while the drive hears garbage: its serial settings differ from the master's.
  bool understandsLine() const;
  /// One more of what only the line can see: lost_gap, early or lost_busy.
  void count(std::uint64_t ExchangeCounters::*counter);
  void clearCounters();
  const ExchangeCounters& counters() const;

  // Faults of the connection.
  void inject(const Fault& fault);
  void clearFaults();
  /// Cuts the drive off from the bus (it runs on) \p until then; nothing: until setOnline().
  void setOffline(std::optional<TimePoint> until);
  void setOnline();
  /// Switches the mains off \p until it starts up again, without start-up time; nothing: until powerOn().
  void powerOff(TimePoint now, std::optional<TimePoint> until);
  /// Off for 2 s, then the start-up time.
  void powerCycle(TimePoint now);
  /// Switches the mains on; the drive answers after its start-up time.
  void powerOn(TimePoint now);

  // Operating the drive by hand. A refusal says why and changes nothing.
  /// Trips the drive. \p code as its manual numbers it.
  virtual Refusal trip(int code, TimePoint now) = 0;
  /// What the drive's state word reads while this trip lasts, instead of what its manual says; until it is reset.
  virtual Refusal showTripAs(unsigned state);
  /// The drive is taken over at its panel, which runs the motor at \p hertz: sign = direction, 0 = stopped, at most the
  /// maximum frequency.
  virtual Refusal takeOverAtPanel(double hertz, TimePoint now) = 0;
  virtual Refusal releasePanel(TimePoint now) = 0;
  /// The STOP key: the motor ramps down and stays stopped until the run command of the bus has been off.
  virtual Refusal pressStopKey(TimePoint now) = 0;
  /// Safe torque off. \p active: the motor is cut off and the drive trips.
  virtual Refusal setSafeStop(bool active, TimePoint now) = 0;
  /// \p load 0 to 3; 1 = rated torque of the motor.
  Refusal setLoad(double load, TimePoint now);
  /// The drive is busy writing its EEPROM until then.
  void setBusy(TimePoint until, TimePoint now);
  /// Sets a parameter as at the panel, in RAM and EEPROM. \p value is in the unit that the panel shows.
  virtual Refusal setParameter(const std::string& code, double value, TimePoint now) = 0;
  /// Appends to \p values what RAM and EEPROM hold, in the unit that the panel shows.
  virtual Refusal parameter(const std::string& code, KeyValues& values) const = 0;
  /// What the motor really does, as of the last advance().
  virtual const Motor& motor() const = 0;
  /// RUN as the drive holds it from the bus, through a trip too.
  virtual bool runCommand() const = 0;

  /// What the drive and its motor really do; call advance() first.
  KeyValues describe() const;

protected:
  // What a protocol provides.
  /// A frame for this drive, whole unless answersDamaged(). \p good becomes false where the drive doesn't take it for a
  /// request (wrong length).
  virtual std::optional<Answer> answer(const Bytes& frame, TimePoint now, bool& good) = 0;
  /// The drive answers a damaged frame too.
  virtual bool answersDamaged() const;
  virtual bool isBroadcast(const Bytes& frame) const = 0;
  virtual std::optional<int> functionOf(const Bytes& frame) const = 0;
  virtual Access accessOf(const Bytes& frame) const = 0;
  virtual Answer exceptionAnswer(const Bytes& frame, int code) = 0;
  virtual Bytes foreignReply(const Bytes& reply, bool other_station) = 0;

  // What a brand provides.
  /// The next time at which something happens by itself, if before the given one; else the given one.
  virtual TimePoint nextChange(TimePoint limit) const = 0;
  /// Time advances by this much, during which only motion happens.
  virtual void move(double seconds) = 0;
  /// Does what is due at clock().
  virtual void change() = 0;
  virtual void losePower() = 0;
  virtual void gainPower() = 0;
  virtual double startUpTime() const = 0;
  /// The motor has another \p load: 0 to 3, 1 = rated torque.
  virtual void takeLoad(double load) = 0;
  virtual void takeBusy(TimePoint until) = 0;
  virtual void describeMotor(KeyValues& values) const = 0;

  TimePoint clock() const;
  /// The drive takes another station number (after a power cycle).
  void setStation(int station);
  /// The drive hears nothing until then (it goes on running).
  void goDeaf(TimePoint until);
  /// Takes other serial settings (after a power cycle); nothing: the drive understands no line at all.
  /// \p stop_bits_matter: the drive checks them.
  void setSerial(const std::optional<LineSettings>& serial, bool stop_bits_matter = false);
  Random& random();

private:
  bool listening() const;
  std::optional<Answer> serve(const Bytes& frame, const ExchangeFacts& exchange, std::vector<Fault> faults,
                              TimePoint now);
  void spoil(Answer& answer, const Fault& fault);
  void changeConnection();

  std::string name_;
  int station_;
  Random random_;
  TimePoint clock_;
  bool powered_ = true;
  bool online_ = true;
  std::optional<TimePoint> power_returns_;
  std::optional<TimePoint> online_returns_;
  TimePoint deaf_until_;
  std::optional<LineSettings> line_;
  std::optional<LineSettings> serial_;
  bool serial_told_ = false;
  bool stop_bits_matter_ = false;
  FaultQueue faults_;
  ExchangeCounters counters_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_SIMULATED_DRIVE_H
