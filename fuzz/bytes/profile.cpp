// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// A profile file as a user writes it. Whatever stands in it: problems in words, or a drive that works.
#include <cmath>
#include <utility>
#include <vector>

#include "checks.h"
#include "inverter_bus/drive/drive.h"
#include "text_file.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using drive::Drive;

/// A reply full of \p byte that a block of \p count values may bring.
wire::Bytes fullReply(const drive::ReadBlock& block, std::uint8_t byte)
{
  const bool coils = block.space == drive::Space::Coil;
  const std::size_t size = coils ? (block.count + 7) / 8 : 2 * block.count;
  require(block.count >= 1 && size <= 255, "a read that no frame can carry");
  wire::Bytes reply(2 + size, byte);
  reply[0] = coils ? 0x01 : 0x03;
  reply[1] = static_cast<std::uint8_t>(size);
  return reply;
}

void useBlocks(const Drive& drive, const std::vector<drive::ReadBlock>& blocks)
{
  for (const drive::ReadBlock& block : blocks)
  {
    require(!drive.read(1, block).pdu.empty(), "an empty request");
    for (const unsigned char byte : { std::uint8_t{ 0x00 }, std::uint8_t{ 0x30 }, std::uint8_t{ 0xFF } })
    {
      drive::Monitor monitor;
      drive.decode(block, fullReply(block, byte), monitor);
      drive.faultText(monitor.fault_code.value_or(1));
      drive.warningText(monitor.warning_code.value_or(1));
    }
  }
}

void useParameters(const Drive& drive)
{
  for (const auto& entry : drive.profile().parameters)
  {
    drive.parameterRefusal(entry.first, true);
    const auto parameter = drive.findParameter(entry.first, false);
    if (!parameter)
    {
      continue;
    }
    for (const double value : { 0.0, 1.0, -1.0, 1e9, -1e300, std::nan("") })
    {
      const drive::Encoded encoded = drive.encodeParameter(*parameter, value);
      require(encoded.ok == encoded.error.empty(), "a refusal without a reason");
      drive.writeParameter(1, *parameter, encoded.raw);
    }
    require(!drive.readParameter(1, *parameter).pdu.empty(), "an empty request");
  }
}

void useSequences(const Drive& drive)
{
  for (const auto& entry : drive.profile().sequences)
  {
    drive.missingFor(entry.first);
    drive.armingAdvice(entry.first);
    const drive::Sequence* sequence = drive.sequence(entry.first);
    for (std::size_t i = 0; sequence != nullptr && i < sequence->steps.size(); ++i)
    {
      const drive::Step& step = sequence->steps[i];
      require(!drive.command(1, step, 1).pdu.empty(), "a step without a request");
      require(std::isfinite(step.pause) && step.pause >= 0.0 && step.pause <= 3600.0, "a pause without end");
    }
  }
}

void use(const Drive& drive)
{
  useBlocks(drive, drive.fastBlocks());
  useBlocks(drive, drive.slowBlocks());
  useBlocks(drive, drive.faultBlocks());
  useParameters(drive);
  useSequences(drive);
  for (const double frequency : { 0.0, 50.0, 1e300 })
  {
    drive.frequencyCounts(frequency);
  }
  for (std::size_t i = 0; i < drive.faultEntries() && i < 3; ++i)
  {
    drive.faultReads(i);
  }
  drive.chosenRead({ 1, 2, 3, 4, 14 });
  drive.unconfirmedText();
  drive.runsWithoutStop();
  drive.exceptionText(0x8302);
  drive.readAttributes(1);
  drive.loopback(1, 0xA55A);
  drive.readStoreBusy(1);
}

/// A message, or a drive.
std::string load(const std::string& path, const drive::ProfileChanges& changes)
{
  try
  {
    use(Drive(drive::loadProfile(path, "", changes)));
    return "";
  }
  catch (const drive::ConfigurationError& error)
  {
    requireOneLine(error.what());
    return error.what();
  }
}
}  // namespace
}  // namespace fuzz
}  // namespace inverter_bus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace inverter_bus;
  static fuzz::TextFile file;
  file.write(data, size);
  const std::vector<std::string> problems = drive::checkProfile(file.path());
  for (const std::string& problem : problems)
  {
    fuzz::requireOneLine(problem);
  }
  const std::string message = fuzz::load(file.path(), drive::ProfileChanges());
  fuzz::require(message == (problems.empty() ? "" : problems.front()),
                "the node says something else than check_profile");
  if (problems.empty())
  {
    drive::ProfileChanges all;
    all.place = "fuzz";
    all.confirm = { "all" };
    fuzz::load(file.path(), all);
  }
  return 0;
}
