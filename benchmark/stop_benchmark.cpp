// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// How long does a stop take to the wire? 31 MX2 at 19200, velocities at 50 Hz on each, a parameter read always waits, 0, 3
// or 15 of them dead, stops at random instants. The whole core in virtual time: what is measured is what the driver decides,
// and no host. A unit test plays fewer.
//
//   stop_benchmark --profiles config/drives [--stops 10000] [--seed 1]

#include <algorithm>
#include <boost/program_options.hpp>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>

#include "support/stop_latency_story.h"

namespace
{
using namespace inverter_bus;
namespace po = boost::program_options;

using Death = StopLatencyStory::Death;

/// The most that a stop may wait [ms]: with dead drives that are silent, and with such as answer late or half.
constexpr double GOAL_SILENT_MS = 40.0;
constexpr double GOAL_ODD_MS = 46.0;

struct Options
{
  std::string profiles;
  unsigned stops = 10000;
  std::uint64_t seed = 1;
};

double quantile(const std::vector<Duration>& sorted, double share)
{
  const auto index = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1));
  return toSeconds(sorted[index]) * 1e3;
}

/// True if the goal is met.
bool play(const Options& options, unsigned dead, Death death, const char* title)
{
  StopLatencyStory::Plan plan;
  plan.dead = dead;
  plan.death = death;
  plan.stops = options.stops;
  plan.seed = options.seed;
  StopLatencyStory story(plan, options.profiles);
  std::vector<Duration> latencies = story.play();
  if (latencies.size() < options.stops)
  {
    std::printf("%2u dead, %-14s a stop did not come after %zu\n", dead, title, latencies.size());
    return false;
  }
  std::sort(latencies.begin(), latencies.end());
  const double goal = death == Death::Silent ? GOAL_SILENT_MS : GOAL_ODD_MS;
  const double worst = quantile(latencies, 1.0);
  std::printf("%2u dead, %-14s %7zu stops: median %5.1f ms, p99 %5.1f ms, maximum %5.1f ms, goal %4.0f ms %s\n", dead,
              title, latencies.size(), quantile(latencies, 0.5), quantile(latencies, 0.99), worst, goal,
              worst <= goal ? "met" : "MISSED");
  std::fflush(stdout);
  return worst <= goal;
}

Options parse(int argc, char** argv)
{
  Options options;
  po::options_description description("How long stops take to the wire, in virtual time");
  description.add_options()("help", "")("profiles", po::value(&options.profiles)->required(), "config/drives")(
      "stops", po::value(&options.stops)->default_value(options.stops), "of each kind of bus")(
      "seed", po::value(&options.seed)->default_value(options.seed), "");
  po::variables_map map;
  po::store(po::parse_command_line(argc, argv, description), map);
  if (map.count("help") != 0)
  {
    std::cout << description;
    std::exit(EXIT_SUCCESS);
  }
  po::notify(map);
  if (options.stops == 0)
  {
    throw std::invalid_argument("--stops must be at least 1");
  }
  return options;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    const Options options = parse(argc, argv);
    bool met = play(options, 0, Death::Silent, "");
    for (const unsigned dead : { 3U, 15U })
    {
      met = play(options, dead, Death::Silent, "silent") && met;
      met = play(options, dead, Death::Late, "late replies") && met;
      met = play(options, dead, Death::Broken, "broken replies") && met;
    }
    return met ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::cerr << "stop_benchmark: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
