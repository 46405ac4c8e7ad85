#!/usr/bin/env bash
# pymodbus cuts its client's timeout to whole seconds: below 1 s it doesn't wait at all and can't even connect.
#
# Peer: python3-pymodbus 3.0.0-7 (Debian 12; it calls itself 3.0.0rc1), TCP client.
# Guess: timeout=0.5 waits for half a second.
# Seen: it is 0. The connection fails with "Operation now in progress"; 1.9 is 1 s. A line with a dead station that
# should cost 0.1 s costs a whole second or everything.
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

from pymodbus.client import ModbusTcpClient
from pymodbus.exceptions import ConnectionException

logging.disable(logging.CRITICAL)
listener = socket.create_server(('127.0.0.1', 0))


def silent_server():
    kept = []
    while True:
        kept.append(listener.accept())


threading.Thread(target=silent_server, daemon=True).start()
for timeout in 0.5, 1.9:
    client = ModbusTcpClient('127.0.0.1', port=listener.getsockname()[1], timeout=timeout, retries=0)
    start = time.monotonic()
    try:
        client.read_holding_registers(0, 1, slave=1)
        outcome = 'connected'
    except ConnectionException:
        outcome = 'failed to connect'
    print('timeout %g: %s, over after about %.0f s' % (timeout, outcome, time.monotonic() - start))
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
timeout 0.5: failed to connect, over after about 0 s
timeout 1.9: connected, over after about 1 s
SEEN
echo "as seen"
