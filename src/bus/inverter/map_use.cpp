// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/map_use.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// A drive whose state changes just then is asked again, not in every refresh.
constexpr double PROOF_PERIOD_S = 0.5;
}  // namespace

MapUse::MapUse(const drive::Drive& drive, const InverterConfig& config)
  : drive_(drive), config_(config), read_(drive.mappedRead())
{
}

bool MapUse::wanted(const drive::Drive& drive, const InverterConfig& config)
{
  return drive.profile().map && (config.configure_map || drive.mappedRead());
}

MapOrders MapUse::orders(TimePoint now, bool fits, bool run, bool at_rest)
{
  MapOrders orders;
  in_use_ = false;
  if (!read_ || !fits || !ended_.empty())
  {
    return orders;
  }
  const std::size_t state = run ? 1 : 0;
  if (proven_[state])
  {
    orders.read = read_;
    orders.proven_with_run = proven_[0] && proven_[1] ? std::nullopt : std::optional<bool>(run);
    in_use_ = true;
  }
  else if ((run || at_rest) && now >= next_proof_)
  {
    next_proof_ = now + seconds(PROOF_PERIOD_S);
    orders.proof = { *read_, drive_.blockOf({ "raw_status" }) };
  }
  return orders;
}

void MapUse::note(const MapOutcome& outcome)
{
  switch (outcome.verdict)
  {
    case MapOutcome::Verdict::Equal:
      proven_[outcome.run ? 1 : 0] = true;
      break;
    case MapOutcome::Verdict::Unlike:
      end("its words are not those of plain reads, so it is not in effect: switch the drive off and on");
      break;
    case MapOutcome::Verdict::Refused:
      end("the drive refuses the read: switch it off and on, or set P200 = 0");
      break;
    case MapOutcome::Verdict::Doubtful:
      lost();
      break;
    case MapOutcome::Verdict::Open:
      break;
  }
}

void MapUse::lost()
{
  proven_ = {};
}

void MapUse::restart()
{
  proven_ = {};
  ended_.clear();
  next_proof_ = TimePoint();
  in_use_ = false;
}

void MapUse::end(const std::string& why)
{
  ended_ = why;
  proven_ = {};
  in_use_ = false;
}

std::vector<std::pair<std::string, std::uint32_t>> MapUse::takeWrites(const MapTable& table, bool at_rest)
{
  if (!config_.configure_map || written_ || !at_rest || !table.known() || table.fits() || table.inOtherUse())
  {
    return {};
  }
  written_ = true;
  return table.differences();
}

std::string MapUse::takeRefusal(const MapTable& table)
{
  if (!config_.configure_map || refusal_told_ || !table.inOtherUse())
  {
    return "";
  }
  refusal_told_ = true;
  return "configure_map: nothing is written, since the drive's register map is in other use: it has " + table.text() +
         "; wanted: " + table.wantedText();
}

bool MapUse::inUse() const
{
  return in_use_;
}

std::string MapUse::whyNot(const MapTable& table) const
{
  if (!wanted(drive_, config_) || in_use_)
  {
    return "";
  }
  const std::string text = "the register map is not used: ";
  if (table.refused())
  {
    return text + "the drive refuses to read out the map's parameters, and may have no map";
  }
  if (!table.known())
  {
    return "";
  }
  if (table.inOtherUse())
  {
    return text + "it is in other use, with " + table.text() + " instead of " + table.wantedText();
  }
  if (!table.fits())
  {
    return text + "the drive has " + table.text() + " instead of " + table.wantedText() +
           (config_.configure_map ? "; it is written while the motor is at rest"
                                  : "; set the drive, or configure_map: true");
  }
  if (!read_)
  {
    return text + "no maker shows a read of several mapped registers; confirm: [" + drive_.profile().map->unconfirmed +
           "] tries it";
  }
  return ended_.empty() ? "" : text + ended_;
}
}  // namespace bus
}  // namespace inverter_bus
