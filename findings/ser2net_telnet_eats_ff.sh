#!/usr/bin/env bash
# ser2net's telnet accepter takes FF and the byte after it out of what goes to the line, and doubles FF towards the
# client.
#
# Peer: ser2net 4.3.11-1 with libgensio4 2.6.2-4 (Debian 12), "accepter: telnet,tcp", in front of a pseudo-terminal.
# Guess: a telnet port negotiates at the beginning and passes data, or at worst spoils all of it at once.
# Seen: 18 bytes of negotiation come first. Then all frames without FF pass unharmed both ways: reads, settings, even
# the coil OFF of a Modbus drive (05 .. 00 00). Coil ON (05 .. FF 00) reaches the line two bytes short and its answer
# comes back a byte too long: everything works but the motor doesn't start, or, on drives whose stop holds FF, doesn't
# stop.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(ser2net=4.3.11-1 libgensio4=2.6.2-4)
mkdir -p debs/partial
apt-get -o "Dir::Cache::archives=$work/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root -qq -y --reinstall \
  --allow-downgrades --no-install-recommends --download-only install "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in debs/*.deb; do dpkg -x "$package" root; done

libraries=$(dirname "$(find "$work/root" -name 'libgensio.so.4*' -print -quit)")
LD_LIBRARY_PATH=$libraries /usr/bin/python3 - <<'PYTHON' 2>ser2net.log | tee seen
import os, pty, select, socket, subprocess, time, tty


def ser2net(accepter, *options):
    # Starts it in front of a pseudo-terminal; returns the process, the line's far side and the TCP port.
    line, port = pty.openpty()
    tty.setraw(port)
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        number = probe.getsockname()[1]
    with open('ser2net.yaml', 'w') as stream:
        stream.write('connection: &line\n  accepter: %s,127.0.0.1,%d\n  connector: serialdev,%s,9600n81,local\n' %
                     (accepter, number, os.ttyname(port)))
        if options:
            stream.write('  options:\n' + ''.join('    %s\n' % option for option in options))
    return subprocess.Popen(['root/usr/sbin/ser2net', '-n', '-c', 'ser2net.yaml']), line, number


def connect(number):
    for _ in range(200):
        try:
            return socket.create_connection(('127.0.0.1', number))
        except ConnectionRefusedError:
            time.sleep(0.05)


def received(source, seconds=0.5):
    # All that comes until nothing has come for a while.
    data = b''
    while select.select([source], [], [], seconds)[0]:
        more = os.read(source if isinstance(source, int) else source.fileno(), 999)
        if not more:
            break
        data += more
    return data


server, line, number = ser2net('telnet,tcp')
try:
    client = connect(number)
    print('first, to the client:', received(client).hex(' '))
    for name, frame in (('coil off', '01 05 00 00 00 00 cd ca'), ('coil on', '01 05 00 00 ff 00 8c 3a')):
        client.sendall(bytes.fromhex(frame))
        print('%-8s to the line:   %s' % (name, received(line).hex(' ')))
        os.write(line, bytes.fromhex(frame))
        print('%-8s to the client: %s' % (name, received(client).hex(' ')))
finally:
    server.kill()
PYTHON

diff - seen <<'SEEN' || { cat ser2net.log >&2; echo "DIFFERENT: < as it was seen, > now"; exit 1; }
first, to the client: ff fb 03 ff fd 03 ff fb 01 ff fe 01 ff fd 00 ff fb 00
coil off to the line:   01 05 00 00 00 00 cd ca
coil off to the client: 01 05 00 00 00 00 cd ca
coil on  to the line:   01 05 00 00 8c 3a
coil on  to the client: 01 05 00 00 ff ff 00 8c 3a
SEEN
echo "as seen"
