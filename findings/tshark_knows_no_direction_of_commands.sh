#!/usr/bin/env bash
# tshark can't tell the request from the answer for just those Modbus RTU functions that start and stop a motor.
#
# Peer: tshark 4.0.17-0+deb12u3 (Debian 12), its dissector mbrtu on link type 147 (user 0).
# Guess: requests and answers alternate on a line, so the dissector knows which is which, as it does for Modbus TCP.
# Seen: it goes by the length of a single frame. 03H, 0FH and 10H it tells; 05H, 06H and 08H have answers like their
# requests, and 17H is not looked at: "unknown ... Unable to classify as query or response". A filter or a script on
# "Query" misses every such command; the data of a 17H is not decoded. (And the loop-back's sub-function, 0, is shown as
# 1.)
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
version=4.0.17-0+deb12u3
packages=("tshark=$version" "libwireshark16=$version" "libwiretap13=$version" "libwsutil14=$version")
mkdir -p debs/partial
apt-get -o "Dir::Cache::archives=$work/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root -qq -y --reinstall \
  --allow-downgrades --no-install-recommends --download-only install "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in debs/*.deb; do dpkg -x "$package" root; done

/usr/bin/python3 - <<'PYTHON'
import struct

FRAMES = [  # request and answer of 03, 05, 06, 08, 10 and 17H
    '01 03 00 00 00 01', '01 03 02 00 07', '01 05 00 00 FF 00', '01 05 00 00 FF 00',
    '01 06 00 00 07 D0', '01 06 00 00 07 D0', '01 08 00 00 12 34', '01 08 00 00 12 34',
    '01 10 00 00 00 01 02 07 D0', '01 10 00 00 00 01', '01 17 00 00 00 01 00 00 00 01 02 07 D0', '01 17 02 00 07',
]


def frame(text):
    data, crc = bytes.fromhex(text), 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return data + crc.to_bytes(2, 'little')


with open('line.pcap', 'wb') as stream:
    stream.write(struct.pack('<IHHiIII', 0xA1B2C3D4, 2, 4, 0, 0, 65535, 147))
    for second, text in enumerate(FRAMES):
        data = frame(text)
        stream.write(struct.pack('<IIII', second, 0, len(data), len(data)) + data)
PYTHON

libraries=$(dirname "$(find "$work/root" -name 'libwireshark.so.16')")
as_rtu='uat:user_dlts:"User 0 (DLT=147)","mbrtu","0","","0",""'
LD_LIBRARY_PATH=$libraries HOME=$work root/usr/bin/tshark -r line.pcap -o "$as_rtu" -T fields -E separator='|' \
  -e frame.number -e _ws.col.Protocol -e _ws.col.Info 2>tshark.log | tee seen

diff - seen <<'SEEN' || { cat tshark.log >&2; echo "DIFFERENT: < as it was seen, > now"; exit 1; }
1|Modbus RTU|   Query: Unit:   1, Func:   3: Read Holding Registers
2|Modbus RTU|Response: Unit:   1, Func:   3: Read Holding Registers
3|Modbus RTU| unknown: Unit:   1, Func:   5: Write Single Coil. Unable to classify as query or response.
4|Modbus RTU| unknown: Unit:   1, Func:   5: Write Single Coil. Unable to classify as query or response.
5|Modbus RTU| unknown: Unit:   1, Func:   6: Write Single Register. Unable to classify as query or response.
6|Modbus RTU| unknown: Unit:   1, Func:   6: Write Single Register. Unable to classify as query or response.
7|Modbus RTU| unknown: Unit:   1, Func:   8/  1: Return Query Data. Unable to classify as query or response.
8|Modbus RTU| unknown: Unit:   1, Func:   8/  1: Return Query Data. Unable to classify as query or response.
9|Modbus RTU|   Query: Unit:   1, Func:  16: Write Multiple Registers
10|Modbus RTU|Response: Unit:   1, Func:  16: Write Multiple Registers
11|Modbus RTU| unknown: Unit:   1, Func:  23: Read Write Register. Unable to classify as query or response.
12|Modbus RTU| unknown: Unit:   1, Func:  23: Read Write Register. Unable to classify as query or response.
SEEN
echo "as seen"
