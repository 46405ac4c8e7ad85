#!/usr/bin/env bash
# libmodbus shows a late answer to one read as the value of the next one.
#
# Peer: libmodbus5 3.1.6-2.1+deb12u1 (Debian 12), RTU, its defaults but for a time-out of 0.2 s.
# Guess: what is still in the port is thrown away before the next request, or the answer is recognised as another one's.
# Seen: register 0010H is answered with 17, 0.1 s too late. The read of 0020H that follows succeeds and shows 17, though
# that register holds 34. An RTU answer doesn't say which register it is of, and nothing is flushed unless
# modbus_set_error_recovery() asks for it.
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
library.modbus_set_response_timeout(modbus, 0, 200000)
sent = threading.Event()


def drive():
    os.read(line, 99)
    time.sleep(0.3)
    os.write(line, frame('01 03 02 00 11'))
    sent.set()
    os.read(line, 99)
    time.sleep(0.05)
    os.write(line, frame('01 03 02 00 22'))


threading.Thread(target=drive, daemon=True).start()
value = ctypes.c_uint16(0)
answer = library.modbus_read_registers(modbus, 0x10, 1, ctypes.byref(value))
print('read of 0010H:', library.modbus_strerror(ctypes.get_errno()).decode() if answer < 0 else value.value)
sent.wait()
answer = library.modbus_read_registers(modbus, 0x20, 1, ctypes.byref(value))
print('read of 0020H:', library.modbus_strerror(ctypes.get_errno()).decode() if answer < 0 else value.value)
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
read of 0010H: Connection timed out
read of 0020H: 17
SEEN
echo "as seen"
