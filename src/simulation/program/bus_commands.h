// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_BUS_COMMANDS_H
#define INVERTER_BUS_SIMULATION_BUS_COMMANDS_H

#include <string>

#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
class SimulatedBus;

/// Runs one command of the text grammar that standard input and the ROS service share. Words are separated by blanks;
/// times are seconds. `#` starts a comment.
///
///     help | list                        commands | targets
///     bus show                           counters of the line, key=value
///     bus frames [N]                     the last N frames (10), separated by |
///     bus unplug [S] | bus plug          the master's adapter is pulled out (for S) and put in again
///     bus echo on|off                    the adapter gives the master its own bytes back
///     bus silent on|off|S                the line between master and drives is cut (for S)
///     bus noise [N]                      N random bytes (8) at once
///     bus foreign HEX... [now] [raw]     a second master's request when the line is free, or now; CRC added unless raw
///                                        (CompoWay/F: the body as text, STX, ETX and BCC added; raw: HEX)
///     bus reset                          counters back to 0
///
///     NAME show                          what drive and motor really do, key=value
///     NAME get CODE | NAME set CODE X    a parameter, in the panel's unit; set: as at the panel (RAM and EEPROM)
///     NAME offline [S] | NAME online     cut off the bus; it runs on
///     NAME trip N                        trip with this code (MX2, RX: E N)
///     NAME damaged | truncated [BYTES] | noise [BYTES] | late S | foreign [station|shape] | exception N |
///          lost_request | lost_reply     spoils the next exchange; `count N`: the next N, `count 0`: all,
///                                        `for S`: all within S, `function F`: only that function code (or 0x..;
///                                        CompoWay/F: service, 0x0102); exception N: the Modbus exception code
///                                        (CompoWay/F: the response code, 0x1103; up to 0xFF the end code, 0x13);
///                                        `writes`, `reads`: only such requests (17H writes, a loop-back does neither);
///                                        `longer BYTES`: only replies with more bytes than this
///     NAME clear                         takes back what waits
///     NAME busy S                        EEPROM write in progress for S: parameter writes are refused (3G3JE: all
///                                        writes, with 2203)
///     NAME power_cycle [S]               no power, and deaf, for S in all (without S: 2 s, then the start-up time)
///     NAME power on|off
///     NAME panel HZ | NAME panel_release taken over at the panel, sign = direction, and given back (MX2, RX: A001, A002
///                                        = 02; 7200MA: Sn-04, Sn-05 = 0; 3G3JE: P10 = 1)
///     NAME panel_stop                    STOP key: stays stopped until RUN was off
///     NAME sto on|off                    safe torque off (MX2, RX: E37), where the drive has it
///     NAME load X                        1 = rated torque
///
/// The answer is one line, "ok ..." or "error: ... (what is allowed)", and empty for an empty line.
std::string runCommand(SimulatedBus& bus, const std::string& line, TimePoint now);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_BUS_COMMANDS_H
