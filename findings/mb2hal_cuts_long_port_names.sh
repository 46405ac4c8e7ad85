#!/usr/bin/env bash
# LinuxCNC's mb2hal opens another port than the one it was given when the name is long, as names in /dev/serial/by-id are.
#
# Peers: mb2hal of linuxcnc-uspace 2.9.0~pre1+git20230208.f1270d6ed7-1+deb12u2, libmodbus5 3.1.6-2.1+deb12u1 (Debian 12),
# loaded without a machine, in front of two pseudo-terminals.
# Guess: SERIAL_PORT takes any path, or a path that is too long is an error.
# Seen: it keeps the first 31 characters, says nothing, and opens that. Where a port of that name exists, its requests go
# there; where there is none, only the pin num_errors counts up. A name such as
# /dev/serial/by-id/usb-FTDI_FT232R_USB_UART_A50285BI-if00-port0 has 62 characters.
# It plays in an IPC namespace of its own, so a LinuxCNC that runs here notices nothing.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(linuxcnc-uspace=2.9.0~pre1+git20230208.f1270d6ed7-1+deb12u2 libmodbus5=3.1.6-2.1+deb12u1)
apt-get -o APT::Sandbox::User=root -qq download "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in *.deb; do dpkg -x "$package" root; done

cat >play.py <<'PYTHON'
import os, pty, select, subprocess, sys, time, tty

directory = os.path.realpath(os.getcwd())
given = (directory + '/' + 62 * 'p')[:62]
lines = {}
for name, path in (('its first 31 characters', given[:31]), ('the whole name', given)):
    line, port = pty.openpty()
    tty.setraw(port)
    os.symlink(os.ttyname(port), path)
    lines[line] = name

with open('mb2hal.ini', 'w') as stream:
    stream.write('[MB2HAL_INIT]\nINIT_DEBUG=0\nVERSION=1.1\nTOTAL_TRANSACTIONS=1\n[TRANSACTION_00]\nLINK_TYPE=serial\n'
                 'SERIAL_PORT=%s\nSERIAL_BAUD=9600\nSERIAL_BITS=8\nSERIAL_PARITY=none\nSERIAL_STOP=1\nSERIAL_DELAY_MS=0\n'
                 'MB_SLAVE_ID=1\nMB_TX_CODE=fnct_03_read_holding_registers\nFIRST_ELEMENT=0\nNELEMENTS=1\n'
                 'HAL_TX_NAME=a\nMAX_UPDATE_RATE=0.0\nMB_RESPONSE_TIMEOUT_MS=200\nMB_BYTE_TIMEOUT_MS=200\nDEBUG=0\n' % given)
print('SERIAL_PORT has', len(given), 'characters')
driver = subprocess.Popen(['root/usr/bin/mb2hal', 'config=mb2hal.ini'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
end = time.monotonic() + 20.0
ready = []
while not ready and time.monotonic() < end:
    ready = select.select(list(lines), [], [], 0.5)[0]
if not ready:
    sys.exit('no request on either')
print('first request:', os.read(ready[0], 99).hex(' '), 'on', lines[ready[0]])
time.sleep(1.0)
print('requests on the whole name:', 'yes' if select.select([line for line in lines if lines[line] == 'the whole name'],
                                                            [], [], 0)[0] else 'none')
print('it says:', os.read(driver.stdout.fileno(), 999) if select.select([driver.stdout], [], [], 0)[0] else 'nothing')
driver.terminate()
driver.communicate()
PYTHON
libraries=$work/root/usr/lib:$(dirname "$(find "$work/root" -name libmodbus.so.5)")
# LinuxCNC refuses to run as root, which this is in the namespace.
RTAPI_UID=65534 LD_LIBRARY_PATH=$libraries PATH=$work/root/usr/bin:$PATH \
  unshare --map-root-user --ipc /usr/bin/python3 play.py 2>play.log | tee seen

diff - seen <<'SEEN' || { cat play.log >&2; echo "DIFFERENT: < as it was seen, > now"; exit 1; }
SERIAL_PORT has 62 characters
first request: 01 03 00 00 00 01 84 0a on its first 31 characters
requests on the whole name: none
it says: nothing
SEEN
echo "as seen"
