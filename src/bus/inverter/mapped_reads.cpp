// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/mapped_reads.h"

namespace inverter_bus
{
namespace bus
{
bool MappedReads::take(const MapOrders& given)
{
  const MapOrders orders = plain_ ? MapOrders() : given;
  const bool same = orders.read.has_value() == orders_.read.has_value() && orders.proof.size() == orders_.proof.size();
  orders_ = orders;
  plain_ = false;
  mapped_word_.reset();
  return !same;
}

const MapOrders& MappedReads::orders() const
{
  return orders_;
}

void MappedReads::compare(bool mapped, const drive::Monitor& values, const drive::Monitor& before)
{
  if (mapped)
  {
    mapped_word_ = values.raw_status;
    return;
  }
  MapOutcome outcome;
  const bool told = mapped_word_ && values.raw_status && before.raw_status && before.run_seen;
  // A word without any bit proves nothing: registers that nothing lies over read 0 as well.
  if (told && *before.raw_status == *values.raw_status && *before.raw_status != 0)
  {
    outcome.verdict = *mapped_word_ == *before.raw_status ? MapOutcome::Verdict::Equal : MapOutcome::Verdict::Unlike;
    outcome.run = *before.run_seen;
  }
  outcome_ = outcome;
}

bool MappedReads::accepts(const drive::Monitor& values)
{
  const bool both = values.running && values.output_frequency;
  if (both && *values.running != (*values.output_frequency > 0.0))
  {
    outcome_ = MapOutcome{ MapOutcome::Verdict::Doubtful, false };
    return false;
  }
  return values.run_seen && (!orders_.proven_with_run || *values.run_seen == *orders_.proven_with_run);
}

void MappedReads::refused()
{
  outcome_ = MapOutcome{ MapOutcome::Verdict::Refused, false };
}

void MappedReads::drop()
{
  orders_ = MapOrders();
  plain_ = true;
}

std::optional<MapOutcome> MappedReads::takeOutcome()
{
  const std::optional<MapOutcome> outcome = outcome_;
  outcome_.reset();
  return outcome;
}

void MappedReads::forget()
{
  orders_ = MapOrders();
  mapped_word_.reset();
  outcome_.reset();
  plain_ = false;
}
}  // namespace bus
}  // namespace inverter_bus
