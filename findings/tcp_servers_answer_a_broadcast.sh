#!/usr/bin/env bash
# Modbus TCP servers answer a write to unit 0, which on a serial line is a broadcast that nobody answers.
#
# Peers: libmodbus5 3.1.6-2.1+deb12u1 and python3-pymodbus 3.0.0-7 (Debian 12), modbus-serial 8.0.25 and jsmodbus 5.0.0
# (npm).
# Guess: unit 0 is carried out without an answer.
# Seen: four of five answer it like any unit, with an answer that equals the request; pymodbus with a table of units is
# silent. A client that expects no answer takes it for the answer to its next request or, used to serial adapters, for
# its own echo.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(libmodbus5=3.1.6-2.1+deb12u1 python3-pymodbus=3.0.0-7)
mkdir -p debs/partial
apt-get -o "Dir::Cache::archives=$work/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root -qq -y --reinstall \
  --allow-downgrades --no-install-recommends --download-only install "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in debs/*.deb; do dpkg -x "$package" root; done
packages=(modbus-serial@8.0.25 jsmodbus@5.0.0)
npm install --ignore-scripts --no-audit --no-fund --no-save "${packages[@]}" >npm.log 2>&1 ||
  { cat npm.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }

cat >libmodbus.py <<'SERVER'
import ctypes, sys
library = ctypes.CDLL('libmodbus.so.5')
library.modbus_new_tcp.restype = library.modbus_mapping_new.restype = ctypes.c_void_p
modbus = ctypes.c_void_p(library.modbus_new_tcp(b'127.0.0.1', int(sys.argv[1])))
table = ctypes.c_void_p(library.modbus_mapping_new(9, 9, 9, 9))
listener, request = ctypes.c_int(library.modbus_tcp_listen(modbus, 1)), (ctypes.c_uint8 * 260)()
library.modbus_tcp_accept(modbus, ctypes.byref(listener))
length = 0
while length >= 0:
    length = library.modbus_receive(modbus, request)
    if length > 0:
        library.modbus_reply(modbus, request, length, table)
SERVER
cat >pymodbus_server.py <<'SERVER'
import logging, sys
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartTcpServer
logging.disable(logging.CRITICAL)
unit = ModbusSlaveContext(co=ModbusSequentialDataBlock(0, [0] * 9))
single = sys.argv[2] == 'single=True'
units = ModbusServerContext(unit if single else {1: unit}, single)
StartTcpServer(context=units, address=('127.0.0.1', int(sys.argv[1])))
SERVER
cat >modbus-serial.js <<'SERVER'
const { ServerTCP } = require('modbus-serial');
new ServerTCP({ setCoil: () => {} }, { host: '127.0.0.1', port: +process.argv[2] });
SERVER
cat >jsmodbus.js <<'SERVER'
const network = new (require('net').Server)();
new (require('jsmodbus').server.TCP)(network, { coils: Buffer.alloc(9) });
network.listen(+process.argv[2], '127.0.0.1');
SERVER

libraries=$(dirname "$(find "$work/root" -name libmodbus.so.5)")
LD_LIBRARY_PATH=$libraries PYTHONPATH=$work/root/usr/lib/python3/dist-packages /usr/bin/python3 - <<'PYTHON' | tee seen
import select, socket, subprocess, time

SERVERS = {
    'libmodbus': ['/usr/bin/python3', 'libmodbus.py', 'PORT'],
    'pymodbus, single=True': ['/usr/bin/python3', 'pymodbus_server.py', 'PORT', 'single=True'],
    'pymodbus, single=False': ['/usr/bin/python3', 'pymodbus_server.py', 'PORT', 'single=False'],
    'modbus-serial': ['node', 'modbus-serial.js', 'PORT'],
    'jsmodbus': ['node', 'jsmodbus.js', 'PORT'],
}


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


for name, command in SERVERS.items():
    port = free_port()
    server = subprocess.Popen([word.replace('PORT', str(port)) for word in command])
    try:
        connection = connect(port)
        connection.sendall(bytes.fromhex('0001 0000 0006 00 05 0000 0000'))
        answered = select.select([connection], [], [], 2.0)[0]
        print('%-23s %s' % (name + ':', connection.recv(99).hex(' ') if answered else 'silence'))
    finally:
        server.kill()
PYTHON

diff - seen <<'SEEN' || { echo "DIFFERENT: < as it was seen, > now"; exit 1; }
libmodbus:              00 01 00 00 00 06 00 05 00 00 00 00
pymodbus, single=True:  00 01 00 00 00 06 00 05 00 00 00 00
pymodbus, single=False: silence
modbus-serial:          00 01 00 00 00 06 00 05 00 00 00 00
jsmodbus:               00 01 00 00 00 06 00 05 00 00 00 00
SEEN
echo "as seen"
