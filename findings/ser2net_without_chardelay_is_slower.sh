#!/usr/bin/env bash
# Switching off ser2net's "chardelay", which holds bytes back, makes answers slower by 30 ms, not faster.
#
# Peer: ser2net 4.3.11-1 with libgensio4 2.6.2-4 (Debian 12) on a pseudo-terminal fed at 9600 baud; the client asks,
# waits for the 13 bytes of the answer and asks again.
# Guess: "chardelay: false" passes bytes on at once, which is what a master that waits for answers wants.
# Seen: the first byte goes at once, the other twelve some 45 ms after the answer's start, though they were there after
# 14 ms: Nagle's algorithm in ser2net waits for the acknowledgement that the client's kernel delays by 40 ms. With
# chardelay on the answer is whole after 18 ms; "accepter: tcp(nodelay)" and chardelay off together give 15 to 17 ms.
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


LENGTH, CHARACTER = 13, 10 / 9600


def answer_time(accepter, option):
    # Median from an answer's first byte on the line to its last one at the client [ms], of 30.
    server, line, number = ser2net(accepter, option)
    try:
        client = connect(number)
        times = []
        for _ in range(30):
            client.sendall(b'request')
            os.read(line, 99)
            start = time.monotonic()
            got, sent = 0, 0
            while got < LENGTH:
                if sent < LENGTH and time.monotonic() >= start + sent * CHARACTER:
                    os.write(line, b'x')
                    sent += 1
                wait = max(0.0, start + sent * CHARACTER - time.monotonic()) if sent < LENGTH else 1.0
                if select.select([client], [], [], wait)[0]:
                    got += len(client.recv(99))
            times.append(1000 * (time.monotonic() - start))
        return sorted(times)[len(times) // 2]
    finally:
        server.kill()


with_delay = answer_time('tcp', 'chardelay: true')
without_delay = answer_time('tcp', 'chardelay: false')
without_both = answer_time('tcp(nodelay)', 'chardelay: false')
with open('times', 'w') as stream:
    stream.write('%.0f ms with chardelay, %.0f ms without, %.0f ms without and with nodelay\n' %
                 (with_delay, without_delay, without_both))
print('without chardelay more than 15 ms slower:', without_delay > with_delay + 15.0)
print('with nodelay and without chardelay no slower:', without_both < with_delay + 5.0)
PYTHON
cat times

diff - seen <<'SEEN' || { cat ser2net.log >&2; echo "DIFFERENT: < as it was seen, > now"; exit 1; }
without chardelay more than 15 ms slower: True
with nodelay and without chardelay no slower: True
SEEN
echo "as seen"
