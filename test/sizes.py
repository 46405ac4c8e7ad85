#!/usr/bin/env python3
"""Holds the sizes of functions, classes and files of src/, include/ and fuzz/bus/ below their limits.

    test/sizes.py           what is too large, as FILE:LINE: TEXT, one a line; exit status 1 where there is any
    test/sizes.py --all     the largest of each kind instead

Limits: a function 60 lines (from the line of its name to its last brace), a class 25 methods and 12 data members, a file
500 lines, in the room bus and in fuzz/bus 400. Constructors, destructors, assignment operators, friends and what is static constant data
don't count; a class without private members is data and has no limit. What may be larger stands in
test/size_exceptions.txt, with a number that it must not exceed and that must not be far above the truth: exceptions only
shrink.

universal-ctags reads the sources: it needs neither a build nor an include path, and sizes_test.py holds it to what the
C++ of this package looks like.
"""
import argparse
import collections
import glob
import json
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
EXCEPTIONS = os.path.join('test', 'size_exceptions.txt')
LIMITS = {'function': 60, 'methods': 25, 'members': 12, 'file': 500}
BUS_FILE_LIMIT = 400
# An exception's number may exceed the truth by this factor: an edit should not need one here each time.
SLACK = 1.05

Size = collections.namedtuple('Size', 'kind name number limit path line')
# kind: function, methods or members (of a class), file; name: qualified, without anonymous namespaces; a file's path
Exemption = collections.namedtuple('Exemption', 'kind number name reason line')


def missing():
    """Why nothing can be checked here; empty where it can."""
    try:
        done = subprocess.run(['ctags', '--list-features'], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              universal_newlines=True)
    except OSError:
        return 'universal-ctags is not installed'
    return '' if re.search(r'^json\b', done.stdout, re.MULTILINE) else 'ctags is not universal-ctags with JSON'


def sources(root):
    found = [path for pattern in ('src/**/*.cpp', 'src/**/*.h', 'include/**/*.h', 'fuzz/bus/**/*.cpp',
                                     'fuzz/bus/**/*.h')
             for path in glob.glob(os.path.join(root, pattern), recursive=True)]
    return sorted(os.path.relpath(path, root) for path in found)


def parse(root, paths):
    """ctags' entries for the files, in order, as dictionaries."""
    command = ['ctags', '--options=NONE', '--output-format=json', '--languages=C++', '--langmap=C++:.cpp.h',
               '--kinds-C++=pcsufm', '--sort=no', '--fields=+neaZ', '--fields-C++=+{properties}', '-L', '-', '-o', '-']
    done = subprocess.run(command, cwd=root, input='\n'.join(paths), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, check=True)
    return [entry for entry in map(json.loads, done.stdout.splitlines()) if entry.get('_type') == 'tag']


def qualified(tag):
    """inverter_bus::bus::(anonymous)::Job -> bus::Job: as short as it is unique enough for a list of exceptions."""
    parts = [part for part in (tag.get('scope', '') + '::' + tag['name']).split('::') if part and '__anon' not in part]
    return '::'.join(parts[1:] if parts[0] == 'inverter_bus' and len(parts) > 1 else parts)


def owned(record, tags):
    """What a class declares itself: not what its nested classes do, nor another specialization of its name."""
    scope = (record.get('scope', '') + '::' if record.get('scope') else '') + record['name']
    return [tag for tag in tags if tag.get('scope') == scope and tag['path'] == record['path'] and
            record['line'] <= tag['line'] <= record['end']]


def is_method(tag, record):
    return (tag['kind'] in ('prototype', 'function') and '__anon' not in tag['name'] and  # a lambda's name
            tag['name'] != record['name'] and not tag['name'].startswith('~') and
            not re.match(r'operator\s*=$', tag['name']))


def is_data_member(tag):
    return tag['kind'] == 'member' and 'static' not in tag.get('properties', '').split(',')


def class_sizes(record, tags):
    mine = owned(record, tags)
    if not any(tag.get('access') in ('private', 'protected') for tag in mine):
        return  # data
    for kind, number in (('methods', sum(is_method(tag, record) for tag in mine)),
                         ('members', sum(map(is_data_member, mine)))):
        yield Size(kind, qualified(record), number, LIMITS[kind], record['path'], record['line'])


def file_limit(path):
    return BUS_FILE_LIMIT if re.match(r'(src|include/inverter_bus|fuzz)/bus/', path) else LIMITS['file']


def measure(root, paths):
    """Every function, class and file with its size."""
    by_file = collections.defaultdict(list)
    for tag in parse(root, paths):
        by_file[tag['path']].append(tag)
    for path in paths:
        with open(os.path.join(root, path), encoding='utf-8') as stream:
            lines = sum(1 for line in stream)
        yield Size('file', path, lines, file_limit(path), path, lines)
        for tag in by_file[path]:
            if tag['kind'] == 'function' and '__anon' not in tag['name']:
                yield Size('function', qualified(tag), tag['end'] - tag['line'] + 1, LIMITS['function'], path, tag['line'])
            elif tag['kind'] in ('class', 'struct'):
                yield from class_sizes(tag, by_file[path])


def read_exemptions(text):
    """The exemptions of a list, and what is wrong with its lines as (line, text)."""
    exemptions, problems = {}, []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith('#'):
            continue
        match = re.match(r'(function|methods|members|file)\s+(\d+)\s+(\S+)\s+(\S.*)$', line)
        if not match:
            problems.append((number, 'not KIND NUMBER NAME REASON, with function, methods, members or file as its kind'))
            continue
        kind, size, name, reason = match.groups()
        if (kind, name) in exemptions:
            problems.append((number, '%s %s is listed twice' % (kind, name)))
        exemptions[kind, name] = Exemption(kind, int(size), name, reason, number)
    return exemptions, problems


WORDS = {'function': 'function {name} has {number} lines', 'methods': 'class {name} has {number} methods',
         'members': 'class {name} has {number} data members', 'file': 'the file has {number} lines'}


def judge(sizes, exemptions):
    """What is wrong with the sizes, as (path, line, text). Of overloaded functions the largest counts."""
    problems, largest = [], {}
    for size in sizes:
        key = (size.kind, size.name)
        if key not in largest or largest[key].number < size.number:
            largest[key] = size
        allowed = exemptions[key].number if key in exemptions else size.limit
        if size.number > max(allowed, size.limit):
            text = WORDS[size.kind].format(**size._asdict())
            problems.append((size.path, size.line, '%s, at most %d%s' % (
                text, allowed, ' as an exception' if key in exemptions else '')))
    for key, exemption in sorted(exemptions.items()):
        size = largest.get(key)
        here = (EXCEPTIONS, exemption.line)
        if size is None:
            problems.append(here + ('%s %s: does not exist' % key,))
        elif size.number <= size.limit:
            problems.append(here + ('%s %s: no longer needed, it is down to %d' % (key + (size.number,)),))
        elif exemption.number > size.number * SLACK:
            problems.append(here + ('%s %s: too high, it is down to %d' % (key + (size.number,)),))
    return problems


def check(root=ROOT):
    """Everything that is wrong in a tree, as lines FILE:LINE: TEXT."""
    with open(os.path.join(root, EXCEPTIONS), encoding='utf-8') as stream:
        exemptions, mistakes = read_exemptions(stream.read())
    problems = [(EXCEPTIONS, line, text) for line, text in mistakes]
    problems += judge(measure(root, sources(root)), exemptions)
    return ['%s:%d: %s' % problem for problem in problems]


def show_all():
    sizes = sorted(measure(ROOT, sources(ROOT)), key=lambda size: size.number / size.limit, reverse=True)
    for kind in ('file', 'methods', 'members', 'function'):
        for size in [size for size in sizes if size.kind == kind][:20]:
            print('%-9s %5d of %3d  %s:%d: %s' % (kind, size.number, size.limit, size.path, size.line, size.name))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--all', action='store_true', help='show the largest of each kind instead')
    arguments = parser.parse_args()
    if missing():
        print('not run: ' + missing())
        return 0
    if arguments.all:
        show_all()
        return 0
    problems = check()
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == '__main__':
    sys.exit(main())
