// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/jobs.h"

namespace inverter_bus
{
namespace bus
{
Job::Job(const drive::Drive& drive, std::uint8_t station, CommandKind kind)
  : drive_(drive), station_(station), kind_(kind)
{
}

CommandKind Job::kind() const
{
  return kind_;
}

Duration Job::pause() const
{
  return pause_;
}

Answer& Job::answer()
{
  return answer_;
}

Job::Progress Job::fail(std::uint16_t error_id, const std::string& message)
{
  answer_.success = false;
  answer_.error_id = error_id;
  answer_.message = message;
  return Progress::Done;
}

Job::Progress Job::succeed(const std::string& message)
{
  answer_.success = true;
  answer_.error_id = ERROR_NONE;
  answer_.message = message;
  return Progress::Done;
}

Job::Progress Job::refusedByDrive(const wire::Reply& reply, const std::string& what)
{
  return fail(reply.error_id, what + ": " + drive_.exceptionText(reply.error_id));
}

Job::Progress Job::lost(const wire::Reply& reply)
{
  return fail(reply.error_id, errorText(reply.error_id, reply.gateway_code));
}

// --- faults ----------------------------------------------------------------------------------------------------------

ReadFaultsJob::ReadFaultsJob(const drive::Drive& drive, std::uint8_t station, bool faulted)
  : Job(drive, station, CommandKind::ReadFaults), faulted_(faulted), reads_(drive.faultReads(0))
{
}

wire::Request ReadFaultsJob::next()
{
  return drive_.read(station_, reads_[read_]);
}

Job::Progress ReadFaultsJob::done(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Exception)
  {
    return refusedByDrive(reply, "reading the trip memory");
  }
  drive_.decodeFault(entry_, reads_[read_], reply.pdu, record_);
  if (++read_ < reads_.size())
  {
    return Progress::GoesOn;
  }
  if (record_.code != 0)
  {
    answer().faults.push_back(record_);
  }
  record_ = drive::FaultRecord();
  read_ = 0;
  if (++entry_ >= drive_.faultEntries())
  {
    return finish();
  }
  reads_ = drive_.faultReads(entry_);
  return Progress::GoesOn;
}

Job::Progress ReadFaultsJob::finish()
{
  if (faulted_ && !answer().faults.empty())
  {
    answer().present = answer().faults.front();
  }
  const std::size_t count = answer().faults.size();
  return succeed(count == 0 ? "the trip memory is empty" : std::to_string(count) + " trips, newest first");
}
}  // namespace bus
}  // namespace inverter_bus
