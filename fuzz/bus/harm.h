// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_HARM_H
#define INVERTER_BUS_FUZZ_HARM_H

#include "fuzz/bus/streams.h"

namespace inverter_bus
{
namespace fuzz
{
/// Faults by chance: of replies, drives and the line.
class Harm
{
public:
  /// \p refuses drives refuse requests; otherwise replies of another kind come. (A refusal that is then made another
  /// request's answer would look like the right one.)
  Harm(Stage& stage, Streams& streams, bool refuses);

  /// Something fails.
  void act();

private:
  void harmReplies(std::size_t index);
  void harmDrive(std::size_t index);
  void takeOver(std::size_t index);
  void harmLine();
  void killSeveral();
  void failWhileItChanges();
  void fail(std::size_t index, double how, double duration);

  Stage& stage_;
  Streams& streams_;
  bool refuses_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_HARM_H
