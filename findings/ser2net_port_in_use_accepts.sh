#!/usr/bin/env bash
# A ser2net port that is in use still accepts: the refusal is a line of text in place of data, then the end.
#
# Peer: ser2net 4.3.11-1 with libgensio4 2.6.2-4 (Debian 12), "accepter: tcp", one client allowed (its default).
# Guess: the second client's connection is refused, or waits in the backlog.
# Seen: connect() succeeds, then come the bytes of "Port already in use" and the end. To a Modbus client that is a port
# that opens well, answers with garbage and is gone, as often as it tries. With "kickolduser: true" (so in the file that
# Debian installs) it is the other way round: the first one loses its connection at once and without a word.
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
    # All that comes until nothing has come for a while, and whether it was the end.
    data = b''
    while select.select([source], [], [], seconds)[0]:
        more = os.read(source if isinstance(source, int) else source.fileno(), 999)
        if not more:
            return data, 'end of the connection'
        data += more
    return data, 'still connected'


for option in 'kickolduser: false', 'kickolduser: true':
    server, line, number = ser2net('tcp', option)
    try:
        first = connect(number)
        first.sendall(b'1')
        received(line)
        second = connect(number)
        print(option)
        print('  second client gets: %s, %s' % received(second))
        print('  first client gets: %s, %s' % received(first))
    finally:
        server.kill()
PYTHON

diff - seen <<'SEEN' || { cat ser2net.log >&2; echo "DIFFERENT: < as it was seen, > now"; exit 1; }
kickolduser: false
  second client gets: b'Port already in use\r\n', end of the connection
  first client gets: b'', still connected
kickolduser: true
  second client gets: b'', still connected
  first client gets: b'', end of the connection
SEEN
echo "as seen"
