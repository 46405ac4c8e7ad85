// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/status_conversion.h"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
using std::chrono::milliseconds;

class StatusConversionTest : public testing::Test
{
protected:
  StatusConversionTest()
  {
    config_.name = "belt";
    config_.node = 7;
    config_.drive = "/home/user/test_drive.yaml";
    status_.has_stamp = true;
    status_.stamp = moment_.steady;
  }

  static drive::Drive drive()
  {
    drive::Profile profile;
    profile.name = "test_drive";
    profile.faults[9] = "undervoltage";
    return drive::Drive(profile);
  }

  InverterStatus convert() const
  {
    return toMessage(status_, config_, drive(), moment_);
  }

  void run(int direction, double frequency)
  {
    status_.monitor.running = true;
    status_.monitor.direction = direction;
    status_.monitor.output_frequency = frequency;
  }

  Moment moment_{ TimePoint(std::chrono::hours(1)), ros::Time(5000, 0) };
  bus::InverterConfig config_;
  bus::InverterStatus status_;
};

TEST_F(StatusConversionTest, whatTheDriveCannotTellIsNotANumberAndNotKnown)
{
  const InverterStatus message = convert();
  EXPECT_EQ(0U, message.known);
  EXPECT_TRUE(std::isnan(message.velocity));
  EXPECT_TRUE(std::isnan(message.output_frequency));
  EXPECT_TRUE(std::isnan(message.output_current));
  EXPECT_TRUE(std::isnan(message.output_voltage));
  EXPECT_TRUE(std::isnan(message.dc_voltage));
  EXPECT_TRUE(std::isnan(message.torque));
  EXPECT_TRUE(std::isnan(message.temperature));
  EXPECT_DOUBLE_EQ(0.0, message.commanded_velocity);
}

TEST_F(StatusConversionTest, everyFieldHasItsBit)
{
  drive::Monitor& monitor = status_.monitor;
  monitor.operation = monitor.running = monitor.ready = monitor.at_speed = monitor.at_set_frequency = true;
  monitor.overload_warning = monitor.pid_deviation = monitor.faulted = true;
  monitor.direction = 1;
  monitor.raw_status = 0x1234;
  monitor.fault_code = std::uint16_t{ 9 };
  monitor.warning_code = 0U;
  monitor.output_frequency = 50.0;
  monitor.output_current = 4.5;
  monitor.output_voltage = 230.0;
  monitor.dc_voltage = 325.0;
  monitor.torque = -12.0;
  monitor.temperature = 41.0;
  const InverterStatus message = convert();
  EXPECT_EQ(2U * InverterStatus::KNOWN_TEMPERATURE - 1U, message.known);
  EXPECT_TRUE(message.operation && message.running && message.ready && message.at_speed && message.at_set_frequency);
  EXPECT_TRUE(message.overload_warning && message.pid_deviation && message.faulted);
  EXPECT_EQ(0x1234U, message.raw_status);
  EXPECT_EQ(9, message.fault_code);
  EXPECT_EQ("undervoltage", message.fault_text);
  EXPECT_DOUBLE_EQ(4.5, message.output_current);
  EXPECT_DOUBLE_EQ(230.0, message.output_voltage);
  EXPECT_DOUBLE_EQ(325.0, message.dc_voltage);
  EXPECT_DOUBLE_EQ(-12.0, message.torque);
  EXPECT_DOUBLE_EQ(41.0, message.temperature);
}

TEST_F(StatusConversionTest, aStateThatTheProfileDoesNotKnowIsNamedAndNoTripIsClaimed)
{
  status_.monitor.unknown_trip = 7;
  const InverterStatus message = convert();
  EXPECT_FALSE(message.faulted);
  EXPECT_EQ(message.known & InverterStatus::KNOWN_FAULTED, 0U);
  EXPECT_EQ(message.fault_text.find("unknown state 7"), 0U) << message.fault_text;
}

TEST_F(StatusConversionTest, aFlagThatIsFalseIsKnown)
{
  status_.monitor.faulted = false;
  const InverterStatus message = convert();
  EXPECT_FALSE(message.faulted);
  EXPECT_EQ(InverterStatus::KNOWN_FAULTED, message.known);
}

TEST_F(StatusConversionTest, velocityIsInTheUsersUnit)
{
  config_.hz_per_unit = 2.5;
  run(-1, 20.0);
  const InverterStatus message = convert();
  EXPECT_DOUBLE_EQ(-8.0, message.velocity);
  EXPECT_EQ(InverterStatus::DIRECTION_REVERSE, message.direction);
  EXPECT_DOUBLE_EQ(20.0, message.output_frequency);
}

TEST_F(StatusConversionTest, aMirroredDriveIsSeenInTheUsersSense)
{
  config_.hz_per_unit = -2.0;
  run(-1, 20.0);
  const InverterStatus message = convert();
  EXPECT_DOUBLE_EQ(10.0, message.velocity);
  EXPECT_EQ(InverterStatus::DIRECTION_FORWARD, message.direction);
}

TEST_F(StatusConversionTest, atRestThereIsNoDirection)
{
  config_.hz_per_unit = -1.0;
  status_.monitor.running = false;
  status_.monitor.direction = 1;
  status_.monitor.output_frequency = 0.0;
  const InverterStatus message = convert();
  EXPECT_EQ(InverterStatus::DIRECTION_NONE, message.direction);
  EXPECT_NE(0U, message.known & InverterStatus::KNOWN_DIRECTION);
  EXPECT_DOUBLE_EQ(0.0, message.velocity);
  EXPECT_FALSE(std::signbit(message.velocity));
}

TEST_F(StatusConversionTest, aVelocityWithoutDirectionIsNotKnown)
{
  status_.monitor.output_frequency = 20.0;
  const InverterStatus message = convert();
  EXPECT_TRUE(std::isnan(message.velocity));
  EXPECT_EQ(InverterStatus::KNOWN_OUTPUT_FREQUENCY, message.known);
}

TEST_F(StatusConversionTest, whatAnOfflineDriveSaidLastIsNoStatus)
{
  run(1, 20.0);
  status_.communication_error = true;
  status_.stamp = moment_.steady - milliseconds(2500);
  const InverterStatus message = convert();
  EXPECT_TRUE(message.communication_error);
  EXPECT_EQ(0U, message.known);
  EXPECT_FALSE(message.running);
  EXPECT_TRUE(std::isnan(message.velocity));
  EXPECT_EQ(ros::Time(4997, 500000000), message.header.stamp);
}

TEST_F(StatusConversionTest, aDriveThatRefusesForTheMomentIsNoCommunicationErrorAndTellsNothing)
{
  run(1, 20.0);
  status_.communication_error = true;
  status_.refuses = true;
  const InverterStatus message = convert();
  EXPECT_FALSE(message.communication_error);
  EXPECT_EQ(0U, message.known);
  EXPECT_FALSE(message.running);
  EXPECT_TRUE(std::isnan(message.velocity));
}

TEST_F(StatusConversionTest, theStampIsTheArrivalInRosTime)
{
  status_.stamp = moment_.steady - milliseconds(20);
  EXPECT_EQ(ros::Time(4999, 980000000), convert().header.stamp);
}

TEST_F(StatusConversionTest, withoutAReplyThereIsNoStamp)
{
  status_.has_stamp = false;
  EXPECT_TRUE(convert().header.stamp.isZero());
}

TEST_F(StatusConversionTest, aStampBeforeTheBeginningOfRosTimeIsZero)
{
  moment_.ros = ros::Time(0, 0);
  status_.stamp = moment_.steady - milliseconds(1);
  EXPECT_TRUE(convert().header.stamp.isZero());
}

TEST_F(StatusConversionTest, theNodesOwnFieldsAreCopied)
{
  status_.run_command = status_.move_velocity_active = status_.reset_active = status_.stop_active = true;
  status_.locked = false;
  status_.error_id = 0xB005;
  status_.error_text = "locked";
  status_.commanded_velocity = -3.0;
  const InverterStatus message = convert();
  EXPECT_TRUE(message.run_command && message.move_velocity_active && message.reset_active && message.stop_active);
  EXPECT_FALSE(message.locked);
  EXPECT_EQ(InverterStatus::ERROR_LOCKED, message.error_id);
  EXPECT_EQ("locked", message.error_text);
  EXPECT_DOUBLE_EQ(-3.0, message.commanded_velocity);
  EXPECT_EQ("belt", message.name);
  EXPECT_EQ(7, message.node);
  EXPECT_EQ("test_drive", message.drive);
}

TEST(FaultConversionTest, whatTheDriveDoesNotKeepIsNotANumber)
{
  drive::FaultRecord record;
  record.code = 7;
  record.text = "overvoltage";
  record.dc_voltage = 400.0;
  const Fault message = toMessage(record);
  EXPECT_EQ(7, message.code);
  EXPECT_EQ("overvoltage", message.text);
  EXPECT_DOUBLE_EQ(400.0, message.dc_voltage);
  EXPECT_TRUE(std::isnan(message.output_frequency));
  EXPECT_TRUE(std::isnan(message.power_on_hours));
}

TEST(ErrorIdTest, theConstantsAreThoseOfTheBus)
{
  EXPECT_EQ(bus::ERROR_OUT_OF_RANGE, +InverterStatus::ERROR_OUT_OF_RANGE);
  EXPECT_EQ(bus::ERROR_OFFLINE, +InverterStatus::ERROR_OFFLINE);
  EXPECT_EQ(bus::ERROR_CANCELLED, +InverterStatus::ERROR_CANCELLED);
  EXPECT_EQ(bus::ERROR_SHUTTING_DOWN, +InverterStatus::ERROR_SHUTTING_DOWN);
  EXPECT_EQ(bus::ERROR_NOT_OFFERED, +InverterStatus::ERROR_NOT_OFFERED);
  EXPECT_EQ(bus::ERROR_LOCKED, +InverterStatus::ERROR_LOCKED);
  EXPECT_EQ(bus::ERROR_NOT_ARMED, +InverterStatus::ERROR_NOT_ARMED);
  EXPECT_EQ(wire::ERROR_TIMEOUT, +InverterStatus::ERROR_TIMEOUT);
  EXPECT_EQ(wire::ERROR_DAMAGED, +InverterStatus::ERROR_DAMAGED);
  EXPECT_EQ(wire::ERROR_PORT_LOST, +InverterStatus::ERROR_PORT_LOST);
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus
