#!/usr/bin/env bash
# libmodbus takes a baud rate that it doesn't know, says that all went well, and sets 9600.
#
# Peer: libmodbus5 3.1.6-2.1+deb12u1 (Debian 12), its own calls, on a pseudo-terminal.
# Guess: modbus_new_rtu() or modbus_connect() fails for 76800, a rate that inverters offer (C071 = 09 of an OMRON MX2).
# Seen: both succeed, and the port is at 9600; a warning is printed only after modbus_set_debug(). 38400 to compare.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(libmodbus5=3.1.6-2.1+deb12u1)
mkdir -p debs/partial
apt-get -o "Dir::Cache::archives=$work/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root -qq -y --reinstall \
  --allow-downgrades --no-install-recommends --download-only install "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in debs/*.deb; do dpkg -x "$package" root; done

LD_LIBRARY_PATH=$(dirname "$(find "$work/root" -name libmodbus.so.5)") /usr/bin/python3 - <<'PYTHON' | tee seen
import ctypes, os, pty, termios

library = ctypes.CDLL('libmodbus.so.5')
library.modbus_new_rtu.restype = ctypes.c_void_p
RATES = {getattr(termios, 'B%d' % rate): rate for rate in (9600, 19200, 38400, 57600, 115200)}
for rate in 38400, 76800:
    line, port = pty.openpty()
    modbus = ctypes.c_void_p(library.modbus_new_rtu(os.ttyname(port).encode(), rate, ctypes.c_char(b'N'), 8, 1))
    answer = library.modbus_connect(modbus)
    found = RATES[termios.tcgetattr(port)[5]]
    print('asked %d: modbus_connect() returned %d, the port is at %d' % (rate, answer, found))
    library.modbus_close(modbus)
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
asked 38400: modbus_connect() returned 0, the port is at 38400
asked 76800: modbus_connect() returned 0, the port is at 9600
SEEN
echo "as seen"
