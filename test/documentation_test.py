#!/usr/bin/env python3
"""Compares what README and docs say with the code: names, types, defaults, ranges, constants, bounds, and test names."""
import collections
import glob
import os
import re
import shlex
import subprocess
import unittest

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# More than this and nobody reads it to the end: what is left over goes into a page of docs/. Counted as `wc -w` does.
README_WORDS = 2500

# What a user reads, README first.
PAGES = ['README.md'] + sorted(os.path.relpath(path, ROOT) for path in glob.glob(os.path.join(ROOT, 'docs', '*.md')))
# All that links to each other.
LINKED = PAGES + ['CONTRIBUTING.md', os.path.join('findings', 'README.md')]


def read(*parts):
    with open(os.path.join(ROOT, *parts), encoding='utf-8') as stream:
        return stream.read()


def code(pattern):
    return '\n'.join(read(path) for path in sorted(glob.glob(os.path.join(ROOT, pattern), recursive=True)))


def table(text, heading):
    """The first table below a heading, as a list of rows; back-ticks taken off."""
    section = re.split(r'^#+ ', text.split('\n%s\n' % heading, 1)[1], maxsplit=1, flags=re.MULTILINE)[0]
    lines = [line for line in section.splitlines() if line.startswith('|')]
    rows = [[cell.strip().strip('`') for cell in re.split(r'(?<!\\)\|', line)[1:-1]] for line in lines]
    return rows[2:]


def members(source, struct):
    """Members of a C++ struct: name to (type, default)."""
    body = re.search(r'struct %s\n\{\n(.*?)\n\};' % struct, source, re.DOTALL).group(1)
    found = re.findall(r'^  ([\w:<>]+) (\w+)(?:\s*=\s*([^;]+)|\{([^;]*)\})?;', body, re.MULTILINE)
    return {name: (kind, (value or braces).strip()) for kind, name, value, braces in found}


def commands(program, *words):
    """Command lines of README and docs that begin so, as a shell splits them."""
    found = []
    for path in PAGES:
        # A line of a block, or what stands between back-ticks.
        for line in re.findall(r'^(%s .*)$|`(%s [^`]*)`' % (program, program), read(path), re.MULTILINE):
            arguments = shlex.split(' '.join(line).strip(), comments=True)
            if arguments[1:1 + len(words)] == list(words):
                found.append(arguments)
    return found


def without_code(text):
    """A page without its blocks of code: a # in them is a comment, and brackets are no links."""
    return re.sub(r'^ *```.*?^ *```', '', text, flags=re.MULTILINE | re.DOTALL)


def anchors(text):
    """What a link may name in a page: its headings, as GitHub turns them into anchors, and anchors of its own."""
    found, counts = set(re.findall(r'<a id="([\w-]+)"></a>', text)), collections.Counter()
    for heading in re.findall(r'^#+ (.*)$', without_code(text), re.MULTILINE):
        slug = re.sub(r'[^\w\- ]', '', heading.strip().lower()).replace(' ', '-')
        found.add('%s-%d' % (slug, counts[slug]) if counts[slug] else slug)
        counts[slug] += 1
    return found


def links(text):
    """Targets of the links and pictures of a page that lead to files, as (file, anchor); file '': the page itself."""
    prose = re.sub(r'`([^`\n]|\n(?!\n))*`', '', without_code(text))
    targets = re.findall(r'\]\(([^)\s]+)\)', prose)
    return [target.partition('#')[::2] for target in targets if not re.match(r'\w+:', target)]


def fields(path):
    """Fields of a message, or of a service's request: name to type."""
    lines = read(*path).split('\n---')[0].splitlines()
    return {match.group(2): match.group(1) for match in
            (re.match(r'(\w+(?:\[\])?) (\w+)\s*(?:#.*)?$', line) for line in lines) if match}


ACCEPTED = {'string': str, 'bool': bool, 'uint8': int, 'float64': (int, float)}


TYPES = {'std::string': 'string', 'double': 'double', 'int': 'int', 'unsigned': 'int', 'bool': 'bool',
         'std::uint8_t': 'int', 'std::optional<double>': 'double', 'std::vector<int>': 'list of int'}


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.readme = read('README.md')
        cls.scan_list = read('docs', 'scan_list_files.md')
        cls.configuration = code('src/bus/configuration/*.cpp')
        header = read('include/inverter_bus/bus/configuration.h')
        cls.bus = members(header, 'BusConfig')
        cls.bus.update(members(read('include/inverter_bus/wire/serial_port.h'), 'SerialSettings'))
        cls.entry = members(header, 'InverterConfig')

    def listed(self, name):
        """Keys that the code accepts, from its own list."""
        function = re.search(r'Keys& %s\(\)\n\{.*?Keys KEYS\{(.*?)\};' % name, self.configuration, re.DOTALL)
        constant = re.search(r'%s\{(.*?)\};' % name, self.configuration, re.DOTALL)
        body = (function or constant).group(1)
        return re.findall(r'"(\w+)"', body)

    def testBusParametersAreThoseOfTheCode(self):
        documented = [row[0] for row in table(self.scan_list, '### The bus')]
        self.assertEqual(documented, self.listed('busKeys'))

    def testEntryParametersAreThoseOfTheCode(self):
        documented = [row[0] for row in table(self.scan_list, '### An entry of the scan list')]
        self.assertEqual(documented, ['name', 'node'] + self.listed('sharedKeys'))

    def assertRows(self, rows, known):
        for name, kind, default, _range, _meaning in rows:
            if name not in known:
                continue
            cpp_type, cpp_default = known[name]
            if cpp_type in TYPES:
                self.assertEqual(kind, TYPES[cpp_type], name)
            if default.startswith(('required', 'none', 'the ')) or cpp_type not in TYPES:
                continue
            self.assertEqual(default.strip('"'), cpp_default.strip('"').strip('{} ') if kind != 'list of int' else
                             '[%s]' % cpp_default.strip('{} '), name)

    def testTypesAndDefaultsAreThoseOfTheCode(self):
        self.assertRows(table(self.scan_list, '### The bus'), self.bus)
        self.assertRows(table(self.scan_list, '### An entry of the scan list'), self.entry)

    def testChoicesAndTheirDefaultsAreThoseOfTheCode(self):
        rows = {row[0]: row for row in table(self.scan_list, '### The bus')}
        choices = re.findall(r'choice\("(\w+)", \{([^}]*)\},\s*"(\w+)"\)', self.configuration)
        self.assertEqual(sorted(name for name, _, _ in choices), ['parameter_access', 'protocol', 'rs485'])
        for name, values, default in choices:
            self.assertEqual(rows[name][2], default, name)
            self.assertEqual(re.findall(r'\w+', rows[name][3]), re.findall(r'\w+', values), name)

    def testRangesAreThoseOfTheCode(self):
        rows = {row[0]: row[3] for heading in ('### The bus', '### An entry of the scan list')
                for row in table(self.scan_list, heading)}
        integers = re.findall(r'integer\("(\w+)", (\d+), (\d+), bus\.\w+\)', self.configuration)
        self.assertEqual(len(integers), 4)
        for name, low, high in integers:
            self.assertEqual(rows[name], '%s to %s' % (low, high), name)
        ranges = re.findall(r'(?:number|readRating)\((?:entry, )?"(\w+)",\s*\{ ([\d.]+), ([\d.]+), (true|false), "(\w+)" \}',
                            self.configuration)
        self.assertGreater(len(ranges), 4)
        for name, low, high, without_low, unit in ranges:
            if unit in ('A', 'V'):
                expected = 'above %g, %s' % (float(low), unit)
            elif without_low == 'true':
                expected = 'above %g, to %g %s' % (float(low), float(high), unit)
            else:
                expected = '%g to %g %s' % (float(low), float(high), unit)
            self.assertEqual(rows[name], expected, name)

    def testTheShortTablesOfTheReadmeSayWhatTheLongOnesSay(self):
        section = self.readme.split('\n## Parameters\n', 1)[1].split('\n## ', 1)[0]
        bus, entry = re.split(r'\n\n(?=\| key of an entry)', section)
        for short, heading in ((bus, '### The bus'), (entry, '### An entry of the scan list')):
            defaults = {row[0]: row[2] for row in table(self.scan_list, heading)}
            rows = [[cell.strip() for cell in re.split(r'(?<!\\)\|', line)[1:-1]]
                    for line in short.splitlines() if line.startswith('| `')]
            self.assertGreater(len(rows), 5)
            for names, default, _ in rows:
                given = [value.strip('`') for value in default.split(', ')]
                self.assertEqual([defaults[name] for name in re.findall(r'`(\w+)`', names)], given, names)

    def testReservedNamesAreThoseOfTheCode(self):
        rows = {row[0]: row[3] for row in table(self.scan_list, '### An entry of the scan list')}
        self.assertEqual(re.findall(r'`(\w+)`', rows['name'] + '`')[1:], self.listed('RESERVED_NAMES'))

    def testTopicsAreThoseOfTheCode(self):
        ros = code('src/ros/*.cpp')
        found = set()
        for kind, name in re.findall(r'node\.advertise<(\w+)>\(\s*(?:inverter\.name \+ )?"/?(\w+)"', ros):
            found.add((name, 'published', 'inverter_bus/' + kind))
        for kind, name in re.findall(r'subscribe<([\w:]+)>\(\s*node, (?:name \+ )?"/?(\w+)"', ros):
            found.add((name, 'subscribed', kind.replace('::', '/') if '::' in kind else 'inverter_bus/' + kind))
        found.add(('diagnostics', 'published', 'diagnostic_msgs/DiagnosticArray'))
        documented = {(name.split('/')[-1].lstrip('~'), direction.split(',')[0], kind)
                      for name, direction, kind, _ in table(self.readme, '## Topics')}
        self.assertEqual(documented, found)

    def testServicesAreThoseOfTheCode(self):
        services = code('src/ros/services.cpp')
        found = set()
        for kind, own, name in re.findall(r'advertise<([\w:]+)>\(\s*node, (name \+ )?"(\w+)"', services):
            kind = kind.replace('::', '/') if '::' in kind else 'inverter_bus/' + kind
            found.add(('~<inverter>/' + name if own else '~' + name, kind))
        documented = {(name, kind) for name, kind, _, _ in table(self.readme, '## Services')}
        self.assertEqual(documented, found)

    def testBoundsOfServicesAreThoseOfTheCode(self):
        bounds = members(read('include/inverter_bus/bus/types.h'), 'ServiceBounds')
        for name, _kind, bound, _ in table(self.readme, '## Services'):
            service = name.split('/')[-1].lstrip('~')
            if service != 'dump_trace':
                self.assertEqual(bound, '%g s' % float(bounds[service][1]), name)

    def testErrorIdsAreThoseOfMessageAndCode(self):
        message = {name: int(value) for name, value in
                   re.findall(r'^uint16 (ERROR_\w+)=(\d+)', read('msg', 'InverterStatus.msg'), re.MULTILINE)}
        source = read('include/inverter_bus/bus/types.h') + read('include/inverter_bus/wire/request.h')
        constants = {name: int(value, 16) for name, value in
                     re.findall(r'constexpr std::uint16_t (ERROR_\w+) = (0x[0-9A-F]+);', source)}
        documented = {name: int(value, 16) for value, name, _ in table(self.readme, '## Error ids') if name != '-'}
        self.assertEqual(message, constants)
        self.assertEqual(documented, constants)

    def testTheFirstScanListUsesKnownKeys(self):
        block = re.search(r'## A first scan list\n\n```yaml\n(.*?)```', self.readme, re.DOTALL).group(1)
        parameters = yaml.safe_load(block)
        self.assertLessEqual(set(parameters), set(self.listed('busKeys')))
        for entry in parameters['scan_list'] + [parameters['defaults']]:
            self.assertLessEqual(set(entry), set(['name', 'node'] + self.listed('sharedKeys')))

    def testServiceCallsAreAcceptedAsTyped(self):
        kinds = {row[0].split('/')[-1].lstrip('~'): row[1] for row in table(self.readme, '## Services')}
        calls = commands('rosservice', 'call')
        self.assertGreater(len(calls), 4)
        for call in calls:
            self.assertEqual(len(call), 4, 'one argument in quotes, also for a service that needs none: %s' % call)
            package, kind = kinds[call[2].split('/')[-1]].split('/')
            request = fields(('srv', kind + '.srv')) if package == 'inverter_bus' else {}
            arguments = yaml.safe_load(call[3])
            self.assertIsInstance(arguments, dict, call)
            for name, given in arguments.items():
                self.assertIn(name, request, call)
                self.assertIsInstance(given, ACCEPTED[request[name]], call)

    def testPublishedMessagesAreAcceptedAsTyped(self):
        lines = commands('rostopic', 'pub')
        self.assertTrue(any('-- -' in ' '.join(line) for line in lines), 'a negative velocity')
        for line in lines:
            words = line[2:]
            behind = words.index('--') if '--' in words else len(words)
            for option in (word for word in words[:behind] if word.startswith('-')):
                self.assertIn(option, ('-r', '-1'), 'rostopic takes it for an option: %s' % line)
            self.assertIsInstance(yaml.safe_load(words[-1]), float, line)

    def testProfilesAreThoseOfTheRepository(self):
        section = self.readme.split('\n## ')[0]
        documented = re.findall(r'^\|[^|]+\| `(\w+)` \|', section, re.MULTILINE)
        files = [os.path.splitext(os.path.basename(path))[0]
                 for path in glob.glob(os.path.join(ROOT, 'config', 'drives', '*.yaml'))]
        self.assertEqual(sorted(documented), sorted(files))


class Documents(unittest.TestCase):
    def testTheReadmeIsShort(self):
        self.assertLessEqual(len(read('README.md').split()), README_WORDS)

    def testLinksLeadSomewhere(self):
        for page in LINKED:
            for name, anchor in links(read(page)):
                path = os.path.normpath(os.path.join(os.path.dirname(page), name)) if name else page
                where = '%s: %s#%s' % (page, name, anchor)
                self.assertFalse(path.startswith('..') or os.path.isabs(path), where)
                self.assertTrue(os.path.exists(os.path.join(ROOT, path)), where)
                if anchor:
                    self.assertIn(anchor, anchors(read(path)), where)

    def testEveryPageIsInTheIndex(self):
        listed = [os.path.join('docs', name) for name, _ in links(read('docs', 'README.md'))]
        for page in PAGES:
            if os.path.basename(page) != 'README.md':
                self.assertIn(page, listed)

    def testThePictureShowsWhatItsSourceSays(self):
        picture = read('docs', 'data_flow.svg')
        words = re.sub(r'\s+', ' ', ' '.join(re.findall(r'<text[^>]*>([^<]*)</text>', picture)))
        words = words.replace('&lt;', '<').replace('&gt;', '>').replace('&#160;', ' ').replace('&#45;', '-')
        for label in re.findall(r'label="([^"]*)"', read('docs', 'data_flow.dot')):
            for line in re.split(r'\\[nl]', label):
                if line.strip():
                    self.assertIn(' '.join(line.split()), ' '.join(words.split()))

    def testKnownBitsFollowTheFieldsOfTheMessage(self):
        message = read('msg', 'InverterStatus.msg')
        bits = re.findall(r'^uint32 KNOWN_(\w+)=(\d+)', message, re.MULTILINE)
        self.assertEqual([int(value) for _, value in bits], [1 << n for n in range(len(bits))])
        fields = re.findall(r'^\w+ (\w+)$', message, re.MULTILINE)
        positions = [fields.index(name.lower()) for name, _ in bits]
        self.assertEqual(positions, sorted(positions))

    def testSafetyRulesNameTestsThatExist(self):
        tests = code('test/unit/*/*.cpp') + code('test/system/*.cpp') + code('test/integration/*.py') + code('test/*.py') + code('test/peers/*.py')
        for name in re.findall(r'`(\w+)\.(\w+)`', read('docs', 'safety_rules.md')):
            suite, case = name
            self.assertRegex(tests, r'(TEST(_F|_P)?\(%s, %s\)|class %s\b)' % (suite, case, suite), name)
            self.assertRegex(tests, r'(TEST(_F|_P)?\(%s, %s\)|def %s\()' % (suite, case, case), name)

    def testEveryRuleOfTheContractHasATest(self):
        rules = [row[0] for row in table(read('docs', 'safety_rules.md'), '## The scheduler')]
        self.assertEqual(rules, ['3.%d' % n for n in range(1, 15)])
        rules = [row[0] for row in table(read('docs', 'safety_rules.md'), '## Safety')]
        self.assertEqual(rules, ['4.%d' % n for n in range(1, 12)])
        for heading in ('## The scheduler', '## Safety'):
            for rule, _, tests in table(read('docs', 'safety_rules.md'), heading):
                self.assertTrue(tests, 'rule %s has no test' % rule)

    def testRulesAndMutationsOfBusFuzzAreThoseOfItsSources(self):
        rows = table(read('docs', 'safety_rules.md'), '## Under any mix of faults')
        named = [name for row in rows for name in re.findall(r'\w+', row[2])]
        self.assertEqual(sorted(named), sorted(os.listdir(os.path.join(ROOT, 'fuzz', 'mutations'))))
        checker = code('fuzz/bus/**/*.cpp')
        for row in rows:
            first = re.split('[;,:]', row[1])[0]
            self.assertIn('"%s' % first, checker, 'rule %s: bus_fuzz prints no "%s"' % (row[0], first))

    def testTheFindingsAreThoseOfTheFolder(self):
        rows = table('\n' + read('findings', 'README.md'), '# Findings')
        named = [re.match(r'\[(\w+)\]\((\w+)\.sh\)$', row[0]).groups() for row in rows]
        scripts = [os.path.basename(path)[:-3] for path in glob.glob(os.path.join(ROOT, 'findings', '*.sh'))]
        self.assertEqual(sorted(named), sorted((name, name) for name in scripts))
        for name in scripts:
            self.assertTrue(os.access(os.path.join(ROOT, 'findings', name + '.sh'), os.X_OK), name)
            text = read('findings', name + '.sh')
            self.assertIn('echo "as seen"', text, name)
            self.assertNotRegex(text, r'inverter_bus', name + ' shows others, not this project')

    def testTheChangelogIsCatkins(self):
        lines = read('CHANGELOG.rst').splitlines()
        self.assertEqual(lines[1], 'Changelog for package inverter_bus')
        self.assertEqual([set(lines[0]), set(lines[2])], [{'^'}, {'^'}])
        self.assertEqual([len(lines[0]), len(lines[2])], [len(lines[1])] * 2)
        self.assertIn('Forthcoming', lines)

    def testLaunchFilesAndScanListsThatAreNamedExist(self):
        for path in LINKED:
            for name in re.findall(r'(?<![\w/])(\w+\.launch)\b', read(path)):
                self.assertTrue(os.path.exists(os.path.join(ROOT, 'launch', name)), '%s: %s' % (path, name))
            for name in re.findall(r'\bconfig/([\w/]+\.yaml)', read(path)):
                self.assertTrue(os.path.exists(os.path.join(ROOT, 'config', name)), '%s: %s' % (path, name))

    def testTheScriptsExplainThemselves(self):
        for script in ('scripts/test', 'scripts/demo'):
            answer = subprocess.run(['bash', os.path.join(ROOT, script), '--help'], stdout=subprocess.PIPE,
                                    universal_newlines=True, check=True)
            self.assertIn(script, answer.stdout)
            self.assertNotIn('#', answer.stdout)


class Architecture(unittest.TestCase):
    """docs/architecture.md names every room and no file that is not there."""

    @classmethod
    def setUpClass(cls):
        cls.text = read('docs/architecture.md')

    def testEveryRoomIsInTheTable(self):
        table = self.text[self.text.index('## Rooms'):self.text.index('## Threads')]
        rooms = {cell for row in re.findall(r'^\| (`[^|]*`) \|', table, re.MULTILINE) for cell in re.findall(r'`([^`]+)`', row)}
        folders = {os.path.relpath(path, os.path.join(ROOT, 'src')) for pattern in ('*', os.path.join('*', '*'))
                   for path in glob.glob(os.path.join(ROOT, 'src', pattern)) if os.path.isdir(path)}
        inside = {folder for folder in folders if os.path.dirname(folder) in ('simulation',)}
        containers = {'wire'}
        self.assertEqual(rooms, folders - inside - containers)

    def testEveryPlaceToLookIsThere(self):
        table = self.text[self.text.index('## Where to look'):]
        places = [cell for row in re.findall(r'^\| [^|`]* \| (.*) \|$', table, re.MULTILINE)
                  for cell in re.findall(r'`([\w/.<>]+/[\w/.<>]+)`', row)]
        self.assertGreater(len(places), 20)
        for place in places:
            with self.subTest(place=place):
                base = place.replace('<family>', '*')
                found = [path for start in ('', 'src') for end in ('', '.h', '.cpp', '*.cpp')
                         for path in glob.glob(os.path.join(ROOT, start, base + end))]
                self.assertTrue(found, place + ' is not there')


if __name__ == '__main__':
    unittest.main()
