#!/usr/bin/env python3
"""However scripts/demo is ended, everything that it started ends with it, and its work directory is gone.

It plays on a pseudo-terminal as session leader, as under `xterm -e` and `ssh -t`: when that terminal is closed, the kernel
tells nobody else.
"""
import glob
import os
import pty
import select
import shutil
import signal
import tempfile
import threading
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.environ['INVERTER_BUS_BUILD']
PATIENCE = 120.0  # [s] for busy machines


def wait_for(condition, what):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError('not seen within %.0f s: %s' % (PATIENCE, what() if callable(what) else what))
        time.sleep(0.05)


class Demo:
    """scripts/demo as leader of a session with a terminal of its own."""

    def __init__(self):
        self.directory = tempfile.mkdtemp(prefix='demo_terminal_')
        self.mark = ('TMPDIR=' + self.directory).encode()
        self.said = b''
        self.closed = False
        environment = dict(os.environ, TMPDIR=self.directory, TERM='xterm', LC_ALL='C.UTF-8')
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            os.execvpe('bash', ['bash', os.path.join(ROOT, 'scripts', 'demo'), '--build', BUILD], environment)
        self.status = None
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        """A terminal that nobody reads would hold the demo up."""
        while not self.closed:
            try:
                if select.select([self.master], [], [], 0.05)[0]:
                    self.said += os.read(self.master, 65536)
            except OSError:
                return

    def last_words(self):
        return self.said[-1000:].decode(errors='replace')

    def close_terminal(self):
        self.closed = True
        self.reader.join()
        os.close(self.master)

    def type(self, text):
        os.write(self.master, text)

    def ended(self):
        if self.status is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.status = os.WEXITSTATUS(status) if os.WIFEXITED(status) else -os.WTERMSIG(status)
        return self.status is not None

    def processes(self):
        """Everything that was started below it, by the mark in the environment."""
        found = []
        for path in glob.glob('/proc/[0-9]*/environ'):
            try:
                with open(path, 'rb') as stream:
                    if self.mark in stream.read().split(b'\0'):
                        with open(os.path.join(os.path.dirname(path), 'cmdline'), 'rb') as line:
                            found.append(line.read().replace(b'\0', b' ').decode(errors='replace'))
            except OSError:
                pass
        return found

    def remove(self):
        """Whatever the test has found, nothing is left of it."""
        if not self.ended():
            os.kill(self.pid, signal.SIGTERM)
            wait_for(self.ended, 'the end of the demo')
        if not self.closed:
            self.close_terminal()
        shutil.rmtree(self.directory, ignore_errors=True)


class DemoTerminal(unittest.TestCase):
    def start(self):
        demo = Demo()
        self.addCleanup(demo.remove)
        return demo

    def started(self):
        """A demo whose motors run."""
        demo = self.start()
        wait_for(lambda: b'running' in demo.said or demo.ended(), demo.last_words)
        self.assertFalse(demo.ended(), demo.last_words())
        names = ' '.join(demo.processes())
        for name in ('inverter_bus_node', 'simulated_bus_node', 'conveyor_scene', 'roslaunch'):
            self.assertIn(name, names)
        return demo

    def assertNothingIsLeft(self, demo):
        wait_for(demo.ended, lambda: 'the end of the demo; it said %s' % demo.last_words())
        wait_for(lambda: not demo.processes(), lambda: 'the end of %s' % demo.processes())
        self.assertEqual(os.listdir(demo.directory), [])

    def testAClosedTerminalEndsEverything(self):
        demo = self.started()
        demo.close_terminal()
        self.assertNothingIsLeft(demo)

    def testATerminalThatIsClosedDuringTheStartEndsEverything(self):
        demo = self.start()
        wait_for(lambda: b'Starting' in demo.said or demo.ended(), demo.last_words)
        demo.close_terminal()
        self.assertNothingIsLeft(demo)
        self.assertNotEqual(demo.status, 0)

    def testASignalToTheScriptAloneEndsEverything(self):
        for number in (signal.SIGTERM, signal.SIGQUIT):
            demo = self.started()
            os.kill(demo.pid, number)
            self.assertNothingIsLeft(demo)
            self.assertNotEqual(demo.status, 0)

    def testCtrlCStopsTheMotorsAndASecondOneChangesNothing(self):
        demo = self.started()
        demo.type(b'\x03')
        wait_for(lambda: b'stopping every motor' in demo.said or demo.ended(), demo.last_words)
        demo.type(b'\x03')
        demo.type(b'\x03')
        self.assertNothingIsLeft(demo)
        self.assertIn('standing still', demo.last_words())
        self.assertEqual(demo.status, 0)

    def testAQuitFromTheKeyboardEndsEverything(self):
        demo = self.started()
        demo.type(b'\x1c')
        self.assertNothingIsLeft(demo)


if __name__ == '__main__':
    unittest.main()
