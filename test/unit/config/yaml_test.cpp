// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Documents: merge keys, duplicates, places, and what the parameter server can't carry.
#include "config/yaml.h"

#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace inverter_bus
{
namespace config
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

/// Every complaint as "line path: what", one line each.
class Mistakes : public Complaints
{
public:
  void complain(const Spot& spot, const std::string& what) override
  {
    text += spot.place + " " + spot.path + ": " + what + "\n";
  }
  std::string text;
};

/// The parameters that \p text makes; fails where it has mistakes.
Value parameters(const std::string& text)
{
  Mistakes mistakes;
  const auto tree = readYaml(text, "", Purpose::Parameters, mistakes);
  EXPECT_EQ("", mistakes.text) << text;
  return tree.value_or(Value());
}

/// What is wrong with \p text as a scan list.
std::string mistakes(const std::string& text)
{
  Mistakes mistakes;
  readYaml(text, "", Purpose::Parameters, mistakes);
  return mistakes.text;
}

/// The value at \p key, which must be there.
const Value& at(const Value& map, const std::string& key)
{
  static const Value NONE;
  const Value* found = map.find(key);
  EXPECT_NE(nullptr, found) << key;
  return found == nullptr ? NONE : *found;
}

const char* const BASE = "base: &base {a: 1, b: 2}\nother: &other {b: 3, c: 4}\n";

TEST(YamlMerge, takesWhatTheMapItselfDoesNotSay)
{
  const Value value = parameters(std::string(BASE) + "map: {<<: *base, b: 7}\nlater: {b: 7, <<: *base}\n");
  for (const char* name : { "map", "later" })
  {
    const Value& map = at(value, name);
    EXPECT_EQ(2U, map.map.size());
    EXPECT_EQ(1, at(map, "a").integer);
    EXPECT_EQ(7, at(map, "b").integer) << name;
  }
}

TEST(YamlMerge, ofSeveralMapsTheFirstWins)
{
  const Value map = at(parameters(std::string(BASE) + "map: {<<: [*base, *other]}\n"), "map");
  EXPECT_EQ(1, at(map, "a").integer);
  EXPECT_EQ(2, at(map, "b").integer);
  EXPECT_EQ(4, at(map, "c").integer);
}

TEST(YamlMerge, goesThroughMapsThatMergeThemselves)
{
  const Value map =
      at(parameters(std::string(BASE) + "middle: &middle {<<: *base, d: 5}\nmap: {<<: *middle}\n"), "map");
  EXPECT_EQ(3U, map.map.size());
  EXPECT_EQ(5, at(map, "d").integer);
}

TEST(YamlMerge, doesNotReplaceMapsInside)
{
  const Value map = at(parameters("base: &base {in: {a: 1}}\nmap: {<<: *base, in: {b: 2}}\n"), "map");
  EXPECT_EQ(nullptr, at(map, "in").find("a"));
}

TEST(YamlMerge, inQuotesIsAKeyLikeAnyOther)
{
  EXPECT_EQ(5, at(at(parameters("map: {'<<': 5}\n"), "map"), "<<").integer);
}

TEST(YamlMerge, ofSomethingElseIsRefused)
{
  EXPECT_THAT(mistakes("map: {<<: 5}\n"), AllOf(HasSubstr("map.<<"), HasSubstr("allowed: *NAME")));
  EXPECT_THAT(mistakes(std::string(BASE) + "map: {<<: [*base, 5]}\n"), HasSubstr("3 map.<<"));
  EXPECT_THAT(mistakes("a: &a {<<: *a}\n"), HasSubstr("nested too deeply"));
  EXPECT_THAT(mistakes(std::string(BASE) + "map: {<<: *base, <<: *other}\n"), HasSubstr("duplicate key"));
}

TEST(YamlDocument, aKeyStandsOnce)
{
  EXPECT_THAT(mistakes("node: 2\nnode: 3\n"), HasSubstr("2 node: duplicate key"));
  EXPECT_THAT(mistakes("list:\n  - {a: 1, b: 2, a: 3}\n"), HasSubstr("2 list[0].a: duplicate key"));
  EXPECT_THAT(mistakes("{0x21: 1, '33': 2}\n"), HasSubstr("duplicate key"));
}

TEST(YamlDocument, whatNotEverybodyReadsAlikeIsRefusedWithItsPlace)
{
  EXPECT_THAT(mistakes("scan_list:\n  - node: 010\n"), AllOf(HasSubstr("2 scan_list[0].node"), HasSubstr("8 or 10")));
  EXPECT_THAT(mistakes("retries: 1:30\n"), AllOf(HasSubstr("1 retries"), HasSubstr("is 90")));
  EXPECT_THAT(mistakes("name: 2026-11-29\n"), HasSubstr("1 name: value '2026-11-29' is a date"));
  EXPECT_THAT(mistakes("a: 1\n---\nb: 2\n"), HasSubstr("several YAML documents"));
  EXPECT_THAT(mistakes("a: !mine 5\n"), HasSubstr("tag !mine"));
  EXPECT_THAT(mistakes("a: !!set {x, y}\n"), HasSubstr("has the tag"));
}

TEST(YamlDocument, everyMistakeIsFound)
{
  EXPECT_THAT(mistakes("a: 010\nb: 1:30\nc: 1\nc: 2\n"), AllOf(HasSubstr("1 a"), HasSubstr("2 b"), HasSubstr("4 c")));
}

TEST(YamlDocument, whatIsNoYamlHasALine)
{
  EXPECT_THAT(mistakes("a: 1\nb: [\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(mistakes("a: 1\nb: *nobody\n"), AllOf(HasSubstr("2 "), HasSubstr("not valid YAML")));
  EXPECT_THAT(mistakes(""), HasSubstr("is empty"));
  EXPECT_THAT(mistakes("# nothing but this\n"), HasSubstr("is empty"));
  EXPECT_THAT(mistakes("a: b\x01\n"), AllOf(HasSubstr("1 "), HasSubstr("control character")));
  EXPECT_THAT(mistakes("a: 1\nb: \xFF\n"), AllOf(HasSubstr("2 "), HasSubstr("not UTF-8")));
}

TEST(YamlDocument, tabsStandInTextsAndCommentsOnly)
{
  EXPECT_THAT(mistakes("a: 1\nport:\t/dev/ttyS0\n"), AllOf(HasSubstr("2 "), HasSubstr("tab")));
  EXPECT_THAT(mistakes("a: 1\t\n"), HasSubstr("tab"));
  EXPECT_THAT(mistakes("\ta: 1\n"), HasSubstr("tab"));
  EXPECT_THAT(mistakes("a: 1\t# why\n"), HasSubstr("tab"));
  EXPECT_THAT(mistakes("a: [1,\t2]\n"), HasSubstr("tab"));
  EXPECT_THAT(mistakes("a: it's\tit\n"), HasSubstr("tab"));
  EXPECT_THAT(mistakes("a: |\n  x\ty\nb:\t1\n"), AllOf(HasSubstr("3 "), HasSubstr("tab")));
  EXPECT_THAT(mistakes("- a: |\n    x\ty\n  b:\t1\n"), AllOf(HasSubstr("3 "), HasSubstr("tab")));
  for (const char* good : { "a: 1 #\twhy\n", "#\twhy\na: 1\n", "a: 'x\ty'\n", "a: \"x\ty\"\n", "a: 'it''s\t'\n",
                            "a: |\n  x\ty\nb: 1\n", "a: !!str 'x\ty'\n", "a: [\"x\ty\", 'z\t']\n", "a: \"\\\"\t\"\n" })
  {
    EXPECT_EQ("", mistakes(good)) << good;
  }
}

TEST(YamlDocument, quotesEnd)
{
  EXPECT_THAT(mistakes("a: 1\nb: 'x\nc: 2\n"), AllOf(HasSubstr("2 "), HasSubstr("never closed")));
  EXPECT_THAT(mistakes("a: \"x\\\"\n"), HasSubstr("never closed"));
  EXPECT_EQ("", mistakes("a: it's\n"));
  EXPECT_EQ("", mistakes("a: x\n  'y\n  \"z\nb: 1\n"));
  EXPECT_EQ("", mistakes("# it's \"\na: 1 # '\n"));
}

TEST(YamlDocument, linesOfWindowsAndAByteOrderMarkAreFine)
{
  EXPECT_EQ(2, at(parameters("\xEF\xBB\xBF"
                             "a: 1\r\nb: 2\r\n"),
                  "b")
                   .integer);
}

TEST(YamlParameters, onlyWhatRoslaunchCanLoad)
{
  EXPECT_THAT(mistakes("parity:\n"), AllOf(HasSubstr("1 parity"), HasSubstr("no value"), HasSubstr("allowed:")));
  EXPECT_THAT(mistakes("scan_list: #00000006\n"), AllOf(HasSubstr("scan_list"), HasSubstr("# begins a comment")));
  EXPECT_THAT(mistakes("list: [1, ~]\n"), HasSubstr("1 list[1]"));
  EXPECT_THAT(mistakes("faults:\n  table: {99: x}\n"),
              AllOf(HasSubstr("2 faults.table.99"), HasSubstr("'99' in quotes")));
  EXPECT_THAT(mistakes("{on: 1}\n"), HasSubstr("'on' in quotes"));
  EXPECT_THAT(mistakes("scan_list: 2147483648\n"), AllOf(HasSubstr("more than 32 bits"), HasSubstr("'0x80000002'")));
  EXPECT_EQ("", mistakes("faults: {table: {'99': x}}\nscan_list: -2147483646\n"));
}

TEST(YamlParameters, haveTheTypesOfTheParameterServer)
{
  const Value map = parameters("{a: 1, b: 1.0, c: '1', d: yes, e: 0x10, f: 1e3, g: text, h: [1, x], i: {j: off}}\n");
  EXPECT_EQ(Value::Type::Integer, at(map, "a").type);
  EXPECT_EQ(Value::Type::Number, at(map, "b").type);
  EXPECT_EQ(Value::Type::Text, at(map, "c").type);
  EXPECT_TRUE(at(map, "d").boolean);
  EXPECT_EQ(16, at(map, "e").integer);
  EXPECT_EQ(Value::Type::Text, at(map, "f").type);
  EXPECT_EQ("text", at(map, "g").text);
  EXPECT_EQ("x", at(map, "h").list.at(1).text);
  EXPECT_FALSE(at(at(map, "i"), "j").boolean);
}

TEST(YamlParameters, areSortedAsTheParameterServerHasThem)
{
  const Value map = parameters("{b: 1, a: 2}\n");
  EXPECT_EQ("a", map.map.at(0).key);
  Mistakes none;
  EXPECT_EQ("b", readYaml("{b: 1, a: 2}\n", "", Purpose::Profile, none).value_or(Value()).map.at(0).key);
}

TEST(YamlPlaces, areThoseOfTheKeys)
{
  Mistakes none;
  const auto tree = readYaml("a: 1\nb:\n  c: [2,\n    3]\nd:\n", "some.yaml", Purpose::Profile, none);
  ASSERT_TRUE(tree.has_value());
  EXPECT_EQ("some.yaml:1", tree->place);
  EXPECT_EQ("some.yaml:2", at(*tree, "b").place);
  EXPECT_EQ("some.yaml:3", at(at(*tree, "b"), "c").place);
  EXPECT_EQ("some.yaml:4", at(at(*tree, "b"), "c").list.at(1).place);
  EXPECT_EQ("some.yaml:5", at(*tree, "d").place);
  EXPECT_EQ("", none.text);
}

TEST(YamlTextFile, saysWhyItCantBeRead)
{
  const auto mistake_in = [](const std::string& path) {
    Mistakes mistakes;
    EXPECT_FALSE(readYamlFile(path, Purpose::Profile, mistakes).has_value());
    return mistakes.text;
  };
  EXPECT_THAT(mistake_in("/nonexistent/file.yaml"), HasSubstr("/nonexistent/file.yaml : cannot be read: No such file"));
  EXPECT_THAT(mistake_in("/"), HasSubstr("not a regular file"));
  const std::string path = testing::TempDir() + "config_yaml_test_large.yaml";
  std::ofstream(path) << std::string(LARGEST_YAML + 1, ' ');
  EXPECT_THAT(mistake_in(path), HasSubstr("1 MiB"));
  std::remove(path.c_str());
}
}  // namespace
}  // namespace config
}  // namespace inverter_bus
