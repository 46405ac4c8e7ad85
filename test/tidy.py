#!/usr/bin/env python3
"""clang-tidy over src/ and include/, with the rules of .clang-tidy; any finding is an error.

    test/tidy.py --build DIR            what differs from the main branch: from the merge base with origin/main or main
                                        to the files as they are, uncommitted ones included
    test/tidy.py --build DIR --whole    all of it; so too without git or such a branch, and where .clang-tidy differs

DIR has compile_commands.json and the generated messages. A header is looked at from one source that includes it. What was
clean, with everything that it includes, is remembered in DIR and not looked at again.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# Each version finds something else; this is Debian 12's.
TIDY = 'clang-tidy-14'
RULES = ('.clang-tidy', 'test/tidy.py')
# Of a finding with all its notes.
LINES_SHOWN = 12


def git(root, *words):
    """Lines that git prints, None where it fails."""
    try:
        done = subprocess.run(('git', '-C', root) + words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              universal_newlines=True)
    except OSError:
        return None
    return done.stdout.splitlines() if done.returncode == 0 else None


def changed_files(root):
    """Files of the tree that differ from the main branch, relative to it; None: that can't be told."""
    for branch in ('origin/main', 'main'):
        base = git(root, 'merge-base', 'HEAD', branch)
        if base:
            changed = git(root, 'diff', '--name-only', '--relative', base[0])
            new = git(root, 'ls-files', '--others', '--exclude-standard')
            return None if changed is None or new is None else sorted(set(changed + new))
    return None


class Sources:
    """The sources that clang-tidy can be given, and the headers of the package that each includes."""

    def __init__(self, root, commands):
        self.root = root
        self.commands = {}  # source, relative to root: how it is compiled
        for entry in commands:
            path = os.path.relpath(os.path.join(entry['directory'], entry['file']), root)
            if path.startswith('src' + os.sep):
                self.commands[path] = entry.get('command') or ' '.join(entry['arguments'])
        self._included = {}
        self._closures = {path: self._closure(path) for path in self.commands}

    def _includes(self, path):
        """Headers of the package that a file names itself."""
        if path not in self._included:
            with open(os.path.join(self.root, path), encoding='utf-8') as stream:
                names = re.findall(r'^\s*#\s*include\s+"([^"]+)"', stream.read(), re.MULTILINE)
            places = [os.path.normpath(os.path.join(folder, name)) for name in names
                      for folder in (os.path.dirname(path), 'src', 'include')]
            self._included[path] = [place for place in places if os.path.isfile(os.path.join(self.root, place))]
        return self._included[path]

    def _closure(self, path):
        found, waiting = {path}, [path]
        while waiting:
            new = [name for name in self._includes(waiting.pop()) if name not in found]
            found.update(new)
            waiting.extend(new)
        return found

    def key(self, source, rules):
        """Changes with everything of the package that clang-tidy's answer depends on."""
        parts = [rules, self.commands[source]]
        for path in sorted(self._closures[source]):
            with open(os.path.join(self.root, path), encoding='utf-8') as stream:
                parts += [path, stream.read()]
        return hashlib.sha256('\0'.join(parts).encode()).hexdigest()

    def choose(self, changed):
        """Sources that show all of the changed files, and the headers that no source includes."""
        chosen = {path for path in changed if path in self.commands}
        lonely = []
        headers = [path for path in changed
                   if re.match(r'(src|include)/.*\.h$', path) and os.path.isfile(os.path.join(self.root, path))]
        for header in headers:
            users = [source for source, closure in self._closures.items() if header in closure]
            if not users:
                lonely.append(header)
            elif not chosen.intersection(users):
                chosen.add(min(users, key=lambda source: self._distance(source, header)))
        return sorted(chosen), lonely

    def _distance(self, source, header):
        """The source of the same name is the nearest, then whatever includes it itself, then the smallest."""
        stem = os.path.splitext(os.path.basename(header))[0]
        return (os.path.basename(source) != stem + '.cpp', header not in self._includes(source),
                len(self._closures[source]), source)


class Memory:
    """What was clean: a source and its key. Forgets sources that are no longer there."""

    def __init__(self, path, sources):
        self._path = path
        try:
            with open(path) as stream:
                self._keys = {source: key for source, key in json.load(stream).items() if source in sources}
        except (OSError, ValueError):
            self._keys = {}

    def knows(self, source, key):
        return self._keys.get(source) == key

    def add(self, source, key):
        self._keys[source] = key
        with open(self._path + '.new', 'w') as stream:
            json.dump(self._keys, stream)
        os.replace(self._path + '.new', self._path)


def look_at(build, source):
    """Exit status and findings of clang-tidy for one source."""
    done = subprocess.run([TIDY, '--quiet', '-p', build, os.path.join(ROOT, source)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    if done.returncode != 0 and not done.stdout:
        return done.returncode, done.stderr
    return done.returncode, done.stdout.replace(ROOT + os.sep, '')


def split(output):
    """The findings in an output, each with its notes."""
    found = re.split(r'^(?=\S[^:\n]*:\d+:\d+: (?:warning|error):)', output, flags=re.MULTILINE)
    return [text for text in found if text.strip()]


def check(build, sources, chosen, rules):
    """Runs clang-tidy and prints what it finds, once; returns how many findings there are."""
    memory = Memory(os.path.join(build, 'tidy_clean.json'), sources.commands)
    keys = {source: sources.key(source, rules) for source in chosen}
    new = [source for source in chosen if not memory.knows(source, keys[source])]
    start, seen = time.monotonic(), set()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for source, (status, output) in zip(new, pool.map(lambda source: look_at(build, source), new)):
            if status == 0:
                memory.add(source, keys[source])
                continue
            for finding in split(output) or ['%s: clang-tidy failed with status %d\n' % (source, status)]:
                if finding not in seen:
                    seen.add(finding)
                    print(''.join(finding.splitlines(True)[:LINES_SHOWN]), end='', flush=True)
    print('clang-tidy: %d files, %d of them unchanged since they were clean; %d findings, %.0f s' %
          (len(chosen), len(chosen) - len(new), len(seen), time.monotonic() - start))
    return len(seen)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--build', required=True, metavar='DIR')
    parser.add_argument('--whole', action='store_true')
    arguments = parser.parse_args()
    if not shutil.which(TIDY):
        print('not run: %s is not installed' % TIDY)
        return 0

    with open(os.path.join(arguments.build, 'compile_commands.json'), encoding='utf-8') as stream:
        sources = Sources(ROOT, json.load(stream))
    changed = None if arguments.whole else changed_files(ROOT)
    if changed is None or set(RULES) & set(changed):
        chosen = sorted(sources.commands)
    else:
        chosen, lonely = sources.choose(changed)
        for header in lonely:
            print('%s: not looked at: no source includes it' % header)
    with open(os.path.join(ROOT, '.clang-tidy'), encoding='utf-8') as stream:
        rules = stream.read()
    version = subprocess.run([TIDY, '--version'], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
    return 1 if check(os.path.abspath(arguments.build), sources, chosen, version + rules) else 0


if __name__ == '__main__':
    sys.exit(main())
