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
from inverter_bus.srv import ReadFaults, ReadParameter, Reset, Stop, WriteParameter
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


class Storm(unittest.TestCase):
    def setUp(self):
        self.bench = Bench(belts(3), baud_rate=115200)
        self.bench.start_driver()
        self.callers = []
        self.over = threading.Event()

    def tearDown(self):
        self.end_callers()
        self.bench.close()

    def end_callers(self):
        self.over.set()
        for caller in self.callers:
            caller.ended.set()
        for caller in self.callers:
            caller.thread.join(PATIENCE)

    def proxy(self, name, kind):
        """Who calls it when the node is gone gets an exception at once."""
        path = '%s/%s' % (self.bench.driver_name, name)
        rospy.wait_for_service(path, PATIENCE)
        return rospy.ServiceProxy(path, kind)

    def start_callers(self):
        """Three threads for each inverter and four for the bus."""
        stop_all = self.proxy('stop', Stop)
        dump_trace = self.proxy('dump_trace', Trigger)
        actions = [self.send_group, self.harm,
                   lambda number: self.answer_and_news(stop_all(number % 3)),
                   lambda number: self.answer_and_news(dump_trace())]
        for belt in self.bench.inverters.values():
            actions += [self.sender(belt), self.reader(belt), self.user(belt)]
        self.callers = [Caller(action) for action in actions]

    def sender(self, belt):
        def send(number):
            belt.send(VELOCITIES[number % len(VELOCITIES)])
            self.wait_for_news(belt)

        return send

    def reader(self, belt):
        read_parameter = self.proxy(belt.name + '/read_parameter', ReadParameter)
        return lambda number: read_parameter(name=('F002', 'Z999')[number % 2])

    def user(self, belt):
        reset = self.proxy(belt.name + '/reset', Reset)
        read_faults = self.proxy(belt.name + '/read_faults', ReadFaults)
        stop = self.proxy(belt.name + '/stop', Stop)
        write_parameter = self.proxy(belt.name + '/write_parameter', WriteParameter)
        calls = (lambda number: reset(), lambda number: read_faults(), lambda number: stop(mode=number % 5),
                 lambda number: write_parameter(name='F002', value=0.5 + number % 2, persist=number % 3 == 0))
        return lambda number: calls[number % len(calls)](number)

    def wait_for_news(self, belt):
        """What a thread without a call waits for before its next round."""
        before = belt.status
        while belt.status is before and not self.over.wait(0.01):
            pass

    def send_group(self, number):
        velocity = VELOCITIES[number % len(VELOCITIES)]
        self.bench.send_group(belt_1=velocity, belt_2=-velocity, belt_3=10.0, **({'nobody': 1.0} if number % 5 == 0 else {}))
        self.wait_for_news(self.bench['belt_1'])

    def answer_and_news(self, answer):
        self.wait_for_news(self.bench['belt_2'])
        return answer

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
        self.wait_for_rounds(5)
        self.end_callers()
        for caller in self.callers:
            self.assertFalse(caller.thread.is_alive(), 'a call was not answered')
            self.assertEqual(caller.problems, [])
        self.assertGreater(sum(caller.successes for caller in self.callers), 20)
        self.assertTrue(self.bench.driver.running(), self.bench.driver.log())
        # An inverter that is offline is asked less often than it is harmed: what is left of that is not the stop's matter.
        for name in self.bench.inverters:
            self.bench.simulate(name + ' clear')
        answer = self.bench.stop_all()
        self.assertTrue(answer.success, answer.message)
        self.assertAllStopped()

    def testShutdownInTheMiddleStopsEveryMotor(self):
        self.start_callers()
        self.wait_for_rounds(2)
        self.bench.driver.signal(signal.SIGTERM)
        self.assertEqual(self.bench.driver.wait(), 0, self.bench.driver.log())
        self.end_callers()
        self.assertAllStopped()
        self.assertIn('every motor that this node may have started is confirmed as stopped', self.bench.driver.log())


if __name__ == '__main__':
    init('storm_test')
    rostest.rosrun('inverter_bus', 'storm', Storm)
    rospy.signal_shutdown('done')
