#!/usr/bin/env python3
"""What is not there: a port that is missing, unplugged or in use, and an inverter that is offline."""
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
            self.assertEqual(second.wait(40.0), 1, second.log())
            self.assertIn('in use', second.log())
            self.assertIn(self.bench.link, second.log())
        finally:
            rospy.delete_param('/second_driver')
        self.assertFalse(self.bench['belt_1'].fresh().communication_error)


if __name__ == '__main__':
    init('availability_test')
    rostest.rosrun('inverter_bus', 'availability', Availability)
    rospy.signal_shutdown('done')
