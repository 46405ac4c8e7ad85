#!/usr/bin/env bash
# jsmodbus answers a read of registers that don't exist with success and no data.
#
# Peer: jsmodbus 5.0.0 (npm), TCP server with three holding registers.
# Guess: exception 02, as the specification has it.
# Seen: a normal answer with no data at all; of two registers of which one exists, that one. A client that trusts "no
# exception" and doesn't compare the count reads past the end of the answer, or keeps an old value as new.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(jsmodbus@5.0.0)
npm install --ignore-scripts --no-audit --no-fund --no-save "${packages[@]}" >npm.log 2>&1 ||
  { cat npm.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }

/usr/bin/python3 - <<'PYTHON' | tee seen
import select, socket, subprocess, time

SERVER = """
const network = new (require('net').Server)();
new (require('jsmodbus').server.TCP)(network, { holding: Buffer.from([0, 1, 0, 2, 0, 3]) });
network.listen(+process.argv[1], '127.0.0.1');
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
    connection = connect(port)
    for address, count in ((2, 1), (3, 1), (2, 2)):
        connection.sendall(bytes.fromhex('0001 0000 0006 01 03 %04x %04x' % (address, count)))
        print('%d from register %d: %s' % (count, address, received(connection).hex(' ')))
finally:
    server.kill()
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
1 from register 2: 00 01 00 00 00 05 01 03 02 00 03
1 from register 3: 00 01 00 00 00 03 01 03 00
2 from register 2: 00 01 00 00 00 05 01 03 02 00 03
SEEN
echo "as seen"
