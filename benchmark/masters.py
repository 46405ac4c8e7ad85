"""Who can be at the master's end of a simulated wire: this driver, the plain loop, and what people use today."""
import os
import shutil
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))


class Master:
    """A master as a process of its own, which reads lines on its standard input."""

    name = ''
    missing = None  # why it can't be here; None: it can

    def __init__(self, command, environment=None):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        universal_newlines=True, bufsize=1, env=environment, start_new_session=True)

    def tell(self, line):
        self.process.stdin.write(line + '\n')
        self.process.stdin.flush()

    def stop(self, station):
        """Takes RUN off at this station, in whatever way this master does so."""
        self.tell('stop %d' % station)

    def stopped(self, station):
        """Is this frame its stop? A function of the request's bytes."""
        return lambda data: data[:6] == bytes([station, 0x05, 0, 0, 0, 0])

    def end(self, patience=15.0):
        """Ends it. Returns what it printed."""
        try:
            self.process.stdin.close()
        except OSError:
            pass
        self.process.terminate()
        return self.wait(patience)

    def wait(self, patience):
        self.process.stdin = None if self.process.stdin and self.process.stdin.closed else self.process.stdin
        try:
            return self.process.communicate(timeout=patience)[0]
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.communicate()[0]


class Driver(Master):
    """This package's driver, without ROS (bus_master)."""

    name = 'inverter_bus'

    def __init__(self, programs, wire, seconds, warm_up):
        """warm_up [s]: from then on all motors turn, and what it costs is counted."""
        super().__init__([os.path.join(programs, 'bus_master'), '--scan-list', wire.scan_list, '--warm-up', str(warm_up),
                          '--seconds', str(seconds), '--velocity', '10'])
        self.drive = wire.scene.drive

    def stop(self, station):
        self.tell('stop %d' % (station - 1))

    def stopped(self, station):
        return vfs15_stopped(station) if self.drive == 'toshiba_vfs15' else super().stopped(station)


def vfs15_stopped(station):
    """A VF-S15's FA00 without bit 10 (RUN): by 06H, or first of the two words of its block by 10H or 17H."""
    words = {0x06: (bytes([0xFA, 0x00]), 2, 4), 0x10: (bytes([0x18, 0x70]), 2, 7), 0x17: (bytes([0x18, 0x70]), 6, 11)}

    def judge(data):
        if data[0] != station or data[1] not in words:
            return False
        address, at, word = words[data[1]]
        return data[at:at + 2] == address and len(data) > word and not data[word] & 0x04

    return judge


class PlainLoop(Master):
    """libmodbus in a loop, with or without legal gaps (plain_loop)."""

    name = 'libmodbus loop'

    def __init__(self, programs, wire, seconds, gap):
        scene = wire.scene
        super().__init__([os.path.join(programs, 'plain_loop'), '--device', wire.link, '--inverters', str(scene.inverters),
                          '--baud', str(scene.baud), '--drive', scene.drive, '--gap', gap, '--seconds', str(seconds)])


class Pymodbus(Master):
    """pymodbus in the same loop (pymodbus_loop.py)."""

    name = 'pymodbus loop'

    def __init__(self, _programs, wire, seconds):
        super().__init__(['/usr/bin/python3', os.path.join(HERE, 'pymodbus_loop.py'), wire.link, str(wire.scene.baud),
                          str(wire.scene.inverters), str(seconds)])


def lacks_pymodbus():
    """Asked of the system's Python, which has Debian's package."""
    found = subprocess.run(['/usr/bin/python3', '-c', 'import pymodbus'], stderr=subprocess.DEVNULL).returncode == 0
    return None if found else 'python3-pymodbus is not installed'


class Hal(Master):
    """A driver of LinuxCNC, loaded by halrun without a machine."""

    def __init__(self, lines):
        # LinuxCNC refuses to run as root.
        environment = dict(os.environ, RTAPI_UID=os.environ.get('RTAPI_UID', '65534'))
        super().__init__(['halrun', '-s'], environment)
        for line in lines:
            self.tell(line)

    def end(self, patience=15.0):
        self.tell('exit')
        self.process.stdin.close()
        return self.wait(patience)


def lacks_linuxcnc():
    return None if shutil.which('halrun') else 'linuxcnc-uspace is not installed'


class Wj200(Hal):
    """LinuxCNC's wj200_vfd: one MX2 at station 1."""

    name = 'wj200_vfd'

    def __init__(self, _programs, wire, _seconds):
        super().__init__(['loadusr -W wj200_vfd --device=%s --baud=%d --parity=none --stopbits=1' %
                          (wire.link, wire.scene.baud), 'setp wj200-vfd.0.mbslaveaddr 1', 'setp wj200-vfd.0.enable TRUE',
                          'setp wj200-vfd.0.commanded-frequency 10', 'setp wj200-vfd.0.run TRUE'])

    def stop(self, _station):
        self.tell('setp wj200-vfd.0.run FALSE')

    def run(self):
        self.tell('setp wj200-vfd.0.run TRUE')


class Vfs11(Hal):
    """LinuxCNC's vfs11_vfd: one VF-S11 or VF-S15 at station 1."""

    name = 'vfs11_vfd'

    def __init__(self, _programs, wire, _seconds):
        settings = os.path.join(wire.directory, 'vfs11.ini')
        with open(settings, 'w') as stream:
            stream.write('[VFS11]\nTYPE = rtu\nDEVICE = %s\nTARGET = 1\nBAUD = %d\nBITS = 8\nPARITY = none\n'
                         'STOPBITS = 1\n' % (wire.link, wire.scene.baud))
        super().__init__(['loadusr -Wn vfs11_vfd vfs11_vfd --ini=%s' % settings, 'setp vfs11_vfd.enable TRUE',
                          'setp vfs11_vfd.speed-command 300', 'setp vfs11_vfd.spindle-on TRUE'])

    def stop(self, _station):
        self.tell('setp vfs11_vfd.spindle-on FALSE')

    def run(self):
        self.tell('setp vfs11_vfd.spindle-on TRUE')

    def stopped(self, station):
        return vfs15_stopped(station)


class Mb2hal(Hal):
    """LinuxCNC's mb2hal with the same two reads per drive, and RUN of station 1 as a coil that it writes each time."""

    name = 'mb2hal'
    READS = (('fnct_01_read_coils', 0, 24), ('fnct_03_read_holding_registers', 0x1000, 4))

    def __init__(self, _programs, wire, _seconds):
        settings = os.path.join(wire.directory, 'mb2hal.ini')
        with open(settings, 'w') as stream:
            stream.write(self.settings(wire))
        super().__init__(['loadusr -W mb2hal config=%s' % settings, 'setp mb2hal.run.00.bit TRUE'])

    def settings(self, wire):
        transactions = [(node, code, first, count, 'n%d_%s' % (node, code[5:7]))
                        for node in range(1, wire.scene.inverters + 1) for code, first, count in self.READS]
        transactions.append((1, 'fnct_15_write_multiple_coils', 0, 1, 'run'))
        text = '[MB2HAL_INIT]\nINIT_DEBUG=0\nVERSION=1.1\nTOTAL_TRANSACTIONS=%d\n' % len(transactions)
        for index, (node, code, first, count, name) in enumerate(transactions):
            text += ('[TRANSACTION_%02d]\nLINK_TYPE=serial\nSERIAL_PORT=%s\nSERIAL_BAUD=%d\nSERIAL_BITS=8\n'
                     'SERIAL_PARITY=none\nSERIAL_STOP=1\nSERIAL_DELAY_MS=0\nMB_SLAVE_ID=%d\nMB_TX_CODE=%s\n'
                     'FIRST_ELEMENT=%d\nNELEMENTS=%d\nHAL_TX_NAME=%s\nMAX_UPDATE_RATE=0.0\nMB_RESPONSE_TIMEOUT_MS=500\n'
                     'MB_BYTE_TIMEOUT_MS=500\nDEBUG=0\n' % (index, wire.link, wire.scene.baud, node, code, first, count, name))
        return text

    def stop(self, _station):
        self.tell('setp mb2hal.run.00.bit FALSE')

    def run(self):
        self.tell('setp mb2hal.run.00.bit TRUE')

    def stopped(self, station):
        return lambda data: data[:2] == bytes([station, 0x0F]) and len(data) > 7 and not data[7] & 0x01
