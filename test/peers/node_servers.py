"""Modbus servers of npm: from NODE_PATH, npm's global modules, or where install_dependencies has put them."""
import json
import os
import shutil
import subprocess
import threading

from own_master import CACHE, free_port
from simulated_line import SimulatedLine

HERE = os.path.dirname(os.path.abspath(__file__))
NODE = shutil.which('node') or shutil.which('nodejs')


def environment():
    paths = [os.environ.get('NODE_PATH', ''), os.path.join(CACHE, 'node_modules'), '/usr/lib/node_modules',
             '/usr/local/lib/node_modules']
    return dict(os.environ, NODE_PATH=os.pathsep.join(path for path in paths if path))


def missing(module):
    """Why it can't be used, '' if it can."""
    found = NODE and subprocess.call([NODE, '-e', 'require.resolve("%s")' % module], env=environment(),
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0
    return '' if found else 'npm\'s %s is not installed (INVERTER_BUS_PEERS=1 does that)' % module


class NodeServer:
    """A server that plays MX2 drives and tells after each write what its drives do, a line of JSON each."""

    def __init__(self, script):
        self.port = free_port()
        self.drives = {}
        self.process = subprocess.Popen([NODE, os.path.join(HERE, script), str(self.port)], env=environment(),
                                        stdout=subprocess.PIPE, universal_newlines=True)
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()
        SimulatedLine.wait_for(lambda: self.drives or self.process.poll() is not None, script + ' listening')
        if self.process.poll() is not None:
            raise AssertionError('%s ended' % script)

    def read(self):
        for line in self.process.stdout:
            drive = json.loads(line)
            self.drives[drive['unit']] = drive

    def end(self):
        self.process.kill()
        self.process.wait()
        self.reader.join()
        self.process.stdout.close()
