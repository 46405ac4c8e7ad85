// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Many threads at the door of a Bus with its own thread, a real serial port and simulated drives on a pseudo-terminal, in
// real time. Every call is answered once, the observer is called by one thread at a time, nothing is left running; that
// no two threads touch the same thing at once is for the thread sanitizer to see (scripts/test --sanitize thread).

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "inverter_bus/bus/bus.h"
#include "inverter_bus/simulation/bus_runner.h"

namespace inverter_bus
{
namespace
{
constexpr std::size_t INVERTERS = 3;
const char* const NAMES[INVERTERS] = { "belt_1", "belt_2", "belt_3" };
/// For what takes far less than a second on a quiet machine.
constexpr auto PATIENCE = std::chrono::seconds(60);
/// Services that one thread leaves waiting: less than the bus answers within their bounds.
constexpr std::size_t MOST_OPEN = 4;

/// Every call to the bus that gets an answer, and how often it got one.
class Ledger
{
public:
  bus::AnswerCallback open()
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const std::size_t number = answers_.size();
    answers_.emplace_back();
    ++open_;
    return [this, number](const bus::Answer& answer) { close(number, answer); };
  }

  /// False if it did not come true in time.
  bool waitForOpen(std::size_t most)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, PATIENCE, [&] { return open_ <= most; });
  }

  bool waitForSuccesses(std::size_t count)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, PATIENCE, [&] { return successes_ >= count; });
  }

  std::size_t successes() const
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    return successes_;
  }

  std::size_t calls() const
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    return answers_.size();
  }

  bool eachOnce() const
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    return std::all_of(answers_.begin(), answers_.end(), [](int count) { return count == 1; });
  }

private:
  void close(std::size_t number, const bus::Answer& answer)
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    open_ -= ++answers_[number] == 1 ? 1 : 0;
    successes_ += answer.success ? 1 : 0;
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<int> answers_;
  std::size_t open_ = 0;
  std::size_t successes_ = 0;
};

/// Keeps the last status of each inverter, and notices when two threads report at once.
class Watcher : public bus::Observer
{
public:
  void inverterStatus(const bus::InverterStatus& status) override
  {
    const Visit visit(*this);
    const std::lock_guard<std::mutex> guard(mutex_);
    last_[status.index] = status;
    ++count_;
    changed_.notify_all();
  }

  void busStatus(const bus::BusStatus& status) override
  {
    const Visit visit(*this);
    const std::lock_guard<std::mutex> guard(mutex_);
    bus_ = status;
    changed_.notify_all();
  }

  void log(const bus::Finding&) override
  {
    const Visit visit(*this);
  }

  void trace(bus::TraceDump) override
  {
    const Visit visit(*this);
  }

  /// Runs until \p condition holds for the last status of every inverter.
  bool waitForAll(const std::function<bool(const bus::InverterStatus&)>& condition)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, PATIENCE, [&] { return std::all_of(last_, last_ + INVERTERS, condition); });
  }

  bool waitForBus(const std::function<bool(const bus::BusStatus&)>& condition)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, PATIENCE, [&] { return condition(bus_); });
  }

  /// Waits for news, or for the end of the bus.
  void waitForNews()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    const unsigned long count = count_;
    changed_.wait_for(lock, PATIENCE, [&] { return count_ != count || over_; });
  }

  void end()
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    over_ = true;
    changed_.notify_all();
  }

  bool alone() const
  {
    return !crowded_;
  }

private:
  struct Visit
  {
    explicit Visit(Watcher& watcher) : watcher(watcher)
    {
      if (++watcher.inside_ > 1)
      {
        watcher.crowded_ = true;
      }
    }
    ~Visit()
    {
      --watcher.inside_;
    }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

    Watcher& watcher;
  };

  std::atomic<int> inside_{ 0 };
  std::atomic<bool> crowded_{ false };
  std::mutex mutex_;
  std::condition_variable changed_;
  bus::InverterStatus last_[INVERTERS];
  bus::BusStatus bus_;
  unsigned long count_ = 0;
  bool over_ = false;
};

/// The bus, its drives, and threads that call it until told to stop.
class Threads : public ::testing::Test
{
protected:
  Threads() : link_(::testing::TempDir() + "threads_" + std::to_string(::getpid()))
  {
    std::string yaml = "port: " + link_ + "\nbaud_rate: 115200\ndefaults: {drive: omron_mx2}\nscan_list:\n";
    for (std::size_t index = 0; index < INVERTERS; ++index)
    {
      yaml += std::string("  - {name: ") + NAMES[index] + ", node: " + std::to_string(index + 1) + "}\n";
    }
    simulation::LineOptions line;
    line.delivery_step = std::chrono::microseconds(500);
    simulated_ = std::make_unique<simulation::SimulatedBus>(simulation::busConfigFromText(yaml), line,
                                                            std::chrono::steady_clock::now());
    runner_ = std::make_unique<simulation::BusRunner>(*simulated_, link_);
    player_ = std::thread([this] { runner_->run(); });
    bus::Configuration configuration = read(yaml);
    auto port = bus::makePort(configuration.bus);
    bus_ = std::make_unique<bus::Bus>(std::move(configuration), std::move(port), watcher_);
  }

  ~Threads() override
  {
    callers_end_ = true;
    watcher_.end();
    joinCallers();
    bus_.reset();
    runner_->stop();
    player_.join();
  }

  void startUnlocked()
  {
    bus_->start();
    ASSERT_TRUE(watcher_.waitForAll([](const bus::InverterStatus& status) { return !status.locked; }));
  }

  /// All at once: velocities of three publishers, groups, stops, every service, and every question.
  void startCallers()
  {
    for (int number = 0; number < 3; ++number)
    {
      call([this, number](unsigned round) { sendVelocities(number, round); });
    }
    call([this](unsigned round) { callServices(round); });
    call([this](unsigned round) { callServices(round + 1); });
    call([this](unsigned round) { callStops(round); });
    call([this](unsigned round) { ask(round); });
  }

  void joinCallers()
  {
    for (std::thread& caller : callers_)
    {
      caller.join();
    }
    callers_.clear();
  }

  /// Ends the callers, and waits until every call is answered.
  void endCallers()
  {
    callers_end_ = true;
    joinCallers();
    EXPECT_TRUE(ledger_.waitForOpen(0)) << "calls without an answer";
  }

  void expectInOrder()
  {
    EXPECT_TRUE(ledger_.eachOnce()) << "a call of " << ledger_.calls() << " was not answered exactly once";
    EXPECT_TRUE(watcher_.alone()) << "the observer was called by two threads at once";
  }

  void expectStopped()
  {
    for (const char* name : NAMES)
    {
      const std::string shown = runner_->command(std::string(name) + " show");
      EXPECT_NE(shown.find(" run_coil=0"), std::string::npos) << name << ": " << shown;
    }
  }

  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<simulation::BusRunner> runner_;
  Watcher watcher_;
  Ledger ledger_;
  std::atomic<bool> callers_end_{ false };

private:
  static bus::Configuration read(const std::string& yaml)
  {
    const std::string path = ::testing::TempDir() + "threads_" + std::to_string(::getpid()) + ".yaml";
    std::ofstream(path) << yaml;
    const bus::Value value = bus::readYamlFile(path);
    std::remove(path.c_str());
    return bus::readConfiguration(value, "scan list", INVERTER_BUS_ROOT "/config/drives");
  }

  void call(std::function<void(unsigned)> round)
  {
    callers_.emplace_back([this, round = std::move(round)] {
      for (unsigned number = 0; !callers_end_; ++number)
      {
        round(number);
      }
    });
  }

  bus::VelocityCommand from(int publisher) const
  {
    bus::VelocityCommand command;
    command.publisher.name = "/publisher_" + std::to_string(publisher);
    command.publisher.topic = "command";
    return command;
  }

  void sendVelocities(int publisher, unsigned round)
  {
    bus::VelocityCommand command = from(publisher);
    const double velocity = round % 7 == 0 ? 0.0 : 10.0 + round % 20;
    command.targets = { { round % INVERTERS, velocity } };
    bus_->command(command);
    command.targets = { { 0, velocity }, { 1, -velocity }, { 2, velocity } };
    command.grouped = true;
    bus_->command(command);
    command.targets[1].second = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(bus_->command(command), 0);
    bus_->refuse({ round % INVERTERS }, bus::ERROR_OUT_OF_RANGE, "no such name", true);
    watcher_.waitForNews();
  }

  void callServices(unsigned round)
  {
    const std::size_t index = round % INVERTERS;
    bus_->readParameter(index, "F002", ledger_.open());
    bus_->readParameter(index, "Z999", ledger_.open());
    bus_->writeParameter(index, "A020", 1.0 + round % 3, round % 2 == 0, ledger_.open());
    bus_->reset(index, ledger_.open());
    bus_->readFaults(index, ledger_.open());
    EXPECT_TRUE(ledger_.waitForOpen(MOST_OPEN));
  }

  void callStops(unsigned round)
  {
    const auto index = round % 4 < INVERTERS ? std::optional<std::size_t>(round % 4) : std::nullopt;
    const bus::AnswerCallback answered = ledger_.open();
    // An answer may lead to the next call: no lock of the bus is held while it is given.
    bus_->stop(index, static_cast<std::uint8_t>(round % 5), [this, answered](const bus::Answer& answer) {
      bus_->report();
      bus_->command(from(9));
      answered(answer);
    });
    EXPECT_TRUE(ledger_.waitForOpen(MOST_OPEN));
    watcher_.waitForNews();
  }

  void ask(unsigned round)
  {
    EXPECT_EQ(bus_->report().inverters.size(), INVERTERS);
    EXPECT_FALSE(bus_->portInUse());
    EXPECT_GT(bus_->bounds().stop, 0.0);
    if (round % 10 == 0)
    {
      bus_->budget();
      bus_->dumpTrace();
    }
    watcher_.waitForNews();
  }

  std::string link_;
  std::unique_ptr<simulation::SimulatedBus> simulated_;
  std::thread player_;
  std::vector<std::thread> callers_;
};

TEST_F(Threads, everyCallIsAnsweredOnceAndAStopOfAllEndsEverything)
{
  startUnlocked();
  startCallers();
  EXPECT_TRUE(ledger_.waitForSuccesses(40));
  endCallers();
  bus_->stop(std::nullopt, 0, ledger_.open());
  EXPECT_TRUE(ledger_.waitForOpen(0));
  expectStopped();
  expectInOrder();
}

TEST_F(Threads, shutdownInTheMiddleAnswersEveryCallAndStopsEveryMotor)
{
  startUnlocked();
  startCallers();
  EXPECT_TRUE(ledger_.waitForSuccesses(25));
  // Several at once, as a signal and a lost master may ask for it.
  std::vector<std::thread> enders;
  std::atomic<std::size_t> unconfirmed{ 0 };
  for (int number = 0; number < 3; ++number)
  {
    enders.emplace_back([this, &unconfirmed] { unconfirmed += bus_->shutdown().size(); });
  }
  for (std::thread& ender : enders)
  {
    ender.join();
  }
  watcher_.end();
  EXPECT_EQ(unconfirmed, 0U);
  expectStopped();
  // Who calls now is refused, and answered at once; there is no bus thread any more that could do it later.
  const std::size_t calls = ledger_.calls();
  const std::size_t successes = ledger_.successes();
  bus_->readParameter(0, "F002", ledger_.open());
  endCallers();
  EXPECT_GT(ledger_.calls(), calls);
  EXPECT_EQ(ledger_.successes(), successes);
  expectStopped();
  expectInOrder();
}

TEST_F(Threads, aPortThatIsPulledOutMeanwhileComesBack)
{
  startUnlocked();
  startCallers();
  for (std::uint64_t time = 1; time <= 2; ++time)
  {
    EXPECT_TRUE(ledger_.waitForSuccesses(ledger_.successes() + 4));
    EXPECT_EQ(runner_->command("bus unplug"), "ok");
    EXPECT_TRUE(watcher_.waitForBus([](const bus::BusStatus& status) { return !status.connected; }));
    EXPECT_EQ(runner_->command("bus plug"), "ok");
    EXPECT_TRUE(watcher_.waitForBus([&](const bus::BusStatus& status) { return status.reconnects >= time; }));
  }
  EXPECT_TRUE(watcher_.waitForAll([](const bus::InverterStatus& status) { return !status.communication_error; }));
  endCallers();
  EXPECT_TRUE(bus_->shutdown().empty());
  expectStopped();
  expectInOrder();
}

TEST_F(Threads, aBusThatIsEndedBeforeItWasStartedAnswersEveryCall)
{
  bus_->readParameter(0, "F002", ledger_.open());
  bus_->stop(std::nullopt, 0, ledger_.open());
  bus_->shutdown();
  EXPECT_TRUE(ledger_.waitForOpen(0));
  EXPECT_EQ(ledger_.successes(), 0U);
  expectInOrder();
}
}  // namespace
}  // namespace inverter_bus
