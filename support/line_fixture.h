// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_LINE_FIXTURE_H
#define INVERTER_BUS_TEST_LINE_FIXTURE_H

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/wire/line.h"
#include "support/fake_port.h"
#include "support/wire_frames.h"

namespace inverter_bus
{
namespace wire
{
/// A line at 19200 8N1 on virtual time, Modbus RTU unless set otherwise. A character takes 521 us, the gap 1.8 ms, a
/// read request 4.2 ms.
class LineFixture : public testing::Test
{
protected:
  explicit LineFixture(std::unique_ptr<Protocol> protocol = makeModbusRtu(), LineTiming timing = { 19200, 10 })
    : protocol_(std::move(protocol)), timing_(timing)
  {
    std::string error;
    line_.open(error);
    line_.setFrameObserver([this](const FrameEvent& event) { events_.push_back(event); });
  }

  /// The exchange of a request, written without CRC, as the bus does it.
  Reply ask(const std::string& request)
  {
    EXPECT_TRUE(line_.settle());
    return line_.exchange(requestOf(withCrc(request)));
  }

  bool mayAsk(const std::string& request) const
  {
    return line_.mayAsk(requestOf(withCrc(request)));
  }

  /// The next request is answered \p milliseconds after its beginning; \p frame without CRC.
  void answerNext(const std::string& frame, double milliseconds = 10)
  {
    port_.answerNext({ { ms(milliseconds), withCrc(frame) } });
  }

  void answerNextRaw(const Bytes& bytes, double milliseconds = 10)
  {
    port_.answerNext({ { ms(milliseconds), bytes } });
  }

  static Duration ms(double milliseconds)
  {
    return seconds(milliseconds / 1000);
  }

  Duration elapsed() const
  {
    return clock_.now() - start_;
  }

  void startWatch()
  {
    start_ = clock_.now();
  }

  /// Kinds of all frames seen so far, one letter each: Request, Reply (A), Exception, Damaged, Late, Foreign.
  std::string seen() const
  {
    std::string letters;
    for (const FrameEvent& event : events_)
    {
      letters += "RAEDLF"[static_cast<int>(event.kind)];
    }
    return letters;
  }

  const std::string READ = "01 03 00 00 00 02";
  const std::string REPLY = "01 03 04 12 34 56 78";
  const std::string OTHER_READ = "01 03 00 00 00 01";
  const std::string OTHER_REPLY = "01 03 02 12 34";
  const std::string WRITE = "01 06 00 01 13 88";
  const std::string LOOP_BACK = "01 08 00 00 12 34";

  VirtualClock clock_;
  FakePort port_{ clock_ };
  const std::unique_ptr<Protocol> protocol_;
  const LineTiming timing_;
  Line line_{ port_, *protocol_, clock_, timing_ };
  std::vector<FrameEvent> events_;
  TimePoint start_ = clock_.now();
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_LINE_FIXTURE_H
