// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_TRACE_FILES_H
#define INVERTER_BUS_ROS_TRACE_FILES_H

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "inverter_bus/bus/types.h"
#include "util/steady_condition.h"

namespace inverter_bus
{
namespace ros_node
{
/// Path without a leading `~`; `~/.ros` is ROS_HOME where that is set, as for ROS itself.
std::string expandHome(const std::string& path);

/// Writes the flight recorder's content into files, away from the bus thread. Of one node the newest 50 that were written by
/// themselves and the newest 50 that were asked for are kept. Each is named in the log.
class TraceFiles
{
public:
  using Log = std::function<void(bus::Level, const std::string&)>;

  struct File
  {
    std::string path;
    std::string reason;
  };

  /// \param directory as configured; made when the first file is written
  /// \param node_name in the files' names, each '/' inside it a '.', so that several buses can share a directory
  /// \param log gets one line for each file, or one that says why there is none; any thread
  TraceFiles(const std::string& directory, const std::string& node_name, Log log);
  /// As stop().
  ~TraceFiles();

  TraceFiles(const TraceFiles&) = delete;
  TraceFiles& operator=(const TraceFiles&) = delete;

  /// Writes \p dump soon; does not block. How often that may be is the caller's (bus::FlightRecorder); one that comes while
  /// another waits for a slow disk is left out. Any thread.
  void writeSoon(bus::TraceDump dump);

  /// Writes what \p record gives now because it was asked for, but at most one file per second: else the last one that
  /// was asked for. Any thread.
  /// \return the file's path; empty: it failed, and \p error says why
  std::string writeAsked(const std::function<bus::TraceDump()>& record, TimePoint now, std::string& error);

  /// The file that was written last, if any. Any thread.
  std::optional<File> last() const;

  /// Writes the files that wait and ends the thread: nothing is written afterwards.
  void stop();

private:
  void work();
  std::string write(const bus::TraceDump& dump, const std::string& kind, std::string& error);
  std::string newPath(const std::string& kind, const std::string& reason);
  void removeOldFiles(const std::string& newest, const std::string& kind) const;

  const std::string directory_;
  const std::string prefix_;
  const Log log_;

  std::mutex writing_;  ///< one file at a time
  unsigned number_ = 0;
  std::string last_asked_;
  std::optional<TimePoint> last_asked_at_;

  mutable std::mutex mutex_;
  util::SteadyCondition changed_;
  std::optional<bus::TraceDump> waiting_;
  std::optional<File> last_;
  bool stopping_ = false;
  std::thread thread_;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_TRACE_FILES_H
