#!/usr/bin/env bash
# tshark shows no Modbus RTU frame at all where a broadcast is: the very frame that stops all drives of a line.
#
# Peer: tshark 4.0.17-0+deb12u3 (Debian 12), its dissector mbrtu on link type 147 (user 0), which RTU frames have to be
# given by "-o uat:user_dlts:...": there is no link type of their own.
# Guess: a frame to unit 0 is shown like any other one, perhaps as a broadcast.
# Seen: the protocol column is empty, and the filter "mbrtu" drops it, with a correct CRC and the same function as the
# frame before it. Unit 0 is taken as a sign that the bytes are not Modbus RTU.
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

FRAMES = [  # unit, function, address, ...
    '01 0F 00 00 00 08 01 00', '00 0F 00 00 00 08 01 00',
    '01 06 00 00 00 00', '00 06 00 00 00 00',
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
1|Modbus RTU|   Query: Unit:   1, Func:  15: Write Multiple Coils
2||
3|Modbus RTU| unknown: Unit:   1, Func:   6: Write Single Register. Unable to classify as query or response.
4||
SEEN
echo "as seen"
