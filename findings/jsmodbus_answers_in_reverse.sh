#!/usr/bin/env bash
# jsmodbus answers requests that arrive together in reverse order.
#
# Peer: jsmodbus 5.0.0 (npm), TCP server.
# Guess: answers come in the order of their requests; so they do from pymodbus and modbus-serial.
# Seen: three reads in one segment, transactions 1, 2 and 3, are answered 3, 2, 1, each with its own value. A client
# that pipelines and takes the next answer for its oldest request shows each register's value as another one's.
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
    connection.sendall(b''.join(bytes.fromhex('%04x 0000 0006 01 03 %04x 0001' % (n, n - 1)) for n in (1, 2, 3)))
    answers = received(connection)
    for n in range(0, len(answers), 11):
        print('transaction %d: value %d' % (answers[n + 1], answers[n + 10]))
finally:
    server.kill()
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
transaction 3: value 3
transaction 2: value 2
transaction 1: value 1
SEEN
echo "as seen"
