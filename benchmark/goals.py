"""What the figures of a run are measured against. Ratios are of one run on one machine; a goal that is missed is printed so."""
from figures import Goal

LEGAL = 1.12
"""Refresh, slow values included, against the plain loop with legal gaps."""
ILLEGAL = {19200: 1.22, 9600: 1.26, 115200: 1.35}
"""The same against the loop without legal gaps, by baud rate: above 19200 a legal gap is 1.75 ms."""


def value(found, *keys):
    """found[key][key]..., or None where something on the way is missing."""
    for key in keys:
        if found is None:
            return None
        found = found.get(key) if isinstance(found, dict) else None
    return found


def of_wire(results):
    for one in results.get('wire', []):
        yield Goal('timing error of the simulated wire, %d baud, of a character' % one['baud'], one['share'], 0.02, '')


def of_refresh(results):
    for one in results.get('refresh', []):
        real = one.get('real')
        yield Goal('refresh of %s / loop with legal gaps' % one['title'], value(real, 'legal', 'ratio'), LEGAL, '')
        yield Goal('refresh of %s / loop without legal gaps' % one['title'], value(real, 'illegal', 'ratio'),
                   ILLEGAL[one['baud']], '')
        if one['title'] == '31 MX2, 19200':
            yield Goal('refresh of 31 MX2, 19200 / the build before', value(real, 'before', 'ratio'), 0.64, '')
    yield Goal('one exchange for the whole status, 5 MX2, 19200 / loop without legal gaps',
               value(results.get('map'), 'ratio'), 0.75, '')


def of_stops(results):
    for one in results.get('stops', {}).get('virtual', []):
        limit = 0.040 if one['fault'] == 'silent' else 0.046
        yield Goal('longest of %d stops, %s dead of 31 (%s), virtual time' %
                   (one['count'], one['dead'] or 'none', one['fault']), one['max'], limit, 's')


def of_dead(results):
    for one in results.get('dead', []):
        if one['dead'] in (1, 3, 15):
            yield Goal('cycle of the live ones beside %d dead of 31 / alone' % one['dead'], one['ratio'], 1.06, '')
        yield Goal('%d dead of 31 are back' % one['dead'], one['back'], 3.0 if one['dead'] <= 6 else 8.0, 's')


def of_cost(results):
    cost = results.get('cost', {})
    yield Goal('share of a core, 31 MX2 at 115200, without ROS', value(cost, 'driver', 'share'), 0.02, '')
    yield Goal('share of a core, 31 MX2 at 115200, whole node', value(cost, 'node', 'share'), 0.04, '')
    if value(cost, 'before', 'resident_kb'):
        yield Goal('resident memory', value(cost, 'driver', 'resident_kb'), cost['before']['resident_kb'], 'kB')
    graph = {one['buses']: one['cycle'] for one in cost.get('graph', [])}
    for number in (4, 8):
        alone, together = graph.get(1), graph.get(number)
        yield Goal('cycle with %d buses in one graph / with one' % number, together / alone if alone and together else None,
                   1.02, '')


def of(results):
    """All goals, in the order of the document."""
    return [goal for part in (of_wire, of_refresh, of_stops, of_dead, of_cost) for goal in part(results)]
