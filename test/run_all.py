#!/usr/bin/env python3
"""Runs every test of a build and counts the cases; scripts/test calls it.

Prints a line per test program, the failed cases with the end of their output, and `N passed, N failed` at the end. A
program that crashes, hangs or leaves no result counts as a failure.
"""
import argparse
import concurrent.futures
import functools
import glob
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


# Whole nodes under a sanitizer, unless --only ros asks for all of them, which keep real time: callers from many threads
# against the bus thread, and every way for a node to end.
SANITIZED_ROS_TESTS = ('storm', 'shutdown')


class Program:
    """One test program: how to run it and how to count its cases."""

    def __init__(self, kind, name, command, time_limit=300.0, results=None, environment=None, directory=ROOT):
        self.kind = kind
        self.name = name
        self.command = command
        self.time_limit = time_limit
        self.results = results  # directory of JUnit files; None: a Python unittest or a single check
        self.environment = environment or {}
        self.directory = directory
        self.reports = None  # directory that the sanitizers of its processes write to
        self.shall_be_reported = False  # a probe: a finding is a success, and none is a failure


class Outcome:
    def __init__(self):
        self.passed = 0
        self.failed = []
        self.skipped = []
        self.seconds = 0.0
        self.output = ''


def run(program, logs):
    """Runs one program in a process group of its own, which does not survive it."""
    outcome = Outcome()
    environment = dict(os.environ, **program.environment)
    if program.results:
        shutil.rmtree(program.results, ignore_errors=True)
        os.makedirs(program.results)
    if program.reports:
        shutil.rmtree(program.reports, ignore_errors=True)
        os.makedirs(program.reports)
    log = os.path.join(logs, '%s_%s.log' % (program.kind, program.name))
    start = time.monotonic()
    with open(log, 'w') as stream:
        try:
            process = start_program(program, environment, stream)
        except OSError as error:
            outcome.failed.append('%s (%s)' % (program.name, error))
            return outcome
        try:
            status = process.wait(program.time_limit)
        except subprocess.TimeoutExpired:
            status = 'over %.0f s' % program.time_limit
        except BaseException:
            end_group(process)
            raise
        end_group(process)
    outcome.seconds = time.monotonic() - start
    with open(log, errors='replace') as stream:
        outcome.output = stream.read()
    count(program, status, outcome)
    judge_reports(program, outcome)
    return outcome


def start_program(program, environment, stream):
    return subprocess.Popen(program.command, cwd=program.directory, env=environment, stdin=subprocess.DEVNULL,
                            stdout=stream, stderr=subprocess.STDOUT, start_new_session=True)


def judge_reports(program, outcome):
    """A finding fails the program, whichever of its processes it was in and whatever that made of its exit status."""
    reports = sorted(glob.glob(os.path.join(program.reports, '*'))) if program.reports else []
    if program.shall_be_reported:
        outcome.passed, outcome.failed = (1, []) if reports else (0, ['%s: its error is not reported' % program.name])
        return
    for path in reports:
        outcome.failed.append('%s: sanitizer report %s' % (program.name, path))
        with open(path, errors='replace') as stream:
            outcome.output += '\n' + stream.read()


def end_group(process):
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, number)
            process.wait(5.0)
        except (ProcessLookupError, subprocess.TimeoutExpired):
            pass


def count(program, status, outcome):
    if program.results:
        count_junit(program, outcome)
    elif re.search(r'^Ran \d+ tests? in', outcome.output, re.MULTILINE):
        count_unittest(outcome)
    elif status == 0:
        outcome.skipped = re.findall(r'^not run: (.*)$', outcome.output, re.MULTILINE)
        outcome.passed = 0 if outcome.skipped else 1
    if status != 0 and not outcome.failed:
        outcome.failed.append('%s (exit status %s)' % (program.name, status))
    if status == 0 and not outcome.passed and not outcome.failed and not outcome.skipped:
        outcome.failed.append('%s (ran no test)' % program.name)


def count_junit(program, outcome):
    """Cases of gtest's and rosunit's result files. rostest's own summary repeats them, but knows of crashed nodes."""
    for path in sorted(glob.glob(os.path.join(program.results, '**', '*.xml'), recursive=True)):
        if os.path.basename(path).startswith('rostest-'):
            continue
        try:
            tree = xml.etree.ElementTree.parse(path)
        except xml.etree.ElementTree.ParseError:
            outcome.failed.append('%s (unreadable results)' % program.name)
            continue
        for case in tree.iter('testcase'):
            if case.get('status') == 'notrun':
                continue
            name = '%s.%s' % (case.get('classname', '').split('.')[-1], case.get('name'))
            if case.find('failure') is not None or case.find('error') is not None:
                outcome.failed.append(name)
            else:
                outcome.passed += 1


def count_unittest(outcome):
    total = int(re.search(r'^Ran (\d+) tests? in', outcome.output, re.MULTILINE).group(1))
    outcome.failed = re.findall(r'^(?:FAIL|ERROR): (\S+)', outcome.output, re.MULTILINE)
    outcome.skipped = re.findall(r"\.\.\. skipped ['\"](.*)['\"]$", outcome.output, re.MULTILINE)
    outcome.passed = max(0, total - len(outcome.failed) - len(outcome.skipped))


def report(program, outcome):
    words = ['%d passed' % outcome.passed]
    if outcome.failed:
        words.append('%d failed' % len(outcome.failed))
    words += ['not run: ' + reason for reason in outcome.skipped]
    print('%-6s %-8s %-36s %7.1f s   %s' % ('FAILED' if outcome.failed else 'ok', program.kind, program.name,
                                            outcome.seconds, ', '.join(words)), flush=True)
    if outcome.failed:
        for name in outcome.failed:
            print('         failed: %s' % name)
        for line in outcome.output.splitlines()[-60:]:
            # Without colours and the like.
            print('         | %s' % re.sub(r'\x1b\[[0-9;]*m|[^\x20-\x7e]', '', line))


def unit_test_names():
    """unit/wire/line_test.cpp and system/alive_test.cpp are the programs wire_line_test and system_alive_test."""
    for path in glob.glob(os.path.join(ROOT, 'test', 'unit', '*', '*_test.cpp')) + \
            glob.glob(os.path.join(ROOT, 'test', 'system', '*_test.cpp')):
        folder, name = os.path.split(os.path.splitext(path)[0])
        yield os.path.basename(folder) + '_' + name


def unit_programs(build):
    names = set(unit_test_names())
    for path in sorted(glob.glob(os.path.join(build, 'devel', 'lib', 'inverter_bus', '*_test'))):
        name = os.path.basename(path)
        if name not in names:
            continue  # left over in the build from a test that has moved
        results = os.path.join(build, 'results', name)
        yield Program('unit', name, [path, '--gtest_output=xml:%s/%s.xml' % (results, name)], results=results)


def ros_programs(build):
    for path in sorted(glob.glob(os.path.join(ROOT, 'test', 'integration', '*.test'))):
        name = os.path.splitext(os.path.basename(path))[0]
        results = os.path.join(build, 'results', 'rostest_' + name)
        home = os.path.join(results, 'home')
        yield Program('ros', name, ['rostest', path], time_limit=420.0, results=results,
                      environment={'ROS_TEST_RESULTS_DIR': results, 'ROS_HOME': home, 'ROS_IP': '127.0.0.1'})


def lint_programs(build, whole=False):
    sources = [path for pattern in ('include/**/*.h', 'src/**/*.h', 'src/**/*.cpp', 'test/**/*.h', 'test/**/*.cpp',
                                    'benchmark/**/*.h', 'benchmark/**/*.cpp', 'fuzz/**/*.h', 'fuzz/**/*.cpp')
               for path in sorted(glob.glob(os.path.join(ROOT, pattern), recursive=True))]
    # Other versions format a little differently.
    if shutil.which('clang-format-14'):
        yield Program('lint', 'clang_format', ['clang-format-14', '--dry-run', '-Werror'] + sources)
    if shutil.which('catkin_lint'):
        # It doesn't see targets that a function defines; scripts/ and test/ belong to developers; the two about
        # directories mean catkin's own include directory, which is marked SYSTEM; fuzz/bytes can be built by itself too.
        ignored = ['undefined_target', 'uninstalled_script', 'external_directory', 'external_interface_path',
                   'subproject']
        yield Program('lint', 'catkin_lint', ['catkin_lint', '--offline', '--strict', '-W1'] +
                      [word for name in ignored for word in ('--ignore', name)] + [ROOT])
    if shutil.which('shellcheck'):
        scripts = ['scripts/test', 'scripts/demo', 'scripts/fuzz', 'scripts/benchmark', 'scripts/install_dependencies',
                   'scripts/common.sh', '.ci/run'] + sorted(glob.glob(os.path.join(ROOT, 'findings', '*.sh')))
        yield Program('lint', 'shellcheck', ['shellcheck', '-x'] + scripts)
    yield python_program('lint', 'test/documentation_test.py', build)
    yield python_program('lint', 'test/contract_test.py', build)
    yield python_program('lint', 'test/steady_waits_test.py', build)
    # As many processes as cores; only what differs from the main branch, or all.
    yield Program('lint', 'clang_tidy', [sys.executable, os.path.join(ROOT, 'test', 'tidy.py'), '--build', build] +
                  (['--whole'] if whole else []), time_limit=3600.0)
    yield python_program('lint', 'test/tidy_test.py', build)
    yield Program('lint', 'sizes', [sys.executable, os.path.join(ROOT, 'test', 'sizes.py')])
    yield python_program('lint', 'test/sizes_test.py', build)
    yield Program('lint', 'mutations_fit', [sys.executable, os.path.join(ROOT, 'scripts', 'mutate'), '--check'])


def python_program(kind, path, build, time_limit=120.0):
    name = os.path.splitext(os.path.basename(path))[0]
    return Program(kind, name, [sys.executable, os.path.join(ROOT, path), '-v'], time_limit,
                   environment={'INVERTER_BUS_BUILD': build})


def bus_fuzz_programs(build, seeds, processes=2):
    """The whole bus in virtual time (fuzz/bus): always the same seeds."""
    program = os.path.join(build, 'devel', 'lib', 'inverter_bus', 'bus_fuzz')
    each = seeds // processes
    for first in range(1, seeds + 1, each):
        yield Program('fuzz', 'bus_%d_to_%d' % (first, first + each - 1),
                      [program, '--seed', str(first), '--seeds', str(each)], time_limit=600.0)


def fuzz_programs(build, seeds=1000):
    """bus_fuzz, and a short run of every fuzz target (fuzz/bytes): its corpus, and always the same changes of it."""
    yield from bus_fuzz_programs(build, seeds)
    for corpus in sorted(glob.glob(os.path.join(ROOT, 'fuzz', 'bytes', 'corpus', '*'))):
        name = os.path.basename(corpus)
        program = os.path.join(build, 'fuzz', 'fuzz_' + name)
        longest = 2000 if os.path.exists(os.path.join(ROOT, 'fuzz', 'bytes', name + '.dict')) else 256
        yield Program('fuzz', name, [program, '-runs=20000', '-max_total_time=4', '-max_len=%d' % longest, corpus],
                      directory=os.path.join(build, 'fuzz'))


def other_programs(build):
    yield python_program('install', 'test/install_test.py', build)
    yield python_program('programs', 'test/command_line_test.py', build)
    yield python_program('programs', 'test/benchmark_test.py', build)
    for path in sorted(glob.glob(os.path.join(ROOT, 'test', 'peers', '*_test.py'))):
        yield python_program('peer', os.path.relpath(path, ROOT), build, 180.0)
    yield python_program('demo', 'test/demo_terminal_test.py', build, 600.0)
    yield Program('demo', 'demo_once', ['bash', os.path.join(ROOT, 'scripts', 'demo'), '--once', '--build', build],
                  time_limit=420.0)


def sanitizer_options(sanitizer, reports):
    """Every process writes its findings to a file of its own: what a node says to its log, nobody would see.

    The undefined behaviour sanitizer of GCC has no files beside the address sanitizer: it aborts, and that one reports it.
    """
    suppressions = os.path.join(ROOT, 'test', 'thread_sanitizer.supp')
    options = {'address': {'ASAN_OPTIONS': 'detect_leaks=1:detect_stack_use_after_return=1:handle_abort=1',
                           'LSAN_OPTIONS': 'detect_leaks=1',
                           'UBSAN_OPTIONS': 'print_stacktrace=1:halt_on_error=1:abort_on_error=1'},
               'thread': {'TSAN_OPTIONS': "second_deadlock_stack=1:suppressions='%s'" % suppressions}}[sanitizer]
    # The same file for all: they share their settings, and the last one's count.
    log_path = ":log_path='%s'" % os.path.join(reports, 'report')
    return {name: text + log_path for name, text in options.items()}


def sanitized(programs, sanitizer, build):
    for program in programs:
        program.reports = os.path.join(build, 'sanitizer_reports', '%s_%s' % (program.kind, program.name))
        program.environment.update(sanitizer_options(sanitizer, program.reports))
        program.time_limit *= 3.0
        yield program


def probe_programs(build):
    """Programs with an error each: a build whose sanitizer finds nothing, or whose findings get lost, does not pass."""
    probe = os.path.join(build, 'devel', 'lib', 'inverter_bus', 'sanitizer_probe')
    errors = subprocess.run([probe], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout.split()
    for error in errors:
        # By way of a shell that hides its exit status, as the harness of the integration tests may.
        program = Program('probe', error, ['sh', '-c', '"$1" "$2"; true', 'sh', probe, error])
        program.shall_be_reported = True
        yield program


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--build', required=True)
    parser.add_argument('--only', choices=['unit', 'fuzz', 'ros', 'lint'])
    parser.add_argument('--match', default='')
    parser.add_argument('--whole', action='store_true', help='clang-tidy over all, not only over what differs from main')
    parser.add_argument('--sanitize', choices=['address', 'thread'])
    arguments = parser.parse_args()
    build = os.path.abspath(arguments.build)

    groups = {'lint': functools.partial(lint_programs, whole=arguments.whole), 'unit': unit_programs, 'fuzz': fuzz_programs, 'ros': ros_programs,
              'other': other_programs}
    if arguments.only:
        groups = {arguments.only: groups[arguments.only]}
    elif arguments.sanitize:
        groups = {'unit': unit_programs, 'fuzz': functools.partial(fuzz_programs, seeds=100),
                  'ros': lambda build: [program for program in ros_programs(build)
                                        if program.name in SANITIZED_ROS_TESTS]}
        if arguments.sanitize == 'thread':
            del groups['fuzz']  # they have one thread
    if arguments.sanitize:
        groups = {'probe': probe_programs, **groups}

    logs = os.path.join(build, 'test_logs')
    os.makedirs(logs, exist_ok=True)
    passed, failed, start = 0, 0, time.monotonic()
    for group, programs in groups.items():
        if arguments.sanitize:
            chosen = list(sanitized(programs(build), arguments.sanitize, build))
        else:
            chosen = list(programs(build))
        chosen = [program for program in chosen if arguments.match in program.name or program.shall_be_reported]
        # Whole nodes on a simulated line keep real time and mostly wait: two at a time. Peers share names and ports.
        cores = os.cpu_count() or 1
        workers = {'unit': cores, 'lint': cores, 'fuzz': cores, 'ros': min(2, cores)}.get(group, 1)
        with concurrent.futures.ThreadPoolExecutor(workers) as pool:
            for program, outcome in zip(chosen, pool.map(lambda program: run(program, logs), chosen)):
                report(program, outcome)
                passed += outcome.passed
                failed += len(outcome.failed)
    print('All of it took %.0f s; the output of each program is in %s' % (time.monotonic() - start, logs))
    print('%d passed, %d failed' % (passed, failed))
    return 0 if failed == 0 and passed > 0 else 1


if __name__ == '__main__':
    sys.exit(main())
