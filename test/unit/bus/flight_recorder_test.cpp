// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The last 8,192 frames and 2,048 events (contract, section 4.11).

#include "bus/report/flight_recorder.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// Frame \p number, one per millisecond.
wire::FrameEvent frame(int number)
{
  return { wire::FrameEvent::Kind::Request,
           at(number),
           { static_cast<std::uint8_t>(number >> 8), static_cast<std::uint8_t>(number & 0xFF) } };
}

void record(FlightRecorder& recorder, int first, int count)
{
  for (int number = first; number < first + count; ++number)
  {
    recorder.add(frame(number));
  }
}

wire::Bytes bytesOf(const TraceDump& dump, std::size_t index)
{
  const TraceFrame& frame = dump.frames[index];
  const auto first = dump.bytes.begin() + static_cast<std::ptrdiff_t>(frame.first);
  return { first, first + static_cast<std::ptrdiff_t>(frame.size) };
}

TEST(FlightRecorder, isEmptyAtFirst)
{
  const FlightRecorder recorder;
  EXPECT_TRUE(recorder.dump("asked for", at(0)).frames.empty());
}

TEST(FlightRecorder, givesFramesOldestFirst)
{
  FlightRecorder recorder;
  record(recorder, 0, 3);
  const TraceDump dump = recorder.dump("asked for", at(50));
  ASSERT_EQ(dump.frames.size(), 3U);
  EXPECT_EQ(dump.frames[0].time, at(0));
  EXPECT_EQ(dump.frames[2].time, at(2));
  EXPECT_EQ(bytesOf(dump, 2), (wire::Bytes{ 0, 2 }));
  EXPECT_EQ(dump.reason, "asked for");
  EXPECT_EQ(dump.time, at(50));
}

TEST(FlightRecorder, keepsTheLast8192Frames)
{
  for (const int recorded : { 8192, 8193, 16383, 16384, 20001 })
  {
    FlightRecorder recorder;
    record(recorder, 0, recorded);
    const TraceDump dump = recorder.dump("", at(0));
    ASSERT_EQ(dump.frames.size(), 8192U) << recorded;
    for (int index = 0; index < 8192; ++index)
    {
      const int number = recorded - 8192 + index;
      ASSERT_EQ(dump.frames[static_cast<std::size_t>(index)].time, at(number)) << recorded;
      ASSERT_EQ(bytesOf(dump, static_cast<std::size_t>(index)), frame(number).bytes) << recorded;
    }
  }
}

TEST(FlightRecorder, keepsTheLast2048EventsBesideTheFrames)
{
  for (const int recorded : { 0, 1, 2048, 2049, 5000 })
  {
    FlightRecorder recorder;
    record(recorder, 0, 3);
    for (int number = 0; number < recorded; ++number)
    {
      recorder.add(traceEvent(at(number) + std::chrono::microseconds(7), "event " + std::to_string(number)));
    }
    const TraceDump dump = recorder.dump("", at(0));
    EXPECT_EQ(dump.frames.size(), 3U);
    const int kept = std::min(recorded, 2048);
    ASSERT_EQ(dump.events.size(), static_cast<std::size_t>(kept));
    for (int index = 0; index < kept; ++index)
    {
      const TraceEvent& event = dump.events[static_cast<std::size_t>(index)];
      const int number = recorded - kept + index;
      ASSERT_EQ(event.time, at(number) + std::chrono::microseconds(7));
      ASSERT_EQ(std::string(event.text.data()), "event " + std::to_string(number));
    }
  }
}

TEST(FlightRecorder, framesOfTheLongestKindAllHaveRoom)
{
  // 16 registers: a request of 8 bytes, a reply of 37.
  FlightRecorder recorder;
  for (int number = 0; number < 10000; ++number)
  {
    wire::FrameEvent event = frame(number);
    event.bytes.resize(number % 2 == 0 ? 8 : 37, static_cast<std::uint8_t>(number));
    recorder.add(event);
  }
  EXPECT_EQ(recorder.dump("", at(0)).frames.size(), 8192U);
}

TEST(FlightRecorder, ofFramesThatAreTooLongForItTheNewestStay)
{
  FlightRecorder recorder(5);  // room for 200 bytes
  for (int number = 0; number < 9; ++number)
  {
    wire::FrameEvent event = frame(number);
    event.bytes.assign(90, static_cast<std::uint8_t>(number));
    recorder.add(event);
  }
  TraceDump dump = recorder.dump("", at(0));
  ASSERT_EQ(dump.frames.size(), 2U);
  EXPECT_EQ(bytesOf(dump, 0), wire::Bytes(90, 7));
  EXPECT_EQ(bytesOf(dump, 1), wire::Bytes(90, 8));

  wire::FrameEvent longest = frame(9);
  longest.bytes.assign(300, 9);
  recorder.add(longest);
  dump = recorder.dump("", at(0));
  ASSERT_EQ(dump.frames.size(), 1U);
  EXPECT_EQ(bytesOf(dump, 0), wire::Bytes(200, 9));
  recorder.add(frame(10));
  dump = recorder.dump("", at(0));
  ASSERT_EQ(dump.frames.size(), 1U);
  EXPECT_EQ(bytesOf(dump, 0), frame(10).bytes);
}

TEST(FlightRecorder, dumpLeavesTheRecordAsItIs)
{
  FlightRecorder recorder(5);
  record(recorder, 0, 7);
  recorder.dump("", at(0));
  recorder.add(frame(7));
  const TraceDump dump = recorder.dump("", at(0));
  ASSERT_EQ(dump.frames.size(), 5U);
  EXPECT_EQ(dump.frames.front().time, at(3));
  EXPECT_EQ(dump.frames.back().time, at(7));
}

TEST(FlightRecorder, keepsStampsToTheMicrosecond)
{
  FlightRecorder recorder;
  wire::FrameEvent event = frame(1);
  event.time += std::chrono::microseconds(7);
  event.kind = wire::FrameEvent::Kind::Late;
  recorder.add(event);
  const TraceDump dump = recorder.dump("", at(0));
  EXPECT_EQ(dump.frames.front().time, at(1) + std::chrono::microseconds(7));
  EXPECT_EQ(dump.frames.front().kind, wire::FrameEvent::Kind::Late);
}

TEST(FlightRecorder, dumpsByItselfAtMostOnceInTenSeconds)
{
  FlightRecorder recorder;
  record(recorder, 0, 2);
  const auto first = recorder.automaticDump("belt tripped", at(0));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->reason, "belt tripped");
  EXPECT_EQ(first->frames.size(), 2U);
  EXPECT_FALSE(recorder.automaticDump("lift tripped", at(1)));
  EXPECT_FALSE(recorder.automaticDump("lift tripped", at(9999)));
  EXPECT_TRUE(recorder.automaticDump("lift tripped", at(10000)));
}

TEST(FlightRecorder, dumpThatWasHeldBackDoesNotStartTheTenSecondsAgain)
{
  FlightRecorder recorder;
  recorder.automaticDump("", at(0));
  recorder.automaticDump("", at(9000));
  EXPECT_TRUE(recorder.automaticDump("", at(10000)));
}

TEST(FlightRecorder, dumpOnRequestIsNeverHeldBackAndHoldsNoneBack)
{
  FlightRecorder recorder;
  record(recorder, 0, 1);
  recorder.automaticDump("", at(0));
  EXPECT_EQ(recorder.dump("asked for", at(10)).frames.size(), 1U);
  EXPECT_EQ(recorder.dump("asked for", at(9999)).frames.size(), 1U);
  EXPECT_TRUE(recorder.automaticDump("", at(10000)));
}

TEST(FlightRecorder, dumpFromAnotherThreadIsInOrder)
{
  FlightRecorder recorder(100);
  std::atomic<bool> done{ false };
  std::thread writer([&] {
    record(recorder, 0, 20000);
    done = true;
  });
  do
  {
    const TraceDump dump = recorder.dump("", at(0));
    for (std::size_t index = 1; index < dump.frames.size(); ++index)
    {
      EXPECT_EQ(dump.frames[index].time, dump.frames[index - 1].time + Ms(1));
    }
  } while (!done);
  writer.join();
  EXPECT_EQ(recorder.dump("", at(0)).frames.back().time, at(19999));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
