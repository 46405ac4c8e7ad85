"""A simulated bus for an independent client: started as the program, without ROS."""
import os
import shutil
import subprocess
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ.get('INVERTER_BUS_BUILD', os.path.join(ROOT, 'build', 'test'))
PROGRAM = os.path.join(BUILD, 'devel', 'lib', 'inverter_bus', 'simulated_bus')


class SimulatedLine:
    def __init__(self, scan_list, *options):
        self.directory = tempfile.mkdtemp(prefix='inverter_bus_peer_')
        self.link = os.path.join(self.directory, 'line')
        path = os.path.join(self.directory, 'bus.yaml')
        with open(path, 'w') as stream:
            stream.write(scan_list)
        self.process = subprocess.Popen([PROGRAM, '--scan-list', path, '--link', self.link] + list(options),
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                        universal_newlines=True, bufsize=1)
        self.wait_for(lambda: os.path.exists(self.link), 'the simulated line')

    @staticmethod
    def wait_for(condition, what, patience=30.0):
        deadline = time.monotonic() + patience
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError('not seen within %.0f s: %s' % (patience, what))
            time.sleep(0.02)

    def command(self, line):
        """A command of the simulated bus's grammar; returns what follows "ok"."""
        self.process.stdin.write(line + '\n')
        self.process.stdin.flush()
        while True:
            answer = self.process.stdout.readline()
            if answer == '':
                raise AssertionError('the simulated bus ended')
            if answer.startswith('ok'):
                return answer[2:].strip()
            if answer.startswith('error'):
                raise AssertionError(line + ': ' + answer)

    def real(self, name):
        return dict(word.split('=', 1) for word in self.command(name + ' show').split() if '=' in word)

    def close(self):
        self.process.stdin.close()
        self.process.terminate()
        self.process.wait()
        self.process.stdout.close()
        shutil.rmtree(self.directory)
