// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/scene.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "fuzz/bus/dice.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr std::size_t MOST_INVERTERS = 8;
constexpr double LOWEST_HZ = 4.0;
constexpr double HZ_APART = 5.5;
constexpr double RANGE_HZ = 3.5;
// More than any request and its reply have together in bytes, a read of a trip memory included.
constexpr double LONGEST_FRAMES = 90.0;
constexpr double PROBE_FRAME = 24.0;          // characters
constexpr double REPLY_SLACK_S = 0.03;        // wire::Line waits so much longer for the rest of a reply that has begun
constexpr double SHORTEST_BLINDNESS_S = 2.0;  // contract, 8.15
constexpr double TURNAROUND_S = 0.012;        // of a simulated drive at most
constexpr double USUAL_FRAMES = 24.0;         // characters of a read and its reply
constexpr double READS_PER_REFRESH = 4.0;
constexpr double SLOW_FRAMES = 34.0;  // characters of the longest read of slow values and its reply
constexpr double SLOW_READS = 6.0;    // of one inverter, settings that are repeated among them
constexpr double SLOW_RATE = 0.045;   // what is left of 7.5 % of the wire where little may be saved up

const char* const TECO_ENTRY =
    ", drive: teco_7200ma, confirm: [run_forward, fault_reset, frequency_scale, monitor_layout, fault_coding], "
    "overrides: {reverse_word: 2, monitor_base: 0x0020}";
/// The codes are those that the simulated drive was given; the manual's own are not public.
const char* const JE_ENTRY =
    ", drive: omron_3g3je, confirm: [current_scale, controller_status_meaning], overrides: {operation_codes: "
    "{run_forward: \"1101\", run_reverse: \"1102\", stop: \"1100\", fault_reset: \"1201\", ram_write_mode: \"1401\", "
    "setup_area_0: \"1700\", setup_area_1: \"1701\"}}";

std::string number(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Writes one bus. The checker works with what is noted in the facts; the driver reads the text.
class SceneWriter
{
public:
  SceneWriter(std::uint64_t number, const std::string& name)
    : dice_(number * 7919U + 17U)
    , limits_dice_(number * 104729U + 29U)
    , slow_dice_(number * 15485863U + 43U)
    , later_dice_(number * 32452843U + 41U)
  {
    scene_.name = name;
  }

  Scene write()
  {
    chooseLine();
    chooseLimits();
    const std::size_t count = chooseCount();
    // What the bus can meet: about ten exchanges for each inverter.
    shortest_timeout_ = std::ceil(static_cast<double>(count) * 800.0 * scene_.character * 5.0) / 5.0;
    for (std::size_t index = 0; index < count; ++index)
    {
      addInverter(index);
    }
    scene_.one_brand =
        std::all_of(scene_.inverters.begin(), scene_.inverters.end(),
                    [this](const InverterFacts& facts) { return facts.drive == scene_.inverters.front().drive; });
    head_ << "scan_list:\n" << list_.str() << "simulation:\n" << simulation_.str();
    scene_.yaml = head_.str();
    return scene_;
  }

private:
  void chooseLine()
  {
    head_ << "port: /dev/virtual\n";
    unsigned bits = 10;
    if (scene_.name == "compoway")
    {
      scene_.compoway = true;
      scene_.baud_rate = dice_.hits(0.5) ? 19200 : 9600;
      head_ << "protocol: compoway_f\nparity: even\ndata_bits: 7\nstop_bits: 2\n";
      bits = 11;
    }
    else if (scene_.name == "mixed" || scene_.name == "teco")
    {
      scene_.baud_rate = 9600;
      head_ << "parity: even\n";
      bits = 11;
    }
    else if (scene_.name == "toshiba" || scene_.name == "toshiba_block")
    {
      scene_.baud_rate = dice_.any<int>({ 9600, 19200, 38400 });
      head_ << "parity: even\n";
      bits = 11;
    }
    else
    {
      scene_.baud_rate = dice_.any<int>({ 9600, 19200, 19200 });
    }
    scene_.character = static_cast<double>(bits) / scene_.baud_rate;
    scene_.retries = static_cast<int>(dice_.below(4));
    head_ << "baud_rate: " << scene_.baud_rate << "\nretries: " << scene_.retries << "\n";
    scene_.interval = dice_.hits(0.25) ? dice_.any<double>({ 0.05, 0.3, 1.4 }) : 0.0;
    head_ << "interval: " << scene_.interval << "\n";
    scene_.idle_divisor = static_cast<unsigned>(dice_.hits(0.25) ? 2 + dice_.below(4) : 1);
    head_ << "idle_divisor: " << scene_.idle_divisor << "\n";
    scene_.offline_after = static_cast<unsigned>(dice_.hits(0.7) ? 3 : 1 + dice_.below(8));
    head_ << "offline_after: " << scene_.offline_after << "\n";
    response_timeout_ = scene_.compoway ? 0.25 : dice_.any<double>({ 0.05, 0.1, 0.1, 0.2 });
    head_ << "response_timeout: " << response_timeout_ << "\n";
  }

  /// Dice of their own: what else happens on a bus does not depend on them.
  void chooseLimits()
  {
    limits_ = limits_dice_.hits(0.5);
    all_saturate_ = limits_ && limits_dice_.hits(0.3);
    head_ << (all_saturate_ ? "limit: saturate\n" : "");
    scene_.slow_interval = slow_dice_.any<double>({ 1.0, 1.0, 0.1, 2.5, 0.0 });
    head_ << "slow_interval: " << scene_.slow_interval << "\n";
  }

  std::string limitsOf(InverterFacts& facts)
  {
    std::ostringstream text;
    text.precision(12);
    if (!limits_)
    {
      return "";
    }
    const double unit = std::fabs(facts.hz_per_unit);
    facts.saturates = all_saturate_ || limits_dice_.hits(0.6);
    if (facts.saturates || limits_dice_.hits(0.5))
    {
      facts.max_velocity = std::round((facts.highest_hz + limits_dice_.between(0.0, 1.5)) / unit * 1e4) / 1e4;
      text << ", max_velocity: " << facts.max_velocity;
    }
    if (limits_dice_.hits(0.4))
    {
      facts.min_velocity = std::round(0.6 * facts.lowest_hz / unit * 1e4) / 1e4;
      text << ", min_velocity: " << facts.min_velocity;
    }
    text << (facts.saturates && !all_saturate_ ? ", limit: saturate" : "");
    return text.str();
  }

  std::size_t chooseCount()
  {
    const std::size_t few = 1 + dice_.below(3);
    return dice_.hits(0.6) ? few : 1 + dice_.below(MOST_INVERTERS);
  }

  std::string chooseDrive(std::size_t index)
  {
    if (scene_.name == "mx2")
    {
      return "omron_mx2";
    }
    if (scene_.name == "mx2_rx")
    {
      return index % 2 == 0 ? "omron_mx2" : "omron_rx";
    }
    if (scene_.name == "teco")
    {
      return "teco_7200ma";
    }
    if (scene_.name == "compoway")
    {
      return "omron_3g3je";
    }
    if (scene_.name == "mixed")
    {
      return dice_.any<std::string>({ "omron_mx2", "omron_rx", "toshiba_vfs15", "teco_7200ma" });
    }
    return "toshiba_vfs15";
  }

  void addInverter(std::size_t index)
  {
    InverterFacts facts;
    facts.name = std::string(1, static_cast<char>('a' + index));
    facts.drive = chooseDrive(index);
    facts.node = static_cast<unsigned>(index + 1);
    const std::vector<double> units{ 1.0, 1.0, 2.5, -1.0, 10.0 };
    facts.hz_per_unit = dice_.any(units);
    facts.lowest_hz = LOWEST_HZ + HZ_APART * static_cast<double>(index);
    facts.highest_hz = facts.lowest_hz + RANGE_HZ;
    facts.command_timeout = dice_.any<double>({ 0.5, 0.5, 0.3, 1.0, 0.0 });
    facts.response_timeout = dice_.hits(0.1) ? 0.15 : response_timeout_;
    facts.fixed_value = 1.0 + 0.1 * static_cast<double>(index);
    std::ostringstream parameters;
    std::string more;
    setUp(facts, parameters, more);
    more += limitsOf(facts);
    list_ << "  - {name: " << facts.name << ", node: " << facts.node << ", hz_per_unit: " << facts.hz_per_unit
          << ", command_timeout: " << facts.command_timeout << ", response_timeout: " << facts.response_timeout
          << (dice_.hits(0.2) ? ", stop_unexpected_motion: true" : "") << more << "}\n";
    simulation_ << "  " << facts.name << ": {turnaround: " << number(dice_.between(0.002, 0.012)) << ", parameters: {"
                << parameters.str() << "}}\n";
    scene_.inverters.push_back(facts);
  }

  void setUp(InverterFacts& facts, std::ostringstream& parameters, std::string& more)
  {
    if (facts.drive == "toshiba_vfs15")
    {
      setUpToshiba(facts, parameters, more);
    }
    else if (facts.drive == "teco_7200ma")
    {
      facts.brand = Brand::TECO;
      // 1.0 s as shipped is what the driver assumes; more of them on one line need more.
      facts.drive_timeout = std::max(1.0, shortest_timeout_);
      parameters << "Bn-01: 1.0, Bn-02: 1.0, Cn-27: " << facts.drive_timeout;
      more = TECO_ENTRY;
    }
    else if (facts.drive == "omron_3g3je")
    {
      facts.brand = Brand::JE;
      facts.fixed_parameter = "P02";
      facts.fixed_value += 20.0;
      facts.free_parameter = dice_.hits(0.3) ? "P05" : "";
      parameters << "acceleration: 1.0, deceleration: 1.0, P02: " << facts.fixed_value;
      more = JE_ENTRY;
    }
    else
    {
      setUpHitachi(facts, parameters, more);
    }
  }

  void setUpHitachi(InverterFacts& facts, std::ostringstream& parameters, std::string& more)
  {
    facts.fixed_parameter = "F003";
    facts.free_parameter = "A020";
    parameters << "F002: 1.0, F003: " << facts.fixed_value;
    more = ", drive: " + facts.drive;
    if (dice_.hits(0.5))
    {
      facts.drive_timeout = std::max(shortest_timeout_, dice_.any<double>({ 0.6, 1.0, 2.0 }));
      parameters << ", C077: " << facts.drive_timeout << ", C076: " << (dice_.hits(0.7) ? 4 : 1);
      more += facts.drive == "omron_rx" ? ", confirm: [parameter_C076, parameter_C077]" : "";
    }
    if (dice_.hits(0.2))
    {
      facts.own_delay = 0.02;
      parameters << ", C078: 20";
      // The RX's register of C078 is printed for the MX2 only: without confirmation it can't be read.
      facts.own_delay = facts.drive == "omron_mx2" ? facts.own_delay : 0.0;
    }
    if (scene_.name == "mx2" && later_dice_.hits(0.6))
    {
      addMap(facts, parameters, more);
    }
  }

  /// A register map that is in effect, one that the driver sets up and that counts from the drive's next power-on, or one that is
  /// in other use. Dice of its own: what else happens on a bus does not depend on it.
  void addMap(InverterFacts& facts, std::ostringstream& parameters, std::string& more)
  {
    facts.map = true;
    more += ", confirm: [register_map]";
    const double kind = later_dice_.between(0.0, 1.0);
    const char* const fits = ", P200: 1, P201: 0x1005, P301: 0x1E01, P202: 0x1006, P302: 0x1F01";
    more += kind < 0.4 ? "" : ", configure_map: true";
    parameters << (kind < 0.4 ? fits : (kind > 0.9 ? ", P200: 1, P201: 0x4001, P301: 0x1212" : ""));
  }

  void setUpToshiba(InverterFacts& facts, std::ostringstream& parameters, std::string& more)
  {
    facts.brand = Brand::TOSHIBA;
    // E6581913 p73: its reply takes 50 ms when the EEPROM is written.
    facts.response_timeout = std::max(facts.response_timeout, 0.1);
    facts.fixed_parameter = "dEC";
    facts.free_parameter = "ACC";
    parameters << "ACC: 1.0, dEC: " << facts.fixed_value;
    more = ", drive: toshiba_vfs15";
    facts.fed_by_word = later_dice_.hits(0.4);
    facts.block = scene_.name == "toshiba_block" || (scene_.name == "mixed" && dice_.hits(0.5));
    if (facts.block)
    {
      parameters << ", F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 14";
    }
    else if (dice_.hits(0.2))
    {
      more += ", configure_block: true";
    }
    if (dice_.hits(0.4))
    {
      facts.drive_timeout = std::max(shortest_timeout_, dice_.any<double>({ 1.0, 2.0 }));
      parameters << ", F803: " << facts.drive_timeout << ", F804: " << (dice_.hits(0.5) ? 2 : 1);
    }
    if (dice_.hits(0.2))
    {
      facts.own_delay = 0.02;
      parameters << ", F805: 0.02";
    }
    if (limits_dice_.hits(0.3))
    {
      // FC90 is 0 while it is healthy.
      facts.listed_trips = { 0, 1, 2 };
      more += std::string(", overrides: {") + (facts.fed_by_word ? "feeds: command_word, " : "") +
              "status: {faulted: {register: 0xFC90, values: {\"0\": 0, \"1\": 1, \"2\": 1}}}}";
    }
    more += facts.fed_by_word && facts.listed_trips.empty() ? ", overrides: {feeds: command_word}" : "";
  }

  Dice dice_;
  Dice limits_dice_;
  Dice slow_dice_;
  Dice later_dice_;
  bool limits_ = false;
  bool all_saturate_ = false;
  Scene scene_;
  double response_timeout_ = 0.1;
  double shortest_timeout_ = 0.6;
  std::ostringstream head_;
  std::ostringstream list_;
  std::ostringstream simulation_;
};
}  // namespace

std::string Scene::title(std::size_t index) const
{
  return inverters[index].name + " (" + inverters[index].drive + ")";
}

Duration Scene::longestSlowPeriod() const
{
  const double exchange = 3.0 * toSeconds(gap()) + TURNAROUND_S + PROFILE_DELAY_S + SLOW_FRAMES * character;
  const double needs = SLOW_READS * static_cast<double>(inverters.size()) * exchange;
  // One goes with each refresh, and those at rest are refreshed seldom.
  const double turns = SLOW_READS * (interval + toSeconds(longestExchange())) * idle_divisor;
  return seconds(std::max({ slow_interval, needs / SLOW_RATE, turns }));
}

Duration Scene::gap() const
{
  return compoway ? seconds(0.002) : (baud_rate > 19200 ? seconds(0.00175) : seconds(3.5 * character));
}

double Scene::longestSilence() const
{
  double longest = 0.0;
  for (const InverterFacts& facts : inverters)
  {
    longest = std::max(longest, facts.response_timeout + facts.own_delay);
  }
  return longest;
}

Duration Scene::longestExchange() const
{
  return 3 * gap() + seconds(longestSilence() + PROFILE_DELAY_S + REPLY_SLACK_S + LONGEST_FRAMES * character);
}

double Scene::longestBlindness() const
{
  const double exchange = 3.0 * toSeconds(gap()) + TURNAROUND_S + USUAL_FRAMES * character;
  const double refreshes = READS_PER_REFRESH * exchange * static_cast<double>(inverters.size());
  // Commands and services alternate with refreshes.
  return std::max(SHORTEST_BLINDNESS_S, 3.0 * idle_divisor * (interval + 2.0 * refreshes)) +
         4.0 * toSeconds(longestExchange());
}

Duration Scene::longestProbe() const
{
  return 2 * gap() + seconds(longestSilence() + PROBE_FRAME * character);
}

const std::vector<std::string>& sceneNames()
{
  static const std::vector<std::string> NAMES{ "mx2",  "mx2_rx", "toshiba",  "toshiba_block",
                                               "teco", "mixed",  "compoway", "mixed" };
  return NAMES;
}

Scene makeScene(std::uint64_t number, const std::string& name)
{
  const std::vector<std::string>& names = sceneNames();
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
  {
    throw std::invalid_argument("--scan-list " + name + ": there is no such kind of bus");
  }
  return SceneWriter(number, name.empty() ? names[number % names.size()] : name).write();
}
}  // namespace fuzz
}  // namespace inverter_bus
