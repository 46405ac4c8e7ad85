// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/lost_writes.h"

namespace inverter_bus
{
namespace bus
{
LostWrites::LostWrites(int retries, int offline_after) : retries_(retries), offline_after_(offline_after)
{
}

bool LostWrites::tryAgain()
{
  ++tries_;
  return tries_ <= retries_;
}

void LostWrites::velocityEnded()
{
  tries_ = 0;
}

bool LostWrites::lost()
{
  read_answered_ = read_answered_ && in_a_row_ > 0;
  ++in_a_row_;
  return in_a_row_ >= offline_after_;
}

void LostWrites::acknowledged()
{
  tries_ = 0;
  in_a_row_ = 0;
  raised_ = false;
}

bool LostWrites::readAnswered()
{
  const bool news = raised_ && !read_answered_;
  read_answered_ = true;
  return news;
}

void LostWrites::raise()
{
  raised_ = true;
}

void LostWrites::lower()
{
  raised_ = false;
}

bool LostWrites::raised() const
{
  return raised_;
}

std::string LostWrites::text() const
{
  return read_answered_ ? "reads are answered, writes are lost" : "writes are lost";
}

int LostWrites::inARow() const
{
  return in_a_row_;
}
}  // namespace bus
}  // namespace inverter_bus
