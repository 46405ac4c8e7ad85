// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// A serial port with a driver behind it, which a pseudo-terminal has not: the system calls below stand between the port
// and the kernel in this program and play the driver. Bytes go through a pseudo-terminal. <asm/termbits.h> excludes
// <termios.h>: neither may be included here by anything else.
#include <asm/termbits.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/serial.h>
#include <linux/tty.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>

#include "inverter_bus/wire/serial_port.h"
#include "support/wire_frames.h"
#include "wire/port/tty_setup.h"

namespace
{
/// What the driver of a real port keeps, and what was asked of it.
struct Driver
{
  termios2 attributes{};
  /// What it makes of a request.
  std::function<void(termios2&)> quirk = [](termios2&) {};
  serial_struct serial{};
  bool takes_serial_flags = true;
  int exclusive = 0;
  int discipline = N_TTY;
  bool takes_discipline = true;
  bool breaking = false;
  int flushes = 0;
};

Driver driver;

constexpr unsigned FIRST_PTS_MAJOR = 136;
constexpr unsigned LAST_PTS_MAJOR = 143;
constexpr unsigned TTY_USB_MAJOR = 188;

template <typename Function>
Function next(const char* name)
{
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

void lookReal(struct stat* status)
{
  const unsigned number = major(status->st_rdev);
  if (S_ISCHR(status->st_mode) && number >= FIRST_PTS_MAJOR && number <= LAST_PTS_MAJOR)
  {
    status->st_rdev = makedev(TTY_USB_MAJOR, minor(status->st_rdev));
  }
}

template <typename Kept>
int give(const Kept& kept, void* argument)
{
  *static_cast<Kept*>(argument) = kept;
  return 0;
}

void setAttributes(const termios2& wanted)
{
  driver.attributes = wanted;
  driver.quirk(driver.attributes);
}

int setDiscipline(int wanted)
{
  driver.discipline = driver.takes_discipline ? wanted : driver.discipline;
  errno = EINVAL;
  return driver.takes_discipline ? 0 : -1;
}

int setSerial(const serial_struct& wanted)
{
  driver.serial.flags = driver.takes_serial_flags ? wanted.flags : driver.serial.flags;
  return 0;
}
}  // namespace

extern "C" int fstat(int descriptor, struct stat* status) noexcept
{
  const int result = next<int (*)(int, struct stat*)>("fstat")(descriptor, status);
  lookReal(status);
  return result;
}

// Before glibc 2.33 fstat() was an inline function around this one.
extern "C" int __fxstat(int version, int descriptor, struct stat* status) noexcept
{
  const int result = next<int (*)(int, int, struct stat*)>("__fxstat")(version, descriptor, status);
  lookReal(status);
  return result;
}

extern "C" int tcflush(int /*descriptor*/, int /*queue*/) noexcept
{
  ++driver.flushes;
  return 0;
}

extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept
{
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  switch (request)
  {
    case TCGETS2:
      return give(driver.attributes, argument);
    case TCSETS2:
      setAttributes(*static_cast<const termios2*>(argument));
      return 0;
    case TIOCGEXCL:
      return give(driver.exclusive, argument);
    case TIOCEXCL:
    case TIOCNXCL:
      driver.exclusive = request == TIOCEXCL ? 1 : 0;
      return 0;
    case TIOCGSERIAL:
      return give(driver.serial, argument);
    case TIOCSSERIAL:
      return setSerial(*static_cast<const serial_struct*>(argument));
    case TIOCGETD:
      return give(driver.discipline, argument);
    case TIOCSETD:
      return setDiscipline(*static_cast<const int*>(argument));
    case TIOCCBRK:
      driver.breaking = false;
      return 0;
    default:
      return next<int (*)(int, unsigned long, ...)>("ioctl")(descriptor, request, argument);
  }
}

namespace inverter_bus
{
namespace wire
{
namespace
{
using testing::HasSubstr;

class RealPort : public testing::Test
{
protected:
  RealPort()
  {
    driver = Driver();
    EXPECT_EQ(0, ::grantpt(master_));
    EXPECT_EQ(0, ::unlockpt(master_));
    settings_.device = ::ptsname(master_);
    settings_.baud_rate = 19200;
  }

  ~RealPort() override
  {
    ::close(master_);
  }

  OpenResult open(Port& port)
  {
    return port.open(error_);
  }

  OpenResult open()
  {
    return open(*port());
  }

  std::unique_ptr<Port> port() const
  {
    return makeSerialPort(settings_);
  }

  std::string configured(const std::string& sysfs) const
  {
    const int tty = ::open(settings_.device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    std::string reason = configureTty(tty, settings_, false, sysfs);
    ::close(tty);
    return reason;
  }

  SerialSettings settings_;
  std::string error_;
  int master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
};

TEST_F(RealPort, isFlushedByItsOwnerWhenOpenedAndClosed)
{
  const auto owner = port();
  ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
  EXPECT_EQ(1, driver.flushes);
  owner->close();
  EXPECT_EQ(2, driver.flushes);
}

TEST_F(RealPort, isNotFlushedByWhoIsRefused)
{
  const auto owner = port();
  ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
  driver.flushes = 0;
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(OpenResult::InUse, open());
  }
  EXPECT_EQ(0, driver.flushes);
  EXPECT_EQ(1, driver.exclusive);
}

TEST_F(RealPort, isNotFlushedByWhoSharesIt)
{
  settings_.exclusive = false;
  {
    const auto first = port();
    ASSERT_EQ(OpenResult::Opened, open(*first)) << error_;
  }
  EXPECT_EQ(0, driver.flushes);
  EXPECT_EQ(0, driver.exclusive);
}

TEST_F(RealPort, isNotTouchedByWhoIsRefused)
{
  driver.exclusive = 1;
  driver.breaking = true;
  driver.discipline = N_GSM0710;
  settings_.baud_rate = 9600;
  EXPECT_EQ(OpenResult::InUse, open());
  EXPECT_THAT(error_, HasSubstr(settings_.device + " is in use by another process"));
  EXPECT_EQ(1, driver.exclusive);
  EXPECT_EQ(0, driver.flushes);
  EXPECT_EQ(0U, driver.attributes.c_ospeed);
  EXPECT_TRUE(driver.breaking);
  EXPECT_EQ(N_GSM0710, driver.discipline);
}

TEST_F(RealPort, isFreeAgainForItsOwnNextOpen)
{
  const auto owner = port();
  for (int i = 0; i < 3; ++i)
  {
    ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
    EXPECT_EQ(1, driver.exclusive);
  }
  owner->close();
  EXPECT_EQ(0, driver.exclusive);
}

TEST_F(RealPort, isRenewedUnderItsLock)
{
  const auto owner = port();
  ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
  driver.attributes.c_cflag |= CMSPAR;
  driver.flushes = 0;
  owner->abandon();
  EXPECT_FALSE(owner->isOpen());
  EXPECT_FALSE(owner->send(withCrc("01 03 00 00 00 01")));
  EXPECT_EQ(OpenResult::InUse, open()) << "nobody gets in between";
  ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
  EXPECT_TRUE(owner->isOpen());
  EXPECT_EQ(0U, driver.attributes.c_cflag & CMSPAR);
  EXPECT_EQ(1, driver.flushes);
  EXPECT_TRUE(owner->send(withCrc("01 03 00 00 00 01")));
}

TEST_F(RealPort, isGivenBackByACloseAfterAll)
{
  const auto owner = port();
  ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
  owner->abandon();
  owner->close();
  EXPECT_EQ(0, driver.exclusive);
  EXPECT_EQ(OpenResult::Opened, open()) << error_;
}

TEST_F(RealPort, isOpenedAnewWhereItsNameMeansAnotherOneNow)
{
  const std::string device = settings_.device;
  const std::string link = testing::TempDir() + "real_port_link_" + std::to_string(::getpid());
  ::unlink(link.c_str());
  ASSERT_EQ(0, ::symlink(device.c_str(), link.c_str()));
  settings_.device = link;
  const auto owner = port();
  ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
  ASSERT_EQ(0, ::unlink(link.c_str()));
  owner->abandon();
  EXPECT_EQ(OpenResult::NotThere, open(*owner));
  settings_.device = device;
  EXPECT_EQ(OpenResult::Opened, open()) << "the old one was given back: " << error_;
}

TEST_F(RealPort, losesWhatAnotherProgramLeft)
{
  driver.attributes.c_cflag = CMSPAR | PARENB | CRTSCTS | HUPCL | CSTOPB | CS5 | (B300 << IBSHIFT);
  driver.attributes.c_iflag = IXON | IXOFF | INPCK | PARMRK | ISTRIP | ICRNL | IUCLC;
  driver.attributes.c_oflag = OPOST | ONLCR;
  driver.attributes.c_lflag = ICANON | ECHO | ISIG | IEXTEN | EXTPROC;
  driver.attributes.c_cc[VMIN] = 0;
  driver.attributes.c_cc[VTIME] = 5;
  driver.breaking = true;
  driver.discipline = N_GSM0710;
  settings_.parity = Parity::Even;
  ASSERT_EQ(OpenResult::Opened, open()) << error_;
  EXPECT_EQ(tcflag_t{ CREAD | CLOCAL | CS8 | PARENB | B19200 }, driver.attributes.c_cflag);
  EXPECT_EQ(tcflag_t{ IGNPAR | INPCK }, driver.attributes.c_iflag);
  EXPECT_EQ(0U, driver.attributes.c_oflag);
  EXPECT_EQ(0U, driver.attributes.c_lflag);
  EXPECT_EQ(1, driver.attributes.c_cc[VMIN]);
  EXPECT_EQ(0, driver.attributes.c_cc[VTIME]);
  EXPECT_EQ(19200U, driver.attributes.c_ispeed);
  EXPECT_EQ(19200U, driver.attributes.c_ospeed);
  EXPECT_FALSE(driver.breaking);
  EXPECT_EQ(N_TTY, driver.discipline);
}

TEST_F(RealPort, checksNoParityWhereThereIsNone)
{
  driver.attributes.c_iflag = INPCK;
  ASSERT_EQ(OpenResult::Opened, open()) << error_;
  EXPECT_EQ(tcflag_t{ IGNPAR }, driver.attributes.c_iflag);
}

struct Quirk
{
  const char* name;
  std::function<void(termios2&)> change;
  const char* words;
};

class RefusedSetting : public RealPort, public testing::WithParamInterface<Quirk>
{
};

TEST_P(RefusedSetting, isSaidThoughTheDriverDidNotSayIt)
{
  settings_.parity = Parity::Odd;
  driver.quirk = GetParam().change;
  EXPECT_EQ(OpenResult::NotThere, open());
  EXPECT_THAT(error_, HasSubstr("cannot use " + settings_.device));
  EXPECT_THAT(error_, HasSubstr(GetParam().words));
  EXPECT_EQ(0, driver.exclusive) << "given back";
}

const Quirk QUIRKS[] = {
  { "stickyParity", [](termios2& set) { set.c_cflag |= CMSPAR; }, "parity" },
  { "noParity", [](termios2& set) { set.c_cflag &= ~tcflag_t{ PARENB }; }, "parity" },
  { "evenParity", [](termios2& set) { set.c_cflag &= ~tcflag_t{ PARODD }; }, "parity" },
  { "sevenBits", [](termios2& set) { set.c_cflag = (set.c_cflag & ~tcflag_t{ CSIZE }) | CS7; }, "8 data bits" },
  { "twoStopBits", [](termios2& set) { set.c_cflag |= CSTOPB; }, "1 stop bits" },
  { "flowControl", [](termios2& set) { set.c_cflag |= CRTSCTS; }, "flow control" },
  { "modemLines", [](termios2& set) { set.c_cflag &= ~tcflag_t{ CLOCAL }; }, "modem lines" },
  { "softwareFlowControl", [](termios2& set) { set.c_iflag |= IXON; }, "raw mode" },
  { "rateOfItsOwn", [](termios2& set) { set.c_ospeed = 9600; }, "19200: its driver runs at 9600" },
};

INSTANTIATE_TEST_SUITE_P(All, RefusedSetting, testing::ValuesIn(QUIRKS),
                         [](const auto& info) { return info.param.name; });

TEST_F(RealPort, takesARateWithoutAConstant)
{
  settings_.baud_rate = 76800;
  const auto owner = port();
  ASSERT_EQ(OpenResult::Opened, open(*owner)) << error_;
  EXPECT_EQ(tcflag_t{ BOTHER }, driver.attributes.c_cflag & CBAUD);
  EXPECT_EQ(76800U, driver.attributes.c_ospeed);
  // libmodbus knows no such rate and would set 9600 if it were to set one.
  EXPECT_TRUE(owner->send(withCrc("01 03 00 00 00 01")));
  EXPECT_EQ(76800U, driver.attributes.c_ospeed);
}

TEST_F(RealPort, takesWhatADriverRounds)
{
  settings_.baud_rate = 76800;
  driver.quirk = [](termios2& set) { set.c_ospeed = 76923; };
  EXPECT_EQ(OpenResult::Opened, open()) << error_;
}

TEST_F(RealPort, isAskedForLowLatency)
{
  driver.serial.flags = static_cast<int>(ASYNC_SKIP_TEST);
  ASSERT_EQ(OpenResult::Opened, open()) << error_;
  EXPECT_EQ(static_cast<int>(ASYNC_SKIP_TEST | ASYNC_LOW_LATENCY), driver.serial.flags);
}

TEST_F(RealPort, losesARateThatSetserialPutBehind38400)
{
  settings_.baud_rate = 38400;
  driver.serial.flags = static_cast<int>(ASYNC_SPD_CUST);
  ASSERT_EQ(OpenResult::Opened, open()) << error_;
  EXPECT_EQ(0, driver.serial.flags & static_cast<int>(ASYNC_SPD_MASK));
}

TEST_F(RealPort, refuses38400WhereAnotherRateStaysBehindIt)
{
  driver.serial.flags = static_cast<int>(ASYNC_SPD_CUST);
  driver.takes_serial_flags = false;
  EXPECT_EQ(OpenResult::Opened, open()) << error_;
  settings_.baud_rate = 38400;
  EXPECT_EQ(OpenResult::NotThere, open());
  EXPECT_THAT(error_, HasSubstr("38400"));
  EXPECT_THAT(error_, HasSubstr("setserial"));
}

TEST_F(RealPort, refusesALineDisciplineThatStays)
{
  driver.discipline = N_GSM0710;
  driver.takes_discipline = false;
  EXPECT_EQ(OpenResult::NotThere, open());
  EXPECT_THAT(error_, HasSubstr("line discipline"));
}

TEST_F(RealPort, refusesARateThatItsUartMakesAnotherOneOf)
{
  std::string sysfs = testing::TempDir() + "real_port_XXXXXX";
  ASSERT_NE(nullptr, ::mkdtemp(&sysfs[0]));
  std::string folder = sysfs;
  for (const std::string& part :
       { std::string("class"), std::string("tty"), std::string(::basename(settings_.device.c_str())) })
  {
    folder += "/" + part;
    ASSERT_EQ(0, ::mkdir(folder.c_str(), 0755));
  }
  std::ofstream(folder + "/type") << 4;
  std::ofstream(folder + "/uartclk") << 1843200;
  EXPECT_EQ("", configured(sysfs));
  settings_.baud_rate = 76800;
  EXPECT_THAT(configured(sysfs), HasSubstr("76800: its UART would run at 57600"));
  EXPECT_EQ("", configured("/no/sysfs")) << "the read-back decides elsewhere";
  settings_.baud_rate = 230400;
  driver.quirk = [](termios2& set) { set.c_ospeed = 19200; };
  EXPECT_THAT(configured(sysfs), HasSubstr("230400: its UART stays at 19200"));
  EXPECT_THAT(configured("/no/sysfs"), HasSubstr("230400: its driver runs at 19200"));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
