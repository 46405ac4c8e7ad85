#!/usr/bin/env bash
# modbus-serial doesn't answer a request for which its server has no callback.
#
# Peer: modbus-serial 8.0.25 (npm), ServerTCP, with getHoldingRegister alone.
# Guess: exception 01, illegal function, so that the client knows at once; function 08H gets just that.
# Seen: nothing comes for a write (06) and for input registers (04). To a client, a server that offers reads only is one
# that loses every write: it repeats, waits for its time-out, and may take the whole unit for dead.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(modbus-serial@8.0.25)
npm install --ignore-scripts --no-audit --no-fund --no-save "${packages[@]}" >npm.log 2>&1 ||
  { cat npm.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }

/usr/bin/python3 - <<'PYTHON' | tee seen
import select, socket, subprocess, time

SERVER = """
const { ServerTCP } = require('modbus-serial');
new ServerTCP({ getHoldingRegister: () => 7 }, { host: '127.0.0.1', port: +process.argv[1] });
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


def connect(port):
    for _ in range(200):
        try:
            return socket.create_connection(('127.0.0.1', port))
        except ConnectionRefusedError:
            time.sleep(0.05)


def received(connection, seconds=1.0):
    # All that comes until nothing has come for a while.
    data = b''
    while select.select([connection], [], [], seconds)[0]:
        more = connection.recv(999)
        if not more:
            break
        data += more
    return data


port = free_port()
server = subprocess.Popen(['node', '-e', SERVER, str(port)])
try:
    for name, request in (('read holding', '03 0000 0001'), ('write', '06 0000 0001'), ('read input', '04 0000 0001'),
                          ('loop-back', '08 0000 1234')):
        connection = connect(port)
        connection.sendall(bytes.fromhex('0001 0000 0006 01' + request))
        print('%-13s %s' % (name + ':', received(connection, 2.0).hex(' ') or 'silence'))
finally:
    server.kill()
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
read holding: 00 01 00 00 00 05 01 03 02 00 07
write:        silence
read input:   silence
loop-back:    00 01 00 00 00 03 01 88 01
SEEN
echo "as seen"
