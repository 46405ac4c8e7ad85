// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/connections.h"

#include <string>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
boost::shared_ptr<ros::M_string> connect(const std::string& name, bool latching)
{
  auto header = boost::make_shared<ros::M_string>();
  (*header)["callerid"] = name;
  (*header)["latching"] = latching ? "1" : "0";
  return header;
}

TEST(ConnectionsTest, onlyTheFirstMessageOfAConnectionIsTheFirst)
{
  Connections connections;
  const auto header = connect("/teleop", true);
  const bus::Publisher first = connections.identify(header);
  EXPECT_EQ("/teleop", first.name);
  EXPECT_TRUE(first.latched);
  EXPECT_TRUE(first.first_on_connection);
  EXPECT_FALSE(connections.identify(header).first_on_connection);
}

TEST(ConnectionsTest, aNewConnectionOfTheSameNodeBeginsAnew)
{
  Connections connections;
  connections.identify(connect("/teleop", false));
  const bus::Publisher again = connections.identify(connect("/teleop", false));
  EXPECT_TRUE(again.first_on_connection);
  EXPECT_FALSE(again.latched);
}

TEST(ConnectionsTest, whoWasThereBeforeIsKnownForItsFirstConnectionOnly)
{
  Connections connections;
  connections.setThereBefore({ "/teleop" });
  const auto header = connect("/teleop", true);
  EXPECT_TRUE(connections.identify(header).before_start);
  EXPECT_TRUE(connections.identify(header).before_start);
  EXPECT_FALSE(connections.identify(connect("/teleop", true)).before_start);
  EXPECT_FALSE(connections.identify(connect("/planner", true)).before_start);
}

TEST(ConnectionsTest, withoutAHeaderNothingIsKnown)
{
  Connections connections;
  EXPECT_EQ("", connections.identify(boost::shared_ptr<ros::M_string>()).name);
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus
