#!/usr/bin/env python3
"""Runs a program on a serial port whose reads can be made to fail with EIO: tty_job.py PORT PROGRAM ARGUMENT...

The kernel refuses a read with EIO, and nothing else, to a background job of the terminal that ignores SIGTTIN (termios(3)
and tty(4): job control). So this wrapper makes PORT its controlling terminal and starts the program as a job of its own:
in the foreground after SIGUSR1, where reads work, and in the background after SIGUSR2, where open, poll and write go on
and every read fails. That is how a USB adapter looks whose receiving endpoint has stalled. All other signals that matter
are passed on; the exit status is the program's.
"""
import fcntl
import os
import signal
import struct
import subprocess
import sys
import termios


def put_in_front(tty, group):
    fcntl.ioctl(tty, termios.TIOCSPGRP, struct.pack('i', group))


signal.signal(signal.SIGTTIN, signal.SIG_IGN)
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
if os.getsid(0) != os.getpid():
    os.setsid()
# A session leader without a terminal gets the first one that it opens.
TTY = os.open(sys.argv[1], os.O_RDWR)
JOB = subprocess.Popen(sys.argv[2:], preexec_fn=lambda: os.setpgid(0, 0))
put_in_front(TTY, JOB.pid)
signal.signal(signal.SIGUSR1, lambda *_: put_in_front(TTY, JOB.pid))
signal.signal(signal.SIGUSR2, lambda *_: put_in_front(TTY, os.getpid()))
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, lambda received, _: JOB.send_signal(received))
sys.exit(JOB.wait())
