#!/usr/bin/env bash
# libmodbus waits for an answer to a broadcast, which nobody gives, and reports a write that was sent as failed.
#
# Peer: libmodbus5 3.1.6-2.1+deb12u1 (Debian 12), RTU.
# Guess: modbus_set_slave(0), MODBUS_BROADCAST_ADDRESS, makes a write return at once and successfully.
# Seen: the frame is on the line, then the whole time-out passes (0.5 s as installed), and the write returns -1 with
# "Connection timed out". Whoever repeats failed writes broadcasts twice; whoever stops all drives so waits half a
# second.
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
import ctypes, os, pty, time, tty

library = ctypes.CDLL('libmodbus.so.5', use_errno=True)
library.modbus_new_rtu.restype = ctypes.c_void_p
library.modbus_strerror.restype = ctypes.c_char_p

line, port = pty.openpty()
tty.setraw(port)
modbus = ctypes.c_void_p(library.modbus_new_rtu(os.ttyname(port).encode(), 9600, ctypes.c_char(b'N'), 8, 1))

library.modbus_set_slave(modbus, 0)
library.modbus_connect(modbus)
start = time.monotonic()
answer = library.modbus_write_bit(modbus, 0, 0)
error = library.modbus_strerror(ctypes.get_errno()).decode()
print('modbus_write_bit() returned %d: %s' % (answer, error))
print('after the whole time-out:', time.monotonic() - start > 0.45)
print('on the line:', os.read(line, 99).hex(' '))
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
modbus_write_bit() returned -1: Connection timed out
after the whole time-out: True
on the line: 00 05 00 00 00 00 cc 1b
SEEN
echo "as seen"
