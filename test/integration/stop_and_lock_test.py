#!/usr/bin/env python3
"""Stops: confirmed, first on the bus, and followed by a return to neutral."""
import threading
import time
import unittest

import rostest
import rospy
from harness import Bench, belts, init, stays, wait_for
from inverter_bus.msg import InverterStatus
from inverter_bus.srv import StopRequest


class StopAndLock(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(belts(4))
        cls.bench.start_driver()

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def setUp(self):
        self.streams = []
        for name in self.bench.inverters:
            self.bench[name].wait(lambda s: not s.running and not s.run_command, 'at rest')

    def tearDown(self):
        for stream in self.streams:
            stream.end()
        self.bench.stop_all()

    def run_belt(self, name, velocity):
        stream = self.bench.run(name, velocity)
        self.streams.append(stream)
        return stream

    def testAStopIsConfirmedAndLocks(self):
        belt = self.bench['belt_1']
        self.run_belt('belt_1', 30.0)
        answer = belt.stop()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.error_id, 0)
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')
        status = belt.wait(lambda s: not s.running, 'at rest')
        self.assertTrue(status.locked)
        self.assertFalse(status.run_command)

    def testAStreamThatGoesOnIsRefusedUntilItSentZero(self):
        belt = self.bench['belt_1']
        stream = self.run_belt('belt_1', 30.0)
        belt.stop()
        status = belt.wait(lambda s: s.error_id == InverterStatus.ERROR_LOCKED, 'the stream refused')
        self.assertTrue(status.locked)
        self.assertTrue(status.error_text)
        belt.wait(lambda s: not s.running, 'at rest')
        stays(lambda: not self.bench.turns('belt_1'), 'the motor stands', 1.5)
        stream.velocity = 0.0
        belt.wait(lambda s: not s.locked, 'unlocked by 0')
        stream.velocity = 20.0
        belt.wait(lambda s: abs(s.velocity - 20.0) < 0.05, 'runs again')

    def testSilenceUnlocks(self):
        belt = self.bench['belt_2']
        stream = self.run_belt('belt_2', 20.0)
        stream.end()
        stopped = time.monotonic()
        self.assertTrue(belt.stop().success)
        belt.wait(lambda s: s.locked, 'locked')
        belt.wait(lambda s: not s.locked, 'unlocked by silence')
        self.assertGreater(time.monotonic() - stopped, 0.45)
        belt.send(15.0)
        belt.wait(lambda s: s.run_command, 'runs again')

    def testAZeroOfAnotherPublisherDoesNotUnlock(self):
        belt = self.bench['belt_1']
        self.run_belt('belt_1', 30.0)
        self.bench.send_group(belt_1=30.0)
        belt.stop()
        belt.wait(lambda s: s.locked and not s.running, 'locked and at rest')
        # The group's publisher is this same node: a second node stands for somebody else's zero.
        other = self.bench.start('velocity_once.py', belt.path + '/command', '0.0')
        self.assertEqual(other.wait(), 0, other.log())
        belt.fresh()
        stays(lambda: belt.status.error_id == InverterStatus.ERROR_LOCKED and not self.bench.turns('belt_1'),
              'the stream is refused as before', 0.7)

    def testModesThatTheDriveLacksDecelerate(self):
        belt = self.bench['belt_3']
        for mode in (StopRequest.COAST, StopRequest.QUICK, 77):
            self.run_belt('belt_3', 20.0)
            answer = belt.stop(mode)
            self.assertTrue(answer.success, answer.message)
            self.streams.pop().end()
            belt.wait(lambda s: not s.running and s.fault_code == 0, 'at rest without a trip')
        self.assertIn('DECELERATE', answer.message.upper())

    def testBusWideStop(self):
        for name in self.bench.inverters:
            self.run_belt(name, 25.0)
        answer = self.bench.stop_all()
        self.assertTrue(answer.success, answer.message)
        for name in self.bench.inverters:
            self.assertEqual(self.bench.real(name)['run_coil'], '0')
            self.bench[name].wait(lambda s: s.locked and not s.running, 'locked and at rest')

    def testAStopGoesBeforeAStormOfParameters(self):
        """On a driver of its own, whose longest stop latency no other test has made."""
        bench = Bench(belts(4))
        try:
            bench.start_driver()
            with bench.run('belt_1', 30.0):
                self.storm(bench)
            wait_for(lambda: bench.bus_status.stop_latency_max > 0.0, 'a stop latency')
            # At most the one exchange in flight, and a busy machine.
            self.assertLess(bench.bus_status.stop_latency_max, 0.12)
        finally:
            bench.close()

    def storm(self, bench):
        """Ten stops while twelve threads read and write parameters and read trip memories as fast as they can."""
        ended = threading.Event()

        def call(belt, kind):
            while not ended.is_set():
                if kind == 0:
                    belt.read_parameter('F002')
                elif kind == 1:
                    belt.write_parameter('F003', 0.5)
                else:
                    belt.read_faults()

        threads = [threading.Thread(target=call, args=(bench['belt_%d' % (n % 4 + 1)], n % 3), daemon=True)
                   for n in range(12)]
        for thread in threads:
            thread.start()
        try:
            wait_for(lambda: bench.bus_status.utilization > 0.7, 'a busy line')
            for _ in range(10):
                answer = bench['belt_1'].stop()
                self.assertTrue(answer.success, answer.message)
                self.assertEqual(bench.real('belt_1')['run_coil'], '0')
        finally:
            ended.set()
            for thread in threads:
                thread.join(30.0)

    def testAStopCancelsAVelocityThatWaits(self):
        belt = self.bench['belt_4']
        self.bench.unlock('belt_4')
        belt.forget()
        for _ in range(5):
            belt.send(40.0)
            belt.stop()
        belt.wait(lambda s: not s.run_command and not s.stop_active, 'stopped')
        stays(lambda: self.bench.real('belt_4')['run_coil'] == '0', 'no RUN after the stop', 0.5)

    def testAZeroIsNeverRefused(self):
        belt = self.bench['belt_1']
        self.run_belt('belt_1', 20.0).end()
        self.streams.clear()
        belt.stop()
        belt.forget()
        belt.send(0.0)
        belt.wait(lambda s: not s.locked, 'unlocked')
        self.assertFalse(belt.seen(lambda s: s.error_id != 0))

    def testADeadInverterDoesNotDelayTheStopOfALiveOne(self):
        self.run_belt('belt_1', 30.0)
        self.run_belt('belt_2', 30.0)
        self.bench.simulate('belt_2 offline')
        try:
            answer = self.bench.stop_all()
            self.assertFalse(answer.success)
            self.assertIn('belt_2', answer.message)
            self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')
        finally:
            self.bench.simulate('belt_2 online')
        # The node goes on insisting: the stop reaches the drive when it is back.
        wait_for(lambda: self.bench.real('belt_2')['run_coil'] == '0', 'belt_2 stopped on its return')
        self.bench['belt_2'].wait(lambda s: not s.communication_error and not s.running, 'back and at rest')


if __name__ == '__main__':
    init('stop_and_lock_test')
    rostest.rosrun('inverter_bus', 'stop_and_lock', StopAndLock)
    rospy.signal_shutdown('done')
