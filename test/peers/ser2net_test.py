#!/usr/bin/env python3
"""The driver on rtu+tcp:// against the real ser2net in front of a simulated line, set well and set wrongly."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from own_master import init_with_own_master
from ser2net_server import MISSING, Ser2net

from harness import QUICK_RAMPS, Bench, Stream, belts, stays, wait_for
from inverter_bus.msg import InverterStatus

class Served(unittest.TestCase):
    """A driver, ser2net and a simulated line; a test starts what it needs."""

    entries = belts(2, command_timeout=0.0)
    ramps = QUICK_RAMPS

    @classmethod
    def setUpClass(cls):
        init_with_own_master('ser2net_test')

    def setUp(self):
        simulation = {entry['name']: {'parameters': self.ramps} for entry in self.entries}
        self.bench = Bench(self.entries, simulation=simulation, ramps=False, response_timeout=0.3)
        self.addCleanup(self.bench.close)
        self.server = Ser2net(self.bench.directory, self.bench.link)
        self.addCleanup(self.server.end)

    def start(self, **options):
        self.server.raw(**options)
        self.bench.start_driver(port='rtu+tcp://127.0.0.1:%d' % self.server.port)

    def waitForRest(self, name):
        wait_for(lambda: self.bench.real(name)['running'] == '0', name + ' at rest')


@unittest.skipIf(MISSING, MISSING)
class Raw(Served):
    def testItMovesChangesAndStops(self):
        self.start()
        self.bench.unlock()
        for name, velocity in (('belt_1', 15.0), ('belt_2', -20.0), ('belt_1', 30.0)):
            self.bench[name].send(velocity)
            status = self.bench[name].wait(lambda s: s.running and abs(s.velocity - velocity) < 0.05, 'at speed')
            self.assertEqual(status.error_id, 0, status.error_text)
            self.assertAlmostEqual(self.bench.frequency(name), velocity, delta=0.05)
        answer = self.bench['belt_1'].stop()
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(self.bench.turns('belt_2'))
        answer = self.bench.stop_all()
        self.assertTrue(answer.success, answer.message)
        self.waitForRest('belt_2')

    def testAServerThatWasRestartedFindsTheMotorsStoppedAndLocked(self):
        self.start()
        with self.bench.run('belt_1', 20.0):
            self.server.end()
            status = self.bench['belt_1'].wait(lambda s: s.communication_error, 'the loss is told')
            self.assertEqual(status.error_id, InverterStatus.ERROR_PORT_LOST, status.error_text)
            wait_for(lambda: not self.bench.bus_status.connected, 'not connected')
            self.server.raw()
            self.bench['belt_1'].wait(lambda s: not s.communication_error and s.locked, 'online and locked')
            self.waitForRest('belt_1')
            stays(lambda: self.bench.real('belt_1')['run_coil'] == '0', 'no RUN under a stream of commands', 1.0)

    def testAMotorRunsOnWhenAnotherClientTakesTheConnectionOnce(self):
        self.start()
        with self.bench.run('belt_1', 20.0):
            self.bench['belt_1'].forget()
            reconnects = self.bench.bus_status.reconnects
            with self.server.connect() as other:
                other.settimeout(10.0)
                while other.recv(99):
                    pass  # until the driver has taken it back
            wait_for(lambda: self.bench.bus_status.reconnects > reconnects, 'connected again')
            self.bench['belt_1'].fresh()
            self.assertEqual(self.bench['belt_1'].seen(lambda s: s.locked or s.communication_error), [])
            self.assertTrue(self.bench.turns('belt_1'))
        answer = self.bench['belt_1'].stop()
        self.assertTrue(answer.success, answer.message)

    def testAPortInUseIsToldInTheServersWordsAndTakenWhenItIsFree(self):
        self.server.raw(kickolduser='false')
        with self.server.connect() as other:
            other.sendall(b'\x00')
            self.bench.start_driver(online=False, port='rtu+tcp://127.0.0.1:%d' % self.server.port)
            self.bench['belt_1'].wait(lambda s: s.communication_error, 'a status while the port is in use')
            self.bench['belt_1'].forget()
            wait_for(lambda: len(self.bench['belt_1'].seen()) >= 3, 'the status goes on')
            wait_for(lambda: 'Port already in use' in self.bench.driver.log(), "the server's words")
            self.assertTrue(self.bench.driver.running())
        self.bench['belt_1'].wait_online()


class Telnet(Served):
    """A server in telnet mode takes FFH and the byte behind it out of every frame."""

    def waitForAdvice(self):
        wait_for(lambda: 'telnet' in self.bench.driver.log() and 'raw' in self.bench.driver.log(), 'telnet is named')


@unittest.skipIf(MISSING, MISSING)
class TelnetFromTheStart(Telnet):
    def testItIsNamedAndNothingMoves(self):
        self.server.telnet()
        self.bench.start_driver(online=False, port='rtu+tcp://127.0.0.1:%d' % self.server.port)
        self.waitForAdvice()
        self.bench.finding('bus', 'telnet')
        with Stream(self.bench['belt_1'], 20.0), Stream(self.bench['belt_2'], 20.0):
            stays(lambda: not self.bench.turns('belt_1') and not self.bench.turns('belt_2'), 'at rest', 2.0)
            self.bench['belt_1'].forget()
            wait_for(lambda: len(self.bench['belt_1'].seen()) >= 3, 'the status goes on')
        self.server.end()
        self.server.raw()
        self.bench['belt_1'].wait_online()


@unittest.skipIf(MISSING, MISSING)
class TelnetWhileItRuns(Telnet):
    """Station 60 of a VF-S15: its stop, 3C 06 FA 00 C0 00 ED FF, ends with FFH."""

    entries = [{'name': 'belt_1', 'node': 60, 'drive': 'toshiba_vfs15', 'command_timeout': 0.0}]
    ramps = {'ACC': 0.5, 'dEC': 0.5}

    def testAStopThatIsPendingGoesThrough(self):
        self.start()
        with self.bench.run('belt_1', 20.0):
            self.server.end()
            self.bench['belt_1'].wait(lambda s: s.communication_error, 'the loss is told')
            self.assertTrue(self.bench.turns('belt_1'))
            self.server.telnet()
            self.waitForAdvice()
            self.waitForRest('belt_1')
            stays(lambda: not self.bench.turns('belt_1'), 'at rest', 1.0)


if __name__ == '__main__':
    unittest.main(warnings='ignore')  # rospy leaves sockets to the garbage collector
