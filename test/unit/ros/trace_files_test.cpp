// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/trace_files.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class TraceFilesTest : public testing::Test
{
protected:
  TraceFilesTest() : directory_(fs::path(testing::TempDir()) / ("trace_files_test_" + std::to_string(getpid())))
  {
  }
  ~TraceFilesTest() override
  {
    fs::remove_all(directory_);
  }

  std::size_t files() const
  {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }

  static bus::TraceDump dump(const std::string& reason)
  {
    bus::TraceDump dump;
    dump.reason = reason;
    dump.time = std::chrono::steady_clock::now();
    dump.bytes = { 1, 0xAB, 1, 3 };
    dump.frames.push_back({ wire::FrameEvent::Kind::Request, dump.time - std::chrono::microseconds(1500), 0, 2 });
    dump.frames.push_back({ wire::FrameEvent::Kind::Reply, dump.time, 2, 2 });
    dump.events.push_back(bus::traceEvent(dump.time - std::chrono::microseconds(500), "belt_1: a stop\nis accepted"));
    dump.events.push_back(bus::traceEvent(dump.time + std::chrono::microseconds(3), std::string(500, 'x')));
    return dump;
  }

  const fs::path directory_;
  /// As if somebody asked every two seconds.
  std::string write(TraceFiles& traces, const std::string& reason)
  {
    std::string error;
    now_ += std::chrono::seconds(2);
    return traces.writeAsked([&reason] { return dump(reason); }, now_, error);
  }

  /// As the bus does it; each call has a reason of its own. Ends when the file is there.
  static std::string writeAutomatic(TraceFiles& traces, const std::string& reason)
  {
    traces.writeSoon(dump(reason));
    const TimePoint given_up = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!traces.last() || traces.last()->reason != reason)
    {
      if (std::chrono::steady_clock::now() > given_up)
      {
        ADD_FAILURE() << "no file for " << reason;
        return "";
      }
      std::this_thread::yield();
    }
    return traces.last()->path;
  }

  std::vector<std::string> lines(bus::Level level) const
  {
    std::vector<std::string> texts;
    for (const bus::Finding& finding : logged_)
    {
      if (finding.level == level)
      {
        texts.push_back(finding.text);
      }
    }
    return texts;
  }

  TimePoint now_;
  std::vector<bus::Finding> logged_;
  TraceFiles::Log log_ = [this](bus::Level level, const std::string& text) { logged_.push_back({ level, text }); };
};

TEST_F(TraceFilesTest, aFileHoldsTheFramesWithTheirTimes)
{
  TraceFiles traces(directory_.string(), "/cell/bus", log_);
  const fs::path path = write(traces, "belt_1 trip");
  EXPECT_EQ(directory_, path.parent_path());
  EXPECT_THAT(path.filename().string(), testing::StartsWith("cell.bus-"));
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("belt_1 trip"));
  EXPECT_THAT(text.str(), HasSubstr("request   01 AB"));
  EXPECT_THAT(text.str(), HasSubstr("2 frames, 2 events"));
  EXPECT_THAT(text.str(), HasSubstr("+500  reply     01 03"));
}

TEST_F(TraceFilesTest, eventsStandBetweenTheFramesInTheOrderOfTime)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  std::ostringstream text;
  text << std::ifstream(write(traces, "x")).rdbuf();
  const std::string file = text.str();
  EXPECT_THAT(file, HasSubstr("+1000  event     belt_1: a stop is accepted\n")) << "one line, whatever is in it";
  EXPECT_LT(file.find("request   01 AB"), file.find("event     belt_1"));
  EXPECT_LT(file.find("event     belt_1"), file.find("reply     01 03"));
  EXPECT_THAT(file, HasSubstr("+3  event     " + std::string(119, 'x') + "\n")) << "what is longer is cut off";
}

TEST_F(TraceFilesTest, aReasonCannotLeaveTheDirectory)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  const fs::path path = write(traces, "../../etc/passwd\n/x");
  EXPECT_EQ(directory_, path.parent_path());
  EXPECT_THAT(path.filename().string(), Not(HasSubstr("..")));
}

TEST_F(TraceFilesTest, aNameOfTheNodeCannotLeaveTheDirectory)
{
  for (const char* name : { "/../../etc/x", "/a/../..", "/\xC3\xA4", "/..", "/" })
  {
    TraceFiles traces(directory_.string(), name, log_);
    const fs::path path = write(traces, "x");
    EXPECT_EQ(directory_, path.parent_path()) << name;
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path))) << name;
  }
}

TEST_F(TraceFilesTest, nobodyElseMayWriteAFile)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  const fs::perms perms = fs::status(write(traces, "x")).permissions();
  const fs::perms forbidden = fs::perms::group_write | fs::perms::others_write | fs::perms::owner_exec;
  EXPECT_EQ(fs::perms::none, perms & forbidden);
}

TEST_F(TraceFilesTest, aFileWithANodesNameThatIsNoTraceOfItIsKept)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  fs::create_directories(directory_);
  std::ofstream(directory_ / "bus-1st-notes.txt") << "the user's own";
  for (int i = 0; i < 52; ++i)
  {
    write(traces, "x");
  }
  EXPECT_TRUE(fs::exists(directory_ / "bus-1st-notes.txt"));
}

TEST_F(TraceFilesTest, theNewestFiftyOfANodeAreKept)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  fs::create_directories(directory_);
  std::ofstream(directory_ / "other-1.txt") << "of another node";
  const std::string first = write(traces, "x");
  std::string last;
  for (int i = 0; i < 54; ++i)
  {
    last = write(traces, "x");
  }
  EXPECT_EQ(51U, files());
  EXPECT_FALSE(fs::exists(first));
  EXPECT_TRUE(fs::exists(last));
  EXPECT_TRUE(fs::exists(directory_ / "other-1.txt"));
}

TEST_F(TraceFilesTest, whatTheBusSendsIsWritten)
{
  // How often that is, the flight recorder decides.
  TraceFiles traces(directory_.string(), "/bus", log_);
  const std::string first = writeAutomatic(traces, "trip");
  EXPECT_NE(first, writeAutomatic(traces, "offline"));
  traces.stop();
  EXPECT_EQ(2U, files());
  EXPECT_TRUE(lines(bus::Level::Warn).empty());
}

TEST_F(TraceFilesTest, filesOfNodesWithSimilarNamesAreKeptApart)
{
  std::set<std::string> prefixes;
  const std::vector<std::string> names{ "/a/b", "/a_b", "/a/_b", "/a_/b", "/a__b", "/a/b/", "/a_b_", "/ab", "/A/b" };
  for (const std::string& name : names)
  {
    TraceFiles traces(directory_.string(), name, log_);
    const std::string file = fs::path(write(traces, "x")).filename().string();
    prefixes.insert(file.substr(0, file.find('-')));
  }
  EXPECT_EQ(names.size(), prefixes.size()) << testing::PrintToString(prefixes);
}

TEST_F(TraceFilesTest, aNodePushesOutNoFileOfAnotherWithASimilarName)
{
  TraceFiles other(directory_.string(), "/a_b", log_);
  const std::string kept = write(other, "x");
  TraceFiles traces(directory_.string(), "/a/b", log_);
  for (int i = 0; i < 52; ++i)
  {
    write(traces, "x");
  }
  EXPECT_TRUE(fs::exists(kept));
}

TEST_F(TraceFilesTest, theLongestNameOfANodeGivesAFile)
{
  TraceFiles traces(directory_.string(), "/" + std::string(300, 'n'), log_);
  EXPECT_TRUE(fs::exists(write(traces, std::string(300, 'r'))));
}

TEST_F(TraceFilesTest, aFailureIsAWarningThatSaysWhatToDo)
{
  TraceFiles traces("/proc/nowhere", "/bus", log_);
  traces.writeSoon(dump("trip"));
  traces.stop();
  EXPECT_THAT(lines(bus::Level::Warn),
              testing::ElementsAre(testing::AllOf(HasSubstr("/proc/nowhere"), HasSubstr("trace_directory"))));
  EXPECT_TRUE(lines(bus::Level::Ok).empty());
  EXPECT_FALSE(traces.last());
}

TEST_F(TraceFilesTest, whoAsksTwiceInASecondGetsTheSameFile)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  std::string error;
  int records = 0;
  const auto record = [&records] {
    ++records;
    return dump("dump_trace");
  };
  const std::string first = traces.writeAsked(record, now_, error);
  EXPECT_EQ(first, traces.writeAsked(record, now_ + std::chrono::milliseconds(999), error));
  EXPECT_EQ(1, records);
  EXPECT_NE(first, traces.writeAsked(record, now_ + std::chrono::milliseconds(1000), error));
  EXPECT_EQ(2U, files());
  EXPECT_EQ("", error);
}

TEST_F(TraceFilesTest, aFailureIsNotTakenForTheLastFile)
{
  TraceFiles traces("/proc/nowhere", "/bus", log_);
  std::string error;
  const auto record = [] { return dump("dump_trace"); };
  EXPECT_EQ("", traces.writeAsked(record, now_, error));
  error.clear();
  EXPECT_EQ("", traces.writeAsked(record, now_, error));
  EXPECT_THAT(error, HasSubstr("trace_directory"));
}

TEST_F(TraceFilesTest, whatWasAskedForDoesNotPushOutWhatHappened)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  std::vector<std::string> automatic;
  for (int trip = 0; trip < 3; ++trip)
  {
    automatic.push_back(writeAutomatic(traces, "asked-tripped " + std::to_string(trip)));
  }
  for (int times = 0; times < 60; ++times)
  {
    write(traces, "dump_trace");
  }
  EXPECT_EQ(53U, files());
  for (const std::string& path : automatic)
  {
    EXPECT_TRUE(fs::exists(path)) << path;
  }
}

TEST_F(TraceFilesTest, eachFileIsNamedInTheLogAndForDiagnostics)
{
  TraceFiles traces(directory_.string(), "/bus", log_);
  EXPECT_FALSE(traces.last());
  const std::string asked = write(traces, "dump_trace");
  EXPECT_EQ(asked, traces.last()->path);
  EXPECT_EQ("dump_trace", traces.last()->reason);
  traces.writeSoon(dump("belt\nwent offline"));
  traces.stop();
  EXPECT_EQ("belt went offline", traces.last()->reason);
  EXPECT_THAT(lines(bus::Level::Ok), testing::ElementsAre(HasSubstr(asked), HasSubstr(traces.last()->path)));
}

TEST(ExpandHomeTest, aTildeInFrontIsTheHomeFolder)
{
  unsetenv("ROS_HOME");
  const std::string home = std::getenv("HOME");
  EXPECT_EQ(home + "/.ros/x", expandHome("~/.ros/x"));
  EXPECT_EQ(home, expandHome("~"));
  EXPECT_EQ("/a/~/b", expandHome("/a/~/b"));
  EXPECT_EQ("~user/x", expandHome("~user/x"));
}

TEST(ExpandHomeTest, theFolderOfRosIsRosHome)
{
  const std::string home = std::getenv("HOME");
  setenv("ROS_HOME", "/var/lib/ros", 1);
  EXPECT_EQ("/var/lib/ros/inverter_bus", expandHome("~/.ros/inverter_bus"));
  EXPECT_EQ("/var/lib/ros", expandHome("~/.ros"));
  EXPECT_EQ(home + "/.rosette", expandHome("~/.rosette"));
  EXPECT_EQ(home + "/x", expandHome("~/x"));
  setenv("ROS_HOME", "", 1);
  EXPECT_EQ(home + "/.ros/inverter_bus", expandHome("~/.ros/inverter_bus"));
  unsetenv("ROS_HOME");
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus
