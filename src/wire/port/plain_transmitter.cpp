// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>

#include "inverter_bus/util/clock.h"
#include "wire/port/poll_descriptor.h"
#include "wire/port/transmitter.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// For a port whose buffer is full: more than any frame of a healthy one.
constexpr std::chrono::milliseconds WRITE_SLACK{ 50 };

class PlainTransmitter : public Transmitter
{
public:
  explicit PlainTransmitter(const SerialSettings& settings) : settings_(settings)
  {
  }

  bool attach(int tty, bool switch_rts) override
  {
    tty_ = tty;
    switch_rts_ = switch_rts;
    return setTransmitting(false);
  }

  void detach() override
  {
    tty_ = -1;
  }

  bool send(const Bytes& frame) override
  {
    if (!setTransmitting(true))
    {
      return false;
    }
    const TimePoint end = std::chrono::steady_clock::now() + timeOnLine(settings_, frame.size() + 1);
    const bool written = writeAll(frame, end + WRITE_SLACK);
    if (switch_rts_)
    {
      util::SteadyClock().sleepUntil(end);
    }
    return setTransmitting(false) && written;
  }

private:
  bool writeAll(const Bytes& frame, TimePoint deadline) const
  {
    std::size_t written = 0;
    while (written < frame.size() && waitUntilWritable(tty_, deadline))
    {
      const ssize_t count = ::write(tty_, frame.data() + written, frame.size() - written);
      if (count < 0 && errno != EAGAIN && errno != EINTR)
      {
        return false;
      }
      written += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    return written == frame.size();
  }

  bool setTransmitting(bool on) const
  {
    if (!switch_rts_)
    {
      return true;
    }
    const bool high = on == (settings_.rs485 == Rs485::RtsHigh);
    const int rts = TIOCM_RTS;
    return ::ioctl(tty_, high ? TIOCMBIS : TIOCMBIC, &rts) == 0;
  }

  SerialSettings settings_;
  int tty_ = -1;
  bool switch_rts_ = false;
};
}  // namespace

std::unique_ptr<Transmitter> makePlainTransmitter(const SerialSettings& settings)
{
  return std::make_unique<PlainTransmitter>(settings);
}
}  // namespace wire
}  // namespace inverter_bus
