#!/usr/bin/env bash
# pymodbus's server hangs up when a request arrives in two pieces.
#
# Peer: python3-pymodbus 3.0.0-7 (Debian 12; it calls itself 3.0.0rc1), TCP server.
# Guess: TCP is a stream, so a server waits for the rest of a request.
# Seen: a request whose first 7 bytes (the header) come 0.1 s before its rest is answered with the end of the
# connection: the header alone is decoded as a request for function 0. In one piece the same request is answered. A
# modem, a VPN or a client that writes header and request by two calls is enough.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(python3-pymodbus=3.0.0-7)
mkdir -p debs/partial
apt-get -o "Dir::Cache::archives=$work/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root -qq -y --reinstall \
  --allow-downgrades --no-install-recommends --download-only install "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in debs/*.deb; do dpkg -x "$package" root; done

PYTHONPATH=$work/root/usr/lib/python3/dist-packages /usr/bin/python3 - <<'PYTHON' | tee seen
import logging, socket, threading, time

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartTcpServer

logging.disable(logging.CRITICAL)
with socket.socket() as probe:
    probe.bind(('127.0.0.1', 0))
    address = probe.getsockname()
context = ModbusServerContext(slaves=ModbusSlaveContext(hr=ModbusSequentialDataBlock(0, [7] * 9)), single=True)
threading.Thread(target=StartTcpServer, kwargs={'context': context, 'address': address}, daemon=True).start()


def connect():
    for _ in range(200):
        try:
            return socket.create_connection(address, 5.0)
        except ConnectionRefusedError:
            time.sleep(0.05)


request = bytes.fromhex('0001 0000 0006 01 03 0000 0001')
connection = connect()
connection.sendall(request)
print('in one piece: ', connection.recv(99).hex(' '))
connection = connect()
connection.sendall(request[:7])
time.sleep(0.1)
connection.sendall(request[7:])
print('in two pieces:', connection.recv(99).hex(' ') or 'end of the connection')
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
in one piece:  00 01 00 00 00 05 01 03 02 00 07
in two pieces: end of the connection
SEEN
echo "as seen"
