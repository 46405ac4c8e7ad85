// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/ros/trace_files.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
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
    dump.frames.push_back(
        { wire::FrameEvent::Kind::Request, dump.time - std::chrono::microseconds(1500), { 1, 0xAB } });
    dump.frames.push_back({ wire::FrameEvent::Kind::Reply, dump.time, { 1, 3 } });
    return dump;
  }

  const fs::path directory_;
  std::vector<std::string> warnings_;
  TraceFiles::Warn warn_ = [this](const std::string& text) { warnings_.push_back(text); };
};

TEST_F(TraceFilesTest, aFileHoldsTheFramesWithTheirTimes)
{
  TraceFiles traces(directory_.string(), "/cell/bus", warn_);
  std::string error;
  const fs::path path = traces.write(dump("belt_1 trip"), error);
  EXPECT_EQ(directory_, path.parent_path());
  EXPECT_THAT(path.filename().string(), testing::StartsWith("cell_bus-"));
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("belt_1 trip"));
  EXPECT_THAT(text.str(), HasSubstr("request   01 AB"));
  EXPECT_THAT(text.str(), HasSubstr("+1500  reply     01 03"));
}

TEST_F(TraceFilesTest, aReasonCannotLeaveTheDirectory)
{
  TraceFiles traces(directory_.string(), "/bus", warn_);
  std::string error;
  const fs::path path = traces.write(dump("../../etc/passwd\n/x"), error);
  EXPECT_EQ(directory_, path.parent_path());
  EXPECT_THAT(path.filename().string(), Not(HasSubstr("..")));
}

TEST_F(TraceFilesTest, aNameOfTheNodeCannotLeaveTheDirectory)
{
  for (const char* name : { "/../../etc/x", "/a/../..", "/\xC3\xA4", "/..", "/" })
  {
    TraceFiles traces(directory_.string(), name, warn_);
    std::string error;
    const fs::path path = traces.write(dump("x"), error);
    EXPECT_EQ(directory_, path.parent_path()) << name;
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path))) << name;
  }
}

TEST_F(TraceFilesTest, nobodyElseMayWriteAFile)
{
  TraceFiles traces(directory_.string(), "/bus", warn_);
  std::string error;
  const fs::perms perms = fs::status(traces.write(dump("x"), error)).permissions();
  const fs::perms forbidden = fs::perms::group_write | fs::perms::others_write | fs::perms::owner_exec;
  EXPECT_EQ(fs::perms::none, perms & forbidden);
}

TEST_F(TraceFilesTest, aFileWithANodesNameThatIsNoTraceOfItIsKept)
{
  TraceFiles traces(directory_.string(), "/bus", warn_);
  fs::create_directories(directory_);
  std::ofstream(directory_ / "bus-1st-notes.txt") << "the user's own";
  std::string error;
  for (int i = 0; i < 52; ++i)
  {
    traces.write(dump("x"), error);
  }
  EXPECT_TRUE(fs::exists(directory_ / "bus-1st-notes.txt"));
}

TEST_F(TraceFilesTest, theNewestFiftyOfANodeAreKept)
{
  TraceFiles traces(directory_.string(), "/bus", warn_);
  fs::create_directories(directory_);
  std::ofstream(directory_ / "other-1.txt") << "of another node";
  std::string error;
  const std::string first = traces.write(dump("x"), error);
  std::string last;
  for (int i = 0; i < 54; ++i)
  {
    last = traces.write(dump("x"), error);
  }
  EXPECT_EQ(51U, files());
  EXPECT_FALSE(fs::exists(first));
  EXPECT_TRUE(fs::exists(last));
  EXPECT_TRUE(fs::exists(directory_ / "other-1.txt"));
}

TEST_F(TraceFilesTest, oneFileInTenSecondsIsWrittenByItself)
{
  TraceFiles traces(directory_.string(), "/bus", warn_);
  traces.writeSoon(dump("trip"));
  traces.writeSoon(dump("offline"));
  traces.stop();
  EXPECT_EQ(1U, files());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(TraceFilesTest, aFailureIsAWarningThatSaysWhatToDo)
{
  TraceFiles traces("/proc/nowhere", "/bus", warn_);
  traces.writeSoon(dump("trip"));
  traces.stop();
  ASSERT_EQ(1U, warnings_.size());
  EXPECT_THAT(warnings_[0], HasSubstr("/proc/nowhere"));
  EXPECT_THAT(warnings_[0], HasSubstr("trace_directory"));
}

TEST(ExpandHomeTest, aTildeInFrontIsTheHomeFolder)
{
  const std::string home = std::getenv("HOME");
  EXPECT_EQ(home + "/.ros/x", expandHome("~/.ros/x"));
  EXPECT_EQ(home, expandHome("~"));
  EXPECT_EQ("/a/~/b", expandHome("/a/~/b"));
  EXPECT_EQ("~user/x", expandHome("~user/x"));
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus
