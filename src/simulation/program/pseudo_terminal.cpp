// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/pseudo_terminal.h"

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "simulation/line/terminal_settings.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
[[noreturn]] void fail(const std::string& what)
{
  throw std::runtime_error(what + ": " + std::strerror(errno));
}
}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link, const LineSettings& settings) : link_(link), settings_(settings)
{
  open();
}

PseudoTerminal::~PseudoTerminal()
{
  close();
}

void PseudoTerminal::open()
{
  close();
  near_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  char name[PATH_MAX];
  if (near_ < 0 || grantpt(near_) != 0 || unlockpt(near_) != 0 || ptsname_r(near_, name, sizeof(name)) != 0)
  {
    fail("no pseudo-terminal");
  }
  path_ = name;
  far_ = ::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (far_ < 0)
  {
    fail(path_);
  }
  setTerminal(far_, settings_);
  try
  {
    makeLink();
  }
  catch (...)
  {
    path_.clear();
    close();
    throw;
  }
}

void PseudoTerminal::makeLink()
{
  struct stat status
  {
  };
  if (lstat(link_.c_str(), &status) == 0 && !S_ISLNK(status.st_mode))
  {
    throw std::runtime_error("--link " + link_ + ": exists and is no link (allowed: a new name, or an old link)");
  }
  const std::string fresh = link_ + "." + std::to_string(getpid());
  if (symlink(path_.c_str(), fresh.c_str()) != 0 || rename(fresh.c_str(), link_.c_str()) != 0)
  {
    fail("--link " + link_);
  }
}

void PseudoTerminal::removeLink()
{
  char target[PATH_MAX];
  const ssize_t size = readlink(link_.c_str(), target, sizeof(target));
  if (size > 0 && path_ == std::string(target, static_cast<std::size_t>(size)))
  {
    unlink(link_.c_str());
  }
}

void PseudoTerminal::close()
{
  if (near_ >= 0)
  {
    removeLink();
    ::close(near_);
  }
  if (far_ >= 0)
  {
    ::close(far_);
  }
  near_ = -1;
  far_ = -1;
}

bool PseudoTerminal::isOpen() const
{
  return near_ >= 0;
}

int PseudoTerminal::descriptor() const
{
  return near_;
}

const std::string& PseudoTerminal::path() const
{
  return path_;
}

const std::string& PseudoTerminal::link() const
{
  return link_;
}

Bytes PseudoTerminal::read()
{
  Bytes bytes;
  std::uint8_t buffer[512];
  for (ssize_t size = 1; size > 0 && near_ >= 0;)
  {
    size = ::read(near_, buffer, sizeof(buffer));
    if (size > 0)
    {
      bytes.insert(bytes.end(), buffer, buffer + size);
    }
  }
  return bytes;
}

void PseudoTerminal::write(const Bytes& bytes)
{
  std::size_t written = 0;
  while (near_ >= 0 && written < bytes.size())
  {
    const ssize_t size = ::write(near_, bytes.data() + written, bytes.size() - written);
    if (size < 0 && errno == EINTR)
    {
      continue;
    }
    if (size <= 0)
    {
      return;
    }
    written += static_cast<std::size_t>(size);
  }
}
}  // namespace simulation
}  // namespace inverter_bus
