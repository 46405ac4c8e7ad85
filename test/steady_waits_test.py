#!/usr/bin/env python3
"""Every wait in src/ and include/ is on the steady clock: std::condition_variable and others wait on the wall clock, at least
with GCC 9, whatever clock they are given. util::SteadyCondition and util::SteadyClock are right with every compiler."""
import glob
import os
import re
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# What may wait on the wall clock, or only promises not to.
FORBIDDEN = re.compile(r'''\b(
    condition_variable(_any)? | wait_until | wait_for | sleep_(for|until) | timed_wait | timed_join |
    try_join_(for|until) | try_lock_(for|until) | try_lock_shared_(for|until) | timed_mutex | recursive_timed_mutex |
    pthread_cond_\w+ | pthread_mutex_\w*lock | pthread_timedjoin_np | sem_(timed|clock)wait | u?sleep | nanosleep |
    clock_nanosleep )\b''', re.VERBOSE)
SLEEP = 'std::this_thread::sleep'
# The primitives themselves, and what each is made of.
ALLOWED = {
    'src/util/steady_condition.h': {'pthread_cond_t'},
    'src/util/steady_condition.cpp': {'pthread_cond_init', 'pthread_cond_destroy', 'pthread_cond_signal',
                                      'pthread_cond_broadcast', 'pthread_cond_wait', 'pthread_cond_timedwait'},
    'src/util/clock.cpp': {'clock_nanosleep'},
}
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def without_comments(text):
    """The code without comments and texts, with as many lines."""
    return NOT_CODE.sub(lambda match: '\n' * match.group(0).count('\n'), text)


def waits(text):
    """(line, word) of everything in a source that may wait on the wrong clock."""
    code = without_comments(text)
    return [(code.count('\n', 0, match.start()) + 1, match.group(0)) for match in FORBIDDEN.finditer(code)]


class SteadyWaits(unittest.TestCase):
    def test_only_the_primitives_wait_by_themselves(self):
        sources = [path for folder in ('src', 'include') for ending in ('h', 'cpp')
                   for path in glob.glob(os.path.join(ROOT, folder, '**', '*.' + ending), recursive=True)]
        self.assertGreater(len(sources), 200, 'have the folders moved?')
        found = []
        for path in sorted(sources):
            name = os.path.relpath(path, ROOT)
            with open(path, encoding='utf-8') as stream:
                found += ['%s:%d: %s' % (name, line, word) for line, word in waits(stream.read())
                          if word not in ALLOWED.get(name, ())]
        self.assertEqual([], found, 'use util::SteadyCondition, util::SteadyEvent or util::SteadyClock')

    def test_what_is_allowed_is_there(self):
        for name, words in ALLOWED.items():
            with open(os.path.join(ROOT, name), encoding='utf-8') as stream:
                self.assertEqual(words, {word for _line, word in waits(stream.read())}, name)

    def test_finds_what_waits(self):
        for code in ('std::condition_variable changed_;', '#include <condition_variable>', 'boost::condition_variable_any c;',
                     'c.wait_until(lock, end);', 'future.wait_for(time);', SLEEP + '_for(time);', SLEEP + '_until(end);',
                     'mutex.try_lock_for(time);', 'std::timed_mutex mutex_;',
                     'thread.timed_join(time);', 'ros::Duration(1.0)' + '.sleep();', '::usleep(1000);', 'sem_timedwait(&s, &t);',
                     'pthread_cond_timedwait(&c, &m, &t);', 'nanosleep(&time, nullptr);'):
            self.assertEqual(1, len(waits('int a;\n' + code)), code)
            self.assertEqual(2, waits('int a;\n' + code)[0][0], code)

    def test_comments_texts_and_names_of_ours_are_none(self):
        for code in ('// std::condition_variable of GCC 9', '/* wait_for\n %s_for */' % SLEEP, 'log("no %s_for here");' % SLEEP,
                     'changed_.waitUntil(lock, end, ready);', 'clock.sleepUntil(end);', 'TimePoint wait_until_;',
                     'const char* text = "a \\" sleep";'):
            self.assertEqual([], waits(code), code)


if __name__ == '__main__':
    unittest.main()
