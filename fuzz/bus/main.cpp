// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The whole core in virtual time against simulated drives: users and faults by chance, every rule watched from the
// outside. docs/fuzzing.md

#include <unistd.h>

#include <boost/program_options.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>

#include "fuzz/bus/game.h"
#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
namespace options = boost::program_options;

// Profiles take longer to read than a bus to play: so many buses are made, and each is played on by many seeds.
constexpr std::uint64_t BUSES = 160;
// Not a divisor of it: every bus is ended by some seeds.
constexpr std::uint64_t SHUTDOWN_EVERY = 7;

struct Settings
{
  std::uint64_t seeds = 100;
  std::uint64_t first = 1;
  double minutes = 0.4;
  double hours = 0.0;
  std::string scan_list;
  std::size_t frames = 30;
  bool verbose = false;
  bool digest = false;
};

struct Bench
{
  Scene scene;
  bus::Configuration configuration;
};

bus::Configuration configure(const Scene& scene)
{
  char path[] = "/tmp/bus_fuzz_XXXXXX";
  const int file = ::mkstemp(path);
  if (file < 0)
  {
    throw std::runtime_error("no file can be made under /tmp");
  }
  ::close(file);
  std::ofstream(path) << scene.yaml;
  const bus::Value value = bus::readYamlFile(path);
  std::remove(path);
  return bus::readConfiguration(value, "scan list", INVERTER_BUS_ROOT "/config/drives");
}

class Program
{
public:
  explicit Program(const Settings& settings) : settings_(settings)
  {
  }

  int run()
  {
    const auto begin = std::chrono::steady_clock::now();
    std::uint64_t seed = settings_.first;
    bool failed = false;
    while (!failed && (settings_.hours > 0.0 ? toSeconds(simulated_) < settings_.hours * 3600.0
                                             : seed < settings_.first + settings_.seeds))
    {
      failed = !play(seed++);
    }
    const double wall = toSeconds(std::chrono::steady_clock::now() - begin);
    const Statistics& sum = sum_;
    std::printf(
        "%llu seeds, %.2f h of bus time in %.1f s, %llu exchanges, %llu commands (%llu accepted), %llu RUN frames, "
        "%llu services, %llu statuses, %llu values compared\n",
        number(seed - settings_.first), toSeconds(simulated_) / 3600.0, wall, number(sum.exchanges),
        number(sum.commands), number(sum.accepted), number(sum.runs), number(sum.services), number(sum.statuses),
        number(sum.values));
    std::printf("%llu stops checked, worst stop latency %.1f ms\n%s\n", number(sum.stops),
                toSeconds(sum.worst_stop) * 1e3, failed ? ("FAILED: " + failure_).c_str() : "no rule was broken");
    return failed ? 1 : 0;
  }

private:
  static unsigned long long number(std::uint64_t value)
  {
    return value;
  }

  const Bench& bench(std::uint64_t seed)
  {
    const std::uint64_t which = seed % BUSES;
    const auto found = benches_.find(which);
    if (found != benches_.end())
    {
      return found->second;
    }
    Bench bench;
    bench.scene = makeScene(which, settings_.scan_list);
    bench.configuration = configure(bench.scene);
    return benches_.emplace(which, std::move(bench)).first->second;
  }

  bool play(std::uint64_t seed)
  {
    const Bench& used = bench(seed);
    World world(used.scene, used.configuration, seed);
    Game game(world, seed);
    bool good = true;
    try
    {
      game.play(seconds(settings_.minutes * 60.0));
      if (seed % SHUTDOWN_EVERY == 0)
      {
        game.shutDown();
      }
      else
      {
        game.calmDown();
      }
    }
    catch (const Violation& violation)
    {
      good = false;
      report(seed, world, violation);
    }
    if (settings_.verbose && good)
    {
      std::printf("seed %llu: %s, %zu inverters: good\n", number(seed), used.scene.name.c_str(),
                  used.scene.inverters.size());
    }
    if (settings_.digest)
    {
      std::printf("digest %llu %s\n", number(seed), world.digest().c_str());
    }
    simulated_ += world.now() - world.start();
    add(world.checker().statistics());
    return good;
  }

  void report(std::uint64_t seed, World& world, const Violation& violation)
  {
    const std::string what = violation.what();
    failure_ = "seed " + std::to_string(seed) + ": " + what.substr(0, what.find('\n'));
    std::printf("seed %llu (%s) broke a rule at %.6f s\n  %s\n", number(seed), world.scene().name.c_str(),
                toSeconds(violation.time - world.start()), violation.what());
    std::printf("The bus:\n%s\nThe drives:\n%sThe last frames (a request in flight is not among them):\n%s",
                world.scene().yaml.c_str(), world.state().c_str(), world.lastFrames(settings_.frames).c_str());
    std::printf("Again: bus_fuzz --seed %llu --seeds 1 --minutes %g%s%s\n", number(seed), settings_.minutes,
                settings_.scan_list.empty() ? "" : " --scan-list ", settings_.scan_list.c_str());
  }

  void add(const Statistics& more)
  {
    sum_.exchanges += more.exchanges;
    sum_.commands += more.commands;
    sum_.accepted += more.accepted;
    sum_.runs += more.runs;
    sum_.stops += more.stops;
    sum_.services += more.services;
    sum_.statuses += more.statuses;
    sum_.values += more.values;
    sum_.worst_stop = std::max(sum_.worst_stop, more.worst_stop);
  }

  Settings settings_;
  std::map<std::uint64_t, Bench> benches_;
  Duration simulated_{ 0 };
  Statistics sum_;
  std::string failure_;
};

int main(int argc, char** argv)
{
  Settings settings;
  std::string names;
  for (const std::string& name : sceneNames())
  {
    names += names.find(name + ",") == std::string::npos ? name + ", " : "";
  }
  options::options_description description("bus_fuzz: the core in virtual time against simulated drives");
  description.add_options()("help", "this text")("seeds", options::value(&settings.seeds), "how many seeds")(
      "seed", options::value(&settings.first), "the first one; alone: this one only")(
      "minutes", options::value(&settings.minutes), "bus time per seed, before everything must come back")(
      "hours", options::value(&settings.hours), "instead of --seeds: until so much bus time has passed")(
      "scan-list", options::value(&settings.scan_list), ("only this kind of bus: " + names).c_str())(
      "frames", options::value(&settings.frames), "how many of the last frames to show, up to 5000")(
      "verbose", options::bool_switch(&settings.verbose), "a line per seed")(
      "digest", options::bool_switch(&settings.digest),
      "a line per seed with three hashes: frames; results, statuses and answers without texts; texts");
  options::variables_map given;
  try
  {
    options::store(options::parse_command_line(argc, argv, description), given);
    options::notify(given);
    if (given.count("help") != 0)
    {
      std::cout << description;
      return 0;
    }
    settings.seeds = given.count("seed") != 0 && given.count("seeds") == 0 ? 1 : settings.seeds;
    return Program(settings).run();
  }
  catch (const std::exception& error)
  {
    std::cerr << "bus_fuzz: " << error.what() << "\n";
    return 2;
  }
}
}  // namespace
}  // namespace fuzz
}  // namespace inverter_bus

int main(int argc, char** argv)
{
  return inverter_bus::fuzz::main(argc, argv);
}
