// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_DRIVE_PROFILE_H
#define INVERTER_BUS_DRIVE_PROFILE_H

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/config/value.h"

namespace inverter_bus
{
namespace drive
{
/// A mistake in a profile or a scan list; what() is one line that names file, line, key, value and what is allowed.
class ConfigurationError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// \p text as one line of printable characters and of bearable length, whatever a YAML text contains; for messages.
std::string oneLine(const std::string& text);

/// What an address counts.
enum class Space
{
  Coil,
  Register,
  /// CompoWay/F: an element of 32 bits of a variable area (services 0101 and 0102).
  Variable,
  /// CompoWay/F: the word of service 0601, operating status in the high byte, related information in the low one.
  ControllerStatus,
  /// CompoWay/F: the code of service 3005, command code and related information. Written, never read.
  Operation
};

/// What 100 % of a quantity is, where the drive counts in percent.
enum class Base
{
  None,
  RatedCurrent,
  RatedVoltage
};

/// Ratings of one drive in A and V, as read from it or given by the user; empty: not known (yet).
struct Ratings
{
  std::optional<double> current;
  std::optional<double> voltage;
};

/// A number with a name: known, or known to be unknown until the user supplies it.
struct Constant
{
  std::optional<double> value;
  /// Empty, or the name under which it is unconfirmed.
  std::string unconfirmed;
  /// Which page of which manual holds it.
  std::string where;
  /// Where its value is ("file:line" or the scan list entry) and the key, for messages.
  std::string place;
  std::string key;
};

/// One value inside a drive: where it lies, how many words it has, what one count means.
struct Item
{
  Space space = Space::Register;
  /// Variable type of a CompoWay/F variable (C0, C1, C3).
  std::uint8_t area = 0;
  /// The number printed in the drive's manual.
  std::uint16_t number = 0;
  /// The number on the wire (number + the profile's offset).
  std::uint16_t address = 0;
  /// Registers: 1 or 2 (high word first). Coils: 1, or up to 32 packed with the first coil in bit 0.
  unsigned size = 1;
  bool is_signed = false;
  /// Value of one count in \ref unit.
  double resolution = 1.0;
  std::string unit;
  /// What 100 % is, where the unit is "%" of a rating and the value is wanted in A or V.
  Base base = Base::None;
  /// A bit of the register (0-15) where the item is a flag in a word.
  std::optional<unsigned> bit;
  /// Bits of the register that count (others are undefined on this drive).
  std::uint32_t mask = 0xFFFFFFFF;
  /// A flag that is true for every masked value but 0 (an error word).
  bool nonzero = false;
  /// Raw value to meaning, where the drive counts differently from the driver (direction: 2 means reverse = -1).
  std::map<std::uint32_t, int> values;
  /// Empty, or the name under which this item is unconfirmed.
  std::string unconfirmed;
  /// The item's own mark where a constant's mark is in \ref unconfirmed.
  std::string own_mark;
  /// Its place is unknown: only an override makes it usable (\ref unconfirmed is then never empty).
  bool missing = false;
};

/// A place that a command writes (frequency, direction, run, trip_reset, enter, ...).
struct Point
{
  std::string name;
  Item item;
  /// Every write reaches the EEPROM unless the sequence `connect` could be carried out.
  bool wears = false;
};

/// One step of a command sequence: write a value to a point.
struct Step
{
  std::string point;
  /// Empty: the frequency set-point of the command.
  std::optional<std::uint32_t> value;
  /// Pause after the step [s].
  double pause = 0.0;
  /// False: the drive executes it without a reply.
  bool expects_reply = true;
  /// Empty, or the name under which its value is unconfirmed.
  std::string unconfirmed;
};

/// A command: its steps in the order of sending.
struct Sequence
{
  std::vector<Step> steps;
  /// Empty, or the name under which this sequence is unconfirmed.
  std::string unconfirmed;
};

/// One entry of the parameter table.
struct Parameter
{
  std::string name;
  std::string title;
  Item item;
  /// In \ref Item::unit; empty: not known, the register's size limits.
  std::optional<std::pair<double, double>> range;
  /// The range is from memory or from a sister drive: the drive's own exception decides.
  bool range_unconfirmed = false;
  /// May be written while the motor runs. Empty: not known, the drive decides.
  std::optional<bool> while_running;
  bool read_only = false;
  /// Station number or serial settings: refused unless `persist`, since they would cut the line.
  bool communication = false;
  /// Written only between the sequences open_setup and close_setup, at standstill.
  bool setup = false;
};

/// Reasons of a trip, by code.
using FaultTable = std::map<std::uint16_t, std::string>;

/// Where the trip memory lies: fields by name (code, output_frequency, output_current, dc_voltage, run_hours,
/// power_on_hours), newest trip first.
struct FaultHistory
{
  std::vector<std::map<std::string, Item>> entries;
};

/// A setting of the drive that is read at connect, and what it should be.
struct Expectation
{
  /// Empty: the model text is compared instead.
  std::string parameter;
  /// CompoWay/F attributes (service 0503): the model text must begin with this.
  std::string model;
  /// Values that are fine.
  std::set<std::uint32_t> accept;
  /// What to do when it has another value.
  std::string advice;
  /// Judged only while a command of this node is in force.
  bool when_commanded = false;
};

/// What a drive's own communication time-out is fed by.
enum class Feeds
{
  /// Every request that it hears.
  Everything,
  /// Writes only.
  Writes,
  /// Writes of its command word only.
  CommandWord
};

/// Where a parameter write ends up.
enum class Writes
{
  /// Lost at power-off unless `store` follows.
  Ram,
  /// Every write reaches the EEPROM.
  Eeprom,
  /// The manual doesn't say.
  Unknown
};

/// One selection code of a block read.
struct BlockCode
{
  std::string title;
  /// What the code selects; empty: nothing.
  std::optional<Item> item;
};

/// Several registers of the user's choice in one exchange, and command words beside them (VF-S15: 1875H and 1870H).
struct Block
{
  Item read;
  /// Parameters that select the words of the read, in their order.
  std::vector<std::string> read_slots;
  Item write;
  /// Parameters that select the words of the write, in their order.
  std::vector<std::string> write_slots;
  /// Points in the order of the words, with the code that selects each.
  std::vector<std::pair<std::string, std::uint32_t>> select;
  std::map<unsigned, BlockCode> codes;
  /// Writing this value to this parameter makes changed slots count without a power cycle; empty: none.
  std::string apply_parameter;
  std::uint32_t apply_value = 0;
};

/// A register of the drive's map that holds sixteen coils: bit n is coil \ref first_coil + n.
struct MirroredCoils
{
  std::uint16_t number = 0;      ///< of the register, as printed
  std::uint16_t first_coil = 0;  ///< as printed
};

/// The drive lets its owner lay registers over others (MX2: P200), so that one read brings what lies apart (section `map`).
struct RegisterMap
{
  Item read;
  std::vector<MirroredCoils> words;
  /// What each parameter of the map must be, in the order of the profile. The last one switches the map on.
  std::vector<std::pair<std::string, std::uint32_t>> table;
  /// Empty, or the name under which it is unconfirmed that the drive answers such a read. It shows only where the map
  /// is asked for.
  std::string unconfirmed;
};

/// What the drive does when the bus falls silent.
struct CommunicationLoss
{
  /// Parameter with the drive's own time-out (0 = off); empty: none to read, or not confirmed.
  std::string timeout_parameter;
  /// Parameter with the reaction; empty: none to read, or not confirmed.
  std::string action_parameter;
  /// Reactions after which the motor runs on.
  std::set<std::uint32_t> runs_on;
  /// Assumed time-out where none can be read [s] (key drive_timeout); 0: none.
  double assumed_timeout = 0.0;
  /// Assumed reaction (key drive_loss_action): "runs_on", "decelerate", "coast", "trip".
  std::string assumed_action;
  /// Also supervised at rest.
  bool also_idle = false;
  std::string advice;
};

/// Everything that the driver knows about one kind of drive. Read from YAML, never changed afterwards.
struct Profile
{
  std::string name;   ///< omron_mx2
  std::string title;  ///< OMRON 3G3MX2-V1 ...
  std::string file;
  std::string protocol;  ///< modbus_rtu, compoway_f

  unsigned first_station = 1;
  unsigned last_station = 247;
  std::set<unsigned> baud_rates;
  std::set<unsigned> data_bits;
  std::set<std::string> parities;
  std::set<unsigned> stop_bits;
  /// Combinations like "8N2" where not every one of the sets above goes with every other; empty: all.
  std::set<std::string> characters;

  /// Printed number of the register with wire address 0: 1 where the manual counts from 1, 0 where it prints addresses.
  unsigned first_register = 0;
  /// The last two digits of a number count decimally: a read of several registers steps over A to F.
  bool decimal_numbers = false;
  /// Word that a read of several registers brings where no register is.
  std::optional<std::uint16_t> hole;

  /// Modbus function codes, or CompoWay/F services (MRC and SRC).
  std::set<unsigned> functions;
  unsigned read_registers = 1;
  unsigned write_registers = 1;
  unsigned read_coils = 1;
  /// CompoWay/F: most characters of a frame.
  unsigned frame = 40;
  /// Numbers (as printed) from..to that the drive answers without a hole, so that reads may span them.
  std::vector<std::pair<unsigned, unsigned>> register_spans;
  std::vector<std::pair<unsigned, unsigned>> coil_spans;

  double maximum_frequency = 0.0;  ///< [Hz]
  double reply_delay = 0.0;        ///< [s] besides the gap
  std::optional<double> response_timeout;
  /// The drive may be deaf that long after a trip reset or power-up [s].
  double deaf_after_reset = 0.0;
  /// Silence that the drive needs before a request besides the protocol's own [s].
  double quiet_before = 0.0;

  std::map<std::string, Point> points;
  /// Numbers with names, operation codes of CompoWay/F among them.
  std::map<std::string, Constant> constants;
  /// forward, reverse, stop, coast, quick, reset, release, store, connect, open_setup, close_setup.
  std::map<std::string, Sequence> sequences;
  /// Item that reads 1 while the drive stores to EEPROM.
  std::optional<Item> store_busy;
  Writes writes = Writes::Ram;
  Feeds feeds = Feeds::Everything;

  /// Monitor items by field name of the status message: run_seen, raw_status, operation, running, direction, ready, at_speed,
  /// at_set_frequency, overload_warning, pid_deviation, faulted, restarted, fault_code, warning_code, output_frequency,
  /// output_current, output_voltage, dc_voltage, torque, temperature.
  std::map<std::string, Item> status;
  /// What is read in a refresh when no field of \ref status can be.
  std::optional<Item> keep_alive;
  std::optional<Block> block;
  std::optional<RegisterMap> map;
  /// Parameters that hold the ratings [A, V]; empty: none, or not confirmed.
  std::string rated_current_parameter;
  std::string rated_voltage_parameter;
  /// Fields of \ref status that are read at 1 Hz instead of in every refresh.
  std::set<std::string> slow;
  /// Fields of \ref status that are read only while the drive is tripped.
  std::set<std::string> when_faulted;

  FaultTable faults;
  FaultTable warnings;
  /// The warning code is a set of bits: each entry of the table with all of its bits in it applies.
  bool warning_bits = false;
  FaultHistory history;
  std::map<std::string, Parameter> parameters;
  /// Registers (as printed, from..to) that command the drive: no parameter there can be written.
  std::vector<std::pair<unsigned, unsigned>> command_registers;

  /// What distinguishes this kind of drive from others.
  std::vector<Expectation> identity;
  /// What may command the drive.
  std::vector<Expectation> command_source;
  /// Settings by which a drive restarts by itself.
  std::vector<Expectation> self_restart;
  CommunicationLoss communication_loss;
  /// Parameter whose value (unit s or ms) is the drive's own reply delay (C078); empty: none, or not confirmed.
  std::string reply_delay_parameter;

  /// A write to station 0 that stops every drive of this profile is confirmed safe by the manual.
  bool broadcast_stop = false;
  double broadcast_turnaround = 0.02;  ///< [s]

  /// Meanings of exception codes in the drive's own words.
  std::map<unsigned, std::string> exceptions;

  /// Names that still need `confirm` or `overrides` and lock a command or a monitor.
  std::set<std::string> unconfirmed;
  /// Names that only concern entries of the tables: parameters, their ranges, trip texts.
  std::set<std::string> unconfirmed_tables;
  /// Monitors that are left out because of a mistake that harms nothing else (a wrong unit), one line each ("file:line: ...").
  std::vector<std::string> mistakes;

  /// The register or variable after \p number, counted as the drive counts: distances are differences of these.
  unsigned position(std::uint16_t number) const;
};

/// What a scan list entry changes in its profile.
struct ProfileChanges
{
  /// The entry's `overrides`, a map of profile keys with its place; None: there are none.
  config::Value overrides;
  /// Where the entry names its drive, for messages.
  std::string place;
  /// Names of unconfirmed items that the user has checked, or `all`.
  std::vector<std::string> confirm;
  /// Names of skippableFields() that are left out: not read, not reported, nor what is unconfirmed in them.
  std::vector<std::string> skip;
  /// Where \ref confirm is, for messages; empty: \ref place.
  std::string confirm_place;
};

/// What `skip` may leave out: fields of the status, `store_busy`, and `trip_memory` (the quantities beside the trip codes).
const std::set<std::string>& skippableFields();
/// Fields of the status that can't be left out: what decides safety (contract, 8.3), and the drive's own word.
const std::set<std::string>& protectedFields();

/// Reads the profile \p name_or_path: an absolute path, or a name that means `<directory>/<name>.yaml`.
/// \throws ConfigurationError "file:line: key ...: what is wrong, what is allowed"
Profile loadProfile(const std::string& name_or_path, const std::string& directory,
                    const ProfileChanges& changes = ProfileChanges());

/// The folder with the profiles as shipped: environment variable INVERTER_BUS_DRIVES, or where the package is installed, or its
/// source.
std::string shippedProfileDirectory();

/// Names of the profiles in \p directory, sorted; empty also if it can't be read.
std::vector<std::string> knownProfiles(const std::string& directory);

/// All mistakes of one profile file, one line each ("file:line: ..."); empty: it is fine. For `check_profile`.
std::vector<std::string> checkProfile(const std::string& path);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_DRIVE_PROFILE_H
