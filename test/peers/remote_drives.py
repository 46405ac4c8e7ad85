"""A driver on tcp:// whose drives are somebody else's Modbus server, and what holds for each such server."""
import unittest

from own_master import init_with_own_master

from harness import Bench, belts, wait_for


class Remote(Bench):
    def start_simulator(self, *_):
        """The drives are the server's."""


class RemoteDrives(unittest.TestCase):
    """Its children start their server and say what a drive does, by itself and not through the driver."""

    one_table = False  # the server has the same coils and registers for every unit
    silent_node = None  # a third station, which the server does not have

    @classmethod
    def setUpClass(cls):
        init_with_own_master('remote_drives_test')
        port = cls.startServer()
        entries = belts(2, command_timeout=0.0)
        if cls.silent_node:
            entries.append({'name': 'absent', 'node': cls.silent_node, 'drive': 'omron_mx2'})
        cls.bench = Remote(entries, port='tcp://127.0.0.1:%d' % port, response_timeout=0.5, gateway_timeout=1.0)
        cls.addClassCleanup(cls.bench.close)
        cls.bench.start_driver(online=False)
        for node in (1, 2):
            cls.bench['belt_%d' % node].wait_online()
            wait_for(cls.bench['belt_%d' % node].connected, 'a subscription to its command')

    @classmethod
    def startServer(cls):
        """Returns its port; cleans up by addClassCleanup."""
        raise NotImplementedError

    def drive(self, node):
        """What it does: run, reverse, frequency (as set) [0.01 Hz]."""
        raise NotImplementedError

    def runs(self, node):
        return self.drive(node)['run']

    def setUp(self):
        self.bench.unlock('belt_1', 'belt_2')


class ItsCases:
    def testItMovesChangesReversesAndStops(self):
        belt = self.bench['belt_1']
        for velocity in (15.0, 42.5, -20.0):
            belt.send(velocity)
            status = belt.wait(lambda s: s.running and abs(s.velocity - velocity) < 0.005, 'at %g' % velocity)
            drive = self.drive(1)
            self.assertEqual((drive['run'], drive['reverse'], drive['frequency']),
                             (True, velocity < 0, abs(velocity) * 100))
            self.assertAlmostEqual(status.output_current, 1.5)
            self.assertEqual(status.error_id, 0, status.error_text)
        self.assertTrue(self.one_table or not self.runs(2), 'the other station is left alone')
        answer = belt.stop()
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(self.runs(1))
        belt.wait(lambda s: not s.running and s.locked, 'stopped')

    def testWritesAreHeardAfterAStopOfTheBusToo(self):
        # It is a broadcast to unit 0, which some servers answer with what looks like an echo.
        for _ in range(2):
            self.bench.unlock('belt_1', 'belt_2')
            for node in (1, 2):
                self.bench['belt_%d' % node].send(20.0)
            for node in (1, 2):
                self.bench['belt_%d' % node].wait(lambda s: s.running, 'runs')
            answer = self.bench.stop_all()
            self.assertTrue(answer.success, answer.message)
            for node in (1, 2):
                self.assertFalse(self.runs(node))
                self.bench['belt_%d' % node].wait(lambda s: not s.running and not s.communication_error, 'stopped')
