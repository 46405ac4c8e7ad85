#!/usr/bin/env python3
"""Compares docs/contract.md with what cites it (every rule that is cited exists) and with the code (keys and fields)."""
import bisect
import glob
import os
import re
import subprocess
import unittest

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CONTRACT = os.path.join('docs', 'contract.md')
CITING = ['src', 'include', 'fuzz', 'support', 'test', 'docs', 'msg', 'srv', 'README.md', 'CHANGELOG.rst', 'CMakeLists.txt', 'benchmark',
          'cmake', 'config', 'launch', 'scripts']

# Rules of each numbered section. A new rule goes to the end: a number is never given to another rule.
RULES = {3: 14, 4: 11, 8: 18}
SECTIONS = 8

# "3.9", or "2" for a whole section.
NUMBER = r'\d+(?:\.\d+)?'
# "3.6 and 8.1", "8.8 to 8.10, 8.16", "section 2 and rule 3.10".
LIST = r'%s(?:(?:\s*,\s*and\s+|\s*,\s*|\s+and\s+|\s+or\s+|\s+to\s+)(?:rules?\s+|sections?\s+)?%s)*' % (NUMBER, NUMBER)
RULE_NUMBER = r'\d+\.\d+'
RULE_LIST = LIST.replace(NUMBER, RULE_NUMBER)
CITATIONS = [re.compile(pattern, re.IGNORECASE) for pattern in (
    r"\bcontract(?:'s)?,?\s+(?:rules?\s+|sections?\s+)?(%s)" % LIST,
    r'\brules?\s+(%s)' % RULE_LIST,
    r'\b(%s)\s+of\s+the\s+contract\b' % LIST,
)]
# What may stand between two words of a citation that goes on in the next line of a comment.
LINE_BREAK = re.compile(r'[ \t]*\n[ \t]*(?:///?<?|//!|#|\*)?[ \t]*')


def read(*parts):
    with open(os.path.join(ROOT, *parts), encoding='utf-8') as stream:
        return stream.read()


def text_of(path):
    """"" for what is no text, such as the inputs of the fuzz targets."""
    with open(os.path.join(ROOT, path), 'rb') as stream:
        data = stream.read()
    return '' if b'\0' in data else data.decode('utf-8', errors='replace')


def expand(numbers):
    """The rules of a list: "8.8 to 8.10, 8.16" are four."""
    rules = []
    for first, last in re.findall(r'(%s)(?:\s+to\s+(?:rules?\s+)?(%s))?' % (NUMBER, NUMBER), numbers):
        rules.append(first)
        if last and '.' in first and first.split('.')[0] == last.split('.')[0]:
            section, begin = first.split('.')
            rules += ['%s.%d' % (section, rule) for rule in range(int(begin) + 1, int(last.split('.')[1]))]
        if last:
            rules.append(last)
    return rules


def citations(text):
    """(line, rule) of every citation, also one that is broken over two lines of a comment."""
    joined, starts, lines = '', [0], [1]
    position = 0
    for number, match in enumerate(LINE_BREAK.finditer(text), 1):
        joined += text[position:match.start()] + ' '
        starts.append(len(joined))
        lines.append(lines[-1] + match.group().count('\n'))
        position = match.end()
    joined += text[position:]
    found = set()
    for pattern in CITATIONS:
        for match in pattern.finditer(joined):
            line = lines[bisect.bisect_right(starts, match.start()) - 1]
            found.update((line, rule) for rule in expand(match.group(1)))
    return sorted(found)


def citing_files():
    # Only what belongs to the repository: a build directory in the source tree is none of it.
    listed = subprocess.run(['git', '-C', ROOT, 'ls-files', '-co', '--exclude-standard', '--'] + CITING,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True)
    files = listed.stdout.split('\n') if listed.returncode == 0 else [
        os.path.relpath(path, ROOT) for name in CITING
        for path in [os.path.join(ROOT, name)] + glob.glob(os.path.join(ROOT, name, '**'), recursive=True)]
    return sorted(path for path in set(files) if os.path.isfile(os.path.join(ROOT, path)))


def headings(text):
    """(anchor, number, title) of sections and rules; an anchor stands in the line before its heading."""
    return re.findall(r'^(?:<a id="([\w-]+)"></a>\n)?#{2,3} (\d+(?:\.\d+)?)\.? (.*)$', text, re.MULTILINE)


def first_table(heading):
    section = re.split(r'^#+ ', read(CONTRACT).split('\n%s\n' % heading, 1)[1], maxsplit=1, flags=re.MULTILINE)[0]
    lines = [line for line in section.splitlines() if line.startswith('|')]
    return [[cell.strip() for cell in line.split('|')[1:-1]] for line in lines[2:]]


def message_fields(name):
    fields = re.findall(r'^([\w/]+(?:\[\])?) (\w+)$', read('msg', name + '.msg'), re.MULTILINE)
    return [(field, 'std_msgs/Header' if kind == 'Header' else kind) for kind, field in fields]


class Contract(unittest.TestCase):
    def testRulesAreCompleteUniqueAndInOrder(self):
        numbers = [number for _, number, _ in headings(read(CONTRACT))]
        expected = []
        for section in range(1, SECTIONS + 1):
            expected.append(str(section))
            expected += ['%d.%d' % (section, rule) for rule in range(1, RULES.get(section, 0) + 1)]
        self.assertEqual(numbers, expected)

    def testEveryRuleHasItsAnchor(self):
        for anchor, number, title in headings(read(CONTRACT)):
            expected = 'r' + number.replace('.', '-') if '.' in number else 's' + number
            self.assertEqual(anchor, expected, '%s %s' % (number, title))

    def testEveryRuleSaysSomething(self):
        text = read(CONTRACT)
        for number, body in re.findall(r'^### (\d+\.\d+) .*\n((?:(?!#|<a id).*\n)*)', text, re.MULTILINE):
            self.assertGreater(len(body.split()), 2, number)

    def testEveryRuleThatIsCitedExists(self):
        existing = {number for _, number, _ in headings(read(CONTRACT))}
        wrong = ['%s:%d: cites %s, which is not in %s' % (path, line, rule, CONTRACT)
                 for path in citing_files() for line, rule in citations(text_of(path)) if rule not in existing]
        if wrong:
            self.fail('\n'.join(wrong))

    def testRowsOfTheSafetyRulesAreRules(self):
        existing = {number for _, number, _ in headings(read(CONTRACT))}
        for line, text in enumerate(read('docs', 'safety_rules.md').splitlines(), 1):
            row = re.match(r'\| (\d+\.\d+) \|', text)
            if row:
                self.assertIn(row.group(1), existing, 'docs/safety_rules.md:%d' % line)

    def testLinksToARuleBearItsNumber(self):
        for words, target in re.findall(r'\[(\d+\.\d+)\]\(#([\w-]+)\)', read(CONTRACT)):
            self.assertEqual(target, 'r' + words.replace('.', '-'))


class Citations(unittest.TestCase):
    """The search itself: a form that it overlooks would never fail."""

    def found(self, text):
        return [rule for _, rule in citations(text)]

    def testEveryFormIsFound(self):
        for text, rules in (
                ('// Rule 3.14: the lowest class', ['3.14']),
                ('// rules 4.1 and 4.8', ['4.1', '4.8']),
                ('// Contract, 8.9.', ['8.9']),
                ('// (contract, 3.6 and 8.1)', ['3.6', '8.1']),
                ('// Contract, rules 3.1 to 3.3', ['3.1', '3.2', '3.3']),
                ('// (contract, 8.8 to 8.10, 8.16)', ['8.8', '8.9', '8.10', '8.16']),
                ('// contract, section 2: the order', ['2']),
                ('// (contract, sections 3.8, 3.12, 4.1 and 4.5)', ['3.8', '3.12', '4.1', '4.5']),
                ('// (contract, section 2 and rule 3.10)', ['2', '3.10']),
                ("// of the contract's section 4 on", ['4']),
                ('// section 3 of the contract', ['3']),
                ('// Rule 4.8, and 8.6 of the contract.', ['4.8', '8.6'])):
            self.assertEqual(sorted(self.found(text)), sorted(rules), text)

    def testACitationMayGoOnInTheNextLine(self):
        self.assertEqual(citations('int a;\n/// An order (contract,\n/// section 2).\n'), [(2, '2')])
        self.assertEqual(citations('# Whatever is\n# barred (rule\n#   3.9)\n'), [(2, '3.9')])

    def testOtherNumbersAreNone(self):
        for text in ('// V1.1b3, section 7', '// 3.5 characters', '// contract\n  int a = 3;', '// rule 3 of this page',
                     '// version 8.99', "// the contract's error id"):
            self.assertEqual(self.found(text), [], text)

    def testAWrongOneIsFoundWithItsLine(self):
        self.assertEqual(citations('\n\n// rule ' + '3.99\n'), [(3, '3.99')])


class Code(unittest.TestCase):
    """What the contract names is what the code has; what it marks (planned), the code does not have."""

    @classmethod
    def setUpClass(cls):
        cls.block = re.search(r'### Parameters\n.*?```yaml\n(.*?)```', read(CONTRACT), re.DOTALL).group(1)
        cls.parameters = yaml.safe_load(cls.block)
        cls.planned = re.findall(r'^[ -]*(\w+):.*\(planned\)$', cls.block, re.MULTILINE)
        cls.keys = read('src', 'bus', 'configuration', 'configuration_keys.cpp')

    def listed(self, function):
        body = re.search(r'Keys& %s\(\)\n\{.*?Keys KEYS\{(.*?)\};' % function, self.keys, re.DOTALL).group(1)
        return set(re.findall(r'"(\w+)"', body))

    def built(self, keys):
        return set(keys) - set(self.planned)

    def testKeysAreThoseOfTheCode(self):
        self.assertEqual(self.built(self.parameters), self.listed('busKeys'))
        self.assertEqual(self.built(self.parameters['scan_list'][0]) - {'name', 'node'}, self.listed('sharedKeys'))

    def testPlannedKeysAreThoseThatTheNodeRefusesAsLaterOnes(self):
        self.assertEqual(set(self.planned), self.listed('laterKeys'))

    def testFieldsAreThoseOfTheMessages(self):
        for name in ('InverterStatus', 'BusStatus'):
            rows = [(field.strip('`'), kind.strip('`')) for field, kind, _ in first_table('### ' + name)
                    if '(planned)' not in field]
            self.assertEqual(rows, message_fields(name), name)

    def testPlannedFieldsAreNotThereYet(self):
        planned = [field.split('`')[1] for field, _, _ in first_table('### InverterStatus') if '(planned)' in field]
        self.assertFalse(set(planned) & {field for field, _ in message_fields('InverterStatus')})


if __name__ == '__main__':
    unittest.main()
