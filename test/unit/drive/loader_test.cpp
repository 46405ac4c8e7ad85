// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Every kind of mistake in a profile, reported with file and line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "support/drive_fixture.h"

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

/// The first complaint about \p base with the mistake in it has file, line, key and what is allowed.
void expectReported(const std::string& base, const Mistake& mistake)
{
  const std::string text = replaced(base, mistake.from, mistake.to);
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

std::string nameOf(const testing::TestParamInfo<Mistake>& info)
{
  return info.param.name;
}

class DriveLoaderMistakes : public testing::TestWithParam<Mistake>
{
};

TEST_P(DriveLoaderMistakes, AreReportedWithFileLineAndKey)
{
  expectReported(smallProfile(), GetParam());
}

// clang-format off
const Mistake MISTAKES[] = {
  { "UnknownKey", "title: A small drive", "title: A\ntitel: B", "titel", "unknown key: allowed: ", 1 },
  { "UnknownKeyThatResemblesOne", "title: A small drive", "title: A\ntitel: B", "titel", "(did you mean 'title'?)", 1 },
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
  { "BaseSixty", "last: 31", "last: 1:31", "stations.last", "is 91 to YAML 1.1", 0 },
  { "NumberOfEightWithAZero", "last: 31", "last: 08", "stations.last", "write 8, without leading zeros", 0 },
  { "NumberWithRest", "last: 31", "last: 31x", "stations.last", "an integer", 0 },
  { "FractionForAnInteger", "last: 31", "last: 31.0", "stations.last", "an integer", 0 },
  { "ListForANumber", "last: 31", "last: [31]", "stations.last", "is a list", 0 },
  { "NoValue", "  maximum: 50.0", "  maximum:", "frequency.maximum", "has no value", 0 },
  { "MapForAList", "[9600, 19200]", "{9600: 1}", "serial.baud_rates", "is a map: allowed: a list", 0 },
  { "ListForAMap", "stations: {first: 1, last: 31}", "stations: [1, 31]", "stations", "is a list: allowed: a map", 0 },
  { "EmptyList", "[9600, 19200]", "[]", "serial.baud_rates", "empty list", 0 },
  { "ValueTwice", "[9600, 19200]", "[9600, 9600]", "serial.baud_rates[1]", "twice", 0 },
  { "StationTooLarge", "last: 31", "last: 248", "stations.last", "from 1 to 247", 0 },
  { "StationZero", "first: 1", "first: 0", "stations.first", "from 1 to 247", 0 },
  { "StationsReversed", "first: 1", "first: 32", "stations", "last is below first", -1 },
  { "SevenDataBits", "data_bits: [8]", "data_bits: [7]", "serial.data_bits[0]", "value '7'", 0 },
  { "UnknownParity", "parity: [none]", "parity: [mark]", "serial.parity[0]", "allowed: none, even, odd", 0 },
  { "NoParity", "parity: [none]", "parity: []", "serial.parity", "empty list", 0 },
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
  { "FlagInOtherWords", "range: [0.1, 600.0]", "read_only: y", "parameters.P01.read_only", "allowed: true or false", 0 },
  { "TitleLikeAFlag", "range: [0.1, 600.0]", "title: on", "parameters.P01.title", "in quotes", 0 },
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
  { "NonzeroThatIsNot", "  running: {coil: 5}", "  running: {register: 5, nonzero: false}", "status.running.nonzero", "allowed: true", 0 },
  { "NonzeroOfACoil", "  running: {coil: 5}", "  running: {coil: 5, nonzero: true}", "status.running.nonzero", "unknown key", 0 },
  { "NonzeroAndBit", "  running: {coil: 5}", "  faulted: {register: 5, nonzero: true, bit: 3}", "status.faulted", "nonzero excludes bit, values, signed and resolution", 0 },
  { "NonzeroAndValues", "  running: {coil: 5}", "  faulted: {register: 5, nonzero: true, values: {0: 0}}", "status.faulted", "nonzero excludes", 0 },
  { "FaultedWithoutAWordForHealth", "  running: {coil: 5}", "  faulted: {register: 5, values: {2: 1}}", "status.faulted", "no value means 0 (no trip)", 0 },
  { "FaultedSlow", "  running: {coil: 5}", "  faulted: {coil: 5, slow: true}", "status.faulted", "a trip must not be missed", 0 },
  { "FaultedWhenFaulted", "  running: {coil: 5}", "  faulted: {coil: 5, when: faulted}", "status.faulted", "a trip must not be missed", 0 },
  { "FlagWithoutBit", "  running: {coil: 5}", "  running: {register: 5}", "status.running", "needs bit, values or nonzero", 0 },
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
  { "UnknownRegisterWithoutMark", "{register: 0x0200,", "{register: unknown,", "parameters.P01", "is unknown: needs unconfirmed: NAME", 0 },
  { "UnknownCoilWithoutMark", "  running: {coil: 5}", "  running: {coil: unknown}", "status.running", "is unknown: needs unconfirmed: NAME", 0 },
  { "UnknownPointWithoutMark", "  run: {coil: 1}", "  run: {coil: unknown}", "points.run", "is unknown: needs unconfirmed: NAME", 0 },
  { "UnknownConstantWithoutMark", "faults:", "constants: {reverse_word: {value: unknown}}\nfaults:", "constants.reverse_word", "is unknown: needs unconfirmed: NAME", 0 },
  { "UnknownWhereItMayNotBe", "  maximum: 50.0", "  maximum: unknown", "frequency.maximum", "value 'unknown': allowed: a number", 0 },
  { "ConstantInfinite", "faults:", "constants: {word: {value: .inf}}\nfaults:", "constants.word.value", "value '.inf': allowed: a number", 0 },
  { "ConstantNamedLikeANumber", "faults:", "constants: {0x10: {value: 1}}\nfaults:", "constants.0x10", "can't be the name of a constant", 0 },
  { "ConstantNamedSetpoint", "faults:", "constants: {setpoint: {value: 1}}\nfaults:", "constants.setpoint", "can't be the name of a constant", 0 },
  { "ConstantNamedUnknown", "faults:", "constants: {unknown: {value: 1}}\nfaults:", "constants.unknown", "can't be the name of a constant", 0 },
  { "ConstantWithUnknownKey", "faults:", "constants: {word: {value: 1, page: 9}}\nfaults:", "constants.word.page", "unknown key: allowed: source, unconfirmed, value, where", 0 },
  { "BaseThatIsNotThere", "{register: 0x0100, resolution: 0.01, unit: Hz}", "{base: monitor_base, register: 4}", "status.output_frequency.base", "value 'monitor_base': allowed: a name of the section constants", 0 },
  { "BaseOfACoil", "  running: {coil: 5}", "  running: {base: 5, coil: 5}", "status.running.base", "a name of the section constants", 0 },
  { "BaseIsNoWholeNumber", "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", "  output_frequency: {base: b, register: 4}\nconstants: {b: {value: 0.5}}\n", "constants.b.value", "value 0.5: allowed: an integer from 0 to 65535", 1 },
  { "BaseIsNegative", "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", "  output_frequency: {base: b, register: 4}\nconstants: {b: {value: -5}}\n", "constants.b.value", "value -5: allowed: an integer from 0 to 65535", 1 },
  { "BaseAndRegisterReachTooFar", "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", "  output_frequency: {base: b, register: 4}\nconstants: {b: {value: 0xFFFD}}\n", "status.output_frequency.register", "value '4': allowed: an integer from 0 to 2", 0 },
  { "ConstantInAStepThatIsNotThere", "  stop: [{run: 0}]", "  stop: [{run: run_word}]", "sequences.stop[0].run", "value 'run_word': allowed: ", 0 },
  { "ConstantAsAResolutionThatIsNotThere", "0x0001, resolution: 0.01", "0x0001, resolution: scale", "points.frequency.resolution", "value 'scale': allowed: ", 0 },
  { "ConstantAsAResolutionIsZero", "{register: 0x0100, resolution: 0.01, unit: Hz}\n", "{register: 0x0100, resolution: scale, unit: Hz}\nconstants: {scale: {value: 0}}\n", "constants.scale.value", "value 0: allowed: a number above 0", 1 },
  { "ConstantInAStepIsAFraction", "  stop: [{run: 0}]\n", "  stop: [{run: word}]\nconstants: {word: {value: 0.5}}\n", "constants.word.value", "value 0.5: allowed: an integer of 0 or more", 1 },
  { "ConstantTooLargeForItsPoint", "  stop: [{run: 0}]\n", "  stop: [{run: word}]\nconstants: {word: {value: 2}}\n", "sequences.stop", "value 2 of the step 'run': allowed: 0 to 1", 0 },
  { "OperationCodesOnModbus", "faults:", "operation_codes: {stop: {value: \"0101\"}}\nfaults:", "operation_codes", "unknown key", 0 },
  { "VariableOnModbus", "  running: {coil: 5}", "  running: {variable: C0/0001, bit: 1}", "status.running", "exactly one of the keys coil and register", 0 },
  { "ControllerStatusOnModbus", "  running: {coil: 5}", "  raw_status: {controller_status: true}", "status.raw_status", "exactly one of the keys coil and register", 0 },
  { "OperationOnModbus", "  run: {coil: 1}", "  run: {operation: true}", "points.run", "exactly one of the keys coil and register", 0 },
  { "ServicesOnModbus", "functions: [1, 3, 5, 6, 16]", "services: [0x0101]", "limits.functions", "is missing", -1 },
  { "ElementsOnModbus", "  read_coils: 16", "  read_elements: 2", "limits.read_elements", "unknown key", 0 },
  { "HoleTooLarge", "  read_coils: 16", "  read_coils: 16\n  hole: 0x10000", "limits.hole", "from 0 to 65535", 1 },
  { "HoleNegative", "  read_coils: 16", "  read_coils: 16\n  hole: -1", "limits.hole", "from 0 to 65535", 1 },
  { "HoleUnknown", "  read_coils: 16", "  read_coils: 16\n  hole: unknown", "limits.hole", "from 0 to 65535", 1 },
  { "CharactersWithAnotherLetter", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: [8E1, 8X1]\n", "serial.characters[1]", "value '8X1': allowed: data bits, parity and stop bits, such as 8N2, 8E1 or 8O1", 0 },
  { "CharactersInLowerCase", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: [8n1]\n", "serial.characters[0]", "value '8n1'", 0 },
  { "CharactersWithThreeStopBits", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: [8N3]\n", "serial.characters[0]", "value '8N3'", 0 },
  { "CharactersTooLong", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: [8N1.5]\n", "serial.characters[0]", "value '8N1.5'", 0 },
  { "CharactersOfSevenBitsOnModbus", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: [7E1]\n", "serial.characters[0]", "(Modbus RTU: 8 data bits)", 0 },
  { "CharactersOfNineBits", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: [9N1]\n", "serial.characters[0]", "value '9N1'", 0 },
  { "CharactersEmpty", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: []\n", "serial.characters", "is an empty list", 0 },
  { "CharactersNoList", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: 8E1\n", "serial.characters", "allowed: a list", 0 },
  { "CharactersBesideDataBits", "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "  characters: [8E1]\n  data_bits: [8]\n", "serial.data_bits", "unknown key: allowed: baud_rates, characters", 1 },
  { "TwoWordsWhereOneIsRead", "  read_registers: 8", "  read_registers: 1", "parameters.P02", "needs a read of 2 registers: limits allow 1", -1 },
  { "TwoWordsWhereOneIsWritten", "  write_registers: 8", "  write_registers: 1", "parameters.P02", "needs a write of 2 registers: limits allow 1", -1 },
  { "CountOfARegister", "  running: {coil: 5}", "  raw_status: {register: 5, count: 17}", "status.raw_status.count", "unknown key", 0 },
  { "TwoFlagsOnOneBitOfARegister", "  running: {coil: 5}", "  faulted: {register: 5, bit: 3}\n  ready: {register: 5, bit: 3}", "status.ready", "the same bit as 'faulted'", 1 },
  { "NothingConfirmedToRead", "  run_seen: {coil: 1}\n  running: {coil: 5}\n  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", "  run_seen: {coil: 1, unconfirmed: bits}\n", "status", "has no confirmed field that is read in every refresh: needs one (that is not left out), or keep_alive", -1 },
  { "NothingFastToRead", "  run_seen: {coil: 1}\n  running: {coil: 5}\n  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", "  run_seen: {coil: 1, slow: true}\n", "status", "keep_alive", -1 },
  { "KeepAliveUnconfirmed", "faults:", "keep_alive: {register: 5, unconfirmed: alive}\nfaults:", "keep_alive", "must be confirmed", 0 },
  { "KeepAliveUnknown", "faults:", "keep_alive: {register: unknown, unconfirmed: alive}\nfaults:", "keep_alive", "must be confirmed", 0 },
  { "KeepAliveWithoutAPlace", "faults:", "keep_alive: {source: nowhere}\nfaults:", "keep_alive", "coil and register", 0 },
  { "ReplyInOtherWords", "  stop: [{run: 0}]", "  stop: [{run: 0, reply: yes}]", "sequences.stop[0].reply", "value 'yes': allowed: none", 0 },
  { "PointNamedReply", "  run: {coil: 1}", "  run: {coil: 1}\n  reply: {coil: 9}", "points.reply", "is a keyword of the sequences", 1 },
  { "WearsInOtherWords", "  run: {coil: 1}", "  run: {coil: 1, wears: often}", "points.run.wears", "allowed: true or false", 0 },
  { "WearsOfAStatus", "  running: {coil: 5}", "  running: {coil: 5, wears: true}", "status.running.wears", "unknown key", 0 },
  { "SetupWithoutItsSequences", "range: [0.1, 600.0]", "setup: true", "parameters.P01", "needs the sequences open_setup and close_setup: must be given", 0 },
  { "ConnectNamesAnUnknownPoint", "  stop: [{run: 0}]", "  stop: [{run: 0}]\n  connect: [{marker: 1}]", "sequences.connect", "unknown point 'marker'", 1 },
  { "IdentityNamesAnUnknownParameter", "faults:", "identity: [{parameter: P09, accept: [224]}]\nfaults:", "identity", "value 'P09'", 0 },
  { "IdentityJudgedOnlyWhenCommanded", "faults:", "identity: [{parameter: P01, accept: [224], when: commanded}]\nfaults:", "identity[0].when", "unknown key", 0 },
  { "ModelOfACommandSource", "faults:", "command_source: [{parameter: P01, accept: [2], model: X}]\nfaults:", "command_source[0].model", "unknown key", 0 },
  { "WhenSomethingElseThanCommanded", "faults:", "command_source: [{parameter: P01, accept: [2], when: always}]\nfaults:", "command_source[0].when", "value 'always': allowed: commanded", 0 },
  { "AcceptAText", "faults:", "command_source: [{parameter: P01, accept: [bus]}]\nfaults:", "command_source[0].accept[0]", "value 'bus': allowed: an integer", 0 },
  { "RatingsNameAnUnknownParameter", "faults:", "ratings: {current: P09}\nfaults:", "ratings.current", "value 'P09'", 0 },
  { "RatedCurrentInSeconds", "faults:", "ratings: {current: P01}\nfaults:", "ratings.current", "with the unit 's': allowed: A", 0 },
  { "RatedVoltageInSeconds", "faults:", "ratings: {voltage: P01}\nfaults:", "ratings.voltage", "with the unit 's': allowed: V", 0 },
  { "RatedPower", "faults:", "ratings: {power: P01}\nfaults:", "ratings.power", "unknown key: allowed: current, source, voltage", 0 },
  { "PercentOfSomethingElse", "  running: {coil: 5}", "  torque: {register: 5, unit: \"%\", of: rated_torque}", "status.torque.of", "value 'rated_torque': allowed: rated_current, rated_voltage", 0 },
  { "PercentOfWithoutPercent", "  running: {coil: 5}", "  output_current: {register: 5, unit: A, of: rated_current}", "status.output_current.of", "needs the unit %", 0 },
  { "PercentOfAParameter", "range: [0.1, 600.0]", "of: rated_current", "parameters.P01.of", "unknown key", 0 },
  { "DriveTimeOutInItsOldPlace", "faults:", "communication_loss: {drive_timeout: 1.0}\nfaults:", "communication_loss.drive_timeout", "unknown key: allowed: action_parameter, advice", 0 },
  { "DriveLossActionInItsOldPlace", "faults:", "communication_loss: {drive_loss_action: coast}\nfaults:", "communication_loss.drive_loss_action", "unknown key", 0 },
  { "DriveTimeOutNegative", "faults:", "drive_timeout: -1\nfaults:", "drive_timeout", "value '-1': allowed: a number from 0 to 3600", 0 },
  { "UnknownKindOfWrites", "faults:", "writes: maybe\nfaults:", "writes", "allowed: ram, eeprom, unknown", 0 },
  { "QuietTooLong", "faults:", "timing: {quiet_before: 2}\nfaults:", "timing.quiet_before", "from 0 to 1", 0 },
};
// clang-format on

INSTANTIATE_TEST_SUITE_P(All, DriveLoaderMistakes, testing::ValuesIn(MISTAKES), nameOf);

// --- keys that must be there --------------------------------------------------------------------------------------
class DriveLoaderMandatoryKeys : public testing::TestWithParam<Mistake>
{
};

TEST_P(DriveLoaderMandatoryKeys, AreMissed)
{
  expectReported(smallProfile(), GetParam());
}

// clang-format off
const Mistake MANDATORY[] = {
  { "Drive", "drive: small\n", "", "drive", "is missing: must be given", -1 },
  { "Title", "title: A small drive\n", "", "title", "is missing: must be given", -1 },
  { "Protocol", "protocol: modbus_rtu\n", "", "protocol", "is missing: must be given", -1 },
  { "Numbering", "numbering: {register_offset: -1, coil_offset: -1}\n", "", "numbering", "is missing: must be given", -1 },
  { "RegisterOffset", "register_offset: -1, ", "", "numbering.register_offset", "is missing: must be given", -1 },
  { "Stations", "stations: {first: 1, last: 31}\n", "", "stations", "is missing: must be given", -1 },
  { "FirstStation", "first: 1, ", "", "stations.first", "is missing: must be given", -1 },
  { "LastStation", ", last: 31", "", "stations.last", "is missing: must be given", -1 },
  { "Serial", "serial:\n  baud_rates: [9600, 19200]\n  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n", "", "serial", "is missing: must be given", -1 },
  { "BaudRates", "  baud_rates: [9600, 19200]\n", "", "serial.baud_rates", "is missing: must be given", -1 },
  { "DataBits", "  data_bits: [8]\n", "", "serial.data_bits", "is missing: must be given", -1 },
  { "Parity", "  parity: [none]\n", "", "serial.parity", "is missing: must be given", -1 },
  { "StopBits", "  stop_bits: [1]\n", "", "serial.stop_bits", "is missing: must be given", -1 },
  { "Limits", "limits:\n  functions: [1, 3, 5, 6, 16]\n  read_registers: 8\n  write_registers: 8\n  read_coils: 16\n", "", "limits", "is missing: must be given", -1 },
  { "Functions", "  functions: [1, 3, 5, 6, 16]\n", "", "limits.functions", "is missing: must be given", -1 },
  { "Frequency", "frequency:\n  maximum: 50.0\n", "", "frequency", "is missing: must be given", -1 },
  { "FrequencyMaximum", "  maximum: 50.0", "  source: nowhere", "frequency.maximum", "is missing: must be given", -1 },
  { "Points", "points:\n  frequency: {register: 0x0001, resolution: 0.01, unit: Hz}\n  run: {coil: 1}\n  direction: {coil: 2}\n", "", "points", "is missing: must be given", -1 },
  { "Sequences", "sequences:\n  forward: [{frequency: setpoint}, {direction: 0}, {run: 1}]\n  stop: [{run: 0}]\n", "", "sequences", "is missing: must be given", -1 },
  { "Status", "status:\n  run_seen: {coil: 1}\n  running: {coil: 5}\n  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", "", "status", "is missing: must be given", -1 },
  { "HistoryFirst", "faults:", "faults:\n  history: {count: 2, fields: {code: {offset: 0}}}", "faults.history.first", "is missing: must be given", -1 },
  { "HistoryFields", "faults:", "faults:\n  history: {first: 0x0300, count: 2}", "faults.history.fields", "is missing: must be given", -1 },
  { "HistoryOffset", "faults:", "faults:\n  history: {first: 0x0300, fields: {code: {words: 1}}}", "faults.history.fields.code.offset", "is missing: must be given", -1 },
  { "FaultText", "    1: overcurrent", "    1: {unconfirmed: texts}", "faults.table.1.text", "is missing: must be given", -1 },
  { "ConstantValue", "faults:", "constants: {reverse_word: {where: page 9}}\nfaults:", "constants.reverse_word.value", "is missing: must be given", -1 },
  { "ExpectedParameter", "faults:", "command_source: [{accept: [3]}]\nfaults:", "command_source[0].parameter", "is missing: must be given", -1 },
  { "ExpectedValues", "faults:", "self_restart: [{parameter: P01}]\nfaults:", "self_restart[0].accept", "is missing: must be given", -1 },
  { "IdentityParameter", "faults:", "identity: [{accept: [224]}]\nfaults:", "identity[0].parameter", "is missing: must be given", -1 },
};
// clang-format on

INSTANTIATE_TEST_SUITE_P(All, DriveLoaderMandatoryKeys, testing::ValuesIn(MANDATORY), nameOf);

// --- CompoWay/F ---------------------------------------------------------------------------------------------------
class DriveLoaderCompowayMistakes : public testing::TestWithParam<Mistake>
{
};

TEST_P(DriveLoaderCompowayMistakes, AreReportedWithFileLineAndKey)
{
  expectReported(smallCompowayProfile(), GetParam());
}

// clang-format off
const Mistake COMPOWAY_MISTAKES[] = {
  { "RegisterInAStatus", "{variable: C0/0001,", "{register: 1,", "status.output_frequency", "exactly one of the keys variable and controller_status", 0 },
  { "CoilInAStatus", "{variable: C0/0003, bit: 7}", "{coil: 3}", "status.faulted", "exactly one of the keys variable and controller_status", 0 },
  { "RegisterInAPoint", "{variable: C1/0000,", "{register: 1,", "points.frequency", "exactly one of the keys variable and operation", 0 },
  { "RegisterInAParameter", "{variable: C3/0000,", "{register: 1,", "parameters.P01", "variable", 0 },
  { "VariableAndOperation", "{operation: true}", "{operation: true, variable: C1/0005}", "points.operate", "exactly one of the keys variable and operation", 0 },
  { "VariableInLowerCase", "C0/0001", "c0/0001", "status.output_frequency.variable", "value 'c0/0001': allowed: variable type and address", 0 },
  { "VariableWithThreeDigits", "C0/0001", "C0/001", "status.output_frequency.variable", "as C1/0000", 0 },
  { "VariableWithFiveDigits", "C0/0001", "C0/00001", "status.output_frequency.variable", "as C1/0000", 0 },
  { "VariableWithoutASlash", "C0/0001", "C00001", "status.output_frequency.variable", "as C1/0000", 0 },
  { "VariableWithoutAType", "variable: C0/0001", "variable: 1", "status.output_frequency.variable", "value '1': allowed: a text", 0 },
  { "VariableIsAList", "C0/0001", "[C0, 1]", "status.output_frequency.variable", "allowed: a text on one line", 0 },
  { "VariableUnknownWithoutMark", "C0/0001", "unknown", "status.output_frequency", "needs unconfirmed: NAME", 0 },
  { "WordsOfAVariable", "C0/0001,", "C0/0001, words: 2,", "status.output_frequency.words", "unknown key", 0 },
  { "OperationFalse", "{operation: true}", "{operation: false}", "points.operate.operation", "allowed: true", 0 },
  { "OperationIsNotRead", "raw_status: {controller_status: true}", "raw_status: {operation: true}", "status.raw_status", "exactly one of the keys variable and controller_status", 0 },
  { "Numbering", "stations:", "numbering: {register_offset: 0}\nstations:", "numbering", "unknown key", 0 },
  { "Block", "parameters:", "block: {}\nparameters:", "block", "unknown key", 0 },
  { "UnknownService", "0x0801, 0x3005]", "0x0801, 0x0104, 0x3005]", "limits.services", "service 0x0104: allowed: 0x0101", 0 },
  { "ServiceTwice", "0x0801, 0x3005]", "0x0801, 0x0801, 0x3005]", "limits.services[5]", "twice", 0 },
  { "FunctionsForServices", "services: [0x0101, 0x0102, 0x0503, 0x0601, 0x0801, 0x3005]", "functions: [3, 6]", "limits.services", "is missing", -1 },
  { "NoServiceToOperate", ", 0x3005]", "]", "points.operate", "0x3005", -1 },
  { "NoServiceToReadTheStatus", " 0x0601,", "", "status.raw_status", "0x0601", -1 },
  { "NoServiceToRead", "[0x0101, ", "[", "status.faulted", "0x0101", -1 },
  { "NoServiceToWrite", " 0x0102,", "", "points.frequency", "0x0102", -1 },
  // A reply of three elements has 41 characters, a write of three 48; the drive's buffer holds 40.
  { "MoreElementsThanTheFrameReads", "read_elements: 2", "read_elements: 3", "limits.read_elements", "from 1 to 2", 0 },
  { "MoreElementsThanTheFrameWrites", "write_elements: 2", "write_elements: 3", "limits.write_elements", "from 1 to 2", 0 },
  { "FrameTooShort", "frame: 40", "frame: 8", "limits.frame", "from 32 to 256", 0 },
  { "RegistersForElements", "read_elements: 2", "read_registers: 2", "limits.read_registers", "unknown key", 0 },
  { "StationTooLarge", "last: 99", "last: 100", "stations.last", "from 0 to 99", 0 },
  { "SixDataBits", "data_bits: [7, 8]", "data_bits: [6]", "serial.data_bits[0]", "from 7 to 8", 0 },
  { "CodeOfThreeDigits", "\"AB00\"", "\"AB0\"", "operation_codes.stop.value", "value 'AB0' (a text, in quotes): allowed: four hexadecimal digits in quotes", 0 },
  { "CodeOfFiveDigits", "\"AB00\"", "\"AB000\"", "operation_codes.stop.value", "four hexadecimal digits in quotes", 0 },
  { "CodeWithoutQuotes", "value: \"AB00\"", "value: 0101", "operation_codes.stop.value", "value '0101' has a leading zero and is 65 to YAML 1.1 (octal); allowed: 65 or 101", 0 },
  { "CodeAsANumber", "\"AB00\"", "0xAB00", "operation_codes.stop.value", "four hexadecimal digits in quotes", 0 },
  { "CodeWithOtherLetters", "\"AB00\"", "\"AG00\"", "operation_codes.stop.value", "four hexadecimal digits in quotes", 0 },
  { "CodeUnknownWithoutMark", "{value: \"AB00\"}", "{value: unknown}", "operation_codes.stop", "needs unconfirmed: NAME", 0 },
  { "CodeWithoutValue", "{value: \"AB00\"}", "{where: page 7}", "operation_codes.stop.value", "is missing", -1 },
  { "CodeOfAnotherName", "points:", "  dance: {value: \"AB02\"}\npoints:", "operation_codes.dance", "unknown key: allowed: run_forward, run_reverse, stop", 0 },
  { "CodeThatIsNotThere", "{operate: stop}", "{operate: run_reverse}", "sequences.stop[0].operate", "value 'run_reverse'", 0 },
  { "CodeNamedLikeAConstant", "points:", "constants: {stop: {value: 1}}\npoints:", "operation_codes.stop", "can't be the name of a constant", -1 },
  { "ResponseCodeTooLarge", "parameters:", "exceptions: {0x10000: x}\nparameters:", "exceptions.0x10000", "from 1 to 65535", 0 },
  { "SetupWithoutOpenSetup", "range: [0, 2.5]", "range: [0, 2.5], setup: true", "parameters.P01", "needs the sequences open_setup and close_setup", 0 },
  { "WearsInOtherWords", "wears: true", "wears: often", "points.frequency.wears", "allowed: true or false", 0 },
  { "BitTooLarge", "bit: 7", "bit: 32", "status.faulted.bit", "from 0 to 31", 0 },
  { "TwoFlagsOnOneBit", "  raw_status:", "  ready: {variable: C0/0003, bit: 7}\n  raw_status:", "status.ready", "the same bit as 'faulted'", 0 },
  { "ParametersOverlap", "range: [0, 2.5]}", "range: [0, 2.5]}\n  P02: {variable: C3/0000}", "parameters.P02", "belongs to 'P01'", 1 },
  { "ParameterOnAPoint", "P01: {variable: C3/0000", "P01: {variable: C1/0000", "parameters.P01", "read_only: true", 0 },
  { "RangeBeyondTheVariable", "range: [0, 2.5]", "range: [-1, 2.5]", "parameters.P01.range", "the register holds only 0 to", 0 },
  { "ModelIsAList", "parameters:", "identity: [{model: [1]}]\nparameters:", "identity[0].model", "a text on one line", 0 },
};
// clang-format on

INSTANTIATE_TEST_SUITE_P(All, DriveLoaderCompowayMistakes, testing::ValuesIn(COMPOWAY_MISTAKES), nameOf);

TEST(DriveLoader, TheSmallCompowayProfileOfTheseTestsIsFine)
{
  const ProfileFile file(smallCompowayProfile());
  EXPECT_THAT(checkProfile(file.path()), IsEmpty());
  const Profile profile = file.load();
  EXPECT_EQ(profile.protocol, "compoway_f");
  EXPECT_EQ(profile.points.at("frequency").item.area, 0xC1);
  EXPECT_EQ(profile.constants.at("stop").value, 0xAB00);
}

TEST(DriveLoader, SetupNeedsBothSequences)
{
  std::string text = replaced(smallCompowayProfile(), "range: [0, 2.5]", "range: [0, 2.5], setup: true");
  text =
      replaced(text, "  stop: [{operate: stop}]\n", "  stop: [{operate: stop}]\n  open_setup: [{operate: 0xAB07}]\n");
  const ProfileFile half(text);
  EXPECT_THAT(checkProfile(half.path()), SizeIs(1));
  const ProfileFile whole(replaced(text, "  open_setup:", "  close_setup: [{operate: 0xAB08}]\n  open_setup:"));
  EXPECT_THAT(checkProfile(whole.path()), IsEmpty());
}

// --- block read and write -----------------------------------------------------------------------------------------
std::string blockProfile()
{
  const std::string text = replaced(smallProfile(), "[1, 3, 5, 6, 16]", "[1, 3, 5, 6, 16, 0x17]");
  return replaced(text, "faults:", R"(block:
  read: {register: 0x0300, slots: [P01]}
  write: {register: 0x0310, slots: [P02], select: {frequency: 3}}
  codes:
    0: {title: nothing}
    1: {register: 0x0100, title: frequency}
  apply: {parameter: P01, value: 1}
faults:)");
}

class DriveLoaderBlockMistakes : public testing::TestWithParam<Mistake>
{
};

TEST_P(DriveLoaderBlockMistakes, AreReportedWithFileLineAndKey)
{
  expectReported(blockProfile(), GetParam());
}

// clang-format off
const Mistake BLOCK_MISTAKES[] = {
  { "UnknownReadSlot", "slots: [P01]", "slots: [P01, P09]", "block.read.slots", "value 'P09': allowed: a name of the section parameters", 0 },
  { "UnknownWriteSlot", "slots: [P02]", "slots: [P09]", "block.write.slots", "value 'P09'", 0 },
  { "UnknownPoint", "select: {frequency: 3}", "select: {speed: 3}", "block.write.select", "unknown point 'speed'", 0 },
  { "MorePointsThanSlots", "select: {frequency: 3}", "select: {frequency: 3, run: 1}", "block.write.select", "2 points for 1 slots", 0 },
  { "FewerPointsThanSlots", "slots: [P02]", "slots: [P02, P01]", "block.write.select", "1 points for 2 slots", 0 },
  { "CodeOfAPointTooLarge", "select: {frequency: 3}", "select: {frequency: 65536}", "block.write.select.frequency", "from 0 to 65535", 0 },
  { "UnknownApplyParameter", "{parameter: P01, value: 1}", "{parameter: P09, value: 1}", "block.apply.parameter", "value 'P09'", 0 },
  { "ApplyValueTooLarge", "{parameter: P01, value: 1}", "{parameter: P01, value: 65536}", "block.apply.value", "from 0 to 65535", 0 },
  { "NoFunctionToReadAndWrite", "[1, 3, 5, 6, 16, 0x17]", "[1, 3, 5, 6, 16]", "block", "needs function 0x0017", -1 },
  { "CodeIsAWord", "    1: {register: 0x0100, title: frequency}", "    one: {register: 0x0100}", "block.codes.one", "the selection code 'one': allowed: an integer from 0 to 65535", 0 },
  { "CodeTwice", "    1: {register: 0x0100, title: frequency}", "    1: {title: a}\n    0x1: {title: b}", "block.codes.0x1", "duplicate key", 1 },
  { "CodeWithACoil", "    1: {register: 0x0100, title: frequency}", "    1: {coil: 1, title: frequency}", "block.codes.1.coil", "unknown key", 0 },
  { "CodeBeyondTheRegisters", "    1: {register: 0x0100, title: frequency}", "    1: {register: 0x10000, title: frequency}", "block.codes.1.register", "from 1 to 65535", 0 },
  { "PercentOfWithoutPercent", "    1: {register: 0x0100, title: frequency}", "    1: {register: 0x0100, title: current, of: rated_current}", "block.codes.1.of", "needs the unit %", 0 },
  { "CoilAsAWindow", "read: {register: 0x0300,", "read: {coil: 1,", "block.read", "needs exactly the key register", 0 },
  { "NoReadRegister", "read: {register: 0x0300, ", "read: {", "block.read", "needs exactly the key register", 0 },
  { "UnknownKey", "  apply:", "  aply:", "block.aply", "unknown key: allowed: apply, codes, read", 0 },
  { "NoRead", "  read: {register: 0x0300, slots: [P01]}\n", "", "block.read", "is missing", -1 },
  { "NoWrite", "  write: {register: 0x0310, slots: [P02], select: {frequency: 3}}\n", "", "block.write", "is missing", -1 },
  { "NoReadSlots", ", slots: [P01]", "", "block.read.slots", "is missing", -1 },
  { "NoWriteSlots", ", slots: [P02]", "", "block.write.slots", "is missing", -1 },
  { "NoSelect", ", select: {frequency: 3}", "", "block.write.select", "is missing", -1 },
  { "NoCodes", "  codes:\n    0: {title: nothing}\n    1: {register: 0x0100, title: frequency}\n", "", "block.codes", "is missing", -1 },
};
// clang-format on

INSTANTIATE_TEST_SUITE_P(All, DriveLoaderBlockMistakes, testing::ValuesIn(BLOCK_MISTAKES), nameOf);

TEST(DriveLoader, TheBlockOfTheseTestsIsFine)
{
  const ProfileFile file(blockProfile());
  EXPECT_THAT(checkProfile(file.path()), IsEmpty());
}

// --- decimal numbering --------------------------------------------------------------------------------------------
class DriveLoaderDecimalMistakes : public testing::TestWithParam<Mistake>
{
};

TEST_P(DriveLoaderDecimalMistakes, AreReportedWithFileLineAndKey)
{
  expectReported(
      replaced(smallProfile(), "{register_offset: -1, coil_offset: -1}", "{register_offset: 0, decimal: true}"),
      GetParam());
}

// clang-format off
const Mistake DECIMAL_MISTAKES[] = {
  { "LetterInTheLastDigit", "{register: 0x0200,", "{register: 0x020A,", "parameters.P01.register", "0x020A does not exist on this drive: the last two digits count decimally", 0 },
  { "LetterInTheLastButOne", "{register: 0x0200,", "{register: 0x02A0,", "parameters.P01.register", "0x02A0 does not exist on this drive", 0 },
  { "InAStatus", "{register: 0x0100,", "{register: 0x010F,", "status.output_frequency.register", "0x010F does not exist on this drive", 0 },
  { "InAPoint", "{register: 0x0001,", "{register: 0x000B,", "points.frequency.register", "0x000B does not exist on this drive", 0 },
  { "InAHistory", "faults:", "faults:\n  history: [{code: {register: 0xFE1A}}]", "faults.history[0].code.register", "0xFE1A does not exist on this drive", 1 },
  { "DecimalNumberOfALetter", "{register: 0x0200,", "{register: 522,", "parameters.P01.register", "0x020A does not exist on this drive", 0 },
};
// clang-format on

INSTANTIATE_TEST_SUITE_P(All, DriveLoaderDecimalMistakes, testing::ValuesIn(DECIMAL_MISTAKES), nameOf);

TEST(DriveLoader, LettersInTheFirstTwoDigitsAreFineWhereTheLastTwoAreDecimal)
{
  std::string text =
      replaced(smallProfile(), "{register_offset: -1, coil_offset: -1}", "{register_offset: 0, decimal: true}");
  const ProfileFile file(replaced(text, "{register: 0x0200,", "{register: 0xFD90,"));
  EXPECT_THAT(checkProfile(file.path()), IsEmpty());
  EXPECT_EQ(file.load().parameters.at("P01").item.address, 0xFD90);
}

TEST(DriveLoader, CharactersNameWhichCombinationsThereAre)
{
  const ProfileFile file(replaced(smallProfile(), "  data_bits: [8]\n  parity: [none]\n  stop_bits: [1]\n",
                                  "  characters: [8N2, 8E1, 8O1]\n"));
  EXPECT_THAT(checkProfile(file.path()), IsEmpty());
  const Profile profile = file.load();
  EXPECT_THAT(profile.characters, testing::ElementsAre("8E1", "8N2", "8O1"));
  EXPECT_THAT(profile.data_bits, testing::ElementsAre(8));
  EXPECT_THAT(profile.parities, testing::ElementsAre("even", "none", "odd"));
  EXPECT_THAT(profile.stop_bits, testing::ElementsAre(1, 2));
}

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

TEST(DriveLoader, ManyMistakesAreCountedAndNotAllShown)
{
  std::string text = smallProfile();
  for (int i = 0; i < 1000; ++i)
  {
    text += "nonsense_" + std::to_string(i) + ": 1\n";
  }
  const ProfileFile file(text);
  const auto problems = checkProfile(file.path());
  ASSERT_THAT(problems, SizeIs(51));
  EXPECT_EQ("... and 950 more mistakes", problems.back());
}

TEST(DriveLoader, ALongValueIsCutAndWhatIsAllowedStillThere)
{
  const std::string huge(300000, 'x');
  const ProfileFile value(replaced(smallProfile(), "last: 31", "last: " + huge));
  const auto problems = checkProfile(value.path());
  ASSERT_FALSE(problems.empty());
  EXPECT_LT(problems[0].size(), 1000U);
  EXPECT_THAT(problems[0], AllOf(HasSubstr("xxx... (300000 bytes)'"), HasSubstr("allowed: an integer")));
  const ProfileFile key(smallProfile() + "? " + huge + "\n: 1\n");
  const auto unknown = checkProfile(key.path());
  ASSERT_FALSE(unknown.empty());
  EXPECT_LT(unknown[0].size(), 1100U);
  EXPECT_THAT(unknown[0], AllOf(HasSubstr("xxx... (300000 bytes)'"), HasSubstr("unknown key")));
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
