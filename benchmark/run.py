#!/usr/bin/env python3
"""Measures what the driver makes of a bus, prints the tables, and writes JSON and pictures (docs/performance.md).

Called by scripts/benchmark, which builds the programs first.
"""
import argparse
import json
import os
import platform
import subprocess
import sys

import goals
import in_real_time
import in_virtual_time
import report
import ros_graph
import scenes
from figures import verdict


ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
DOCUMENT = os.path.join(ROOT, 'docs', 'performance.md')


class Amounts:
    """How long everything takes: a whole run is for publishing, a short one for a look."""

    def __init__(self, quick):
        self.virtual_seconds = 30 if quick else 120
        self.rounds = 1 if quick else 3
        self.real_scenes = [scenes.SCENES[index] for index in ((1, 5) if quick else range(len(scenes.SCENES)))]
        self.wire_calls = 200 if quick else 1000
        self.virtual_stops = 500 if quick else 10000
        self.real_stops = 50 if quick else 1000
        self.real_dead = (0,) if quick else (0, 3, 15)
        self.real_inverters = 5 if quick else 31
        self.velocities = 20 if quick else 200
        self.cost_seconds = 5 if quick else 30
        self.graphs = (1,) if quick else (1, 4, 8)
        self.others_seconds = 3 if quick else 15
        self.others_stops = 3 if quick else 50

    def real_seconds(self, scene):
        """At least some twenty cycles in a whole run."""
        return 4.0 if self.rounds == 1 else max(10.0, 1.2 * scene.inverters * 19200.0 / min(scene.baud, 19200) * 0.8)


def say(text):
    print(text, file=sys.stderr, flush=True)


def machine(before):
    with open('/proc/cpuinfo') as stream:
        models = [line.partition(':')[2].strip() for line in stream if line.startswith('model name')]
    system = platform.freedesktop_os_release()['PRETTY_NAME'] if hasattr(platform, 'freedesktop_os_release') else \
        platform.system()
    commit = subprocess.run(['git', '-C', ROOT, 'describe', '--always', '--dirty'], stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL, check=False, universal_newlines=True).stdout.strip()
    return {'processor': models[0] if models else platform.machine(), 'cores': os.cpu_count(), 'system': system,
            'kernel': platform.release(), 'load': os.getloadavg()[0], 'commit': commit or 'unknown', 'before': before}


def measure_wire(programs, _before, amounts):
    return {'wire': in_real_time.wire_error(programs, amounts.wire_calls)}


def measure_refresh(programs, before, amounts):
    found = []
    for scene in scenes.SCENES:
        one = {'title': scenes.title(scene), 'baud': scene.baud,
               'virtual': in_virtual_time.refresh(programs, scene, amounts.virtual_seconds)}
        if before:
            one['virtual_before'] = in_virtual_time.refresh(before, scene, amounts.virtual_seconds)
        if scene in amounts.real_scenes:
            say('  refresh of %s in real time' % one['title'])
            one['real'] = in_real_time.refresh(programs, before, scene, amounts.rounds, amounts.real_seconds(scene))
        found.append(one)
    return {'refresh': found, 'map': in_real_time.whole_status(programs, amounts.real_seconds(scenes.SCENES[1]))}


def measure_curves(programs, _before, amounts):
    return {'baud': in_virtual_time.against_baud(programs, amounts.virtual_seconds),
            'number': in_virtual_time.against_number(programs, amounts.virtual_seconds)}


def measure_stops(programs, before, amounts):
    return {'stops': {'virtual': in_virtual_time.stops(programs, amounts.virtual_stops),
                      'virtual_before': in_virtual_time.stops(before, amounts.virtual_stops) if before else None,
                      'queue': in_virtual_time.queue(programs, amounts.virtual_stops),
                      'real': [in_real_time.stops(programs, amounts.real_inverters, dead, amounts.real_stops)
                               for dead in amounts.real_dead]}}


def measure_dead(programs, _before, amounts):
    return {'dead': in_virtual_time.dead_drives(programs, amounts.virtual_seconds)}


def measure_commands(programs, _before, amounts):
    numbers = sorted({5, amounts.real_inverters})
    found = [in_real_time.commands(programs, inverters, load, amounts.velocities)
             for inverters in numbers for load in ('idle', 'full')]
    if not ros_graph.lacks_ros():
        found += [ros_graph.velocities(programs, scenes.Scene(inverters, 19200, 'omron_mx2'), amounts.velocities)
                  for inverters in numbers]
    return {'commands': found, 'commands_virtual': in_virtual_time.velocities(programs, amounts.velocities)}


def measure_cost(programs, before, amounts):
    large = scenes.Scene(31, 115200, 'omron_mx2')
    found = {'driver': in_real_time.cost(programs, programs, large, amounts.cost_seconds)}
    if before:
        found['before'] = in_real_time.cost(programs, before, large, amounts.cost_seconds)
    found['missing'] = ros_graph.lacks_ros()
    if not found['missing']:
        found['node'] = ros_graph.buses(programs, large, 1, amounts.cost_seconds)
        found['graph'] = [ros_graph.buses(programs, scenes.SCENES[1], number, amounts.cost_seconds)
                          for number in amounts.graphs]
    return {'cost': found}


def measure_others(programs, _before, amounts):
    return {'others': in_real_time.others(programs, amounts.others_seconds, amounts.others_stops)}


PARTS = {'wire': measure_wire, 'refresh': measure_refresh, 'curves': measure_curves, 'stops': measure_stops,
         'dead': measure_dead, 'commands': measure_commands, 'cost': measure_cost, 'others': measure_others}


def measure(arguments):
    """Everything that is asked for. The file is written after each part: nothing is lost when a run is broken off."""
    results = {'quick': arguments.quick, 'machine': machine(arguments.before_name)}
    for name in arguments.only or PARTS:
        say('%s ...' % name)
        results.update(PARTS[name](arguments.programs, arguments.before, Amounts(arguments.quick)))
        write(results, arguments.output)
    return results


def write(results, path):
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    with open(path, 'w') as stream:
        json.dump(results, stream, indent=1, sort_keys=True)
        stream.write('\n')


def draw(results, directory):
    os.makedirs(directory, exist_ok=True)
    for name, make in report.PICTURES.items():
        with open(os.path.join(directory, name), 'w') as stream:
            stream.write(make(results))


def write_docs(results):
    with open(DOCUMENT, encoding='utf-8') as stream:
        document = report.fill(stream.read(), results)
    with open(DOCUMENT, 'w', encoding='utf-8') as stream:
        stream.write(document)
    draw(results, os.path.dirname(DOCUMENT))
    write(results, os.path.join(os.path.dirname(DOCUMENT), 'performance.json'))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--programs', required=True, help='directory of the built programs')
    parser.add_argument('--before', help='directory of the programs of another build, measured in alternation')
    parser.add_argument('--before-name', help='what that build is called')
    parser.add_argument('--output', required=True, help='JSON file; the pictures go beside it')
    parser.add_argument('--from', dest='source', help='measure nothing: tables and pictures of this JSON file')
    parser.add_argument('--quick', action='store_true', help='some minutes instead of more than an hour')
    parser.add_argument('--only', action='append', choices=list(PARTS), help='only this part; may be given several times')
    parser.add_argument('--write-docs', action='store_true', help='fill docs/performance.md, its pictures and JSON')
    arguments = parser.parse_args()

    if arguments.source:
        with open(arguments.source) as stream:
            results = json.load(stream)
    else:
        results = measure(arguments)
    draw(results, os.path.dirname(os.path.abspath(arguments.output)))
    print(report.text(results))
    if arguments.write_docs:
        write_docs(results)
    missed = [goal for goal in goals.of(results) if verdict(goal) == 'MISSED']
    print('%d goals missed%s' % (len(missed), ''.join('\n  ' + goal.name for goal in missed)))
    return 0


if __name__ == '__main__':
    sys.exit(main())
