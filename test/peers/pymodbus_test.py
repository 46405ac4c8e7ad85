#!/usr/bin/env python3
"""The driver on tcp:// against pymodbus, an independent Modbus server, that plays MX2 behind a gateway."""
import os
import sys
import threading
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from own_master import free_port
from remote_drives import ItsCases, RemoteDrives

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

    def follow(self):
        run = self.coil(RUN)
        for number in (OPERATION, RUNNING, AT_SPEED):
            self.coils.values[number - 1] = run
        self.coils.values[READY - 1] = True
        high, low = self.registers.getValues(FREQUENCY - 1, 2) if run else (0, 0)
        turns = 0 if not run else 2 if self.coil(DIRECTION) else 1
        self.registers.values[OUTPUT - 1:TURNS] = [high, low, 150 if run else 0, turns]


class Pymodbus(RemoteDrives):
    @classmethod
    def startServer(cls):
        cls.drives = cls.makeDrives()
        port = free_port()
        threading.Thread(target=StartTcpServer, kwargs={'context': cls.makeContext(), 'address': ('127.0.0.1', port)},
                         daemon=True).start()
        return port

    @classmethod
    def makeDrives(cls):
        return {1: Mx2(), 2: Mx2()}

    @classmethod
    def makeContext(cls):
        return ModbusServerContext(slaves={node: drive.context for node, drive in cls.drives.items()}, single=False)

    def drive(self, node):
        drive = self.drives[node]
        high, low = drive.registers.getValues(FREQUENCY - 1, 2)
        return {'run': drive.coil(RUN), 'reverse': drive.coil(DIRECTION), 'frequency': high << 16 | low}


@unittest.skipIf(MISSING, MISSING)
class ATableOfUnits(ItsCases, Pymodbus):
    """Silent to units that it lacks, broadcasts among them."""

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


@unittest.skipIf(MISSING, MISSING)
class ASilentUnit(Pymodbus):
    """A station that is in the scan list and never answers."""

    silent_node = 3

    def testTheOthersMoveAndStop(self):
        absent, belt = self.bench['absent'], self.bench['belt_1']
        absent.wait(lambda s: s.communication_error and s.error_id != 0, 'offline')
        for velocity in (15.0, -20.0):
            belt.send(velocity)
            belt.wait(lambda s: s.running and abs(s.velocity - velocity) < 0.005, 'at %g' % velocity)
        answer = belt.stop()
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(self.runs(1))
        answer = self.bench.stop_all()
        self.assertFalse(answer.success, 'nobody knows of the absent one')
        self.assertIn('absent', answer.message)
        self.assertNotIn('belt_2', answer.message)
        belt.fresh()


@unittest.skipIf(MISSING, MISSING)
class OneTableForAll(ItsCases, Pymodbus):
    """single=True: every unit is the same drive, and a broadcast is answered."""

    one_table = True

    @classmethod
    def makeDrives(cls):
        drive = Mx2()
        return {1: drive, 2: drive}

    @classmethod
    def makeContext(cls):
        return ModbusServerContext(slaves=cls.drives[1].context, single=True)


if __name__ == '__main__':
    unittest.main(warnings='ignore')  # rospy leaves sockets to the garbage collector
