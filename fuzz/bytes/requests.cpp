// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What messages and service requests bring, of any content and at any moment, on a whole bus in virtual time. The input:
//
//   one byte        the bus (low half), what has happened before the first request (high half)
//   each request    its kind (bit 7: the state is not compared), then what it needs: an inverter, a velocity, names, a mode, a publisher
//
// Time passes, drives fall silent and trip, the port is unplugged and the node shuts down by requests of their own.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bus/bus_loop.h"
#include "bus/coordinator.h"
#include "bus/rules/velocity_group.h"
#include "checks.h"
#include "memory_drives.h"
#include "text_file.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using bus::Answer;

constexpr int MOST_REQUESTS = 12;
constexpr std::size_t LONGEST_ANSWER = 4000;
/// Long enough to see a copy of it, short enough to try many.
constexpr std::size_t LONG_NAME = 20000;

const std::array<std::string, 5> BUSES{
  "scan_list:\n  - {name: a, node: 1, drive: omron_mx2}\n  - {name: b, node: 2, drive: omron_mx2, hz_per_unit: -0.1, "
  "command_timeout: 0}\n",
  "scan_list:\n  - {name: a, node: 1, drive: toshiba_vfs15}\n  - {name: b, node: 2, drive: omron_rx, min_velocity: "
  "5}\n",
  "parameter_access: read_only\nscan_list:\n  - {name: a, node: 1, drive: omron_mx2}\n",
  "parity: even\nscan_list:\n  - {name: a, node: 1, drive: teco_7200ma}\n  - {name: b, node: 2, drive: "
  "toshiba_vfs15}\n",
  "scan_list:\n  - {name: a, node: 1, drive: toshiba_vfs11, confirm: all}\n  - {name: b, node: 2, drive: omron_mx2}\n",
};

bus::Configuration read(const std::string& scan_list)
{
  // A pause between cycles: what matters here are requests, not refreshes.
  const std::string text = "interval: 1.0\nresponse_timeout: 0.02\nbaud_rate: 9600\n" + scan_list;
  TextFile file;
  file.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return bus::readConfiguration(bus::readYamlFile(file.path()), "fuzz", INVERTER_BUS_ROOT "/config/drives");
}

/// True if \p text is UTF-8 (RFC 3629, its table of well-formed sequences) without control characters.
bool isPlainUtf8(const std::string& text)
{
  std::size_t place = 0;
  while (place < text.size())
  {
    const auto byte = [&](std::size_t offset) {
      return place + offset < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[place + offset]))
                                          : 0U;
    };
    const unsigned first = byte(0);
    const std::size_t more = first < 0x80 ? 0 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
    const unsigned low = first == 0xE0 ? 0xA0U : first == 0xF0 ? 0x90U : first == 0xC2 ? 0xA0U : 0x80U;
    const unsigned high = first == 0xED ? 0x9FU : first == 0xF4 ? 0x8FU : 0xBFU;
    bool good = first >= 0x20 && first != 0x7F && (first < 0x80 || (first >= 0xC2 && first <= 0xF4));
    good = good && (more == 0 || (byte(1) >= low && byte(1) <= high));
    for (std::size_t i = 2; i <= more; ++i)
    {
      good = good && byte(i) >= 0x80 && byte(i) <= 0xBF;
    }
    if (!good)
    {
      return false;
    }
    place += more + 1;
  }
  return true;
}

void requireWords(const std::string& text)
{
  requireOneLine(text);
  require(text.size() <= LONGEST_ANSWER, "an answer, a status or a line of the log is too long");
  require(isPlainUtf8(text), "an answer, a status or a line of the log is no printable text");
}

/// What the node itself refuses with; nothing was sent then.
bool isRefusal(std::uint16_t error_id)
{
  return error_id == bus::ERROR_OUT_OF_RANGE || (error_id >= bus::ERROR_OFFLINE && error_id <= bus::ERROR_NOT_ARMED);
}

/// An answer of a service that is awaited.
struct Call
{
  int answers = 0;
  bool refused = false;
  TimePoint expires;
};

/// What a refused request must leave alone.
bool sameState(const bus::InverterStatus& left, const bus::InverterStatus& right)
{
  return left.run_command == right.run_command && left.move_velocity_active == right.move_velocity_active &&
         left.reset_active == right.reset_active && left.stop_active == right.stop_active &&
         left.communication_error == right.communication_error && left.commanded_velocity == right.commanded_velocity &&
         left.has_stamp == right.has_stamp;
}

class World
{
public:
  explicit World(const bus::Configuration& configuration)
    : configuration_(configuration)
    , port_(clock_)
    , protocol_(bus::makeProtocol(configuration.bus))
    , line_(port_, *protocol_, clock_, bus::makeTiming(configuration.bus))
    , coordinator_(configuration, line_)
    , loop_(coordinator_, line_, clock_, mutex_)
    , bounds_(coordinator_.bounds())
  {
    for (std::size_t i = 0; i < configuration.bus.inverters.size(); ++i)
    {
      index_by_name_[configuration.bus.inverters[i].name] = i;
    }
  }

  void run(double duration)
  {
    const TimePoint end = clock_.now() + seconds(duration);
    // After a shutdown the node's thread ends as soon as all is done.
    while (clock_.now() < end && !(shutting_down_ && coordinator_.shutdownDone(clock_.now())))
    {
      const TimePoint wake = loop_.step();
      deliver();
      if (wake > clock_.now())
      {
        clock_.sleepUntil(std::min(wake, end));
      }
    }
  }

  /// What the node sends of itself, whoever asks for nothing.
  const std::set<wire::Bytes>& writes() const
  {
    return port_.writes();
  }

  void play(ByteSource& source, const std::set<wire::Bytes>& own_writes)
  {
    for (int i = 0; i < MOST_REQUESTS && !source.empty(); ++i)
    {
      request(source);
      deliver();
    }
    run(0.2);
    if (!anything_accepted_)
    {
      require(std::includes(own_writes.begin(), own_writes.end(), port_.writes().begin(), port_.writes().end()),
              "something was written although every request was refused");
    }
    end();
  }

private:
  // --- pieces of the input ------------------------------------------------------------------------------------------
  std::size_t inverter(ByteSource& source) const
  {
    return source.byte() % configuration_.bus.inverters.size();
  }

  static double number(ByteSource& source)
  {
    static const std::array<double, 20> NUMBERS{ 0.0,
                                                 -0.0,
                                                 1.0,
                                                 -1.0,
                                                 10.0,
                                                 50.0,
                                                 -50.0,
                                                 50.000001,
                                                 0.004,
                                                 1e-9,
                                                 1e9,
                                                 65535.0,
                                                 65536.0,
                                                 1e300,
                                                 -1e300,
                                                 std::numeric_limits<double>::denorm_min(),
                                                 -std::numeric_limits<double>::min(),
                                                 std::numeric_limits<double>::infinity(),
                                                 -std::numeric_limits<double>::infinity(),
                                                 std::numeric_limits<double>::quiet_NaN() };
    const std::uint8_t kind = source.byte();
    if (kind < NUMBERS.size())
    {
      return NUMBERS[kind];
    }
    if (kind < 0x80)
    {
      return kind - 0x40;
    }
    std::array<std::uint8_t, sizeof(double)> bytes;
    std::generate(bytes.begin(), bytes.end(), [&source] { return source.byte(); });
    double value = 0.0;
    std::memcpy(&value, bytes.data(), bytes.size());
    return value;
  }

  static std::string text(ByteSource& source)
  {
    static const std::array<std::string, 16> WORDS{ "a",      "b",     "F002",  "F870",   "ACC",    "A001",
                                                    "C072",   "F802",  "Sn-02", "0x1103", "0xFFFF", "0x",
                                                    "status", "/../a", "",      "cc" };
    const std::uint8_t kind = source.byte();
    if (kind < WORDS.size())
    {
      return WORDS[kind];
    }
    if (kind == 0xFF)
    {
      return std::string(LONG_NAME, static_cast<char>(source.byte()));
    }
    const wire::Bytes bytes = source.bytes(kind % 32);
    return std::string(bytes.begin(), bytes.end());
  }

  static bus::Publisher publisher(ByteSource& source)
  {
    const std::uint8_t options = source.byte();
    bus::Publisher publisher;
    publisher.name = options == 0xFF ? text(source) : "/user" + std::to_string(options & 3);
    publisher.latched = (options & 4) != 0;
    publisher.first_on_connection = (options & 8) != 0;
    publisher.before_start = (options & 16) != 0;
    return publisher;
  }

  // --- requests -----------------------------------------------------------------------------------------------------
  void request(ByteSource& source)
  {
    const std::uint8_t kind = source.byte();
    watched_ = kind < 0x80;
    switch (kind % 16)
    {
      case 0:
      case 1:
        velocity(source);
        break;
      case 2:
      case 3:
        group(source);
        break;
      case 4:
        stop(source);
        break;
      case 5:
        service("reset", bounds_.reset, [&](bus::AnswerCallback callback) {
          coordinator_.reset(clock_.now(), inverter(source), std::move(callback));
        });
        break;
      case 6:
        service("read_faults", bounds_.read_faults, [&](bus::AnswerCallback callback) {
          coordinator_.readFaults(clock_.now(), inverter(source), std::move(callback));
        });
        break;
      case 7:
        service("read_parameter", bounds_.read_parameter, [&](bus::AnswerCallback callback) {
          const std::size_t index = inverter(source);
          coordinator_.readParameter(clock_.now(), index, text(source), std::move(callback));
        });
        break;
      case 8:
      case 9:
        writeParameter(source);
        break;
      default:
        happen(source);
    }
  }

  /// What is no request: time and accidents.
  void happen(ByteSource& source)
  {
    const std::uint8_t what = source.byte();
    switch (what % 16)
    {
      case 0:
        disturb();
        port_.setDeaf((what & 16) != 0);
        break;
      case 1:
        disturb();
        port_.setTripped((what & 16) != 0);
        break;
      case 2:
        disturb();
        (what & 16) != 0 ? port_.unplug() : port_.plugIn();
        break;
      case 3:
        disturb();
        shutting_down_ = true;
        coordinator_.beginShutdown(clock_.now());
        break;
      default:
        run((what % 16) * (what < 0x80 ? 0.01 : 0.07));
    }
  }

  /// From here on the node may send stops of its own.
  void disturb()
  {
    anything_accepted_ = true;
  }

  void velocity(ByteSource& source)
  {
    bus::VelocityCommand command;
    const std::size_t index = inverter(source);
    command.targets = { { index, number(source) } };
    command.publisher = publisher(source);
    command.publisher.topic = "inverter";
    send(command, { index });
  }

  /// As the node's subscriber of the group topic does.
  void group(ByteSource& source)
  {
    std::vector<std::string> names;
    std::vector<double> velocities;
    const std::uint8_t lengths = source.byte();
    for (unsigned i = 0; i < (lengths & 7U); ++i)
    {
      names.push_back(text(source));
    }
    const unsigned difference = (lengths >> 3 & 3U) == 3 ? 1 : 0;
    for (unsigned i = 0; i < (lengths & 7U) + difference; ++i)
    {
      velocities.push_back(number(source));
    }
    const auto stops = [this](std::size_t index, double velocity) { return coordinator_.stops(index, velocity); };
    bus::VelocityGroup group = bus::resolveGroup(names, velocities, index_by_name_, stops);
    require(group.targets.size() <= index_by_name_.size(), "more targets than inverters");
    bus::VelocityCommand command;
    command.targets = group.targets;
    command.grouped = true;
    command.publisher = publisher(source);
    command.publisher.topic = "group";
    if (!command.targets.empty())
    {
      send(command, group.named);
    }
    if (!group.problem.empty())
    {
      requireWords(group.problem);
      coordinator_.refuse(clock_.now(), group.named, bus::ERROR_OUT_OF_RANGE, group.problem, true);
      checkRefused(group.named, bus::ERROR_OUT_OF_RANGE);
    }
  }

  void send(const bus::VelocityCommand& command, const std::vector<std::size_t>& named)
  {
    const std::vector<bus::InverterStatus> before = statuses();
    const std::uint16_t error_id = coordinator_.command(clock_.now(), command);
    const auto finite = [](const auto& target) { return std::isfinite(target.second); };
    const bool all_finite = std::all_of(command.targets.begin(), command.targets.end(), finite);
    const bool repeat = command.publisher.latched && command.publisher.first_on_connection;
    require(error_id != 0 || all_finite || repeat, "NaN or infinity accepted");
    if (error_id == 0)
    {
      anything_accepted_ = true;
      return;
    }
    checkRefused(named, error_id);
    const std::vector<bus::InverterStatus> after = statuses();
    for (const auto& target : command.targets)
    {
      const bool zero = coordinator_.stops(target.first, target.second);
      anything_accepted_ = anything_accepted_ || zero;
      require(zero || !watched_ || sameState(before[target.first], after[target.first]),
              "a refused velocity has changed something");
    }
  }

  /// Nothing where nobody looks: a report costs more than most requests.
  std::vector<bus::InverterStatus> statuses() const
  {
    std::vector<bus::InverterStatus> statuses;
    if (watched_)
    {
      for (bus::InverterReport& inverter : coordinator_.report(clock_.now()).inverters)
      {
        statuses.push_back(std::move(inverter.status));
      }
    }
    return statuses;
  }

  void checkRefused(const std::vector<std::size_t>& named, std::uint16_t error_id)
  {
    require(isRefusal(error_id), "refused with an error id that is none of the node's");
    if (!watched_)
    {
      return;
    }
    const bus::Report report = coordinator_.report(clock_.now());
    for (const std::size_t index : named)
    {
      const bus::InverterStatus& status = report.inverters[index].status;
      require(status.error_id != 0, "a refusal does not show in the status");
      requireWords(status.error_text);
    }
  }

  void stop(ByteSource& source)
  {
    const std::uint8_t options = source.byte();
    const std::optional<std::size_t> index = (options & 1) != 0 ? std::nullopt : std::make_optional(inverter(source));
    anything_accepted_ = true;
    service(
        "stop", bounds_.stop,
        [&](bus::AnswerCallback callback) {
          coordinator_.stop(clock_.now(), index, source.byte(), (options & 2) != 0 ? nullptr : std::move(callback));
        },
        (options & 2) == 0);
  }

  void writeParameter(ByteSource& source)
  {
    const std::size_t index = inverter(source);
    const std::string name = text(source);
    const double value = number(source);
    const bool persist = (source.byte() & 1) != 0;
    const Call& call = service("write_parameter", bounds_.write_parameter, [&](bus::AnswerCallback callback) {
      coordinator_.writeParameter(clock_.now(), index, name, value, persist, std::move(callback));
    });
    const bool bad = !std::isfinite(value) || configuration_.bus.parameters_read_only;
    require(call.refused || !bad, "a parameter that must not be written");
  }

  template <typename Start>
  const Call& service(const char* name, double bound, const Start& start, bool answered = true)
  {
    const std::vector<bus::InverterStatus> before = statuses();
    calls_.emplace_back();
    Call& call = calls_.back();
    call.answers = answered ? 0 : 1;
    call.expires = clock_.now() + seconds(bound);
    start([this, &call](const Answer& answer) { judge(call, answer); });
    deliver();
    const bool is_stop = std::string(name) == "stop";
    const std::vector<bus::InverterStatus> after = statuses();
    for (std::size_t i = 0; i < before.size() && call.refused && !is_stop; ++i)
    {
      require(sameState(before[i], after[i]) && before[i].locked == after[i].locked,
              "a refused call has changed something");
    }
    const bool reads = std::string(name).compare(0, 4, "read") == 0;
    anything_accepted_ = anything_accepted_ || (!call.refused && !reads);
    return call;
  }

  void judge(Call& call, const Answer& answer)
  {
    ++call.answers;
    require(call.answers == 1, "a call was answered twice");
    require(answer.success == (answer.error_id == 0), "success with an error id, or a failure without");
    requireWords(answer.message);
    call.refused = isRefusal(answer.error_id);
    // A whole exchange may lie between two looks at the clock.
    require(clock_.now() <= call.expires + seconds(0.5), "answered long after its bound");
  }

  // --- the bus ------------------------------------------------------------------------------------------------------
  void deliver()
  {
    const bus::Outputs outputs = coordinator_.takeOutputs();
    for (const bus::Finding& finding : outputs.log)
    {
      requireWords(finding.text);
    }
    for (const bus::InverterStatus& status : outputs.statuses)
    {
      require(std::isfinite(status.commanded_velocity), "a commanded velocity that is no number");
      require((status.error_id == 0) == status.error_text.empty(), "an error id without words, or words without an id");
    }
    for (auto& answer : coordinator_.takeAnswers())
    {
      answer.first(answer.second);
    }
  }

  void end()
  {
    coordinator_.beginShutdown(clock_.now());
    for (const std::string& line : coordinator_.endShutdown())
    {
      requireWords(line);
    }
    deliver();
    const auto answered = [](const Call& call) { return call.answers == 1; };
    require(std::all_of(calls_.begin(), calls_.end(), answered), "a call was never answered");
  }

  const bus::Configuration& configuration_;
  wire::VirtualClock clock_;
  MemoryDrives port_;
  std::unique_ptr<wire::Protocol> protocol_;
  wire::Line line_;
  std::mutex mutex_;
  bus::Coordinator coordinator_;
  bus::BusLoop loop_;
  const bus::ServiceBounds bounds_;
  std::map<std::string, std::size_t> index_by_name_;
  std::deque<Call> calls_;
  bool anything_accepted_ = false;
  /// The state before and after this request is compared.
  bool watched_ = false;
  bool shutting_down_ = false;
};

/// A bus, and what it writes when nobody asks for anything.
struct Stage
{
  bus::Configuration configuration;
  std::set<wire::Bytes> own_writes;
};

std::vector<Stage> makeStages()
{
  std::vector<Stage> stages;
  for (const std::string& scan_list : BUSES)
  {
    stages.push_back({ read(scan_list), {} });
    World world(stages.back().configuration);
    world.run(5.0);
    stages.back().own_writes = world.writes();
  }
  return stages;
}
}  // namespace
}  // namespace fuzz
}  // namespace inverter_bus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace inverter_bus::fuzz;
  static const std::vector<Stage> STAGES = makeStages();
  ByteSource source(data, size);
  const std::uint8_t start = source.byte();
  const Stage& stage = STAGES[(start & 15U) % STAGES.size()];
  World world(stage.configuration);
  // Not connected; connected; being asked about itself; long unlocked.
  constexpr double BEFORE[] = { 0.0, 0.05, 0.3, 1.2 };
  world.run(BEFORE[start >> 4 & 3U]);
  world.play(source, stage.own_writes);
  return 0;
}
