#!/usr/bin/env python3
"""Two programs that command one inverter: the newest wins, /diagnostics warns, and each has its own lock."""
import signal
import unittest

import rostest
import rospy
from harness import Bench, Stream, belts, init, stays, wait_for
from inverter_bus.msg import InverterStatus

OURS, THEIRS = 10.0, 30.0


class TwoPublishers(unittest.TestCase):
    """This program sends 10, another one 30, both twenty times a second and at first without knowing of each other."""

    def setUp(self):
        self.bench = Bench(belts(1))
        self.bench.start_driver()
        self.belt = self.bench['belt_1']
        self.other = None
        self.stream = self.bench.run('belt_1', OURS)

    def tearDown(self):
        self.stream.end()
        self.bench.close()

    def startOther(self):
        # It is new to the driver, and nothing is locked: its first message counts.
        self.other = self.bench.start('velocity_once.py', self.belt.path + '/command', str(THEIRS), 'stream')

    def reference(self):
        """[Hz] as it stands in the drive."""
        return float(self.bench.real('belt_1')['reference'])

    def assertFight(self):
        """Both get through, in turns: whoever spoke last is obeyed."""
        for _ in range(3):
            wait_for(lambda: self.reference() == OURS, 'the drive obeys this program')
            wait_for(lambda: self.reference() == THEIRS, 'the drive obeys the other one')

    def obeysTheOtherFor(self, seconds):
        try:
            stays(lambda: self.reference() == THEIRS and self.bench.turns('belt_1'), 'at its velocity', seconds)
        except AssertionError:
            return False
        return True

    def testBothAreObeyedInTurnsAndDiagnosticsWarns(self):
        self.startOther()
        self.assertFight()
        self.bench.finding('belt_1', 'several publishers')
        self.bench.finding('belt_1', '2 publishers on')
        self.assertEqual(self.bench.diagnostics['belt_1'].level, 1)
        self.assertEqual(self.belt.seen(lambda s: s.locked or s.error_id != 0 and s.error_id < 0x8000), [])
        # The one that is left keeps its motor; when it ends too, the command watchdog stops it.
        self.stream.end()
        # Our last message may still be under way.
        wait_for(lambda: self.obeysTheOtherFor(1.0), 'the other one alone keeps its velocity')
        wait_for(lambda: 'several publishers' not in self.bench.diagnostics['belt_1'].message, 'no warning any more')
        self.other.signal(signal.SIGKILL)
        self.other.wait()
        self.belt.wait(lambda s: s.locked and not s.running, 'stopped by the command watchdog')
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')

    def testAfterAStopEachIsLockedForItself(self):
        self.startOther()
        self.assertFight()
        answer = self.belt.stop()
        self.assertTrue(answer.success, answer.message)
        self.belt.wait(lambda s: s.error_id == InverterStatus.ERROR_LOCKED, 'both are refused')
        stays(lambda: self.bench.real('belt_1')['run_coil'] == '0', 'no RUN by either of them', 1.0)
        # A zero of ours frees us, and not them.
        self.stream.velocity = 0.0
        self.belt.wait(lambda s: not s.running, 'at rest')
        stays(lambda: self.bench.real('belt_1')['run_coil'] == '0', 'their stream runs nothing', 1.0)
        self.stream.velocity = OURS
        wait_for(lambda: self.bench.turns('belt_1') and self.reference() == OURS, 'runs by our command')
        stays(lambda: self.reference() == OURS and self.bench.turns('belt_1'), 'and never by theirs', 1.0)


if __name__ == '__main__':
    init('two_publishers_test')
    rostest.rosrun('inverter_bus', 'two_publishers', TwoPublishers)
    rospy.signal_shutdown('done')
