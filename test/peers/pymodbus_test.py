#!/usr/bin/env python3
"""The driver on tcp:// against pymodbus, an independent Modbus server, that plays two MX2 behind a gateway.

It brings a ROS master of its own, since it needs no other node than the driver.
"""
import os
import shutil
import socket
import subprocess
import sys
import threading
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, 'test', 'integration'))

try:
    from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
    try:
        from pymodbus.server.sync import StartTcpServer  # before 3.0
    except ImportError:
        from pymodbus.server import StartTcpServer
    MISSING = ''
except ImportError as error:
    MISSING = 'python3-pymodbus or what its server needs is not installed (%s)' % error

# The MX2's numbers as in its manual; on the wire each is one less.
RUN, DIRECTION, OPERATION, READY, RUNNING, AT_SPEED = 0x0001, 0x0002, 0x000F, 0x0011, 0x0013, 0x0014
FREQUENCY, OUTPUT, TURNS = 0x0001, 0x1001, 0x1004  # F001 and d001 are two words each; between: current
A001, A002 = 0x1201, 0x1202
REGISTERS, COILS = 0x1300, 0x0060  # how many the server has; beyond them it answers exception 02


def free_port():
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


class Mx2:
    """A few coils and registers of an MX2 whose motor needs no time: status and output follow the commands at once."""

    def __init__(self):
        drive = self

        class Block(ModbusSequentialDataBlock):
            """What the bus writes has its effect at once."""

            def setValues(self, address, values):
                super().setValues(address, values)
                drive.follow()

        self.coils = Block(0, [False] * COILS)
        self.registers = Block(0, [0] * REGISTERS)
        self.registers.values[A001 - 1] = self.registers.values[A002 - 1] = 3
        self.context = ModbusSlaveContext(co=self.coils, di=self.coils, hr=self.registers, ir=self.registers,
                                          zero_mode=True)
        self.follow()

    def coil(self, number):
        return bool(self.coils.getValues(number - 1, 1)[0])

    def frequency(self):
        """Set frequency [0.01 Hz]."""
        high, low = self.registers.getValues(FREQUENCY - 1, 2)
        return high << 16 | low

    def follow(self):
        run = self.coil(RUN)
        for number in (OPERATION, RUNNING, AT_SPEED):
            self.coils.values[number - 1] = run
        self.coils.values[READY - 1] = True
        high, low = self.registers.getValues(FREQUENCY - 1, 2) if run else (0, 0)
        turns = 0 if not run else 2 if self.coil(DIRECTION) else 1
        self.registers.values[OUTPUT - 1:TURNS] = [high, low, 150 if run else 0, turns]


@unittest.skipIf(MISSING, MISSING)
class Pymodbus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        master_port = free_port()
        os.environ['ROS_MASTER_URI'] = 'http://127.0.0.1:%d' % master_port
        os.environ['ROS_IP'] = '127.0.0.1'
        cls.master = subprocess.Popen([shutil.which('rosmaster'), '--core', '-p', str(master_port)],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.addClassCleanup(cls.end_master)
        cls.drives = {1: Mx2(), 2: Mx2()}
        context = ModbusServerContext(slaves={node: drive.context for node, drive in cls.drives.items()}, single=False)
        port = free_port()
        threading.Thread(target=StartTcpServer, kwargs={'context': context, 'address': ('127.0.0.1', port)},
                         daemon=True).start()

        from harness import Bench, belts, init

        class Remote(Bench):
            def start_simulator(self, *_):
                """The drives are pymodbus."""

        init('pymodbus_test')
        cls.bench = Remote(belts(2, command_timeout=0.0), port='tcp://127.0.0.1:%d' % port, response_timeout=0.5)
        cls.addClassCleanup(cls.bench.close)
        cls.bench.start_driver()

    @classmethod
    def end_master(cls):
        cls.master.terminate()
        cls.master.wait()

    def setUp(self):
        self.bench.unlock()

    def testItMovesChangesReversesAndStops(self):
        belt, drive = self.bench['belt_1'], self.drives[1]
        for velocity in (15.0, 42.5, -20.0):
            belt.send(velocity)
            status = belt.wait(lambda s: s.running and abs(s.velocity - velocity) < 0.005, 'at %g' % velocity)
            self.assertEqual(drive.frequency(), abs(velocity) * 100)
            self.assertEqual(drive.coil(DIRECTION), velocity < 0)
            self.assertTrue(drive.coil(RUN))
            self.assertAlmostEqual(status.output_current, 1.5)
            self.assertEqual(status.error_id, 0, status.error_text)
        self.assertFalse(self.drives[2].coil(RUN), 'the other station is left alone')
        answer = belt.stop()
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(drive.coil(RUN))
        belt.wait(lambda s: not s.running and s.locked, 'stopped')

    def testStopOfTheBusReachesBoth(self):
        for node, name in ((1, 'belt_1'), (2, 'belt_2')):
            self.bench[name].send(10.0 * node)
            self.bench[name].wait(lambda s: s.running, 'runs')
        answer = self.bench.stop_all()
        self.assertTrue(answer.success, answer.message)
        for drive in self.drives.values():
            self.assertFalse(drive.coil(RUN))
        for name in ('belt_1', 'belt_2'):
            self.bench[name].wait(lambda s: not s.running and not s.communication_error, 'stopped')

    def testParametersAndExceptionsPass(self):
        belt = self.bench['belt_2']
        answer = belt.read_parameter('A001')
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.value, 3.0)
        answer = belt.write_parameter('F002', 12.34)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.drives[2].registers.getValues(0x1103 - 1, 2), [0, 1234])
        answer = belt.read_parameter('0xFF00')
        self.assertFalse(answer.success)
        self.assertEqual(answer.error_id, 0x8302, answer.message)


if __name__ == '__main__':
    unittest.main(warnings='ignore')  # rospy leaves sockets to the garbage collector
