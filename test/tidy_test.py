#!/usr/bin/env python3
"""What test/tidy.py gives to clang-tidy: files that differ from the main branch, and sources that show their headers."""
import os
import shutil
import subprocess
import tempfile
import unittest

import tidy

FILES = {
    'include/inverter_bus/bus/bus.h': '#include "inverter_bus/bus/types.h"\n',
    'include/inverter_bus/bus/types.h': '#include <string>\n',
    'include/inverter_bus/bus/unused.h': '',
    'src/bus/bus.cpp': '#include "inverter_bus/bus/bus.h"\n',
    'src/bus/rules/rule.h': '',
    'src/bus/rules/rule.cpp': '  #  include "rule.h"\n#include "inverter_bus/bus/types.h"\n',
    'src/ros/node.cpp': '#include "bus/rules/rule.h"\n#include "inverter_bus/bus/bus.h"\n#include "inverter_bus/Message.h"\n',
    'test/unit/bus_test.cpp': '#include "inverter_bus/bus/unused.h"\n',
}


class Tree(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        for path, text in FILES.items():
            self.write(path, text)

    def write(self, path, text):
        full = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, 'w') as stream:
            stream.write(text)


class Choice(Tree):
    def sources(self, flags=''):
        return tidy.Sources(self.root, [{'directory': os.path.join(self.root, 'build'), 'command': 'c++ %s-c %s' % (flags, path),
                                         'file': os.path.join(self.root, path)} for path in FILES if path.endswith('.cpp')])

    def test_sources_are_those_of_the_package(self):
        self.assertEqual(['src/bus/bus.cpp', 'src/bus/rules/rule.cpp', 'src/ros/node.cpp'], sorted(self.sources().commands))

    def test_a_changed_source_is_looked_at_itself(self):
        self.assertEqual((['src/bus/bus.cpp'], []),
                         self.sources().choose(['README.md', 'src/bus/bus.cpp', 'src/bus/gone.cpp', 'test/unit/bus_test.cpp']))

    def test_a_header_is_looked_at_from_the_source_of_its_name(self):
        self.assertEqual((['src/bus/bus.cpp'], []), self.sources().choose(['include/inverter_bus/bus/bus.h']))
        self.assertEqual((['src/bus/rules/rule.cpp'], []), self.sources().choose(['src/bus/rules/rule.h']))

    def test_or_else_from_one_that_includes_it(self):
        self.assertEqual((['src/bus/rules/rule.cpp'], []), self.sources().choose(['include/inverter_bus/bus/types.h']))

    def test_or_from_one_that_is_looked_at_anyway(self):
        self.assertEqual((['src/ros/node.cpp'], []),
                         self.sources().choose(['src/bus/rules/rule.h', 'include/inverter_bus/bus/types.h', 'src/ros/node.cpp']))

    def test_a_header_that_no_source_includes_is_named(self):
        self.assertEqual(([], ['include/inverter_bus/bus/unused.h']),
                         self.sources().choose(['include/inverter_bus/bus/unused.h', 'include/inverter_bus/bus/gone.h']))

    def test_what_was_clean_is_looked_at_again_when_anything_in_it_has_changed(self):
        def keys(flags='', rules=''):
            sources = self.sources(flags)
            return [sources.key(path, rules) for path in sorted(sources.commands)]
        bus, rule, node = keys()
        self.assertEqual([bus, rule, node], keys())
        self.assertNotIn(bus, keys(rules='other'))
        self.assertNotIn(bus, keys(flags='-O1 '))
        self.write('src/bus/rules/rule.h', '// changed\n')
        self.assertEqual([True, False, False], [old == new for old, new in zip((bus, rule, node), keys())])

    def test_memory_outlives_a_run(self):
        path = os.path.join(self.root, 'memory.json')
        sources = ('src/a.cpp', 'src/b.cpp')
        tidy.Memory(path, sources).add('src/a.cpp', 'key')
        self.assertTrue(tidy.Memory(path, sources).knows('src/a.cpp', 'key'))
        self.assertFalse(tidy.Memory(path, sources).knows('src/a.cpp', 'other'))
        self.assertFalse(tidy.Memory(path, sources).knows('src/b.cpp', 'key'))
        self.assertFalse(tidy.Memory(path, ('src/b.cpp',)).knows('src/a.cpp', 'key'))
        self.write('memory.json', 'half a')
        self.assertFalse(tidy.Memory(path, sources).knows('src/a.cpp', 'key'))


class Changes(Tree):
    def git(self, *words):
        subprocess.run(('git', '-C', self.root, '-c', 'user.name=test', '-c', 'user.email=test@test') + words, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def commit(self):
        self.git('add', '-A')
        self.git('commit', '-m', 'message')

    def setUp(self):
        super().setUp()
        if not shutil.which('git'):
            self.skipTest('git is not installed')

    def start(self, branch='main'):
        self.git('init')
        self.git('symbolic-ref', 'HEAD', 'refs/heads/' + branch)
        self.commit()

    def test_without_git_it_can_not_be_told(self):
        self.assertIsNone(tidy.changed_files(self.root))

    def test_nor_without_a_main_branch(self):
        self.start('other')
        self.assertIsNone(tidy.changed_files(self.root))

    def test_nothing_has_changed(self):
        self.start()
        self.assertEqual([], tidy.changed_files(self.root))

    def test_committed_uncommitted_and_new_files(self):
        self.start()
        self.git('checkout', '-b', 'work')
        self.write('src/bus/bus.cpp', '// committed\n')
        self.commit()
        self.write('src/ros/node.cpp', '// not committed\n')
        self.write('src/ros/new.cpp', '')
        self.assertEqual(['src/bus/bus.cpp', 'src/ros/new.cpp', 'src/ros/node.cpp'], tidy.changed_files(self.root))

    def test_what_only_the_main_branch_has_is_no_change(self):
        self.start()
        self.git('branch', 'work')
        self.write('src/bus/bus.cpp', '// on the main branch\n')
        self.commit()
        self.git('checkout', 'work')
        self.assertEqual([], tidy.changed_files(self.root))

    def test_the_branch_of_the_origin_comes_first(self):
        self.start()
        self.git('update-ref', 'refs/remotes/origin/main', 'HEAD')
        self.write('src/bus/bus.cpp', '// committed, not pushed\n')
        self.commit()
        self.assertEqual(['src/bus/bus.cpp'], tidy.changed_files(self.root))


class Findings(unittest.TestCase):
    def test_each_finding_keeps_its_notes(self):
        first = 'src/a.cpp:1:2: error: one [check]\n  code\n  ^\nsrc/a.cpp:3:4: note: because\n'
        second = 'src/b.h:1:2: warning: two [check]\n'
        self.assertEqual([first, second], tidy.split(first + second))
        self.assertEqual([], tidy.split('\n'))


if __name__ == '__main__':
    unittest.main()
