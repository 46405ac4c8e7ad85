// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/elastic_queue.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "util/steady_event.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
/// Longer than any machine needs; a test that waits so long has failed.
constexpr Duration PATIENCE = std::chrono::seconds(20);

class FunctionCallback : public ros::CallbackInterface
{
public:
  explicit FunctionCallback(std::function<CallResult()> function) : function_(std::move(function))
  {
  }
  CallResult call() override
  {
    return function_();
  }

private:
  std::function<CallResult()> function_;
};

ros::CallbackInterfacePtr callback(const std::function<void()>& function)
{
  return boost::make_shared<FunctionCallback>([function] {
    function();
    return ros::CallbackInterface::Success;
  });
}

TEST(ElasticQueueTest, waitingCallbacksDoNotDelayAnother)
{
  util::SteadyEvent release;
  util::SteadyEvent ran;
  std::atomic<int> waiting{ 0 };
  util::SteadyEvent all_wait;
  ElasticQueue queue(64);
  for (int i = 0; i < 50; ++i)
  {
    queue.addCallback(callback([&] {
      if (++waiting == 50)
      {
        all_wait.set();
      }
      release.waitFor(PATIENCE);
    }));
  }
  ASSERT_TRUE(all_wait.waitFor(PATIENCE));
  queue.addCallback(callback([&ran] { ran.set(); }));
  EXPECT_TRUE(ran.waitFor(PATIENCE));
  release.set();
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
}

TEST(ElasticQueueTest, beyondItsBoundCallbacksWaitForAFreeThread)
{
  util::SteadyEvent release;
  std::atomic<int> ran{ 0 };
  ElasticQueue queue(2);
  for (int i = 0; i < 10; ++i)
  {
    queue.addCallback(callback([&] {
      release.waitFor(PATIENCE);
      ++ran;
    }));
    EXPECT_LE(queue.threads(), 2U);
  }
  release.set();
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
  EXPECT_EQ(10, ran);
}

TEST(ElasticQueueTest, threadsThatAreNotNeededEnd)
{
  util::SteadyEvent release;
  util::SteadyEvent all_wait;
  std::atomic<int> waiting{ 0 };
  ElasticQueue queue(64);
  for (int i = 0; i < 30; ++i)
  {
    queue.addCallback(callback([&] {
      if (++waiting == 30)
      {
        all_wait.set();
      }
      release.waitFor(PATIENCE);
    }));
  }
  ASSERT_TRUE(all_wait.waitFor(PATIENCE));
  EXPECT_GE(queue.threads(), 30U);
  release.set();
  const TimePoint deadline = std::chrono::steady_clock::now() + PATIENCE;
  while (queue.threads() > 8 && std::chrono::steady_clock::now() < deadline)
  {
    std::this_thread::yield();
  }
  EXPECT_LE(queue.threads(), 8U);
}

TEST(ElasticQueueTest, aRemovedOwnersCallbacksNeitherRunNorAreRunning)
{
  util::SteadyEvent started;
  util::SteadyEvent release;
  util::SteadyEvent dropped;
  std::atomic<bool> finished{ false };
  std::atomic<bool> ran{ false };
  ElasticQueue queue(1);
  queue.addCallback(callback([&] {
                      started.set();
                      release.waitFor(PATIENCE);
                      finished = true;
                    }),
                    1);
  ASSERT_TRUE(started.waitFor(PATIENCE));
  {
    const std::shared_ptr<util::SteadyEvent> guard(&dropped, [](util::SteadyEvent* event) { event->set(); });
    queue.addCallback(callback([&ran, guard] { ran = true; }), 1);
  }
  std::thread remover([&] {
    queue.removeByID(1);
    EXPECT_TRUE(finished);
  });
  EXPECT_TRUE(dropped.waitFor(PATIENCE));
  release.set();
  remover.join();
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
  EXPECT_FALSE(ran);
}

TEST(ElasticQueueTest, removingOneOwnerDoesNotTouchAnother)
{
  util::SteadyEvent release;
  util::SteadyEvent ran;
  util::SteadyEvent started;
  ElasticQueue queue(1);
  queue.addCallback(callback([&] {
                      started.set();
                      release.waitFor(PATIENCE);
                    }),
                    1);
  ASSERT_TRUE(started.waitFor(PATIENCE));
  queue.addCallback(callback([&ran] { ran.set(); }), 2);
  queue.removeByID(3);
  release.set();
  EXPECT_TRUE(ran.waitFor(PATIENCE));
}

TEST(ElasticQueueTest, aCallbackMayRemoveItsOwnOwner)
{
  util::SteadyEvent done;
  ElasticQueue queue(4);
  queue.addCallback(callback([&] {
                      queue.removeByID(5);
                      done.set();
                    }),
                    5);
  EXPECT_TRUE(done.waitFor(PATIENCE));
}

TEST(ElasticQueueTest, aCallbackThatIsNotReadyIsTriedAgain)
{
  std::atomic<int> tries{ 0 };
  ElasticQueue queue(4);
  queue.addCallback(boost::make_shared<FunctionCallback>(
      [&tries] { return ++tries < 3 ? ros::CallbackInterface::TryAgain : ros::CallbackInterface::Success; }));
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
  EXPECT_EQ(3, tries);
}

TEST(ElasticQueueTest, shutdownDropsWhatWaitsAndTakesNothingMore)
{
  util::SteadyEvent started;
  util::SteadyEvent release;
  std::atomic<bool> ran{ false };
  ElasticQueue queue(1);
  queue.addCallback(callback([&] {
    started.set();
    release.waitFor(PATIENCE);
  }));
  ASSERT_TRUE(started.waitFor(PATIENCE));
  queue.addCallback(callback([&ran] { ran = true; }));
  std::thread releaser([&release] { release.set(); });
  queue.shutdown();
  releaser.join();
  queue.addCallback(callback([&ran] { ran = true; }));
  EXPECT_EQ(0U, queue.threads());
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
}

TEST(ElasticQueueTest, manyThreadsMayAddAndRemove)
{
  std::atomic<int> ran{ 0 };
  ElasticQueue queue(16);
  std::vector<std::thread> users;
  for (std::uint64_t owner = 1; owner <= 4; ++owner)
  {
    users.emplace_back([&queue, &ran, owner] {
      for (int i = 0; i < 500; ++i)
      {
        queue.addCallback(callback([&ran] { ++ran; }), owner);
        if (i % 50 == 49)
        {
          queue.removeByID(owner);
        }
      }
    });
  }
  for (std::thread& user : users)
  {
    user.join();
  }
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
  const int before = ran;
  for (std::uint64_t owner = 1; owner <= 4; ++owner)
  {
    queue.addCallback(callback([&ran] { ++ran; }), owner);
  }
  EXPECT_TRUE(queue.waitIdle(PATIENCE));
  EXPECT_EQ(before + 4, ran);
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus
