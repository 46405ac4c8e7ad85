#!/usr/bin/env bash
# libmodbus sends a loop-back (08H) that it is given as a raw request, but can't receive the answer to it.
#
# Peer: libmodbus5 3.1.6-2.1+deb12u1 (Debian 12), RTU.
# Guess: modbus_send_raw_request() with modbus_receive_confirmation() works for every function, as its manual page
# shows.
# Seen: the length of an answer is known for some functions only; for 08H five of the eight bytes are read and called
# "Invalid CRC". The other three stay in the port, for the next answer to begin with.
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
import ctypes, os, pty, select, threading, tty

library = ctypes.CDLL('libmodbus.so.5', use_errno=True)
library.modbus_new_rtu.restype = ctypes.c_void_p
library.modbus_strerror.restype = ctypes.c_char_p

line, port = pty.openpty()
tty.setraw(port)
modbus = ctypes.c_void_p(library.modbus_new_rtu(os.ttyname(port).encode(), 9600, ctypes.c_char(b'N'), 8, 1))

library.modbus_set_slave(modbus, 1)
library.modbus_connect(modbus)
threading.Thread(target=lambda: os.write(line, os.read(line, 99)), daemon=True).start()
request, answer = (ctypes.c_uint8 * 6)(1, 8, 0, 0, 0x12, 0x34), (ctypes.c_uint8 * 260)()
print('sent bytes:', library.modbus_send_raw_request(modbus, request, 6))
received = library.modbus_receive_confirmation(modbus, answer)
print('confirmation:', received, library.modbus_strerror(ctypes.get_errno()).decode())
left = b''
while select.select([port], [], [], 0.3)[0]:
    left += os.read(port, 99)
print('left in the port:', left.hex(' '))
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
sent bytes: 8
confirmation: -1 Invalid CRC
left in the port: 34 ed 7c
SEEN
echo "as seen"
