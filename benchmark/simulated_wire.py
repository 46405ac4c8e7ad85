"""The simulated bus as a program, with everything that was on its wire, for any master that opens its link."""
import os
import re
import shutil
import subprocess
import tempfile
import time

import scenes
import traces


class SimulatedWire:
    """A scene being played. `with` ends it. Requests without a legal gap are served and counted (--gap ignore)."""

    def __init__(self, programs, scene, realtime_priority=50, spin=0.0001):
        self.scene = scene
        self.directory = tempfile.mkdtemp(prefix='bench_')
        os.chmod(self.directory, 0o755)  # LinuxCNC's programs read their files as somebody else
        self.link = os.path.join(self.directory, 'line')  # short: mb2hal keeps 31 characters of it
        self.scan_list = os.path.join(self.directory, 'bus.yaml')
        self.trace = os.path.join(self.directory, 'trace')
        with open(self.scan_list, 'w') as stream:
            stream.write(scenes.scan_list(scene, self.link))
        self.process = subprocess.Popen(
            [os.path.join(programs, 'simulated_bus'), '--scan-list', self.scan_list, '--link', self.link, '--trace',
             self.trace, '--gap', 'ignore', '--spin', str(spin), '--realtime-priority', str(realtime_priority)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, bufsize=1)
        self.late = None  # [s] the wire's own error on average, once it has ended
        while not os.path.exists(self.link):
            if self.process.poll() is not None:
                raise RuntimeError('simulated_bus ended:\n' + self.process.stdout.read())
            time.sleep(0.01)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()
        shutil.rmtree(self.directory)

    def command(self, line):
        """A command of the simulated bus, such as 'belt_3 offline'."""
        self.process.stdin.write(line + '\n')
        self.process.stdin.flush()

    def frames(self):
        """Everything up to now."""
        with open(self.trace) as stream:
            return traces.parse(stream.read())

    def end(self):
        """Ends the bus; its last words say how punctual it was."""
        if self.process.poll() is None:
            self.process.terminate()
        words, _ = self.process.communicate()
        match = re.search(r'late by ([\d.e+-]+) us on average', words or '')
        if match:
            self.late = float(match.group(1)) * 1e-6
