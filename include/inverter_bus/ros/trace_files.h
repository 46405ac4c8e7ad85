// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_TRACE_FILES_H
#define INVERTER_BUS_ROS_TRACE_FILES_H

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace ros_node
{
/// Path without a leading `~`.
std::string expandHome(const std::string& path);

/// Writes the flight recorder's content into files, away from the bus thread. Of one node the newest 50 are kept.
class TraceFiles
{
public:
  using Warn = std::function<void(const std::string&)>;

  /// \param directory as configured; made when the first file is written
  /// \param node_name in the files' names, so that several buses can share a directory
  /// \param warn gets one sentence when a file could not be written; any thread
  TraceFiles(const std::string& directory, const std::string& node_name, Warn warn);
  /// As stop().
  ~TraceFiles();

  TraceFiles(const TraceFiles&) = delete;
  TraceFiles& operator=(const TraceFiles&) = delete;

  /// Writes \p dump soon, but at most one file per 10 s; does not block. Any thread.
  void writeSoon(bus::TraceDump dump);

  /// Writes now. Any thread.
  /// \return the file's path; empty: it failed, and \p error says why
  std::string write(const bus::TraceDump& dump, std::string& error);

  /// Writes what waits and ends the thread: nothing is written soon any more.
  void stop();

private:
  void work();
  std::string newPath(const std::string& reason);
  void removeOldFiles(const std::string& newest) const;

  const std::string directory_;
  const std::string prefix_;
  const Warn warn_;

  std::mutex writing_;  ///< one file at a time
  unsigned number_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<bus::TraceDump> waiting_;
  std::optional<TimePoint> last_automatic_;
  bool stopping_ = false;
  std::thread thread_;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_TRACE_FILES_H
