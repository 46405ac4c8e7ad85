// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/command_line.h"

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
using testing::HasSubstr;

const std::string USAGE = "usage: some_node\n";

TEST(CommandLineTest, rosArgumentsStartTheNode)
{
  EXPECT_FALSE(judgeCommandLine({}, USAGE));
  EXPECT_FALSE(
      judgeCommandLine({ "__name:=line", "__log:=/tmp/x.log", "_retries:=2", "/a/command:=/b/command", "c:=" }, USAGE));
}

TEST(CommandLineTest, helpIsShownWhereverItStands)
{
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           { "--help" }, { "-h" }, { "__name:=line", "--help" }, { "--nonsense", "-h" } })
  {
    const auto answer = judgeCommandLine(arguments, USAGE);
    ASSERT_TRUE(answer);
    EXPECT_EQ(0, answer->status);
    EXPECT_EQ(USAGE, answer->text);
  }
}

TEST(CommandLineTest, anythingElseIsRefusedAndNamed)
{
  for (const std::string wrong : { "--port=/dev/ttyUSB0", "-v", "--", "scan_list.yaml", "", ":=x", "--name:=x" })
  {
    const auto answer = judgeCommandLine({ "__name:=line", wrong }, USAGE);
    ASSERT_TRUE(answer) << wrong;
    EXPECT_EQ(2, answer->status);
    EXPECT_THAT(answer->text, HasSubstr("'" + wrong + "'"));
    EXPECT_THAT(answer->text, HasSubstr(USAGE));
  }
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus
