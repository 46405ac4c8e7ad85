#!/usr/bin/env python3
"""The two TCP ports against servers of plain sockets: a byte bridge and a Modbus TCP gateway before a simulated bus.

An independent Modbus server (pymodbus) is in test/peers/pymodbus_test.py.
"""
import struct
import unittest

import rostest
import rospy
from gateways import ByteBridge, ModbusGateway
from harness import Bench, belts, init, stays, wait_for
from inverter_bus.msg import InverterStatus


class ThroughGateway(unittest.TestCase):
    """What a driver behind a gateway must do, whatever the gateway speaks."""

    gateway_class = None
    scheme = ''

    @classmethod
    def setUpClass(cls):
        if cls.gateway_class is None:
            raise unittest.SkipTest('only its children run')
        cls.bench = Bench(belts(2, command_timeout=0.0), response_timeout=0.5)
        cls.gateway = cls.gateway_class(cls.bench.link)
        cls.bench.start_driver(port='%s://127.0.0.1:%d' % (cls.scheme, cls.gateway.port))

    @classmethod
    def tearDownClass(cls):
        cls.gateway.close()
        cls.bench.close()

    def setUp(self):
        self.bench.unlock()
        for inverter in self.bench.inverters.values():
            inverter.wait(lambda s: not s.running and not s.run_command, 'at rest')

    def reach(self, name, velocity):
        self.bench[name].send(velocity)
        status = self.bench[name].wait(lambda s: s.running and abs(s.velocity - velocity) < 0.05, 'at %g' % velocity)
        self.assertEqual(status.error_id, 0, status.error_text)
        self.assertAlmostEqual(self.bench.frequency(name), velocity, delta=0.05)

    def testItMovesChangesAndStops(self):
        for name, velocity in (('belt_1', 15.0), ('belt_2', -20.0), ('belt_1', 30.0)):
            self.reach(name, velocity)
        answer = self.bench['belt_1'].stop()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')
        self.assertTrue(self.bench.turns('belt_2'))
        answer = self.bench.stop_all()
        self.assertTrue(answer.success, answer.message)
        for name in ('belt_1', 'belt_2'):
            self.bench[name].wait(lambda s: not s.running and s.locked, 'stopped')
            self.assertFalse(self.bench.turns(name))

    def testParametersAndFaultsPass(self):
        belt = self.bench['belt_2']
        self.assertTrue(belt.write_parameter('F002', 0.66).success)
        self.assertAlmostEqual(belt.read_parameter('F002').value, 0.66)
        self.bench.simulate('belt_2 trip 7')
        belt.wait(lambda s: s.faulted and 'E07' in s.fault_text, 'tripped')
        self.assertEqual(belt.read_faults().present.code, 7)
        answer = belt.reset()
        self.assertTrue(answer.success, answer.message)
        belt.wait(lambda s: not s.faulted, 'no fault')
        refused = belt.read_parameter('0xFF00')  # no register of the drive: its exception passes too
        self.assertEqual(refused.error_id, 0x8302, refused.message)

    def testAClosedConnectionIsOpenedAgainAndNothingRestarts(self):
        belt = self.bench['belt_1']
        with self.bench.run('belt_1', 20.0):
            clients = self.gateway.clients
            reconnects = self.bench.bus_status.reconnects
            self.gateway.down()
            try:
                belt.wait(lambda s: s.communication_error and s.known == 0, 'offline')
                wait_for(lambda: not self.bench.bus_status.connected, 'not connected')
                self.assertEqual(self.bench.finding('bus', str(self.gateway.port)).level, 2)
            finally:
                self.gateway.up()
            wait_for(lambda: self.bench.bus_status.connected and self.bench.bus_status.reconnects > reconnects,
                     'connected again')
            belt.wait(lambda s: not s.communication_error and s.locked, 'online and locked')
            belt.wait(lambda s: not s.running and not s.operation, 'the RUN that was left over is cleared')
            stays(lambda: self.bench.real('belt_1')['run_coil'] == '0', 'no RUN under a stream of commands', 1.0)
            self.assertEqual(self.gateway.clients, clients + 1)
        belt.forget()
        wait_for(lambda: len(belt.seen(lambda s: not s.communication_error)) > 5, 'status goes on')
        self.bench.unlock('belt_1')
        self.reach('belt_1', 10.0)

    def testADriveThatIsOffCostsTheOtherNothing(self):
        self.bench.simulate('belt_2 offline')
        self.bench['belt_2'].wait(lambda s: s.communication_error, 'offline')
        self.reach('belt_1', 20.0)
        self.bench.simulate('belt_2 online')
        self.bench['belt_2'].wait(lambda s: not s.communication_error, 'back')
        self.assertTrue(self.bench.turns('belt_1'))


class RtuOverTcp(ThroughGateway):
    gateway_class = ByteBridge
    scheme = 'rtu+tcp'


class ModbusTcp(ThroughGateway):
    gateway_class = ModbusGateway
    scheme = 'tcp'

    def tearDown(self):
        self.gateway.before_answer = None

    @staticmethod
    def stranger(step):
        """Before each answer one under the number of another request: full of ones, or the echo of a write."""
        def build(number, request, reply):
            if request[1] in (0x05, 0x06):
                lie = request
            elif reply[1] == request[1]:
                lie = reply[:3] + b'\xFF' * (len(reply) - 3)
            else:
                return b''
            return struct.pack('>HHH', number + step & 0xFFFF, 0, len(lie)) + lie

        return build

    def testAnAnswerUnderAWrongNumberIsNeverTaken(self):
        belt = self.bench['belt_1']
        for step in (-1, 1, 0x100):
            belt.forget()
            before = self.gateway.strangers
            self.gateway.before_answer = self.stranger(step)
            wait_for(lambda: self.gateway.strangers > before + 20, 'twenty foreign answers')
            self.gateway.before_answer = None
            seen = belt.seen()
            self.assertGreater(len(seen), 0)
            lies = [s for s in seen if s.running or s.faulted or s.output_frequency > 0.0 or s.raw_status == 0xFFFFFF]
            self.assertEqual(lies, [])
            belt.wait(lambda s: not s.communication_error and s.error_id == 0, 'right answers count')

    def testAStopIsNotConfirmedByAForeignAnswer(self):
        """The drive doesn't hear the stop, and what comes back has its shape but the number of another request."""
        self.reach('belt_1', 20.0)
        self.bench.simulate('belt_1 lost_request count 1 function 5')
        self.gateway.before_answer = self.stranger(-1)
        answer = self.bench['belt_1'].stop()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.bench.real('belt_1')['faults_waiting'], '0', 'the drive missed the first stop')
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')

    def testAnAnswerThatComesOneRequestLateIsNeverTaken(self):
        """A gateway that lost an answer and sends it before the next one."""
        belt = self.bench['belt_1']
        late = []

        def delayed(number, _, reply):
            late.append(struct.pack('>HHH', number, 0, len(reply)) + reply)
            return late.pop(0) if len(late) > 1 else b''

        self.reach('belt_1', 20.0)
        belt.forget()
        self.gateway.before_answer = delayed
        wait_for(lambda: len(belt.seen()) > 10, 'ten status messages')
        self.gateway.before_answer = None
        self.assertEqual([s for s in belt.seen() if not s.running or abs(s.velocity - 20.0) > 0.05], [])

    def testTheGatewaysOwnExceptionIsATimeOut(self):
        """0BH: no answer from the device. The inverter goes offline, as it would on a serial port."""
        self.bench.simulate('belt_2 offline')
        status = self.bench['belt_2'].wait(lambda s: s.communication_error, 'offline')
        self.assertEqual(status.error_id, InverterStatus.ERROR_TIMEOUT)
        self.bench.simulate('belt_2 online')
        self.bench['belt_2'].wait(lambda s: not s.communication_error, 'back')


def suite():
    loader = unittest.TestLoader()
    return unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in (RtuOverTcp, ModbusTcp))


if __name__ == '__main__':
    init('gateway_test')
    rostest.rosrun('inverter_bus', 'gateway', '__main__.suite')
    rospy.signal_shutdown('done')
