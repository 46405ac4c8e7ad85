#!/usr/bin/env python3
"""The arithmetic, the tables and the pictures of scripts/benchmark, from made-up numbers: nothing is measured here."""
import os
import re
import sys
import unittest
import xml.etree.ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, 'benchmark'))

import figures  # noqa: E402
import goals  # noqa: E402
import masters  # noqa: E402
import pictures  # noqa: E402
import report  # noqa: E402
import scenes  # noqa: E402
import traces  # noqa: E402

TRACE = '''\
# 0 is 1000.500000 of CLOCK_MONOTONIC
0.000000 master 1 01 01 00 00 00 18 3C 00
0.010000 drive 1 01 01 03 00 00 01 FD 8E
0.016000 master 1 01 03 10 00 00 04 40 C9 # early
0.026000 drive 1 01 03 08 00 00 00 00 00 00 00 00 95 D7
0.100000 master 2 02 03 10 00 00 04 40 FA
0.200000 master 1 01 03 0F FE 00 04 00 00
0.230000 master 1 01 05 00 00 00 00 CD CA
0.400000 master 2 02 17 10 00 00 04 00 01 00 01 02 00 00 00 00 # lost: gap
0.500000 master 1 01 03 10 0F 00 0A F1 0E
'''


class Figures(unittest.TestCase):
    def test_median_and_percentile(self):
        self.assertIsNone(figures.median([]))
        self.assertEqual(figures.median([3.0]), 3.0)
        self.assertEqual(figures.median([4.0, 1.0, 2.0, 3.0]), 2.5)
        self.assertIsNone(figures.percentile([], 0.99))
        hundred = list(range(1, 101))
        self.assertEqual(figures.percentile(hundred, 0.99), 99)
        self.assertEqual(figures.percentile(hundred, 0.5), 50)
        self.assertEqual(figures.percentile(hundred, 1.0), 100)
        self.assertEqual(figures.percentile([7.0], 0.99), 7.0)
        self.assertEqual(figures.percentile([7.0, 8.0], 0.0), 7.0)

    def test_what_never_came_is_counted_and_in_no_figure(self):
        found = figures.summary([0.1, -1.0, 0.3])
        self.assertEqual((found['count'], found['missing'], found['max']), (3, 1, 0.3))
        self.assertAlmostEqual(found['median'], 0.2)
        nothing = figures.summary([-1.0])
        self.assertEqual((nothing['missing'], nothing['median'], nothing['max']), (1, None, None))

    def test_histogram_has_its_tail_in_the_last_bar(self):
        self.assertEqual(figures.histogram([0.0, 0.004, 0.005, 0.011, 9.0, -1.0], 0.005, 3), [2, 1, 2])

    def test_ratios_are_of_the_same_round(self):
        self.assertEqual(figures.pair_ratios([2.0, 6.0, 1.0], [1.0, 2.0, None]), [2.0, 3.0])
        self.assertIsNone(figures.ratio(1.0, 0))
        self.assertIsNone(figures.ratio(None, 1.0))
        self.assertEqual(figures.spread([3.0, None, 1.0]), (1.0, 3.0))
        self.assertIsNone(figures.spread([]))

    def test_a_goal_is_met_missed_or_not_measured(self):
        self.assertEqual(figures.verdict(figures.Goal('', 1.12, 1.12, '')), 'met')
        self.assertEqual(figures.verdict(figures.Goal('', 1.121, 1.12, '')), 'MISSED')
        self.assertEqual(figures.verdict(figures.Goal('', None, 1.12, '')), 'not measured')


class Traces(unittest.TestCase):
    def setUp(self):
        self.frames = traces.parse(TRACE)

    def test_frames_are_on_the_clock_of_the_host(self):
        self.assertEqual(len(self.frames), 9)
        self.assertAlmostEqual(self.frames[0].time, 1000.5)
        self.assertEqual(self.frames[2].remark, 'early')
        self.assertEqual(self.frames[1].sender, 'drive')
        self.assertEqual(self.frames[4].bytes, bytes.fromhex('02031000000440FA'))

    def test_a_refresh_reads_the_frequency_in_whatever_shape(self):
        periods = traces.periods(self.frames)
        # Station 1: 1000h itself, and a read of 0FFEh to 1001h. The slow values from 100Fh on are no refresh.
        self.assertEqual(list(periods), ['1', '2'])
        self.assertAlmostEqual(periods['1'][0], 0.184)
        self.assertAlmostEqual(periods['2'][0], 0.3)  # 03H, then 17H

    def test_who_reads_no_frequency_is_taken_by_his_most_frequent_request(self):
        text = '# 0 is 0 of CLOCK_MONOTONIC\n' + ''.join(
            '%.6f master 1 01 04 00 0%d 00 01 00 00\n' % (0.01 * count, 1 if count % 3 else 2) for count in range(14))
        self.assertAlmostEqual(traces.cycle(traces.parse(text)), 0.015)
        self.assertIsNone(traces.cycle([]))

    def test_shares(self):
        self.assertAlmostEqual(traces.early_share(self.frames), 1.0 / 7.0)
        self.assertIsNone(traces.early_share([]))
        count = 6 * 8 + 8 + 13 + 15
        self.assertEqual(sum(len(frame.bytes) for frame in self.frames), count)
        self.assertAlmostEqual(traces.wire_use(self.frames, 19200, 0.5), count * 10 / 19200 / 0.5)
        self.assertEqual(len(traces.within(self.frames, 1000.5, 1000.526)), 3)

    def test_a_stop_is_the_first_one_after_its_call(self):
        def stop(data):
            return data[:6] == bytes([1, 5, 0, 0, 0, 0])

        self.assertAlmostEqual(traces.delay_to(self.frames, 1000.7, stop), 0.03)
        self.assertEqual(traces.delay_to(self.frames, 1000.8, stop), -1.0)


    def test_a_stop_of_a_vf_s15_in_all_its_shapes(self):
        stopped = masters.vfs15_stopped(1)
        stops = ('0106FA00C000', '01101870000204C0000000', '0117187500051870000204C0000000', '0106FA008000')
        others = ('0206FA00C000', '0106FA00C400', '0106FA01C000', '01101870000204C40003E8', '0117187500051870000204C4000000',
                  '010318750005', '0106FA00')
        self.assertEqual([stopped(bytes.fromhex(text) + b'..') for text in stops], [True] * len(stops))
        self.assertEqual([stopped(bytes.fromhex(text)) for text in others], [False] * len(others))


class Scenes(unittest.TestCase):
    def test_the_reply_comes_after_the_same_time_at_every_rate(self):
        self.assertAlmostEqual(scenes.silence(9600), 0.00364583, places=6)
        self.assertEqual(scenes.silence(115200), 0.00175)
        text = scenes.scan_list(scenes.Scene(2, 9600, 'omron_mx2'), '/tmp/line')
        self.assertIn('belt_2: {turnaround: 0.001354, parameters: {}}', text)
        self.assertIn('defaults: {drive: omron_mx2, command_timeout: 0}', text)
        self.assertIn('F870: 1', scenes.scan_list(scenes.SCENES[-1], '/tmp/line'))
        self.assertIn('command_timeout: 0, configure_map: true', scenes.scan_list(scenes.MAPPED, '/tmp/line'))
        self.assertEqual(scenes.title(scenes.SCENES[-1]), '1 VF-S15, 19200')

    def test_scene_h_says_the_same(self):
        with open(os.path.join(ROOT, 'benchmark', 'scene.h')) as stream:
            header = stream.read()
        block = re.search(r'parameters: (\{F870.*?\})', header).group(1)
        self.assertEqual(block, scenes.BLOCK)
        self.assertIn(scenes.MAP, header)
        self.assertIn('configure_map: true, confirm: [register_map]', header)
        self.assertEqual(float(re.search(r'reply_delay = ([\d.]+)', header).group(1)), scenes.REPLY_DELAY)


class Pictures(unittest.TestCase):
    def test_ticks_are_round_and_reach_the_most(self):
        self.assertEqual(pictures.ticks(1.0), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0])
        self.assertEqual(pictures.ticks(31), [0, 10, 20, 30, 40])
        self.assertEqual(pictures.ticks(0), [0, 1])
        for most in (0.003, 0.7, 3, 99, 1500, 15706.4):
            steps = pictures.ticks(most)
            self.assertGreaterEqual(steps[-1], most * (1 - 1e-9))
            self.assertLessEqual(len(steps), 8)

    def test_a_picture_is_the_same_every_time_and_well_formed(self):
        series = [('a < b', [(1, 2.0), (3, 4.5)]), ('c', [(1, 0.0)])]
        text = pictures.lines('Title & more', 'x', 'y', series)
        self.assertEqual(text, pictures.lines('Title & more', 'x', 'y', series))
        root = xml.etree.ElementTree.fromstring(text)
        self.assertEqual(len(root.findall('{http://www.w3.org/2000/svg}polyline')), 2)
        self.assertEqual(len(root.findall('{http://www.w3.org/2000/svg}circle')), 3)

    def test_points_lie_where_they_belong(self):
        axes = pictures.Axes(10, 100)
        self.assertEqual(axes.x(0), pictures.LEFT)
        self.assertEqual(axes.x(10), pictures.WIDTH - pictures.RIGHT)
        self.assertEqual(axes.y(0), pictures.HEIGHT - pictures.BOTTOM)
        self.assertEqual(axes.y(100), pictures.TOP)

    def test_bars_are_as_high_as_their_values(self):
        text = pictures.bars('t', 'x', 'y', [('one', [0, 50, 100]), ('two', [0, 0, 25])], ['0', '5', 'more'])
        root = xml.etree.ElementTree.fromstring(text)
        heights = [float(bar.get('height')) for bar in root.findall('{http://www.w3.org/2000/svg}rect')
                   if bar.get('fill') in pictures.COLOURS and bar.get('height') != '10']
        inside = pictures.HEIGHT - pictures.TOP - pictures.BOTTOM
        self.assertEqual(heights, [inside / 2, inside, inside / 4])

    def test_no_results_make_empty_pictures(self):
        for make in report.PICTURES.values():
            xml.etree.ElementTree.fromstring(make({}))


RESULTS = {
    'quick': False,
    'machine': {'processor': 'P', 'cores': 2, 'system': 'S', 'kernel': 'K', 'load': 0.1, 'commit': 'abc', 'before': None},
    'refresh': [{'title': '31 MX2, 19200', 'baud': 19200, 'virtual': None,
                 'real': {'driver': {'cycle': 1.1, 'spread': (1.0, 1.2)},
                          'legal': {'cycle': 1.0, 'ratio': 1.10, 'ratio_spread': (1.09, 1.13)},
                          'illegal': {'cycle': 0.9, 'ratio': 1.23, 'ratio_spread': (1.23, 1.23)},
                          'before': {'cycle': 1.8, 'ratio': 0.61, 'ratio_spread': None}}}],
    'stops': {'virtual': [{'dead': 15, 'fault': 'late', 'count': 10000, 'missing': 0, 'median': 0.01, 'p99': 0.02,
                           'max': 0.045, 'histogram': [10000]}]},
    'cost': {'graph': [{'buses': 1, 'cycle': 0.2, 'share': 0.01, 'resident_kb': 9, 'per_exchange': 1e-4, 'scene': 's'},
                       {'buses': 4, 'cycle': 0.21, 'share': 0.01, 'resident_kb': 9, 'per_exchange': 1e-4, 'scene': 's'}]},
    'others': [{'name': 'mb2hal', 'scene': 's', 'missing': 'linuxcnc-uspace is not installed'}],
}


class Report(unittest.TestCase):
    def test_goals(self):
        verdicts = {goal.name: figures.verdict(goal) for goal in goals.of(RESULTS)}
        self.assertEqual(verdicts['refresh of 31 MX2, 19200 / loop with legal gaps'], 'met')
        self.assertEqual(verdicts['refresh of 31 MX2, 19200 / loop without legal gaps'], 'MISSED')
        self.assertEqual(verdicts['refresh of 31 MX2, 19200 / the build before'], 'met')
        self.assertEqual(verdicts['longest of 10000 stops, 15 dead of 31 (late), virtual time'], 'met')
        self.assertEqual(verdicts['cycle with 4 buses in one graph / with one'], 'MISSED')
        self.assertEqual(verdicts['cycle with 8 buses in one graph / with one'], 'not measured')

    def test_a_missed_goal_and_a_missing_peer_are_said(self):
        text = report.text(RESULTS)
        self.assertIn('| refresh of 31 MX2, 19200 / loop without legal gaps | 1.23 | 1.22 | MISSED |', text)
        self.assertIn('not run: linuxcnc-uspace is not installed', text)
        self.assertIn('1.100 (1.090 to 1.130)', text)
        self.assertNotIn('--quick', text)
        self.assertIn('--quick', report.text(dict(RESULTS, quick=True)))

    def test_nothing_measured_is_said_too(self):
        text = report.text({'quick': False, 'machine': RESULTS['machine']})
        self.assertGreaterEqual(text.count('Not measured in this run.'), 8)

    def test_a_document_is_filled_between_its_markers_and_nowhere_else(self):
        document = 'before\n' + ''.join('<!-- benchmark: %s -->\nold \\1\n<!-- end -->\nkept\n' % name
                                        for name, *_ in report.SECTIONS)
        filled = report.fill(document, RESULTS)
        self.assertNotIn('old', filled)
        self.assertEqual(filled.count('kept'), len(report.SECTIONS))
        self.assertEqual(report.fill(filled, RESULTS), filled)
        with self.assertRaisesRegex(ValueError, 'benchmark: goals'):
            report.fill(document.replace('benchmark: goals', 'other'), RESULTS)

    def test_the_document_of_the_repository_has_all_sections(self):
        with open(os.path.join(ROOT, 'docs', 'performance.md'), encoding='utf-8') as stream:
            report.fill(stream.read(), RESULTS)


if __name__ == '__main__':
    unittest.main()
