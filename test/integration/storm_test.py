#!/usr/bin/env python3
"""Everybody at once: every topic and every service of a node from many threads against its bus thread.

With a sanitizer (scripts/test --sanitize) this is the test that shows that ROS callbacks and the bus thread share nothing
without a lock.
"""
import itertools
import signal
import threading
import unittest

import rostest
import rospy
from harness import PATIENCE, Bench, belts, init, wait_for
from std_srvs.srv import Trigger

VELOCITIES = (20.0, -20.0, 0.0, 35.0, 0.0, float('nan'), 1e9)


class Caller:
    """A thread that does the same again and again, and keeps what came of it."""

    def __init__(self, action):
        self.action = action
        self.rounds = 0
        self.successes = 0
        self.problems = []
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        for number in itertools.count():
            if self.ended.is_set():
                return
            try:
                answer = self.action(number)
            except (rospy.ROSException, rospy.ServiceException) as error:
                self.problems.append(str(error))
                self.ended.wait(0.05)
                continue
            if answer is not None:
                self.successes += 1 if answer.success else 0
                if not answer.success and not answer.message:
                    self.problems.append('refused without a reason: %s' % answer)
            self.rounds += 1

    def end(self):
        self.ended.set()
        self.thread.join(PATIENCE)


class Storm(unittest.TestCase):
    def setUp(self):
        self.bench = Bench(belts(3), baud_rate=115200)
        self.bench.start_driver()
        self.callers = []
        self.over = threading.Event()

    def tearDown(self):
        self.over.set()
        for caller in self.callers:
            caller.end()
        self.bench.close()

    def start_callers(self):
        """Three threads for each inverter and four for the bus."""
        for belt in self.bench.inverters.values():
            self.callers += [Caller(lambda number, belt=belt: self.send(belt, number)),
                             Caller(lambda number, belt=belt: belt.read_parameter(('F002', 'Z999')[number % 2])),
                             Caller(lambda number, belt=belt: self.call(belt, number))]
        rospy.wait_for_service(self.bench.driver_name + '/dump_trace', PATIENCE)
        dump_trace = rospy.ServiceProxy(self.bench.driver_name + '/dump_trace', Trigger)
        self.callers += [Caller(self.send_group),
                         Caller(self.stop_all),
                         Caller(lambda number: self.dump(dump_trace)),
                         Caller(self.harm)]

    def wait_for_news(self, belt):
        """What a thread without a call waits for before its next round."""
        before = belt.status
        while belt.status is before and not self.over.wait(0.01):
            pass

    def send(self, belt, number):
        belt.send(VELOCITIES[number % len(VELOCITIES)])
        self.wait_for_news(belt)

    def send_group(self, number):
        velocity = VELOCITIES[number % len(VELOCITIES)]
        self.bench.send_group(belt_1=velocity, belt_2=-velocity, belt_3=10.0, **({'nobody': 1.0} if number % 5 == 0 else {}))
        self.wait_for_news(self.bench['belt_1'])

    def stop_all(self, number):
        answer = self.bench.stop_all(number % 3)
        self.wait_for_news(self.bench['belt_2'])
        return answer

    def dump(self, dump_trace):
        answer = dump_trace()
        self.wait_for_news(self.bench['belt_3'])
        return answer

    def call(self, belt, number):
        return (belt.reset, belt.read_faults, lambda: belt.stop(number % 5),
                lambda: belt.write_parameter('F002', 0.5 + number % 2, persist=number % 3 == 0))[number % 4]()

    def harm(self, number):
        """Answers that take long or never come: what the bus thread does on its own."""
        name = 'belt_%d' % (1 + number % 3)
        self.bench.simulate(name + ' ' + ('lost_reply count 2', 'damaged', 'trip 7', 'late 0.15')[number % 4])
        self.wait_for_news(self.bench[name])

    def wait_for_rounds(self, rounds):
        wait_for(lambda: all(caller.rounds >= rounds for caller in self.callers),
                 lambda: 'rounds: %s, problems: %s' % ([caller.rounds for caller in self.callers],
                                                      [caller.problems for caller in self.callers]), 3 * PATIENCE)

    def assertAllStopped(self):
        for name in self.bench.inverters:
            self.assertEqual(self.bench.real(name)['run_coil'], '0', name)

    def testEveryCallIsAnsweredAndAStopOfAllEndsEverything(self):
        self.start_callers()
        self.wait_for_rounds(8)
        for caller in self.callers:
            caller.end()
            self.assertFalse(caller.thread.is_alive(), 'a call was not answered')
            self.assertEqual(caller.problems, [])
        self.assertGreater(sum(caller.successes for caller in self.callers), 30)
        self.assertTrue(self.bench.driver.running(), self.bench.driver.log())
        answer = self.bench.stop_all()
        self.assertTrue(answer.success, answer.message)
        self.assertAllStopped()

    def testShutdownInTheMiddleStopsEveryMotor(self):
        self.start_callers()
        self.wait_for_rounds(3)
        self.bench.driver.signal(signal.SIGTERM)
        self.assertEqual(self.bench.driver.wait(), 0, self.bench.driver.log())
        self.assertAllStopped()
        self.assertIn('every motor that this node may have set running is confirmed as stopped', self.bench.driver.log())


if __name__ == '__main__':
    init('storm_test')
    rostest.rosrun('inverter_bus', 'storm', Storm)
    rospy.signal_shutdown('done')
