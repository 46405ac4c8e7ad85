// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Every kind of mistake in a profile, reported with file and line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

/// One mistake: a piece of the small profile, what stands there instead, and what the message must say.
struct Mistake
{
  const char* name;
  const char* from;
  const char* to;
  /// The key in the message.
  const char* key;
  /// A piece of the rest of the message.
  const char* says;
  /// Lines below the first line of \ref to where the mistake is; -1: the line isn't checked.
  int line_offset;
};

std::size_t lineOf(const std::string& text, const std::string& piece)
{
  const std::size_t at = text.find(piece);
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

class DriveLoaderMistakes : public testing::TestWithParam<Mistake>
{
};

TEST_P(DriveLoaderMistakes, AreReportedWithFileLineAndKey)
{
  const Mistake& mistake = GetParam();
  const std::string text = replaced(smallProfile(), mistake.from, mistake.to);
  const ProfileFile file(text);
  const std::vector<std::string> problems = checkProfile(file.path());
  ASSERT_FALSE(problems.empty());
  const std::string& first = problems.front();
  if (mistake.line_offset >= 0)
  {
    const std::size_t line = lineOf(text, mistake.to) + static_cast<std::size_t>(mistake.line_offset);
    EXPECT_THAT(first, StartsWith(file.path() + ":" + std::to_string(line) + ": "));
  }
  EXPECT_THAT(first, HasSubstr("key '" + std::string(mistake.key) + "': "));
  EXPECT_THAT(first, HasSubstr(mistake.says));
  EXPECT_THROW(file.load(), ConfigurationError);
}

// clang-format off
const Mistake MISTAKES[] = {
  { "UnknownKey", "title: A small drive", "title: A\ntitel: B", "titel", "unknown key: allowed: ", 1 },
  { "UnknownNestedKey", "last: 31", "last: 31, middle: 5", "stations.middle", "unknown key: allowed: first, last", 0 },
  { "DuplicateKey", "title: A small drive", "title: A\ntitle: B", "title", "duplicate key", 1 },
  { "DuplicateNestedKey", "  read_coils: 16", "  read_coils: 16\n  read_registers: 9", "limits.read_registers", "duplicate key", 1 },
  { "DuplicateNumberInOtherSpelling", "    1: overcurrent", "    1: overcurrent\n    0x1: other", "faults.table.0x1", "duplicate key", 1 },
  { "MissingTitle", "title: A small drive\n", "", "title", "is missing", -1 },
  { "MissingNumbering", "numbering: {register_offset: -1, coil_offset: -1}\n", "", "numbering", "is missing", -1 },
  { "MissingStop", "  stop: [{run: 0}]\n", "", "sequences.forward", "the sequence stop is missing", -1 },
  { "MissingAddress", "  run: {coil: 1}", "  run: {unit: Hz}", "points.run", "coil and register", 0 },
  { "BothAddresses", "  run: {coil: 1}", "  run: {coil: 1, register: 5}", "points.run", "exactly one of", 0 },
  { "TextForANumber", "last: 31", "last: many", "stations.last", "value 'many': allowed: an integer from 1 to 247", 0 },
  { "QuotedNumber", "last: 31", "last: \"31\"", "stations.last", "in quotes", 0 },
  { "LeadingZero", "last: 31", "last: 031", "stations.last", "without leading zeros", 0 },
  { "NumberWithRest", "last: 31", "last: 31x", "stations.last", "an integer", 0 },
  { "PlusSign", "last: 31", "last: +31", "stations.last", "an integer", 0 },
  { "FractionForAnInteger", "last: 31", "last: 31.0", "stations.last", "an integer", 0 },
  { "ListForANumber", "last: 31", "last: [31]", "stations.last", "a list stands here", 0 },
  { "NoValue", "  maximum: 50.0", "  maximum:", "frequency.maximum", "has no value", 0 },
  { "MapForAList", "[9600, 19200]", "{9600: 1}", "serial.baud_rates", "a map stands here: allowed: a list", 0 },
  { "ListForAMap", "stations: {first: 1, last: 31}", "stations: [1, 31]", "stations", "a list stands here: allowed: a map", 0 },
  { "EmptyList", "[9600, 19200]", "[]", "serial.baud_rates", "empty list", 0 },
  { "ValueTwice", "[9600, 19200]", "[9600, 9600]", "serial.baud_rates[1]", "twice", 0 },
  { "StationTooLarge", "last: 31", "last: 248", "stations.last", "from 1 to 247", 0 },
  { "StationZero", "first: 1", "first: 0", "stations.first", "from 1 to 247", 0 },
  { "StationsReversed", "first: 1", "first: 32", "stations", "last is below first", -1 },
  { "SevenDataBits", "data_bits: [8]", "data_bits: [7]", "serial.data_bits[0]", "value '7'", 0 },
  { "UnknownParity", "parity: [none]", "parity: [mark]", "serial.parity[0]", "allowed: none, even, odd", 0 },
  { "UnknownProtocol", "modbus_rtu", "profibus", "protocol", "allowed: modbus_rtu", 0 },
  { "UnknownFunction", "[1, 3, 5, 6, 16]", "[1, 3, 4, 5, 6, 16]", "limits.functions", "function 0x0004", 0 },
  { "LimitAboveTheProtocol", "read_registers: 8", "read_registers: 126", "limits.read_registers", "from 1 to 125", 0 },
  { "WriteLimitAboveTheProtocol", "write_registers: 8", "write_registers: 124", "limits.write_registers", "from 1 to 123", 0 },
  { "Infinity", "maximum: 50.0", "maximum: .inf", "frequency.maximum", "value '.inf'", 0 },
  { "NotANumber", "maximum: 50.0", "maximum: .nan", "frequency.maximum", "value '.nan'", 0 },
  { "InfinityWord", "maximum: 50.0", "maximum: inf", "frequency.maximum", "value 'inf'", 0 },
  { "Overflow", "maximum: 50.0", "maximum: 1e999", "frequency.maximum", "value '1e999'", 0 },
  { "NegativeMaximum", "maximum: 50.0", "maximum: -50.0", "frequency.maximum", "value '-50.0'", 0 },
  { "MaximumDoesNotFit", "maximum: 50.0", "maximum: 700.0", "points.frequency", "must fit into the register", -1 },
  { "ResolutionZero", "0x0001, resolution: 0.01", "0x0001, resolution: 0", "points.frequency.resolution", "above 0", 0 },
  { "ResolutionNegative", "0x0001, resolution: 0.01", "0x0001, resolution: -0.01", "points.frequency.resolution", "above 0", 0 },
  { "ResolutionInfinite", "0x0001, resolution: 0.01", "0x0001, resolution: .inf", "points.frequency.resolution", "above 0", 0 },
  { "NumberBelowTheFirst", "  direction: {coil: 2}", "  direction: {coil: 0}", "points.direction.coil", "from 1 to 65535", 0 },
  { "RegisterTooLarge", "{register: 0x0200,", "{register: 0x10000,", "parameters.P01.register", "from 1 to 65535", 0 },
  { "NumberNegative", "  direction: {coil: 2}", "  direction: {coil: -1}", "points.direction.coil", "from 1 to 65535", 0 },
  { "BadHex", "  direction: {coil: 2}", "  direction: {coil: 0xZZ}", "points.direction.coil", "0x...", 0 },
  { "ThreeWords", "words: 2", "words: 3", "parameters.P02.words", "from 1 to 2", 0 },
  { "WordsReachTooFar", "register: 0x0201, words: 2", "register: 0xFFFF, words: 2", "parameters.P02", "reaches beyond 0xFFFF", 0 },
  { "OffsetPositive", "coil_offset: -1", "coil_offset: 1", "numbering.coil_offset", "from -65535 to 0", 0 },
  { "RangeUpsideDown", "range: [0.1, 600.0]", "range: [600.0, 0.1]", "parameters.P01.range", "is above the highest", 0 },
  { "RangeWithOneEnd", "range: [0.1, 600.0]", "range: [600.0]", "parameters.P01.range", "[lowest, highest]", 0 },
  { "RangeBeyondTheRegister", "range: [0.1, 600.0]", "range: [0.1, 6600.0]", "parameters.P01.range", "the register holds only 0 to 6553.5", 0 },
  { "RangeNotANumber", "range: [0.1, 600.0]", "range: [0.1, .nan]", "parameters.P01.range[1]", "value '.nan'", 0 },
  { "FlagInOtherWords", "range: [0.1, 600.0]", "read_only: yes", "parameters.P01.read_only", "allowed: true or false", 0 },
  { "FlagInCapitals", "range: [0.1, 600.0]", "read_only: True", "parameters.P01.read_only", "allowed: true or false", 0 },
  { "QuotedFlag", "range: [0.1, 600.0]", "read_only: \"true\"", "parameters.P01.read_only", "allowed: true or false", 0 },
  { "ParameterNamedLikeANumber", "  P01:", "  0x1234:", "parameters.0x1234", "register numbers", 0 },
  { "ParameterWithABadName", "  P01:", "  \"P 01\":", "parameters.P 01", "letters, digits", 0 },
  { "ParametersOverlap", "register: 0x0201, words: 2", "register: 0x0200, words: 2", "parameters.P02", "belongs to 'P01'", -1 },
  { "ParameterOnACommand", "register: 0x0200", "register: 0x0001", "parameters.P01", "read_only: true", -1 },
  { "PointsOverlap", "  direction: {coil: 2}", "  direction: {coil: 1}", "points.run", "lies on the point 'direction'", -1 },
  { "TwoFlagsOnOneBit", "  running: {coil: 5}", "  running: {coil: 1}", "status.running", "the same bit as 'run_seen'", 0 },
  { "BitTooLarge", "  running: {coil: 5}", "  running: {register: 5, bit: 16}", "status.running.bit", "from 0 to 15", 0 },
  { "BitWithMask", "  running: {coil: 5}", "  running: {register: 5, bit: 1, mask: 2}", "status.running", "neither mask", 0 },
  { "BitOfTwoWords", "  running: {coil: 5}", "  running: {register: 5, words: 2, bit: 1}", "status.running", "one word", 0 },
  { "BitOfACoil", "  running: {coil: 5}", "  running: {coil: 5, bit: 1}", "status.running.bit", "unknown key", 0 },
  { "MaskZero", "  running: {coil: 5}", "  running: {register: 5, mask: 0, values: {1: 1}}", "status.running.mask", "from 1", 0 },
  { "FlagWithoutBit", "  running: {coil: 5}", "  running: {register: 5}", "status.running", "needs bit or values", 0 },
  { "FlagWithNegativeMeaning", "  running: {coil: 5}", "  running: {register: 5, values: {1: -1}}", "status.running", "allowed meanings: 0, 1", 0 },
  { "DirectionWithoutValues", "  running: {coil: 5}", "  direction: {register: 5}", "status.direction", "needs values", 0 },
  { "MeaningOutOfRange", "  running: {coil: 5}", "  direction: {register: 5, values: {1: 2}}", "status.direction.values.1", "from -1 to 1", 0 },
  { "RawValueIsNoNumber", "  running: {coil: 5}", "  direction: {register: 5, values: {one: 1}}", "status.direction.values.one", "the raw value 'one'", 0 },
  { "TooManyCoils", "  running: {coil: 5}", "  raw_status: {coil: 5, count: 33}", "status.raw_status.count", "from 1 to 32", 0 },
  { "CoilsBeyondTheLimit", "  running: {coil: 5}", "  raw_status: {coil: 5, count: 17}", "status.raw_status", "limits allow 16", 0 },
  { "CountOfAFlag", "  running: {coil: 5}", "  running: {coil: 5, count: 2}", "status.running.count", "unknown key", 0 },
  { "UnknownField", "  running: {coil: 5}", "  runing: {coil: 5}", "status.runing", "unknown key: allowed: ", 0 },
  { "QuantityOnACoil", "  running: {coil: 5}", "  torque: {coil: 5}", "status.torque", "needs exactly the key register", 0 },
  { "SlowAndWhenFaulted", "  running: {coil: 5}", "  fault_code: {register: 5, slow: true, when: faulted}", "status.fault_code", "exclude each other", 0 },
  { "WhenSomethingElse", "  running: {coil: 5}", "  fault_code: {register: 5, when: running}", "status.fault_code.when", "allowed: faulted", 0 },
  { "UnknownSequence", "  stop: [{run: 0}]", "  stop: [{run: 0}]\n  dance: [{run: 1}]", "sequences.dance", "allowed: forward, reverse", 1 },
  { "UnknownPointInASequence", "  stop: [{run: 0}]", "  stop: [{runn: 0}]", "sequences.stop", "unknown point 'runn': allowed: direction, frequency, run", -1 },
  { "ValueTooLargeForAPoint", "  stop: [{run: 0}]", "  stop: [{run: 2}]", "sequences.stop", "allowed: 0 to 1", -1 },
  { "TwoPointsInAStep", "  stop: [{run: 0}]", "  stop: [{run: 0, direction: 0}]", "sequences.stop[0]", "exactly one point", 0 },
  { "NoPointInAStep", "  stop: [{run: 0}]", "  stop: [{pause: 0.1}]", "sequences.stop[0]", "exactly one point", 0 },
  { "NegativePause", "  stop: [{run: 0}]", "  stop: [{run: 0, pause: -1}]", "sequences.stop[0].pause", "from 0 to 10", 0 },
  { "SetPointForAnotherPoint", "  stop: [{run: 0}]", "  stop: [{run: setpoint}]", "sequences.stop[0].run", "point frequency only", 0 },
  { "EmptySequence", "  stop: [{run: 0}]", "  stop: []", "sequences.stop", "has no steps", 0 },
  { "SequenceWithoutSteps", "  stop: [{run: 0}]", "  stop: {unconfirmed: x}", "sequences.stop.steps", "is missing", 0 },
  { "NoFunctionToWriteCoils", "[1, 3, 5, 6, 16]", "[1, 3, 6, 16]", "points.direction", "needs function 0x0005 or 0x000F", -1 },
  { "NoFunctionToReadCoils", "[1, 3, 5, 6, 16]", "[3, 5, 6, 16]", "status.run_seen", "needs function 0x0001", -1 },
  { "NoFunctionToWriteTwoWords", "[1, 3, 5, 6, 16]", "[1, 3, 5, 6]", "parameters.P02", "needs function 0x0010", -1 },
  { "NoFunctionToReadRegisters", "[1, 3, 5, 6, 16]", "[1, 5, 6, 16]", "status.output_frequency", "needs function 0x0003", -1 },
  { "SpanUpsideDown", "[[0x0100, 0x0120]]", "[[0x0120, 0x0100]]", "spans.registers[0]", "first <= last", 0 },
  { "SpansOverlap", "[[0x0100, 0x0120]]", "[[0x0100, 0x0120], [0x0120, 0x0130]]", "spans.registers[1]", "don't overlap", 0 },
  { "SpanWithOneEnd", "[[0x0100, 0x0120]]", "[[0x0100]]", "spans.registers[0]", "first and last", 0 },
  { "FaultCodeZero", "    1: overcurrent", "    0: none", "faults.table.0", "from 1 to 65535", 0 },
  { "FaultCodeIsAWord", "    1: overcurrent", "    E1: none", "faults.table.E1", "the code 'E1'", 0 },
  { "FaultTextEmpty", "    1: overcurrent", "    1: \"\"", "faults.table.1", "empty text", 0 },
  { "TextOverTwoLines", "title: A small drive", "title: \"A\\nB\"", "title", "a text on one line", 0 },
  { "HistoryWithoutCode", "faults:", "faults:\n  history: [{run_hours: {register: 9}}]", "faults.history", "needs the field code", 1 },
  { "HistoryWithUnknownField", "faults:", "faults:\n  history: [{kode: {register: 9}}]", "faults.history[0].kode", "unknown key: allowed: code", 1 },
  { "HistoryTooFar", "faults:", "faults:\n  history: {first: 0xFFF0, stride: 10, count: 9, fields: {code: {offset: 0}}}", "faults.history", "reaches beyond", 1 },
  { "ExceptionOutOfRange", "faults:", "exceptions: {256: x}\nfaults:", "exceptions.256", "from 1 to 255", 0 },
  { "UnknownParameterNamed", "faults:", "command_source: [{parameter: A009, accept: [3]}]\nfaults:", "command_source", "value 'A009'", 0 },
  { "NothingToAccept", "faults:", "self_restart: [{parameter: P01, accept: []}]\nfaults:", "self_restart[0].accept", "empty list", 0 },
  { "UnknownTimeOutParameter", "faults:", "communication_loss: {timeout_parameter: A009}\nfaults:", "communication_loss.timeout_parameter", "value 'A009'", 0 },
  { "TimeOutWithoutSeconds", "faults:", "communication_loss: {timeout_parameter: P02}\nfaults:", "communication_loss.timeout_parameter", "allowed: s", 0 },
  { "UnknownLossAction", "faults:", "drive_loss_action: explode\nfaults:", "drive_loss_action", "runs_on, decelerate, coast, trip", 0 },
  { "UnknownWriteMode", "faults:", "writes: flash\nfaults:", "writes", "allowed: ram, eeprom", 0 },
  { "NameWithABlank", "  run: {coil: 1}", "  run: {coil: 1, unconfirmed: run coil}", "points.run.unconfirmed", "a name of letters", 0 },
  { "NegativeTime", "faults:", "timing: {reply_delay: -0.1}\nfaults:", "timing.reply_delay", "from 0", 0 },
};
// clang-format on

INSTANTIATE_TEST_SUITE_P(All, DriveLoaderMistakes, testing::ValuesIn(MISTAKES),
                         [](const testing::TestParamInfo<Mistake>& info) { return std::string(info.param.name); });

std::string loadError(const std::string& name, const std::string& directory)
{
  try
  {
    loadProfile(name, directory);
    return "";
  }
  catch (const ConfigurationError& error)
  {
    return error.what();
  }
}

TEST(DriveLoader, TheSmallProfileOfTheseTestsIsFine)
{
  const ProfileFile file(smallProfile());
  EXPECT_THAT(checkProfile(file.path()), IsEmpty());
  const Profile profile = file.load();
  EXPECT_EQ(profile.name, "small");
  EXPECT_EQ(profile.file, file.path());
  EXPECT_EQ(profile.points.at("run").item.number, 1);
  EXPECT_EQ(profile.points.at("run").item.address, 0);
}

TEST(DriveLoader, ANumberingFromZeroKeepsNumberAndAddressEqual)
{
  std::string text = replaced(smallProfile(), "{register_offset: -1, coil_offset: -1}", "{register_offset: 0}");
  text = replaced(text, "  direction: {coil: 2}", "  direction: {coil: 0}");
  const Profile profile = ProfileFile(text).load();
  EXPECT_EQ(profile.points.at("direction").item.address, 0);
  EXPECT_EQ(profile.points.at("frequency").item.address, 1);
  EXPECT_EQ(profile.first_register, 0U);
}

TEST(DriveLoader, ShowsAllMistakesAtOnce)
{
  std::string text = replaced(smallProfile(), "last: 31", "last: 1000");
  text = replaced(text, "maximum: 50.0", "maximum: .inf");
  text = replaced(text, "words: 2", "words: 9");
  const ProfileFile file(text);
  EXPECT_THAT(checkProfile(file.path()), SizeIs(3));
}

TEST(DriveLoader, MalformedYamlHasALine)
{
  const ProfileFile file("drive: x\ntitle: [1, 2\nprotocol: y: z\n");
  const auto problems = checkProfile(file.path());
  ASSERT_THAT(problems, SizeIs(1));
  EXPECT_THAT(problems[0], AllOf(StartsWith(file.path() + ":"), HasSubstr("not valid YAML")));
}

TEST(DriveLoader, AnEmptyFileIsNamed)
{
  for (const char* text : { "", "# nothing\n", "---\na: 1\n---\nb: 2\n", "[1, 2]\n", "word\n", "\n~\n" })
  {
    const ProfileFile file(text);
    const auto problems = checkProfile(file.path());
    ASSERT_FALSE(problems.empty()) << text;
    EXPECT_THAT(problems[0], StartsWith(file.path())) << text;
  }
}

TEST(DriveLoader, AnAliasThatContainsItselfIsRefused)
{
  const ProfileFile file("drive: &a [*a]\n");
  EXPECT_FALSE(checkProfile(file.path()).empty());
}

TEST(DriveLoader, AliasesThatExplodeAreRefused)
{
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 12; ++i)
  {
    const std::string last = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
    for (int j = 0; j < 9; ++j)
    {
      text += ", " + last;
    }
    text += "]\n";
  }
  const auto problems = checkProfile(ProfileFile(text).path());
  ASSERT_FALSE(problems.empty());
}

TEST(DriveLoader, AFileThatCannotBeReadIsNamed)
{
  EXPECT_THAT(loadError("/no/such/file.yaml", ""), StartsWith("/no/such/file.yaml: cannot be read"));
  EXPECT_THAT(loadError("/tmp", ""), StartsWith("/tmp: is not a regular file"));
}

TEST(DriveLoader, AnUnknownDriveListsTheKnownOnes)
{
  EXPECT_THAT(loadError("omron_mx3", profileDirectory()),
              AllOf(HasSubstr("value 'omron_mx3'"), HasSubstr("an absolute path"), HasSubstr("omron_mx2, omron_rx")));
  EXPECT_THAT(loadError("", profileDirectory()), HasSubstr("omron_mx2"));
  EXPECT_THAT(loadError("../drives/omron_mx2", profileDirectory()), HasSubstr("allowed: an absolute path"));
  EXPECT_THAT(loadError("omron_mx2", "/no/such/directory"), HasSubstr("no profiles in /no/such/directory"));
}

TEST(DriveLoader, AMeantDoubleUseOfABitIsAllowed)
{
  const ProfileFile file(replaced(smallProfile(), "  running: {coil: 5}", "  running: {coil: 1, shared: true}"));
  EXPECT_THAT(checkProfile(file.path()), IsEmpty());
}

TEST(DriveLoader, AMessageStaysOnOneLine)
{
  const ProfileFile file(replaced(smallProfile(), "protocol: modbus_rtu", "protocol: \"a\\nb\""));
  for (const std::string& problem : checkProfile(file.path()))
  {
    EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
  }
}

/// The last YAML block of the manual for profile writers.
std::string exampleOfTheDocumentation()
{
  std::ifstream stream(std::string(INVERTER_BUS_ROOT) + "/docs/drive_profiles.md");
  std::stringstream text;
  text << stream.rdbuf();
  const std::string fence = "```yaml\n";
  const std::size_t start = text.str().rfind(fence) + fence.size();
  return text.str().substr(start, text.str().find("```", start) - start);
}

TEST(DriveLoader, TheExampleOfTheDocumentationIsAGoodProfile)
{
  const ProfileFile file(exampleOfTheDocumentation());
  EXPECT_THAT(checkProfile(file.path()), IsEmpty());
  const Drive drive(file.load());
  EXPECT_EQ(drive.profile().name, "acme_a1");
  std::vector<std::string> reads;
  for (const ReadBlock& block : drive.fastBlocks())
  {
    reads.push_back(printed(drive.read(1, block)));
  }
  EXPECT_THAT(reads, testing::ElementsAre("01 03 20 00 00 01", "01 03 21 00 00 03"));
  EXPECT_EQ(printed(drive.write(1, "command", 2)), "01 10 20 00 00 01 02 00 02");
}

TEST(DriveLoader, HexadecimalAndDecimalNumbersAreTheSame)
{
  const ProfileFile file(replaced(smallProfile(), "{register: 0x0200,", "{register: 512,"));
  EXPECT_EQ(file.load().parameters.at("P01").item.number, 0x0200);
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus
