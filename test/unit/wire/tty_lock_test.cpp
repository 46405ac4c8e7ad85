// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The two locks of a serial port. A pseudo-terminal is not made exclusive by the driver, but it can be: it stands for the
// real port here.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>

#include "wire/port/tty_setup.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
class TtyLock : public testing::Test
{
protected:
  TtyLock()
  {
    EXPECT_EQ(0, ::grantpt(master_));
    EXPECT_EQ(0, ::unlockpt(master_));
    device_ = ::ptsname(master_);
    first_ = openDevice();
    second_ = openDevice();
  }

  ~TtyLock() override
  {
    for (const int descriptor : { first_, second_, master_ })
    {
      ::close(descriptor);
    }
  }

  int openDevice() const
  {
    return ::open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  }

  static int exclusive(int tty)
  {
    int set = -1;
    EXPECT_EQ(0, ::ioctl(tty, TIOCGEXCL, &set));
    return set;
  }

  int master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
  std::string device_;
  int first_ = -1;
  int second_ = -1;
};

TEST_F(TtyLock, aRealPortIsLockedTwice)
{
  ASSERT_EQ(LockResult::Taken, lockTty(first_, false));
  EXPECT_EQ(1, exclusive(second_));
  EXPECT_NE(0, ::flock(second_, LOCK_EX | LOCK_NB));
  EXPECT_EQ(EWOULDBLOCK, errno);
}

TEST_F(TtyLock, nobodyButRootOpensAnExclusivePort)
{
  ASSERT_EQ(LockResult::Taken, lockTty(first_, false));
  if (::geteuid() == 0)
  {
    // Root passes TIOCEXCL: what stops a second node of root's is the flock.
    EXPECT_EQ(LockResult::Locked, lockTty(second_, false));
    return;
  }
  EXPECT_LT(openDevice(), 0);
  EXPECT_EQ(EBUSY, errno);
}

TEST_F(TtyLock, aPseudoTerminalHasTheFlockOnly)
{
  ASSERT_EQ(LockResult::Taken, lockTty(first_, true));
  EXPECT_EQ(0, exclusive(second_));
  EXPECT_EQ(LockResult::Locked, lockTty(second_, true));
}

TEST_F(TtyLock, whoeverFindsItLockedLeavesTheLockAlone)
{
  ASSERT_EQ(LockResult::Taken, lockTty(first_, false));
  EXPECT_EQ(LockResult::Locked, lockTty(second_, false));
  EXPECT_EQ(1, exclusive(first_));
  EXPECT_EQ(LockResult::Locked, lockTty(second_, false));
}

TEST_F(TtyLock, aPortThatIsExclusiveIsInUseWhoeverSeesWhichLock)
{
  // As through another device file of the same port: nobody holds the lock that is seen here.
  ASSERT_EQ(0, ::ioctl(first_, TIOCEXCL));
  EXPECT_EQ(LockResult::Exclusive, lockTty(second_, false));
  EXPECT_EQ(1, exclusive(first_)) << "it is the owner's";
  // The lock was given back: it would refuse the owner's own next open.
  EXPECT_EQ(0, ::flock(first_, LOCK_EX | LOCK_NB));
}

TEST_F(TtyLock, whatAKilledOwnerLeavesEndsWithTheLastThatHasThePortOpen)
{
  ASSERT_EQ(LockResult::Taken, lockTty(first_, false));
  ::close(first_);
  first_ = -1;
  EXPECT_EQ(LockResult::Exclusive, lockTty(second_, false));
  ASSERT_EQ(0, ::ioctl(second_, TIOCNXCL));
  EXPECT_EQ(LockResult::Taken, lockTty(second_, false));
}

TEST_F(TtyLock, unlockingEndsBoth)
{
  ASSERT_EQ(LockResult::Taken, lockTty(first_, false));
  unlockTty(first_, false);
  EXPECT_EQ(0, exclusive(second_));
  EXPECT_EQ(LockResult::Taken, lockTty(second_, false));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
