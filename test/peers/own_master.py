"""A ROS master of its own for a peer test, which needs no other node than the driver and the simulated bus."""
import atexit
import os
import shutil
import socket
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, 'test', 'integration'))
CACHE = os.path.join(os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~/.cache'), 'inverter_bus')

_master = None


def free_port():
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


def init_with_own_master(name):
    """At the beginning of each test class; the first call of a program starts the master and the node."""
    global _master
    if _master:
        return
    port = free_port()
    os.environ['ROS_MASTER_URI'] = 'http://127.0.0.1:%d' % port
    os.environ['ROS_IP'] = '127.0.0.1'
    _master = subprocess.Popen([shutil.which('rosmaster'), '--core', '-p', str(port)], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    atexit.register(end_master)
    from harness import init
    init(name)


def end_master():
    _master.terminate()
    _master.wait()
