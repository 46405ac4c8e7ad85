"""Tables and pictures of the results of a run, as Markdown and SVG. Text from numbers: no clock, no machine, no I/O."""
import re

import goals
import pictures
from figures import verdict
from in_virtual_time import BIN, BINS


def ms(value):
    return '-' if value is None else '%.1f ms' % (value * 1e3)


def us(value):
    return '-' if value is None else '%.1f us' % (value * 1e6)


def seconds(value):
    return '-' if value is None else '%.2f s' % value


def plain(value):
    return '-' if value is None else '%.3f' % value


def percent(value):
    return '-' if value is None else '%.1f %%' % (value * 100)


def ranged(text, value, pair):
    """'1.08 (1.07 to 1.10)'."""
    if value is None or not pair or pair[0] == pair[1]:
        return text(value)
    return '%s (%s to %s)' % (text(value), text(pair[0]), text(pair[1]))


def table(head, rows):
    """A Markdown table; says so where there is nothing."""
    rows = [[str(cell) for cell in row] for row in rows]
    if not rows:
        return 'Not measured in this run.\n'
    return '\n'.join(['| ' + ' | '.join(head) + ' |', '|' + '---|' * len(head)] +
                     ['| ' + ' | '.join(row) + ' |' for row in rows]) + '\n'


def machine(results):
    found = results['machine']
    return '%s, %d cores, %s, kernel %s; load %.1f when the run began. Build %s%s.%s\n' % (
        found['processor'], found['cores'], found['system'], found['kernel'], found['load'], found['commit'],
        ' beside ' + found['before'] if found.get('before') else '',
        ' **A short run (--quick): figures scatter more.**' if results['quick'] else '')


def wire(results):
    return table(['baud', 'character', 'late on average', 'of a character', 'at most', 'a master sees (median)', '99 %'],
                 [[one['baud'], us(one['character']), us(one['mean']), percent(one['share']), us(one['latest']),
                   us(one['seen_median']), us(one['seen_p99'])] for one in results.get('wire', [])])


def refresh_virtual(results):
    return table(['bus', 'driver (median)', 'mean', 'plain loop, legal gaps', 'ratio of medians', 'ratio of means',
                  'wire in use'] + (['build before', 'ratio'] if has_before(results) else []),
                 [[one['title'], ms(one['virtual']['median']), ms(one['virtual']['mean']), ms(one['virtual']['plain']),
                   plain(one['virtual']['ratio']), plain(one['virtual']['mean_ratio']), percent(one['virtual']['wire_use'])] +
                  before_cells(results, one) for one in results.get('refresh', []) if one.get('virtual')])


def has_before(results):
    return any(one.get('virtual_before') for one in results.get('refresh', []))


def before_cells(results, one):
    if not has_before(results):
        return []
    before = one.get('virtual_before')
    return [ms(before['median']), plain(one['virtual']['median'] / before['median'])] if before else ['-', '-']


def refresh_real(results):
    rows = []
    for one in results.get('refresh', []):
        real = one.get('real')
        if not real:
            continue
        row = [one['title'], ranged(ms, real['driver']['cycle'], real['driver']['spread'])]
        for other in ('legal', 'illegal', 'before'):
            if other in real:
                row += [ms(real[other]['cycle']), ranged(plain, real[other]['ratio'], real[other]['ratio_spread'])]
            else:
                row += ['-', '-']
        rows.append(row)
    return table(['bus', 'driver', 'loop, legal gaps', 'ratio', 'loop, illegal gaps', 'ratio', 'build before', 'ratio'], rows)


def whole_status(results):
    found = results.get('map')
    if not found:
        return 'Not measured in this run.\n'
    if found.get('missing'):
        return 'Not measured: %s.\n' % found['missing']
    return '5 MX2 at 19200 with their map: %s, the loop without legal gaps %s, ratio %s.\n' % (
        ms(found['cycle']), ms(found['illegal']), plain(found['ratio']))


FAULTS = {'silent': 'silent', 'late': 'answer after 300 ms', 'broken': 'replies of 3 bytes'}


def stops_virtual(results):
    found = results.get('stops', {})
    rows = [['driver', one['dead'], FAULTS[one['fault']] if one['dead'] else '-'] + latency(one)
            for one in found.get('virtual', [])]
    rows += [['driver before', one['dead'], FAULTS[one['fault']] if one['dead'] else '-'] + latency(one)
             for one in found.get('virtual_before') or []]
    rows += [['first come, first served', one['dead'], 'silent' if one['dead'] else '-'] + latency(one)
             for one in found.get('queue', [])]
    return table(['who', 'dead of 31', 'how', 'stops', 'median', '99 %', 'longest', 'without a frame'], rows)


def latency(one):
    return [one['count'], ms(one['median']), ms(one['p99']), ms(one['max']), one['missing']]


def stops_real(results):
    rows = []
    for one in results.get('stops', {}).get('real', []):
        for name, key in (('call to first byte', 'stops'), ('call to confirmed answer', 'confirmed'),
                          ('a thread of this host wakes up late by', 'wake_ups')):
            rows.append([one['inverters'], one['dead'], name] + latency(one[key])[:4])
    return table(['drives', 'dead', 'what', 'how many', 'median', '99 %', 'longest'], rows)


def dead(results):
    return table(['dead of 31', 'live ones beside them', 'live ones alone', 'ratio', 'all are back after', 'plain loop'],
                 [[one['dead'], ms(one['beside']), ms(one['alone']), plain(one['ratio']), seconds(one['back']),
                   ms(one['plain'])] for one in results.get('dead', [])])


def commands(results):
    rows = [['virtual', one['inverters'], one['load'] + ', 1 read waits' * (one['load'] == 'full')] +
            latency(one['commands']) + ['-'] for one in results.get('commands_virtual', [])]
    rows += [['real', one['inverters'], one['load'] + ', 20 reads wait' * (one['load'] == 'full')] + latency(one['commands']) +
             [ms(one['wake_ups']['p99']) if one['wake_ups'] else '-'] for one in results.get('commands', [])]
    return table(['time', 'drives', 'load', 'velocities', 'median', '99 %', 'longest', 'without a frame',
                  'host wakes up late by (99 %)'], rows)


def cost(results):
    found = results.get('cost', {})
    rows = [[name, percent(one['share']), us(one['per_exchange']), '%d kB' % one['resident_kb']]
            for name, one in (('driver without ROS, 31 MX2 at 115200', found.get('driver')),
                              ('the build before', found.get('before')),
                              ('whole node, 31 MX2 at 115200', found.get('node'))) if one]
    rows += [['each of %d nodes in one graph, %s (cycle %s)' % (one['buses'], one['scene'], ms(one['cycle'])),
              percent(one['share']), us(one['per_exchange']), '%d kB' % one['resident_kb']] for one in found.get('graph', [])]
    text = table(['what', 'share of a core', 'CPU per exchange', 'resident'], rows)
    return text + ('\n%s\n' % found['missing'] if found.get('missing') else '')


def others(results):
    rows = []
    for one in results.get('others', []):
        if one['missing']:
            rows.append([one['name'], one['scene'], 'not run: ' + one['missing']] + ['-'] * 6)
            continue
        stops = one['stops']
        rows.append([one['name'], one['scene'], ms(one['cycle']), percent(one['wire_use']), percent(one['early']),
                     ms(one.get('one_dead')), ms(stops['median']), ms(stops['max']),
                     '%d of %d' % (stops['missing'], stops['count'])])
    return table(['who', 'bus', 'cycle', 'wire in use', 'requests before 3.5 characters', 'cycle with one dead drive',
                  'stop, median', 'longest', 'no stop frame'], rows)


def goal_table(results):
    rows = [[goal.name, '-' if goal.value is None else '%.4g %s' % (goal.value, goal.unit),
             '%.4g %s' % (goal.limit, goal.unit), verdict(goal)] for goal in goals.of(results)]
    return table(['goal', 'measured', 'at most', ''], [[cell.strip() for cell in row] for row in rows])


SECTIONS = (('machine', 'Machine', machine), ('goals', 'Goals', goal_table), ('wire', 'The simulated wire', wire),
            ('refresh_virtual', 'Refresh, in virtual time', refresh_virtual),
            ('refresh_real', 'Refresh, in real time', refresh_real), ('map', 'Whole status in one exchange', whole_status),
            ('stops_virtual', 'Stops, in virtual time', stops_virtual), ('stops_real', 'Stops, in real time', stops_real),
            ('dead', 'Dead drives, in virtual time', dead), ('commands', 'Velocities', commands),
            ('cost', 'What it costs the host', cost), ('others', 'Beside others on the same wire', others))


def text(results):
    """All tables, for a terminal."""
    return '\n'.join('%s\n%s\n\n%s' % (title, '-' * len(title), make(results)) for _, title, make in SECTIONS)


def fill(document, results):
    """The document with the section between each pair of markers made anew; raises ValueError where a pair is missing."""
    for name, _, make in SECTIONS:
        pattern = r'(<!-- benchmark: %s -->\n).*?(<!-- end -->)' % name
        document, count = re.subn(pattern, lambda match, made=make(results): match.group(1) + made + match.group(2),
                                  document, flags=re.DOTALL)
        if count != 1:
            raise ValueError('the document has %d sections <!-- benchmark: %s --> instead of one' % (count, name))
    return document


# --- pictures --------------------------------------------------------------------------------------------------------

def efficiency_picture(results):
    found = results.get('baud', [])
    series = [('driver, median', [(index, one['plain'] / one['median']) for index, one in enumerate(found)]),
              ('driver, mean', [(index, one['plain'] / one['mean']) for index, one in enumerate(found)]),
              ('wire in use', [(index, one['wire_use']) for index, one in enumerate(found)])]
    return pictures.lines('Scan efficiency of 5 MX2: plain loop with legal gaps = 1 (virtual time)', 'baud rate', 'efficiency',
                          series, [str(one['baud']) for one in found])


def number_picture(results):
    found = results.get('number', [])
    series = [('driver, median', [(one['inverters'], one['median'] * 1e3) for one in found]),
              ('plain loop, legal gaps', [(one['inverters'], one['plain'] * 1e3) for one in found])]
    return pictures.lines('Cycle against the number of MX2 at 19200 (virtual time)', 'drives', 'cycle [ms]', series)


def dead_picture(results):
    found = results.get('dead', [])
    series = [('live beside dead ones', [(one['dead'], one['beside'] * 1e3) for one in found]),
              ('live alone', [(one['dead'], one['alone'] * 1e3) for one in found]),
              ('plain loop', [(one['dead'], one['plain'] * 1e3) for one in found])]
    return pictures.lines('Cycle against dead drives of 31 MX2 at 19200 (virtual time)', 'dead drives', 'cycle [ms]', series)


def stop_picture(results):
    found = results.get('stops', {})
    series = [('%d dead' % one['dead'], one) for one in found.get('virtual', []) if one['fault'] == 'silent']
    series += [('first come, first served', one) for one in found.get('queue', []) if one['dead'] == 0]
    shares = [(name, [100.0 * bar / one['count'] for bar in one['histogram']]) for name, one in series]
    names = ['%d' % (bar * BIN * 1e3) for bar in range(BINS - 1)] + ['more']
    return pictures.bars('Stop call to first byte, 31 MX2 at 19200 under full load (virtual time)', 'from ... ms on',
                         'share of stops [%]', shares or [('none', [0] * BINS)], names)


PICTURES = {'performance_efficiency.svg': efficiency_picture, 'performance_number.svg': number_picture,
            'performance_dead.svg': dead_picture, 'performance_stops.svg': stop_picture}
