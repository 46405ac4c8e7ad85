// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The simulated bus as a ROS node: parameters in, service ~command, everything else is inverter_bus_bench and
// inverter_bus_simulation.

#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include <ros/ros.h>

#include "bench/scan_list.h"
#include "inverter_bus/InjectFault.h"
#include "inverter_bus/drive/profile.h"
#include "inverter_bus/simulation/bus_config.h"
#include "inverter_bus/simulation/bus_runner.h"
#include "inverter_bus/simulation/simulated_bus.h"
#include "ros/command_line.h"
#include "ros/parameters.h"

namespace
{
namespace sim = inverter_bus::simulation;

const char* const USAGE =
    "usage: simulated_bus_node [--help] [__name:=NAME] [_link:=PATH] [_PARAMETER:=VALUE] [FROM:=TO]...\n"
    "Plays the drives of a scan list on a pseudo-terminal. It needs the parameters scan_list and link (or port: the "
    "name\n"
    "of the link to the terminal), best by simulated_bus.launch. Without ROS: simulated_bus --help\n";

/// Parameters of this node beside those of the driver; `port` is the driver's too, and the link where there is no `link`.
const char* const OWN_KEYS[] = { "link", "gap", "gap_tolerance", "turnaround", "seed", "trace", "client_parity" };

sim::BusConfig readConfig()
{
  inverter_bus::config::Value parameters = inverter_bus::ros_node::readParameters();
  for (const char* key : OWN_KEYS)
  {
    parameters.erase(key);
  }
  inverter_bus::bench::SimulatedScanList list =
      inverter_bus::bench::readScanList(parameters, "~", inverter_bus::drive::shippedProfileDirectory());
  for (const std::string& warning : list.warnings)
  {
    ROS_WARN("%s", warning.c_str());
  }
  double turnaround = 0.0;
  if (ros::param::get("~turnaround", turnaround))
  {
    for (sim::DriveConfig& drive : list.config.drives)
    {
      drive.options.turnaround = turnaround;
    }
  }
  return list.config;
}

void assumeParity(sim::BusRunner& runner)
{
  std::string parity;
  if (!ros::param::get("~client_parity", parity))
  {
    return;
  }
  if (parity != "none" && parity != "even" && parity != "odd")
  {
    throw sim::ConfigError("client_parity: " + parity + " (allowed: none, even, odd)");
  }
  runner.assumeParity(parity == "none" ? sim::Parity::None : (parity == "even" ? sim::Parity::Even : sim::Parity::Odd));
}

std::string readLink()
{
  std::string link;
  if (!ros::param::get("~link", link) && !ros::param::get("~port", link))
  {
    throw sim::ConfigError("link: missing (allowed: name of the link to the pseudo-terminal, as ~link or ~port)");
  }
  return link;
}

sim::LineOptions readLineOptions()
{
  const std::string gap = ros::param::param<std::string>("~gap", "enforce");
  if (gap != "enforce" && gap != "ignore")
  {
    throw sim::ConfigError("gap: " + gap + " (allowed: enforce, ignore)");
  }
  sim::LineOptions options;
  options.gap = gap == "enforce" ? sim::GapRule::Enforce : sim::GapRule::Ignore;
  options.gap_tolerance = sim::seconds(ros::param::param("~gap_tolerance", 0.0003));
  options.delivery_step = std::chrono::microseconds(500);
  options.seed = static_cast<std::uint64_t>(ros::param::param("~seed", 1));
  return options;
}

std::unique_ptr<std::ofstream> openTrace()
{
  const std::string path = ros::param::param<std::string>("~trace", "");
  if (path.empty())
  {
    return nullptr;
  }
  auto file = std::make_unique<std::ofstream>(path, std::ios::app);
  if (!*file)
  {
    throw sim::ConfigError("trace: " + path + " can't be written (allowed: a file in a writable directory)");
  }
  return file;
}

void play(ros::NodeHandle& node)
{
  const std::unique_ptr<std::ofstream> trace = openTrace();
  sim::SimulatedBus bus(readConfig(), readLineOptions(), sim::Clock::now());
  if (trace)
  {
    bus.setObserver([&](const sim::FrameRecord& frame) { *trace << sim::frameText(frame, bus.start()) << std::endl; });
  }
  sim::BusRunner runner(bus, readLink());
  assumeParity(runner);
  std::exception_ptr failure;
  std::thread line([&] {
    try
    {
      runner.run(ros::param::param("~realtime_priority", 0));
    }
    catch (...)
    {
      failure = std::current_exception();
      ros::requestShutdown();
    }
  });
  const boost::function<bool(inverter_bus::InjectFault::Request&, inverter_bus::InjectFault::Response&)> on_command =
      [&runner](inverter_bus::InjectFault::Request& request, inverter_bus::InjectFault::Response& response) {
        response.message = runner.command(request.command);
        response.success = static_cast<unsigned char>(response.message.compare(0, 2, "ok") == 0);
        return true;
      };
  ros::ServiceServer service = node.advertiseService("command", on_command);
  ROS_INFO("simulated bus ready: %s -> %s, %zu drives", runner.terminal().link().c_str(),
           runner.terminal().path().c_str(), bus.drives().size());
  ros::spin();
  service.shutdown();
  runner.stop();
  line.join();
  if (failure)
  {
    std::rethrow_exception(failure);
  }
}
}  // namespace

int main(int argc, char** argv)
{
  if (const auto status = inverter_bus::ros_node::answerCommandLine(argc, argv, USAGE))
  {
    return *status;
  }
  ros::init(argc, argv, "simulated_bus");
  const auto on_signal = [](int) { ros::requestShutdown(); };
  std::signal(SIGTERM, on_signal);  // roscpp itself handles SIGINT only
  std::signal(SIGHUP, on_signal);
  ros::NodeHandle node("~");  // lives until after the last message: without any, ROS logs nothing
  try
  {
    play(node);
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return EXIT_FAILURE;
  }
}
