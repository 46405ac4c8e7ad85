// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/trace_files.h"

#include <fcntl.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "ros/trace_text.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
namespace fs = std::filesystem;

constexpr Duration ASKED_PERIOD = std::chrono::seconds(1);
constexpr std::size_t FILES_KEPT = 50;
constexpr std::size_t LONGEST_REASON = 60;
// Leaves room for the rest in the 255 bytes that a file's name may have.
constexpr std::size_t LONGEST_NODE_NAME = 120;
const char* const EXTENSION = ".txt";
/// In a file's name, between its number and the reason. Neither a node's name nor a reason has a '-', so that they can't look
/// like this.
const char* const AUTOMATIC = "-";
const char* const ASKED = "-asked-";

/// \p text with everything but letters and digits made a single '_', so that it can't leave the directory.
std::string safeReason(const std::string& text)
{
  std::string name;
  for (const char character : text)
  {
    if (std::isalnum(static_cast<unsigned char>(character)) != 0)
    {
      name += character;
    }
    else if (!name.empty() && name.back() != '_')
    {
      name += '_';
    }
  }
  name = name.substr(0, LONGEST_REASON);
  while (!name.empty() && name.back() == '_')
  {
    name.pop_back();
  }
  return name;
}

/// \p node_name without its first '/', each other '/' a '.', which no name of a node has: those of two nodes differ. What no
/// name of a node has either is made '_', so that the result can't leave the directory.
std::string safeNodeName(const std::string& node_name)
{
  std::string name = node_name.substr(std::min(node_name.find_first_not_of('/'), node_name.size()));
  for (char& character : name)
  {
    if (character == '/')
    {
      character = '.';
    }
    else if (std::isalnum(static_cast<unsigned char>(character)) == 0)
    {
      character = '_';
    }
  }
  return name.substr(0, LONGEST_NODE_NAME);
}

bool startsAndEndsWith(const std::string& name, const std::string& start, const std::string& end)
{
  return name.size() > start.size() + end.size() && name.compare(0, start.size(), start) == 0 &&
         name.compare(name.size() - end.size(), end.size(), end) == 0;
}

/// A file of this recorder: \p prefix, a date and a time, EXTENSION. What a user calls similarly stays.
bool isTrace(const std::string& name, const std::string& prefix)
{
  constexpr std::size_t DATE_SIZE = 8;
  if (!startsAndEndsWith(name, prefix, EXTENSION) || name.size() <= prefix.size() + DATE_SIZE)
  {
    return false;
  }
  const auto date = name.begin() + static_cast<std::ptrdiff_t>(prefix.size());
  const auto is_digit = [](unsigned char character) { return std::isdigit(character) != 0; };
  return std::all_of(date, date + DATE_SIZE, is_digit) && date[DATE_SIZE] == 'T';
}

/// Which of the two kinds a file is; those of earlier versions count as automatic ones.
std::string kindOf(const std::string& name)
{
  return name.find(ASKED) == std::string::npos ? AUTOMATIC : ASKED;
}

/// Writes a file that must not exist yet. Returns 0 or an errno.
int writeNewFile(const std::string& path, const std::string& text)
{
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (file < 0)
  {
    return errno;
  }
  int error = 0;
  std::size_t written = 0;
  while (written < text.size() && error == 0)
  {
    const ssize_t count = ::write(file, text.data() + written, text.size() - written);
    error = count >= 0 || errno == EINTR ? 0 : errno;
    written += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  return close(file) == 0 || error != 0 ? error : errno;
}
}  // namespace

std::string expandHome(const std::string& path)
{
  static const std::string ROS_FOLDER = "~/.ros";
  const bool in_ros_folder = path == ROS_FOLDER || path.compare(0, ROS_FOLDER.size() + 1, ROS_FOLDER + "/") == 0;
  const char* ros_home = std::getenv("ROS_HOME");
  if (in_ros_folder && ros_home != nullptr && *ros_home != '\0')
  {
    return ros_home + path.substr(ROS_FOLDER.size());
  }
  if (path != "~" && path.compare(0, 2, "~/") != 0)
  {
    return path;
  }
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0')
  {
    const passwd* user = getpwuid(getuid());
    home = user != nullptr ? user->pw_dir : "/tmp";
  }
  return home + path.substr(1);
}

TraceFiles::TraceFiles(const std::string& directory, const std::string& node_name, Log log)
  : directory_(expandHome(directory)), prefix_(safeNodeName(node_name) + "-"), log_(std::move(log))
{
  thread_ = std::thread([this] { work(); });
}

TraceFiles::~TraceFiles()
{
  stop();
}

void TraceFiles::writeSoon(bus::TraceDump dump)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopping_ || waiting_)
    {
      return;
    }
    waiting_ = std::move(dump);
  }
  changed_.notifyOne();
}

std::string TraceFiles::writeAsked(const std::function<bus::TraceDump()>& record, TimePoint now, std::string& error)
{
  const std::lock_guard<std::mutex> lock(writing_);
  if (last_asked_at_ && now - *last_asked_at_ < ASKED_PERIOD)
  {
    return last_asked_;
  }
  std::string path = write(record(), ASKED, error);
  if (!path.empty())
  {
    last_asked_ = path;
    last_asked_at_ = now;
  }
  return path;
}

/// With \ref writing_ held.
std::string TraceFiles::write(const bus::TraceDump& dump, const std::string& kind, std::string& error)
{
  std::ostringstream text;
  writeTrace(dump, std::chrono::steady_clock::now(), std::chrono::system_clock::now(), text);
  std::error_code result;
  fs::create_directories(directory_, result);
  std::string path = newPath(kind, dump.reason);
  // Under another name first: a program that watches the directory never sees half a file.
  const std::string part = path + ".part";
  const int problem = writeNewFile(part, text.str());
  if (problem != 0 || std::rename(part.c_str(), path.c_str()) != 0)
  {
    error = "can't write the flight recorder into " + directory_ + " (" +
            std::strerror(problem != 0 ? problem : errno) + "): check trace_directory and the space on its disk";
    std::remove(part.c_str());
    return "";
  }
  removeOldFiles(path, kind);
  const std::string reason = util::printable(dump.reason);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_ = File{ path, reason };
  }
  log_(bus::Level::Ok, "flight recorder (" + reason + ") written to " + path);
  return path;
}

std::optional<TraceFiles::File> TraceFiles::last() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_;
}

void TraceFiles::stop()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notifyOne();
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void TraceFiles::work()
{
  std::string last_error;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true)
  {
    changed_.wait(lock, [this] { return stopping_ || waiting_; });
    if (!waiting_)
    {
      return;
    }
    const bus::TraceDump dump = std::move(*waiting_);
    waiting_.reset();
    lock.unlock();
    std::string error;
    {
      const std::lock_guard<std::mutex> writing(writing_);
      write(dump, AUTOMATIC, error);
    }
    if (!error.empty() && error != last_error)
    {
      log_(bus::Level::Warn, error);
    }
    last_error = error;
    lock.lock();
  }
}

/// The number keeps names apart and in order when the wall clock stops or goes back.
std::string TraceFiles::newPath(const std::string& kind, const std::string& reason)
{
  char number[16];
  std::snprintf(number, sizeof number, "-%04u", ++number_ % 10000U);
  const std::string name =
      prefix_ + fileStamp(std::chrono::system_clock::now()) + number + kind + safeReason(reason) + EXTENSION;
  return (fs::path(directory_) / name).string();
}

void TraceFiles::removeOldFiles(const std::string& newest, const std::string& kind) const
{
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(directory_, error), end; !error && entry != end; entry.increment(error))
  {
    const std::string path = entry->path().string();
    const std::string name = entry->path().filename().string();
    if (path != newest && isTrace(name, prefix_) && kindOf(name) == kind)
    {
      files.push_back(path);
    }
  }
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i + FILES_KEPT <= files.size(); ++i)
  {
    std::remove(files[i].c_str());
  }
}
}  // namespace ros_node
}  // namespace inverter_bus
