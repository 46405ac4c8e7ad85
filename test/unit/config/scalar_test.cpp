// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Scalars as PyYAML's SafeLoader and rosparam read them. The expected values are those of YAML 1.1 (yaml.org/type) with the forms
// of PyYAML's resolver; test/peers/rosparam_test.py compares with the real ones.
#include "config/scalar.h"

#include <clocale>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace inverter_bus
{
namespace config
{
namespace
{
using testing::HasSubstr;
using testing::Not;
using Type = Scalar::Type;

constexpr double PI = 3.14159265358979323846;

struct Case
{
  Case(std::string written, Type kind, double value = 0.0, std::string why = "")
    : text(std::move(written)), type(kind), number(value), trap(std::move(why))
  {
  }

  std::string text;
  Type type;
  double number;     // truth values: 0, 1
  std::string trap;  // part of it; empty: none
};

std::ostream& operator<<(std::ostream& stream, const Case& one)
{
  return stream << "'" << one.text << "'";
}

class ScalarTest : public testing::TestWithParam<Case>
{
};

TEST_P(ScalarTest, isWhatRosparamMakesOfIt)
{
  const Case& wanted = GetParam();
  const Scalar scalar = readScalar(wanted.text);
  ASSERT_EQ(static_cast<int>(wanted.type), static_cast<int>(scalar.type));
  EXPECT_EQ(wanted.text, scalar.text);
  EXPECT_EQ(wanted.trap.empty(), scalar.trap.empty()) << scalar.trap;
  EXPECT_THAT(scalar.trap, HasSubstr(wanted.trap));
  switch (wanted.type)
  {
    case Type::Boolean:
      EXPECT_EQ(wanted.number != 0.0, scalar.boolean);
      break;
    case Type::Integer:
      EXPECT_EQ(static_cast<std::int64_t>(wanted.number), scalar.integer);
      EXPECT_DOUBLE_EQ(wanted.number, scalar.number);
      break;
    case Type::Number:
      EXPECT_DOUBLE_EQ(wanted.number, scalar.number);
      break;
    default:
      break;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Words, ScalarTest,
    testing::Values(Case{ "", Type::None }, Case{ "~", Type::None }, Case{ "null", Type::None },
                    Case{ "Null", Type::None }, Case{ "NULL", Type::None }, Case{ "nULL", Type::Text },
                    Case{ "yes", Type::Boolean, 1 }, Case{ "Yes", Type::Boolean, 1 }, Case{ "YES", Type::Boolean, 1 },
                    Case{ "on", Type::Boolean, 1 }, Case{ "ON", Type::Boolean, 1 }, Case{ "true", Type::Boolean, 1 },
                    Case{ "True", Type::Boolean, 1 }, Case{ "no", Type::Boolean, 0 }, Case{ "No", Type::Boolean, 0 },
                    Case{ "off", Type::Boolean, 0 }, Case{ "Off", Type::Boolean, 0 }, Case{ "FALSE", Type::Boolean, 0 },
                    Case{ "y", Type::Text }, Case{ "n", Type::Text }, Case{ "nO", Type::Text },
                    Case{ "tRUE", Type::Text }, Case{ "none", Type::Text }, Case{ "/dev/ttyUSB0", Type::Text },
                    Case{ "tcp://host:502", Type::Text }, Case{ "=", Type::Text, 0, "in quotes" },
                    Case{ "<<", Type::Text, 0, "in quotes" }, Case{ "2026-11-29", Type::Text, 0, "date" },
                    Case{ "2026-11-29 10:00:00", Type::Text, 0, "date" }, Case{ "2026-1-9", Type::Text }));

INSTANTIATE_TEST_SUITE_P(
    WholeNumbers, ScalarTest,
    testing::Values(Case{ "0", Type::Integer, 0 }, Case{ "-0", Type::Integer, 0 }, Case{ "1", Type::Integer, 1 },
                    Case{ "+5", Type::Integer, 5 }, Case{ "-12", Type::Integer, -12 }, Case{ "1_0", Type::Integer, 10 },
                    Case{ "1__0", Type::Integer, 10 }, Case{ "_1", Type::Text }, Case{ "0x01", Type::Integer, 1 },
                    Case{ "0x1F", Type::Integer, 31 }, Case{ "-0x1f", Type::Integer, -31 },
                    Case{ "0x1_0", Type::Integer, 16 }, Case{ "0X1F", Type::Text }, Case{ "0xG", Type::Text },
                    Case{ "0x_", Type::Integer, 0, "not a number" }, Case{ "0b101", Type::Integer, 5 },
                    Case{ "0o10", Type::Text }, Case{ "08", Type::Text }, Case{ "09", Type::Text },
                    Case{ "010", Type::Integer, 8, "8 or 10" }, Case{ "0100", Type::Integer, 64, "64 or 100" },
                    Case{ "-010", Type::Integer, -8, "-8 or -10" }, Case{ "007", Type::Integer, 7, "allowed: 7" },
                    Case{ "00", Type::Integer, 0, "allowed: 0" }, Case{ "1:30", Type::Integer, 90, "is 90" },
                    Case{ "1:2:3", Type::Integer, 3723, "is 3723" }, Case{ "-1:30", Type::Integer, -90, "is -90" },
                    Case{ "1:60", Type::Text }, Case{ "0:30", Type::Text }, Case{ "1,000", Type::Text },
                    Case{ "2147483648", Type::Integer, 2147483648.0 }, Case{ "00_", Type::Integer, 0, "leading zeros" },
                    Case{ "0_", Type::Integer, 0, "leading zeros" },
                    Case{ "99999999999999999999", Type::Number, 99999999999999999999.0, "more than 64 bits" }));

INSTANTIATE_TEST_SUITE_P(
    Numbers, ScalarTest,
    testing::Values(Case{ "1.0", Type::Number, 1.0 }, Case{ "1.", Type::Number, 1.0 }, Case{ ".5", Type::Number, 0.5 },
                    Case{ "+.5", Type::Text }, Case{ "-.5", Type::Text }, Case{ "-0.5", Type::Number, -0.5 },
                    Case{ "09.5", Type::Number, 9.5 }, Case{ "1_0.2_5", Type::Number, 10.25 },
                    Case{ "1.0e+2", Type::Number, 100.0 }, Case{ "1.e+3", Type::Number, 1000.0 },
                    Case{ "2.5E-3", Type::Number, 0.0025 }, Case{ ".5e+1", Type::Number, 5.0 },
                    Case{ "1e2", Type::Text }, Case{ "1e+2", Type::Text }, Case{ "5e-3", Type::Text },
                    Case{ "1.0e2", Type::Text }, Case{ ".", Type::Text }, Case{ "-", Type::Text },
                    Case{ "._5", Type::Text }, Case{ ".inf", Type::Number, std::numeric_limits<double>::infinity() },
                    Case{ "-.INF", Type::Number, -std::numeric_limits<double>::infinity() }, Case{ "inf", Type::Text },
                    Case{ "1.0e+999", Type::Number, std::numeric_limits<double>::infinity() },
                    Case{ "1:30.5", Type::Number, 90.5, "90.5" }, Case{ "nan", Type::Text }));

INSTANTIATE_TEST_SUITE_P(
    Angles, ScalarTest,
    testing::Values(Case{ "rad(pi)", Type::Number, PI }, Case{ "rad(2*pi)", Type::Number, 2 * PI },
                    Case{ "rad( 2 * pi )", Type::Number, 2 * PI }, Case{ "rad(-pi/2)", Type::Number, -PI / 2 },
                    Case{ "rad(1.5)", Type::Number, 1.5 }, Case{ "rad(2**3)", Type::Number, 8.0 },
                    Case{ "rad(-2**2)", Type::Number, -4.0 }, Case{ "rad(1e3)", Type::Number, 1000.0 },
                    Case{ "rad(1+2*3)", Type::Number, 7.0 }, Case{ "rad((1+2)*3)", Type::Text },
                    Case{ "rad()", Type::Number, 0, "not an angle" },
                    Case{ "rad(1/0)", Type::Number, 0, "not an angle" },
                    Case{ "rad(exit)", Type::Number, 0, "not an angle" }, Case{ "rad(2", Type::Text },
                    Case{ "deg(90)", Type::Number, PI / 2 }, Case{ "deg(-90.0)", Type::Number, -PI / 2 },
                    Case{ "deg(9e1)", Type::Number, PI / 2 }, Case{ "deg(90-1)", Type::Number, 0, "not an angle" },
                    Case{ "deg(pi)", Type::Number, 0, "not an angle" }, Case{ "degrees(90)", Type::Text }));

TEST(Scalar, notANumberIsANumber)
{
  EXPECT_EQ(Type::Number, readScalar(".nan").type);
  EXPECT_TRUE(std::isnan(readScalar(".NaN").number));
  EXPECT_EQ(Type::Text, readScalar("-.nan").type);
}

TEST(Scalar, quotesMakeATextOfAnything)
{
  for (const char* text : { "1", "1.0", "yes", "", "010", "1:30", "rad(pi)", "2026-11-29", "<<" })
  {
    const Scalar scalar = readScalar(text, "!");
    EXPECT_EQ(Type::Text, scalar.type) << text;
    EXPECT_EQ("", scalar.trap) << text;
    EXPECT_TRUE(scalar.quoted);
  }
}

TEST(Scalar, tagsSayWhatItIs)
{
  const std::string yaml = "tag:yaml.org,2002:";
  EXPECT_EQ(Type::Text, readScalar("1", yaml + "str").type);
  EXPECT_EQ(3, readScalar("3", yaml + "int").integer);
  EXPECT_EQ(Type::Number, readScalar("3", yaml + "float").type);
  EXPECT_DOUBLE_EQ(100.0, readScalar("1e2", yaml + "float").number);
  EXPECT_TRUE(readScalar("YeS", yaml + "bool").boolean);
  EXPECT_EQ(Type::None, readScalar("x", yaml + "null").type);
  EXPECT_DOUBLE_EQ(2 * PI, readScalar("2*pi", "!radians").number);
  EXPECT_DOUBLE_EQ(9.0, readScalar("(1+2)*3", "!radians").number);
  EXPECT_DOUBLE_EQ(PI, readScalar("180", "!degrees").number);
  for (const auto& wrong :
       { readScalar("x", yaml + "int"), readScalar("x", yaml + "float"), readScalar("x", yaml + "bool"),
         readScalar("aGk=", yaml + "binary"), readScalar("1", "!mine"), readScalar("1.5", yaml + "int") })
  {
    EXPECT_THAT(wrong.trap, HasSubstr("allowed:"));
  }
}

TEST(Scalar, longTextsAreTexts)
{
  EXPECT_EQ(Type::Text, readScalar(std::string(300000, '1')).type);
  EXPECT_EQ("", hintFor(std::string(300000, '0')));
  EXPECT_FALSE(meantNumber(std::string(300000, '1') + "e5"));
}

TEST(Scalar, numbersThatPeopleMean)
{
  EXPECT_DOUBLE_EQ(100.0, meantNumber("1e2").value());
  EXPECT_DOUBLE_EQ(0.005, meantNumber("5e-3").value());
  EXPECT_DOUBLE_EQ(-1500.0, meantNumber("-1.5E3").value());
  EXPECT_DOUBLE_EQ(0.5, meantNumber("+.5").value());
  for (const char* text : { "08", "1", "1.0", "", "e5", "1e", "0x1e2", "01e2", "1e2 Hz", "one" })
  {
    EXPECT_FALSE(meantNumber(text)) << text;
  }
}

TEST(Scalar, hintsSayWhatToWrite)
{
  EXPECT_EQ("write 100.0", hintFor("1e2"));
  EXPECT_EQ("write 0.005", hintFor("5e-3"));
  EXPECT_THAT(hintFor("08"), HasSubstr("write 8,"));
  EXPECT_THAT(hintFor("-08"), HasSubstr("write -8,"));
  EXPECT_EQ("write 1 without quotes", hintFor("1"));
  EXPECT_EQ("write 0.5 without quotes", hintFor("0.5"));
  EXPECT_EQ("write true without quotes", hintFor("true"));
  EXPECT_EQ("write 0.5", hintFor("0,5"));
  EXPECT_EQ("write 8", hintFor("0o10"));
  EXPECT_EQ("", hintFor("one"));
  EXPECT_EQ("", hintFor(""));
}

TEST(Scalar, numbersAreWrittenSoThatEveryReaderTakesThemForTheSame)
{
  for (const double number : { 0.0, 1.0, 100.0, 0.005, 1e-10, 1e22, 0.1, 1.0 / 3.0, 1e300, -2.5e-7, 123456789.125 })
  {
    const Scalar again = readScalar(numberInYaml(number));
    EXPECT_EQ(Type::Number, again.type) << numberInYaml(number);
    EXPECT_EQ(number, again.number) << numberInYaml(number);
  }
  EXPECT_EQ("100.0", numberInYaml(100.0));
  EXPECT_EQ("1.0e-10", numberInYaml(1e-10));
  EXPECT_EQ(".inf", numberInYaml(std::numeric_limits<double>::infinity()));
  EXPECT_EQ("-.inf", numberInYaml(-std::numeric_limits<double>::infinity()));
  EXPECT_EQ(".nan", numberInYaml(std::nan("")));
}
}  // namespace
}  // namespace config
}  // namespace inverter_bus
