#!/usr/bin/env bash
# LinuxCNC's wj200_vfd trips the drive as long as it is not enabled, and sends nothing when it ends: the motor runs on.
#
# Peers: wj200_vfd and vfs11_vfd of linuxcnc-uspace 2.9.0~pre1+git20230208.f1270d6ed7-1+deb12u2, libmodbus5
# 3.1.6-2.1+deb12u1 (Debian 12), loaded without a machine, in front of a small Modbus drive that plays along.
# Guess: a driver that is not enabled leaves the drive alone, and one that is ended with SIGTERM takes RUN off.
# Seen: wj200_vfd writes coil 3, external trip (E12), all the time while "enable" is false, so loading it beside a
# running drive stops that with a fault; ended while RUN is on, it writes nothing more. vfs11_vfd of the same package is
# the opposite twice: it commands 0 while not enabled, and its last frame takes RUN off.
# It plays in an IPC namespace of its own, so a LinuxCNC that runs here notices nothing.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(linuxcnc-uspace=2.9.0~pre1+git20230208.f1270d6ed7-1+deb12u2 libmodbus5=3.1.6-2.1+deb12u1)
apt-get -o APT::Sandbox::User=root -qq download "${packages[@]}" >apt.log 2>&1 ||
  { cat apt.log >&2; echo "not available any more: ${packages[*]}" >&2; exit 2; }
for package in *.deb; do dpkg -x "$package" root; done

cat >play.py <<'PYTHON'
import os, pty, select, subprocess, sys, threading, time, tty

line, port = pty.openpty()
tty.setraw(port)
DEVICE, writes = os.ttyname(port), []


def with_crc(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return data + crc.to_bytes(2, 'little')


def drive():
    # Any station: reads are answered with zeros, writes with their echo.
    pending = b''
    while True:
        pending += os.read(line, 99)
        while len(pending) >= 8:
            length = 9 + pending[6] if pending[1] == 0x10 else 8
            if len(pending) < length:
                break
            request, pending = pending[:length], pending[length:]
            if request[1] <= 4:
                count = request[5] * 2 if request[1] >= 3 else (request[5] + 7) // 8
                answer = request[:2] + bytes([count]) + bytes(count)
            else:
                writes.append(request[:-2].hex(' '))
                answer = request[:6]
            os.write(line, with_crc(answer))


def pin(name, value=None):
    command = ['getp', name] if value is None else ['setp', name, str(value)]
    return subprocess.call(['root/usr/bin/halcmd'] + command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def wait(condition, what, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            sys.exit('not seen: ' + what)
        time.sleep(0.05)


def play(name, arguments, enable, settings, run):
    driver = subprocess.Popen(['root/usr/bin/' + name] + arguments, stdout=sys.stderr)
    wait(lambda: pin(enable) == 0, name + ' is loaded')
    for setting, value in settings:
        pin(setting, value)
    del writes[:]
    wait(lambda: len(writes) >= 2, 'writes while not enabled')
    print(name, 'not enabled, writes:', ', '.join(sorted(set(writes))))
    pin(enable, 1)
    for setting, value in run:
        pin(setting, value)
    running = {'wj200_vfd': '01 05 00 00 ff 00', 'vfs11_vfd': '05 06 fa 00 c4 40'}[name]
    wait(lambda: running in writes, 'RUN')
    driver.terminate()
    driver.wait()
    while select.select([line], [], [], 0.5)[0]:
        time.sleep(0.05)
    last = [write for write in writes if write[:11] == running[:11]][-1]
    print(name, 'ended, its last write to the word of RUN:', last)


threading.Thread(target=drive, daemon=True).start()
play('wj200_vfd', ['--device=' + DEVICE, '--baud=9600', '--parity=none', '--stopbits=1'], 'wj200-vfd.0.enable',
     [('wj200-vfd.0.mbslaveaddr', 1)], [('wj200-vfd.0.commanded-frequency', 20), ('wj200-vfd.0.run', 1)])
with open('vfs11.ini', 'w') as stream:
    stream.write('[VFS11]\nTYPE = rtu\nDEVICE = %s\nTARGET = 5\n' % DEVICE)
    stream.write('BAUD = 9600\nBITS = 8\nPARITY = none\nSTOPBITS = 1\n')
play('vfs11_vfd', ['--ini=vfs11.ini'], 'vfs11_vfd.enable', [],
     [('vfs11_vfd.speed-command', 600), ('vfs11_vfd.spindle-on', 1)])
PYTHON
libraries=$work/root/usr/lib:$(dirname "$(find "$work/root" -name libmodbus.so.5)")
# LinuxCNC refuses to run as root, which this is in the namespace.
RTAPI_UID=65534 LD_LIBRARY_PATH=$libraries PATH=$work/root/usr/bin:$PATH \
  unshare --map-root-user --ipc /usr/bin/python3 play.py 2>play.log | tee seen

diff - seen <<'SEEN' || { cat play.log >&2; echo "DIFFERENT: < as it was seen, > now"; exit 1; }
wj200_vfd not enabled, writes: 01 05 00 02 ff 00
wj200_vfd ended, its last write to the word of RUN: 01 05 00 00 ff 00
vfs11_vfd not enabled, writes: 05 06 fa 00 00 00
vfs11_vfd ended, its last write to the word of RUN: 05 06 fa 00 00 00
SEEN
echo "as seen"
