#!/usr/bin/env bash
# libmodbus sends its next request right behind the last byte of an answer, without the silence that separates RTU
# frames.
#
# Peer: libmodbus5 3.1.6-2.1+deb12u1 (Debian 12), RTU at 9600 baud, consecutive reads.
# Guess: a Modbus RTU library keeps the 3.5 characters between frames, 4 ms at 9600 baud.
# Seen: the next request comes within 2 ms, mostly within 0.2 ms. There is no setting for it. A drive that is strict
# about the gap takes answer and request for one long frame and loses every second request; mbpoll and LinuxCNC's
# drivers are built on it. (The pseudo-terminal has no wire time: what is measured is the program's own pause.)
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
import ctypes, os, pty, threading, time, tty

def frame(text):
    data, crc = bytes.fromhex(text), 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return data + crc.to_bytes(2, 'little')

library = ctypes.CDLL('libmodbus.so.5', use_errno=True)
library.modbus_new_rtu.restype = ctypes.c_void_p
library.modbus_strerror.restype = ctypes.c_char_p

line, port = pty.openpty()
tty.setraw(port)
modbus = ctypes.c_void_p(library.modbus_new_rtu(os.ttyname(port).encode(), 9600, ctypes.c_char(b'N'), 8, 1))

library.modbus_set_slave(modbus, 1)
library.modbus_connect(modbus)
pauses = []


def drive():
    end = None
    while True:
        os.read(line, 99)
        if end:
            pauses.append(time.monotonic() - end)
        os.write(line, frame('01 03 02 00 11'))
        end = time.monotonic()


threading.Thread(target=drive, daemon=True).start()
value = ctypes.c_uint16(0)
good = sum(library.modbus_read_registers(modbus, 0x10, 1, ctypes.byref(value)) == 1 for _ in range(50))
pauses.sort()
print('good reads:', good)
print('pause in half of the cases below 2 ms:', pauses[len(pauses) // 2] < 0.002)
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
good reads: 50
pause in half of the cases below 2 ms: True
SEEN
echo "as seen"
