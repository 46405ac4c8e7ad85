#!/usr/bin/env python3
"""SIGKILL: only the drives can act. Each brand stops its motor by its own time-out, and the next driver runs nothing."""
import signal
import time
import unittest

import rostest
import rospy
from harness import Bench, init, stays, wait_for
from inverter_bus.msg import InverterStatus
from mixed_brands_test import HITACHI, LINE, TECO, TECO_ARMED, VFS15

# Each drive's own communication time-out [s], as set at its panel: decelerate and stop. The 7200MA's is its factory's.
TIMEOUTS = {'conveyor': 1.5, 'pump': 2.0, 'mixer': 1.0}
RAMP = 0.5  # [s] from the maximum frequency to rest
SET_UP = {
    # What MX2 and 7200MA do with a RUN that is still on when they hear something again is not printed: the worst.
    'conveyor': {'parameters': dict(HITACHI, C076=4, C077=TIMEOUTS['conveyor']), 'restart_after_timeout': True},
    'pump': {'parameters': dict(VFS15, F803=TIMEOUTS['pump'], F804=2)},
    'mixer': dict(TECO, restart_after_timeout=True),
}


class Killed(unittest.TestCase):
    """An MX2 (C076/C077), a VF-S15 (F803/F804) and a 7200MA (Sn-39/Cn-27) on one line, running when the driver dies."""

    def setUp(self):
        entries = [{'name': 'conveyor', 'node': 1, 'drive': 'omron_mx2'},
                   {'name': 'pump', 'node': 2, 'drive': 'toshiba_vfs15'},
                   dict({'name': 'mixer', 'node': 3, 'drive': 'teco_7200ma'}, **TECO_ARMED)]
        self.bench = Bench(entries, ramps=False, defaults={'max_velocity': 50.0}, simulation=SET_UP, **LINE)
        self.bench.start_driver()
        self.streams = self.bench.run_all(30.0)

    def tearDown(self):
        for stream in self.streams:
            stream.end()
        self.bench.close()

    def runIsOn(self, name):
        """RUN as it stands in the drive's own command."""
        real = self.bench.real(name)
        return real['run_coil' if name == 'conveyor' else 'run_command'] == '1'

    def kill(self):
        for name in self.bench.inverters:
            self.assertTrue(self.bench.turns(name), name)
        self.bench.driver.signal(signal.SIGKILL)
        self.bench.driver.wait()
        return time.monotonic()

    def restart(self):
        """A new driver, under the streams that never stopped."""
        for inverter in self.bench.inverters.values():
            inverter.forget()
        started = time.monotonic()
        self.bench.start_driver()
        return started

    def assertNothingRuns(self):
        def cleared():
            return not any(self.runIsOn(name) or self.bench.turns(name) for name in self.bench.inverters)

        wait_for(cleared, 'the RUN that was left over is cleared, and the motors stand')
        for inverter in self.bench.inverters.values():
            inverter.wait(lambda s: s.locked and not s.run_command, 'locked')
        stays(cleared, 'nothing runs under streams that go on', 1.5)
        for inverter in self.bench.inverters.values():
            inverter.wait(lambda s: s.error_id == InverterStatus.ERROR_LOCKED, 'its stream is refused')

    def assertUsable(self):
        """A reset where the drive tripped, a 0, and every motor runs again."""
        for name, inverter in self.bench.inverters.items():
            if inverter.status.faulted:
                answer = inverter.reset()
                self.assertTrue(answer.success, answer.message)
        for stream in self.streams:
            stream.velocity = 0.0
        for name, inverter in self.bench.inverters.items():
            inverter.wait(lambda s: not s.locked and not s.faulted, 'free')
        for stream in self.streams:
            stream.velocity = 20.0
        for name in self.bench.inverters:
            wait_for(lambda: abs(self.bench.frequency(name) - 20.0) < 0.1, name + ' runs again')

    def testEachDrivesOwnTimeOutStopsItsMotorAndTheNextDriverRunsNothing(self):
        for name in ('conveyor', 'pump'):
            self.assertNotIn('runs on when communication is lost', self.bench.finding(name).message)
        killed = self.kill()
        for name in sorted(TIMEOUTS, key=TIMEOUTS.get):
            wait_for(lambda: not self.bench.turns(name), name + ' stopped by its own time-out')
            seconds = time.monotonic() - killed
            print('measured: killed, %s at rest after %.2f s; its own time-out is %.1f s, its ramp at most %.1f s' %
                  (name, seconds, TIMEOUTS[name], RAMP))
            # The last frame before the end may be up to a cycle old.
            self.assertGreater(seconds, TIMEOUTS[name] - 0.6, name)
            self.assertLess(seconds, TIMEOUTS[name] + RAMP + 3.0, name)
            self.assertTrue(self.runIsOn(name), name + ': the RUN is left over')
        before = self.bench.frames(1)[-1].time
        self.restart()
        self.assertStoppedAtOnce(before)
        self.assertNothingRuns()
        self.assertUsable()

    def assertStoppedAtOnce(self, before):
        """An MX2 that runs on by itself as soon as it hears something does so from our first request to our stop."""
        def stop():
            sent = [frame for frame in self.bench.frames() if frame.time > before and frame.sender == 'master' and
                    frame.station == '1']
            stops = [frame for frame in sent if frame.text.startswith('01 05 00 00 00 00')]
            return stops[0].time - sent[0].time if stops else None

        seconds = wait_for(stop, "the conveyor's stop")
        print('measured: restarted, from the first request to a drive with a RUN left over to its stop %.3f s' % seconds)
        self.assertLess(seconds, 1.0)

    def testADriverThatIsBackBeforeTheTimeOutsClearsTheLeftoverRunOfRunningMotors(self):
        for name in ('conveyor', 'pump', 'mixer'):
            # So long that none of them is over before the next driver is there.
            code = {'conveyor': 'C077', 'pump': 'F803', 'mixer': 'Cn-27'}[name]
            self.bench.simulate('%s set %s %g' % (name, code, 20.0))
        self.kill()
        started = self.restart()
        self.assertNothingRuns()
        print('measured: started beside running motors, all RUNs cleared and at rest after %.2f s' %
              (time.monotonic() - started))
        self.assertEqual(self.bench.real('mixer')['alarms'], '0')
        self.assertUsable()


if __name__ == '__main__':
    init('killed_test')
    rostest.rosrun('inverter_bus', 'killed', Killed)
    rospy.signal_shutdown('done')
