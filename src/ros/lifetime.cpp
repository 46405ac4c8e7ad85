// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/lifetime.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <ros/init.h>
#include <ros/xmlrpc_manager.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
/// For the rest of the work in roscpp, when nothing depends on it any more.
constexpr Duration PATIENCE = std::chrono::seconds(3);

[[noreturn]] void endProcess(int status)
{
  std::fflush(nullptr);
  std::_Exit(status);
}
}  // namespace

Lifetime::Lifetime()
{
  signals_.listen([this](const std::string& name) { onSignal(name); });
}

Lifetime::~Lifetime()
{
  finished_.set();
  if (guard_.joinable())
  {
    guard_.join();
  }
}

void Lifetime::takeOverKill()
{
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", [this](XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
    end_.set();
    result = ros::xmlrpc::responseInt(1, "", 0);
  });
}

void Lifetime::busIsRunning()
{
  running_.set();
}

const util::SteadyEvent& Lifetime::end() const
{
  return end_;
}

bool Lifetime::waitForEnd(Duration timeout) const
{
  return end_.waitFor(timeout) || ros::isShuttingDown();
}

void Lifetime::finishSoon(int status)
{
  guard_ = std::thread([this, status] {
    if (!finished_.waitFor(PATIENCE))
    {
      endProcess(status);
    }
  });
}

/// Signal thread.
void Lifetime::onSignal(const std::string& name)
{
  if (end_.isSet())
  {
    return;
  }
  std::fprintf(stderr, "%s: stopping\n", name.c_str());
  end_.set();
  // Before the bus runs, the main thread may be held by a master that is gone; no motor waits for it.
  if (!running_.isSet() && !finished_.waitFor(PATIENCE) && !running_.isSet())
  {
    endProcess(0);
  }
}
}  // namespace ros_node
}  // namespace inverter_bus
