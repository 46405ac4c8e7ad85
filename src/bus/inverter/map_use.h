// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_MAP_USE_H
#define INVERTER_BUS_BUS_MAP_USE_H

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/inverter/map_table.h"
#include "bus/inverter/mapped_reads.h"
#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace bus
{
/// Whether the status comes through a drive's register map (contract, 8.17). What is read of the map says what the drive
/// will do from its next power-on; what it does now is proven: mapped words must equal plain reads before and after them,
/// once with RUN off, at rest, and once with RUN on. A lost exchange may hide a power cycle: then it is proven again, as
/// it is when its words contradict the frequency beside them. A mapped read that is refused, or unlike the plain ones,
/// ends the use until the next connect. Pure. Not thread safe; the bus guards it.
class MapUse
{
public:
  /// Both must outlive it.
  MapUse(const drive::Drive& drive, const InverterConfig& config);

  /// The configuration asks for it: what is read of the map matters.
  static bool wanted(const drive::Drive& drive, const InverterConfig& config);

  /// What a refresh that begins at \p now is to do. \p fits: the drive's table is as wanted; \p run: a RUN from this node
  /// may be in force; \p at_rest: the last status showed the motor at rest.
  MapOrders orders(TimePoint now, bool fits, bool run, bool at_rest);
  /// How a refresh that had orders went.
  void note(const MapOutcome& outcome);
  /// An exchange was lost.
  void lost();
  /// The drive was connected again, or switched off and on.
  void restart();
  /// Not used until the next connect, for the reason \p why.
  void end(const std::string& why);

  /// Parameters that make it fit (`configure_map`), once; empty where nothing is to be written. \p at_rest: it may be
  /// written.
  std::vector<std::pair<std::string, std::uint32_t>> takeWrites(const MapTable& table, bool at_rest);
  /// The map is in other use, and was not written: what to say, once; empty: nothing.
  std::string takeRefusal(const MapTable& table);

  bool inUse() const;
  /// Why it is not used, and what to do; empty: it is, or it is not to be used.
  std::string whyNot(const MapTable& table) const;

private:
  const drive::Drive& drive_;
  const InverterConfig& config_;
  const std::optional<drive::ReadBlock> read_;
  /// With RUN off, with RUN on.
  std::array<bool, 2> proven_{};
  TimePoint next_proof_;
  std::string ended_;
  bool in_use_ = false;
  bool written_ = false;
  bool refusal_told_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_MAP_USE_H
