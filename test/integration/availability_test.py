#!/usr/bin/env python3
"""What is not there: a port that is missing, unplugged or in use, and an inverter that is offline."""
import contextlib
import os
import time
import unittest

import rostest
import rospy
from harness import Bench, belts, init, is_nan, stays, wait_for
from inverter_bus.msg import InverterStatus


class Availability(unittest.TestCase):
    def setUp(self):
        self.bench = None

    def tearDown(self):
        if self.bench:
            self.bench.close()

    def testAMissingPortIsWaitedFor(self):
        self.bench = Bench(belts(2))
        later = self.bench.link + '_later'
        driver = self.bench.start_driver(online=False, port=later)
        belt = self.bench['belt_1']
        belt.wait(lambda s: s.communication_error and s.known == 0 and is_nan(s.velocity), 'offline')
        self.assertEqual(belt.status.header.stamp.to_sec(), 0.0)
        wait_for(lambda: self.bench.bus_status and not self.bench.bus_status.connected, 'not connected')
        wait_for(lambda: self.bench.diagnostics.get('bus') and self.bench.diagnostics['bus'].level == 2,
                 '/diagnostics shows it')
        self.assertIn(later, self.bench.diagnostics['bus'].message +
                      ' '.join(value.value for value in self.bench.diagnostics['bus'].values))
        belt.forget()
        start = time.monotonic()
        wait_for(lambda: len(belt.seen()) >= 4, 'status goes on')
        self.assertLess(time.monotonic() - start, 6.0)
        self.assertEqual(len([line for line in driver.log().splitlines() if later in line and 'WARN' in line or
                              later in line and 'ERROR' in line]), 1, driver.log())
        os.symlink(self.bench.link, later)
        belt.wait_online()
        wait_for(lambda: self.bench.bus_status.connected, 'connected')

    def testAPortThatIsPulledOutAndPutBack(self):
        self.bench = Bench(belts(2))
        self.bench.start_driver()
        belt = self.bench['belt_1']
        with self.bench.run('belt_1', 20.0):
            reconnects = self.bench.bus_status.reconnects
            self.bench.simulate('bus unplug')
            belt.wait(lambda s: s.communication_error and s.known == 0, 'offline')
            wait_for(lambda: not self.bench.bus_status.connected, 'not connected')
            self.bench.simulate('bus plug')
            wait_for(lambda: self.bench.bus_status.connected and self.bench.bus_status.reconnects > reconnects,
                     'connected again')
            belt.wait(lambda s: not s.communication_error and s.locked, 'online and locked')
            belt.wait(lambda s: not s.running and not s.operation, 'the RUN that was left over is cleared')
            stays(lambda: self.bench.real('belt_1')['run_coil'] == '0', 'no RUN under a stream of commands', 1.0)

    def testAnInverterThatIsOfflineCostsTheOthersLittle(self):
        self.bench = Bench(belts(3))
        self.bench.start_driver()
        dead, live = self.bench['belt_2'], self.bench['belt_1']
        healthy = self.rate(live)
        last = dead.fresh().header.stamp
        self.bench.simulate('belt_2 offline')
        status = dead.wait(lambda s: s.communication_error, 'offline')
        self.assertEqual(status.known, 0)
        self.assertTrue(is_nan(status.velocity) and is_nan(status.output_current) and is_nan(status.temperature))
        self.assertGreater(status.header.stamp.to_sec(), last.to_sec() - 0.001)
        wait_for(lambda: list(bytearray(self.bench.bus_status.offline_nodes)) == [2], 'named in bus_status')
        self.assertGreater(self.rate(live), 0.8 * healthy)
        dead.forget()
        wait_for(lambda: len(dead.seen()) >= 3, 'its status goes on')
        dead.send(10.0)
        dead.wait(lambda s: s.error_id == InverterStatus.ERROR_OFFLINE, 'a command for it is refused')
        answer = dead.read_parameter('F002')
        self.assertFalse(answer.success)
        self.assertEqual(answer.error_id, InverterStatus.ERROR_OFFLINE)
        self.bench.simulate('belt_2 online')
        back = time.monotonic()
        status = dead.wait(lambda s: not s.communication_error and s.known, 'back')
        self.assertLess(time.monotonic() - back, 4.0)
        self.assertTrue(status.locked)

    def testHalfOfTheDrivesDie(self):
        """Two of four, running. The others run on and stop at once; the dead get their stop when they are back."""
        self.bench = Bench(belts(4))
        self.bench.start_driver()
        dead, live = ('belt_1', 'belt_3'), ('belt_2', 'belt_4')
        with contextlib.ExitStack() as streams:
            for stream in self.bench.run_all(20.0):
                streams.enter_context(stream)
            healthy = self.rate(self.bench['belt_2'], 12)
            for name in dead:
                self.bench.simulate(name + ' offline')
            for name in dead:
                self.bench[name].wait(lambda s: s.communication_error, 'offline')
            wait_for(lambda: list(bytearray(self.bench.bus_status.offline_nodes)) == [1, 3], 'named in bus_status')
            self.assertGreater(self.rate(self.bench['belt_2'], 12), 0.7 * healthy)
            for name in live:
                self.assertTrue(self.bench.turns(name))
                self.assertFalse(self.bench[name].status.locked)
            called = time.monotonic()
            self.assertTrue(self.bench['belt_2'].stop().success)
            print('measured: half of the drives dead, stop of a live one confirmed after %.3f s' %
                  (time.monotonic() - called))
            self.assertEqual(self.bench.real('belt_2')['run_coil'], '0')
            self.assertTrue(self.bench.turns('belt_4'))
            for name in dead:
                self.assertEqual(self.bench.real(name)['run_coil'], '1', 'nothing reaches the dead')
            self.assertBackWithoutRun(dead)
            self.assertTrue(self.bench.turns('belt_4'), 'undisturbed')

    def testAllDrivesDie(self):
        """The line is cut while everything runs: all are offline, calls are answered in time, and nothing runs later."""
        self.bench = Bench(belts(4))
        self.bench.start_driver()
        with contextlib.ExitStack() as streams:
            for stream in self.bench.run_all(20.0):
                streams.enter_context(stream)
            self.bench.simulate('bus silent on')
            for inverter in self.bench.inverters.values():
                inverter.wait(lambda s: s.communication_error and s.known == 0, 'offline')
            wait_for(lambda: list(bytearray(self.bench.bus_status.offline_nodes)) == [1, 2, 3, 4], 'named in bus_status')
            self.assertTrue(self.bench.bus_status.connected)
            for name in self.bench.inverters:
                self.assertEqual(self.bench.finding(name, 'offline').level, 2)
            # Rule 4.11.
            wait_for(lambda: [text for text in self.bench.traces() if 'went offline' in text], 'a flight recorder file')
            called = time.monotonic()
            answer = self.bench.stop_all()
            seconds = time.monotonic() - called
            self.assertFalse(answer.success)
            for name in self.bench.inverters:
                self.assertIn(name, answer.message)
            print('measured: all drives dead, ~stop answered after %.2f s' % seconds)
            self.assertLess(seconds, 2.0 + 3.0)
            self.assertBackWithoutRun(self.bench.inverters)

    def assertBackWithoutRun(self, names):
        """Answering again, they are found, stopped and locked, whatever their streams say."""
        for name in names:
            self.bench[name].forget()
        self.bench.simulate('bus silent off')
        for name in names:
            self.bench.simulate(name + ' online')
        back = time.monotonic()
        for name in names:
            self.bench[name].wait(lambda s: not s.communication_error and s.known, 'back')
        seconds = time.monotonic() - back
        print('measured: %d dead drives answer again, all of them back after %.2f s' % (len(list(names)), seconds))
        self.assertLess(seconds, 3.0 + 3.0)  # later when many are dead at once, and on a busy machine
        for name in names:
            wait_for(lambda: self.bench.real(name)['run_coil'] == '0', 'RUN of %s taken off' % name)
            self.bench[name].wait(lambda s: s.locked and not s.running, 'locked and at rest')
        stays(lambda: not any(self.bench.real(name)['run_coil'] == '1' for name in names),
              'no RUN under streams of commands', 1.0)

    def rate(self, inverter, number=30):
        """Status messages per second."""
        inverter.forget()
        start = time.monotonic()
        wait_for(lambda: len(inverter.seen()) >= number, '%d status messages' % number)
        return number / (time.monotonic() - start)

    def testASecondNodeOnThePortGivesUp(self):
        self.bench = Bench(belts(1))
        self.bench.start_driver()
        rospy.set_param('/second_driver', self.bench.parameters)
        try:
            second = self.bench.start('inverter_bus_node', '__name:=second_driver')
            self.assertEqual(second.wait(60.0), 1, second.log())
            self.assertIn('in use', second.log())
            self.assertIn(self.bench.link, second.log())
        finally:
            rospy.delete_param('/second_driver')
        self.assertFalse(self.bench['belt_1'].fresh().communication_error)


if __name__ == '__main__':
    init('availability_test')
    rostest.rosrun('inverter_bus', 'availability', Availability)
    rospy.signal_shutdown('done')
