#!/usr/bin/env python3
"""/diagnostics: an entry per inverter and one for the bus, with levels and words that say what to do."""
import unittest

import rostest
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from harness import Bench, Stream, belts, init, wait_for

SAFE = {'C076': 4, 'C077': 2.0}  # on communication loss: decelerate after 2 s


class Diagnostics(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # The pauses are where a second master's frame stands alone; without them it mostly collides with ours.
        entries = belts(3)
        entries[1]['stop_unexpected_motion'] = True
        cls.bench = Bench(entries, interval=0.5, simulation={'belt_1': {'parameters': SAFE},
                                                              'belt_2': {'parameters': {'C076': 2, 'C077': 0.0}},
                                                              'belt_3': {'parameters': dict(SAFE, A002=2)}})
        cls.bench.start_driver()

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def wait_level(self, name, level, *words):
        def seen():
            status = self.bench.diagnostics.get(name)
            text = text_of(status) if status else ''
            return status and status.level == level and all(word in text for word in words)

        return wait_for(seen, lambda: '%s at level %d with %s; it is %s' % (name, level, words,
                                                                            self.bench.diagnostics.get(name)))

    def testADriveThatIsSetUpWellIsOk(self):
        self.wait_level('belt_1', DiagnosticStatus.OK)

    def testADriveThatWouldRunOnWithoutCommunicationWarns(self):
        self.wait_level('belt_2', DiagnosticStatus.WARN, 'C077')

    def testADriveThatIsNotCommandedByTheBusWarnsWithTheValueToSet(self):
        self.wait_level('belt_3', DiagnosticStatus.WARN, 'not commanded by the bus', 'A002', '3')

    def testEachHasItsOwnHardwareId(self):
        for name in ('belt_1', 'belt_2', 'bus'):
            wait_for(lambda: name in self.bench.diagnostics, 'an entry of ' + name)
        ids = [self.bench.diagnostics[name].hardware_id for name in ('belt_1', 'belt_2', 'bus')]
        self.assertTrue(all(ids), ids)

    def testATripIsAnErrorWithItsText(self):
        self.bench.simulate('belt_1 trip 5')
        try:
            self.wait_level('belt_1', DiagnosticStatus.ERROR, self.bench['belt_1'].wait(
                lambda s: s.faulted, 'tripped').fault_text)
        finally:
            self.bench['belt_1'].reset()
        self.wait_level('belt_1', DiagnosticStatus.OK)

    def testAnOfflineInverterIsAnError(self):
        self.bench.simulate('belt_1 offline')
        self.wait_level('belt_1', DiagnosticStatus.ERROR)
        self.bench.simulate('belt_1 online')
        self.wait_level('belt_1', DiagnosticStatus.OK)

    def testDiagnosticsGoOnWhenThePortIsGone(self):
        self.bench.simulate('bus unplug')
        try:
            self.wait_level('bus', DiagnosticStatus.ERROR)
            self.bench.diagnostics.clear()
            self.wait_level('bus', DiagnosticStatus.ERROR)
        finally:
            self.bench.simulate('bus plug')
        self.wait_level('belt_1', DiagnosticStatus.OK)

    def testAMotorThatRunsWithoutOurRunWarns(self):
        self.wait_level('belt_1', DiagnosticStatus.OK)
        self.bench.simulate('belt_1 panel 15')
        try:
            self.wait_level('belt_1', DiagnosticStatus.WARN)
            self.assertTrue(self.bench.turns('belt_1'), 'left alone without stop_unexpected_motion')
        finally:
            self.bench.simulate('belt_1 panel_release')
        self.wait_level('belt_1', DiagnosticStatus.OK)

    def testAMotorThatASecondMasterSetsRunningIsStoppedOnlyWhereThatIsAskedFor(self):
        """Rule 4.7: belt_2 has stop_unexpected_motion, belt_1 has not."""
        for name in ('belt_1', 'belt_2'):
            self.bench[name].wait(lambda s: s.known and not s.running, 'at rest')
        for station, name in ((2, 'belt_2'), (1, 'belt_1')):
            self.setRunning(station, name)
        try:
            wait_for(lambda: self.bench.real('belt_2')['run_coil'] == '0', 'the RUN of belt_2 is taken off')
            self.bench['belt_2'].wait(lambda s: s.locked, 'locked')
            self.bench.finding('belt_1', 'runs without a command of this node')
            self.assertEqual(self.bench.real('belt_1')['run_coil'], '1', 'left alone')
        finally:
            self.assertTrue(self.bench['belt_1'].stop().success)
        self.bench['belt_1'].wait(lambda s: not s.running, 'at rest')
        self.wait_level('belt_1', DiagnosticStatus.OK)

    def setRunning(self, station, name):
        """Another master writes the coil of RUN, until its frame met no other."""
        def sent():
            return int(self.bench.simulate('bus show').split('foreign=')[1])

        def runs():
            before = sent()
            self.bench.simulate('bus foreign %02X 05 00 00 FF 00' % station)
            wait_for(lambda: sent() > before, "the other master's frame on the line")
            return any(frame.text.startswith('%02X 05 00 00 FF 00' % station) and frame.sender == 'drive'
                       for frame in self.bench.frames(20))

        wait_for(runs, name + ' set running by another master')

    def testADriveThatIsTakenOverAtItsPanelWhileItRunsWarns(self):
        """Rule 4.7: at another speed, and in the other direction."""
        with self.bench.run('belt_1', 10.0):
            try:
                self.bench.simulate('belt_1 panel 15')
                self.bench.finding('belt_1', 'a speed other than commanded')
                self.bench.simulate('belt_1 panel -15')
                self.bench.finding('belt_1', 'turns in the wrong direction')
            finally:
                self.bench.simulate('belt_1 panel_release')
        self.bench['belt_1'].wait(lambda s: not s.run_command and not s.running, 'stopped by the command watchdog')
        self.wait_level('belt_1', DiagnosticStatus.OK)

    def testAMotorThatDoesNotMoveAlthoughRunIsOnWarns(self):
        """belt_3 takes its RUN from the panel (A002): the bus can write what it wants."""
        self.bench.unlock('belt_3')
        with Stream(self.bench['belt_3'], 10.0):
            self.bench.finding('belt_3', 'does not move although RUN is on')
            self.assertFalse(self.bench.turns('belt_3'))
        self.bench['belt_3'].wait(lambda s: not s.run_command, 'stopped by the command watchdog')

    def testASecondMasterWarns(self):
        def warns():
            self.bench.simulate('bus foreign 01 03 00 00 00 02')
            self.bench.diagnostics.clear()
            status = wait_for(lambda: self.bench.diagnostics.get('bus'), 'an entry of the bus')
            return status.level == DiagnosticStatus.WARN and 'master' in text_of(status)

        wait_for(warns, 'a warning of the bus')


def text_of(status):
    return ' '.join([status.message] + [value.key + ' ' + value.value for value in status.values])


if __name__ == '__main__':
    init('diagnostics_test')
    rostest.rosrun('inverter_bus', 'diagnostics', Diagnostics)
    rospy.signal_shutdown('done')
