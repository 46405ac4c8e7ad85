"""The real ser2net in front of a simulated line."""
import glob
import os
import re
import shutil
import socket
import subprocess

from own_master import CACHE, free_port
from simulated_line import SimulatedLine

UNPACKED = os.path.join(CACHE, 'ser2net', 'usr')  # by scripts/install_dependencies
PROGRAM = shutil.which('ser2net', path='%s:/usr/sbin:%s' % (os.environ.get('PATH', ''), os.path.join(UNPACKED, 'sbin')))
ENVIRONMENT = dict(os.environ, LD_LIBRARY_PATH=':'.join(
    [os.environ.get('LD_LIBRARY_PATH', '')] + glob.glob(os.path.join(UNPACKED, 'lib', '*-linux-*'))).lstrip(':'))


def missing():
    """Why it can't be used, '' if it can."""
    if not PROGRAM:
        return 'ser2net is not installed'
    version = subprocess.run([PROGRAM, '-v'], env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             universal_newlines=True).stdout
    number = re.search(r'version (\d+)', version)
    return '' if number and int(number.group(1)) >= 4 else 'ser2net 4 or later is needed, this is: ' + version.strip()


MISSING = missing()


class Ser2net:
    """Started anew with other settings on the same TCP port, as after an edit of its file.

    What docs/gateways.md recommends is what `raw` sets.
    """

    def __init__(self, directory, link, baud_rate=19200):
        self.directory = directory
        self.link = link
        self.baud_rate = baud_rate
        self.port = free_port()
        self.process = None

    def raw(self, **options):
        self.start('tcp(nodelay)', dict({'kickolduser': 'true', 'chardelay': 'false'}, **options))

    def telnet(self):
        self.start('telnet,tcp', {'kickolduser': 'true'})

    def start(self, accepter, options):
        path = os.path.join(self.directory, 'ser2net.yaml')
        with open(path, 'w') as stream:
            stream.write('connection: &line\n  accepter: %s,127.0.0.1,%d\n' % (accepter, self.port))
            stream.write('  connector: serialdev,%s,%dn81,local\n  options:\n' % (self.link, self.baud_rate))
            stream.writelines('    %s: %s\n' % option for option in options.items())
        self.process = subprocess.Popen([PROGRAM, '-n', '-c', path], env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        SimulatedLine.wait_for(self.listens, 'ser2net listening')

    def listens(self):
        """From the kernel's list, since a connection would be one of its clients."""
        with open('/proc/net/tcp') as stream:
            return any(words[1].endswith(':%04X' % self.port) and words[3] == '0A'
                       for words in (line.split() for line in stream) if len(words) > 3)

    def end(self):
        """As by a crash: without a word to its client but the end of the connection."""
        if self.process:
            self.process.kill()
            self.process.wait()
            self.process = None

    def connect(self):
        return socket.create_connection(('127.0.0.1', self.port), 5.0)
