// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// No wait with a time-out may be on the wall clock: one that is set back would make it longer, and the command watchdog
// late. This program puts itself between the driver and the C library and counts waits by the clock they are on. What it
// can't see, since the C++ library of GCC 10 and later waits on the right clock by itself, steady_waits_test.py forbids.

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <boost/make_shared.hpp>

#include "inverter_bus/bus/bus.h"
#include "ros/elastic_queue.h"
#include "util/steady_event.h"
#include "wire/port/name_lookup.h"

namespace
{
std::atomic<unsigned> steady_waits{ 0 };
std::atomic<unsigned> wall_clock_waits{ 0 };

/// Condition variables that were made for CLOCK_MONOTONIC. All others, also those that are never initialized by a call, wait
/// on CLOCK_REALTIME.
class SteadyConditions
{
public:
  void note(const pthread_cond_t* condition, bool steady)
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    steady ? static_cast<void>(conditions_.insert(condition)) : static_cast<void>(conditions_.erase(condition));
  }

  bool contain(const pthread_cond_t* condition)
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    return conditions_.count(condition) != 0;
  }

private:
  std::mutex mutex_;
  std::set<const pthread_cond_t*> conditions_;
};

/// Never destroyed: threads of libraries may outlive main().
SteadyConditions& steadyConditions()
{
  static auto* const conditions = new SteadyConditions();
  return *conditions;
}

void count(bool steady)
{
  ++(steady ? steady_waits : wall_clock_waits);
}

/// The function that \p own hides.
template <typename Function>
Function* hidden(Function* /*own*/, const char* name)
{
#ifdef __SANITIZE_THREAD__
  void* found = nullptr;  // the sanitizer's own, which has no version, and must not be passed by
#else
  // dlsym() of an older glibc finds the oldest version, which knows another pthread_cond_t.
  void* found = dlvsym(RTLD_NEXT, name, "GLIBC_2.3.2");
#endif
  found = found != nullptr ? found : dlsym(RTLD_NEXT, name);
  return reinterpret_cast<Function*>(found);
}
}  // namespace

extern "C" {
int pthread_cond_init(pthread_cond_t* condition, const pthread_condattr_t* attributes) noexcept
{
  clockid_t clock = CLOCK_REALTIME;
  if (attributes != nullptr)
  {
    pthread_condattr_getclock(attributes, &clock);
  }
  steadyConditions().note(condition, clock == CLOCK_MONOTONIC);
  static auto* const next = hidden(&pthread_cond_init, "pthread_cond_init");
  return next(condition, attributes);
}

int pthread_cond_destroy(pthread_cond_t* condition) noexcept
{
  steadyConditions().note(condition, false);
  static auto* const next = hidden(&pthread_cond_destroy, "pthread_cond_destroy");
  return next(condition);
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* deadline)
{
  count(steadyConditions().contain(condition));
  static auto* const next = hidden(&pthread_cond_timedwait, "pthread_cond_timedwait");
  return next(condition, mutex, deadline);
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* deadline)
{
  count(clock == CLOCK_MONOTONIC);
  static auto* const next = hidden(&pthread_cond_clockwait, "pthread_cond_clockwait");
  return next(condition, mutex, clock, deadline);
}
}  // extern "C"

namespace inverter_bus
{
namespace
{
using std::chrono::milliseconds;

/// For what takes far less than a second on a quiet machine.
constexpr auto PATIENCE = std::chrono::seconds(60);

class SteadyWaits : public ::testing::Test
{
protected:
  SteadyWaits() : steady_before_(steady_waits), wall_clock_before_(wall_clock_waits)
  {
  }

  unsigned steady() const
  {
    return steady_waits - steady_before_;
  }

  unsigned onWallClock() const
  {
    return wall_clock_waits - wall_clock_before_;
  }

  /// Without a wait of its own.
  void spinUntilSomethingWaits() const
  {
    const auto end = std::chrono::steady_clock::now() + PATIENCE;
    while (steady() + onWallClock() == 0 && std::chrono::steady_clock::now() < end)
    {
      std::this_thread::yield();
    }
  }

  void expectOnlySteadyWaits() const
  {
    EXPECT_GT(steady(), 0U) << "nothing has waited: what was tested?";
    EXPECT_EQ(0U, onWallClock());
  }

private:
  const unsigned steady_before_;
  const unsigned wall_clock_before_;
};

class NoObserver : public bus::Observer
{
public:
  void inverterStatus(const bus::InverterStatus& /*status*/) override
  {
  }
  void busStatus(const bus::BusStatus& /*status*/) override
  {
  }
  void log(const bus::Finding& /*finding*/) override
  {
  }
  void trace(bus::TraceDump /*dump*/) override
  {
  }
};

/// A bus whose port is missing: its thread sleeps until it looks for the port again.
bus::Configuration withoutPort()
{
  const std::string path = ::testing::TempDir() + "steady_waits_" + std::to_string(::getpid()) + ".yaml";
  std::ofstream(path) << "port: " << path << ".missing\n"
                      << "defaults: {drive: omron_mx2}\nscan_list:\n  - {name: belt, node: 1}\n";
  const bus::Value value = bus::readYamlFile(path);
  std::remove(path.c_str());
  return bus::readConfiguration(value, "scan list", INVERTER_BUS_ROOT "/config/drives");
}

TEST_F(SteadyWaits, aWaitOnTheWallClockIsNoticed)
{
  std::mutex mutex;
  std::unique_lock<std::mutex> lock(mutex);
  std::condition_variable condition;
  condition.wait_until(lock, std::chrono::system_clock::now() + milliseconds(1), [] { return false; });
  EXPECT_EQ(1U, onWallClock());
  EXPECT_EQ(0U, steady());
}

TEST_F(SteadyWaits, soIsOneOnTheClockThatAConditionHasWithoutAttributes)
{
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  const timespec past{};
  pthread_mutex_lock(&mutex);
  EXPECT_EQ(ETIMEDOUT, pthread_cond_timedwait(&condition, &mutex, &past));
  EXPECT_EQ(ETIMEDOUT, pthread_cond_clockwait(&condition, &mutex, CLOCK_REALTIME, &past));
  EXPECT_EQ(2U, onWallClock());
  EXPECT_EQ(ETIMEDOUT, pthread_cond_clockwait(&condition, &mutex, CLOCK_MONOTONIC, &past));
  EXPECT_EQ(1U, steady());
  pthread_mutex_unlock(&mutex);
}

TEST_F(SteadyWaits, theEventWaitsOnTheSteadyClock)
{
  EXPECT_FALSE(util::SteadyEvent().waitFor(milliseconds(1)));
  expectOnlySteadyWaits();
}

TEST_F(SteadyWaits, theBusSleepsOnTheSteadyClock)
{
  NoObserver observer;
  bus::Configuration configuration = withoutPort();
  auto port = bus::makePort(configuration.bus);
  bus::Bus bus(std::move(configuration), std::move(port), observer);
  bus.start();
  spinUntilSomethingWaits();
  bus.shutdown();
  expectOnlySteadyWaits();
}

TEST_F(SteadyWaits, theBusWaitsForANameOnTheSteadyClock)
{
  const auto release = std::make_shared<util::SteadyEvent>();
  wire::NameLookup lookup("gateway", [release](const std::string& /*host*/, std::string& /*error*/) {
    while (!release->isSet())
    {
      std::this_thread::yield();
    }
    return std::vector<std::string>{ "127.0.0.1" };
  });
  std::string error;
  EXPECT_THAT(lookup.find(std::chrono::steady_clock::now() + milliseconds(1), error), ::testing::IsEmpty());
  EXPECT_TRUE(lookup.goesOn());
  release->set();
  EXPECT_THAT(lookup.find(std::chrono::steady_clock::now() + PATIENCE, error), ::testing::ElementsAre("127.0.0.1"));
  EXPECT_FALSE(lookup.goesOn());
  expectOnlySteadyWaits();
}

TEST_F(SteadyWaits, theQueueOfServicesWaitsOnTheSteadyClock)
{
  class Held : public ros::CallbackInterface
  {
  public:
    explicit Held(const std::atomic<bool>& held) : held_(held)
    {
    }

    CallResult call() override
    {
      while (held_)
      {
        std::this_thread::yield();
      }
      return Success;
    }

  private:
    const std::atomic<bool>& held_;
  };

  std::atomic<bool> held{ true };
  ros_node::ElasticQueue queue(1);
  queue.addCallback(boost::make_shared<Held>(held));
  EXPECT_FALSE(queue.waitIdle(milliseconds(1)));
  held = false;
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
  expectOnlySteadyWaits();
}
}  // namespace
}  // namespace inverter_bus
