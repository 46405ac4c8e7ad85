// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What is said of a port that cannot be opened (contract, 8.13).
#include <gmock/gmock.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>

#include "wire/port/open_failure.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class OpenFailure : public testing::Test
{
protected:
  OpenFailure()
  {
    std::string pattern = testing::TempDir() + "open_failure_XXXXXX";
    folder_ = ::mkdtemp(&pattern[0]);
  }

  std::string add(const std::string& name, mode_t mode = 0660) const
  {
    const std::string path = folder_ + "/" + name;
    std::ofstream(path).flush();
    EXPECT_EQ(0, ::chmod(path.c_str(), mode));
    return path;
  }

  std::string missing(const std::string& name) const
  {
    return openFailure(folder_ + "/" + name, ENOENT);
  }

  std::string folder_;
};

TEST_F(OpenFailure, aMissingNameBesideAPresentOneIsTold)
{
  add("ttyUSB1");
  add("ttyS0");
  add("ttyUSB");
  EXPECT_THAT(missing("ttyUSB0"), AllOf(HasSubstr("No such file"),
                                        HasSubstr(folder_ + "/ttyUSB0 is missing, " + folder_ + "/ttyUSB1 is there"),
                                        Not(HasSubstr("ttyS0"))));
}

TEST_F(OpenFailure, anAdapterMayHaveComeBackUnderTheOtherDriversName)
{
  add("ttyACM0");
  EXPECT_THAT(missing("ttyUSB0"), HasSubstr("ttyACM0 is there"));
  EXPECT_THAT(missing("ttyS4"), EndsWith("plug it in, or check its name"));
}

TEST_F(OpenFailure, manyNamesMakeNoLongLine)
{
  for (int i = 1; i <= 9; ++i)
  {
    add("ttyUSB" + std::to_string(i));
  }
  EXPECT_THAT(missing("ttyUSB0"), AllOf(HasSubstr("ttyUSB4 and 5 more are there"), Not(HasSubstr("ttyUSB5"))));
}

TEST_F(OpenFailure, fixedNamesAreComparedWithAllOfTheirFolder)
{
  ASSERT_EQ(0, ::mkdir((folder_ + "/serial").c_str(), 0755));
  ASSERT_EQ(0, ::mkdir((folder_ + "/serial/by-id").c_str(), 0755));
  add("serial/by-id/usb-FTDI_B-if00-port0");
  EXPECT_THAT(missing("serial/by-id/usb-FTDI_A-if00-port0"), HasSubstr("usb-FTDI_B-if00-port0 is there"));
}

TEST_F(OpenFailure, aLinkToNothingIsTold)
{
  ASSERT_EQ(0, ::symlink("/dev/pts/inverter_bus", (folder_ + "/line").c_str()));
  EXPECT_THAT(missing("line"), HasSubstr("it is a link to /dev/pts/inverter_bus, which is missing"));
}

TEST_F(OpenFailure, namesWithoutNumberOrFolderAreTakenAsTheyAre)
{
  add("rs486");
  EXPECT_THAT(missing("rs"), EndsWith("plug it in, or check its name"));
  EXPECT_THAT(openFailure("", ENOENT), EndsWith("plug it in, or check its name"));
  EXPECT_THAT(openFailure("no_such_port", ENOENT), EndsWith("plug it in, or check its name"));
  EXPECT_THAT(openFailure("/no/such/folder7", ENOENT), EndsWith("plug it in, or check its name"));
  EXPECT_THAT(openFailure("7", ENOENT), EndsWith("plug it in, or check its name"));
}

TEST_F(OpenFailure, permissionDeniedNamesTheGroupOfTheDeviceFile)
{
  const std::string path = add("ttyUSB0");
  struct stat status = {};
  ASSERT_EQ(0, ::stat(path.c_str(), &status));
  const group* owner = ::getgrgid(status.st_gid);
  const std::string name = owner != nullptr ? owner->gr_name : std::to_string(status.st_gid);
  EXPECT_THAT(openFailure(path, EACCES), AllOf(HasSubstr("Permission denied"), HasSubstr("group " + name),
                                               HasSubstr("adduser"), HasSubstr("log in again")));
}

TEST_F(OpenFailure, aGroupThatMayNothingIsNotNamed)
{
  EXPECT_THAT(openFailure(add("ttyUSB0", 0600), EACCES),
              AllOf(HasSubstr("only its owner"), HasSubstr("udev"), Not(HasSubstr("adduser"))));
  EXPECT_THAT(openFailure(folder_ + "/hidden", EACCES), EndsWith("Permission denied"));
}

TEST_F(OpenFailure, anInputOutputErrorMeansNoUart)
{
  EXPECT_THAT(openFailure("/dev/ttyS3", EIO), AllOf(HasSubstr("Input/output error"), HasSubstr("no UART behind it")));
  EXPECT_THAT(noSerialPort("/dev/ttyS3", EIO),
              AllOf(HasSubstr("cannot use /dev/ttyS3"), HasSubstr("no UART behind it")));
  EXPECT_THAT(noSerialPort("/dev/null", ENOTTY), EndsWith("it is not a serial port"));
}

TEST_F(OpenFailure, aContainerIsTold)
{
  EXPECT_THAT(openFailure("/dev/ttyUSB0", EPERM), HasSubstr("--device"));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
