#!/usr/bin/env python3
"""One file, one meaning: rosparam (PyYAML) and the package's reader, side by side over tricky scalars and documents.

What our reader takes must be exactly what roslaunch would put onto the parameter server. It may refuse more (what hides a
mistake: octal numbers, duplicate keys), and each such refusal is listed here.
"""
import datetime
import json
import math
import os
import subprocess
import tempfile
import unittest
import xmlrpc.client

import rosparam

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ.get('INVERTER_BUS_BUILD', os.path.join(ROOT, 'build', 'test'))
PROBE = os.path.join(BUILD, 'devel', 'lib', 'inverter_bus', 'yaml_probe')

SCALARS = '''
1e2 5e-3 1E5 1e+2 1.0e2 1.0e+2 1.5e3 12e03 1.e+3 .5e+1 685.230_15e+03 0.e+1 1.0e+999 -1.0e+999 1.0e-999
08 09 08.5 09.5 0o10 0 -0 +0 +5 -5 1_0 1__0 _1 1_ 0x01 0x1F 0X1F -0x1f 0x1_0 0xg 0b101 0b 0b2 0b1_0
.5 5. +.5 -.5 -0.5 . -. ._5 _.5 1._5 1_0.2_5 1.2.3 1,000 1,5 0,5
1:60 0:0 01:30 :1 -:1 12:34:56:78a
yes Yes YES yES no No NO nO on On ON oN off Off OFF true True TRUE tRUE false False FALSE y n Y N t f none None
nULL nil undefined
.inf .Inf .INF .iNF -.inf +.inf inf Infinity .nan .NaN .NAN .Nan nan -.nan
rad(2*pi) rad(pi) rad(pi/2) rad(-pi/2) rad(1.5) rad(.5) rad(5.) rad(2**3) rad(-2**2) rad(2**-1) rad(1e3) rad(1+2*3) rad(10-3-2)
rad(8/2/2) rad(2**3**2) rad((1+2)) rad(2 rad radian(2) Rad(2)
deg(90) deg(-90.0) deg(+9) deg(9e1) deg(.5) deg(90 Deg(90)
2026-1-9 2026-11-29x 2026-11 10:00:00x
/dev/ttyUSB0 tcp://gateway tcp://10.0.0.1:502 rtu+tcp://host:4001 ~/.ros/inverter_bus omron_mx2 3G3JE 8N1 8E1 a-b a_b a.b a:b a#b a/b
C077 F002 Sn-36 1e 0e 0x -1- --1 1- $(find) $5 a$b C3/0005
'''.split()

QUOTED = ["'1'", '"1"', "'yes'", '"0x1F"', "''", '""', "'rad(pi)'", "'010'", "'#00000006'", '"a\\tb"', '"a\\x41"', "'it''s'",
          '!!str 1', '!!str yes', '!!int 3', '!!int "3"', '!!float 3', '!!float 1e2', '!!float "1e2"', '!!bool yes', '!!bool YeS',
          '!radians 2*pi', '!radians (1+2)*3', '!degrees 180', 'a b', 'a  b', 'a "b"', "a 'b'", 'rad( 2 * pi )']

# Both refuse them: roslaunch with a traceback.
REFUSED_BY_BOTH = ['', '1:', '"a', '["a]', "['a]", '~', 'null', 'Null', 'NULL', '=', '<<', '!!int x', '!!float x', '!!bool x', '!mine 5', '!!set {a}',
                   '!!null x', '!!python/none x', '0x_', '0b_', 'rad()', 'rad(1/0)', 'rad(08)', 'deg(x)', 'deg()', '@a', '`a`', '%a',
                   '2147483648', '-2147483649', '99999999999999999999', '&a', '*a', '2026-11-29', '# comment', '[1, ~]', '{1: 2}',
                   '{yes: 2}', '{1.5: 2}', '{~: 2}', '{? [a] : 2}', '\t1', '1\t', '1\t# x', '[1,\t2]', 'a\tb', "'a", '[1', '{a: 1',
                   'a: b: c', ']', '}', '!!int 1.5', '2026-11-29 10:00:00 +01:00 x: y', 'deg(90-1)', 'deg(pi)', 'rad(exit)']

# Only ours refuses them, since the parameter server would hide what is wrong or unclear.
REFUSED_BY_OURS = ['010', '-010', '+010', '007', '00', '0_7', '0_', '1:30', '1:2:3', '-1:30', '1:30.5', '190:20:30.15',
                   '{a: 1, a: 2}', '{a: {b: 1, b: 1}}', '2026-11-29 10:00:00', '2026-11-29T10:00:00Z', '!!binary aGk=']

DOCUMENTS = [
    'base: &base {a: 1, b: 2}\nkey: {<<: *base, b: 3}\n',
    'base: &base {a: 1, b: 2}\nkey: {b: 3, <<: *base}\n',
    'a: &a {x: 1, y: 1}\nb: &b {y: 2, z: 2}\nkey: {<<: [*a, *b], w: 0}\n',
    'a: &a {x: 1, y: 1}\nb: &b {<<: *a, y: 2}\nkey:\n  <<: *b\n  z: 3\n',
    'scan_list:\n  - &belt {name: a, node: 1, drive: omron_mx2, max_velocity: 50.0}\n  - {<<: *belt, name: b, node: 2}\n',
    'a: &a [1, 2]\nkey: *a\n',
    'key: |\n  a\tb\n  c\nother: 1\n',
    'key: >\n  a\n  b\n\n  c\nother: [a, "b\tc", \'d\te\'] # a\tcomment\n',
    'key:\n- a\n- b: 1\n  c: 2\n-\n  - d\n',
    'key: {a: 1, "b": 2, \'c\': 3, d: [1, 2.0, x]}\n',
    'key: {"a":1, b: {c: d}}\n',
    '? key\n: value\n',
    'key: a\n  b\n  c\n',
    'key: "a\n  b"\n',
    '# comment\n---\nkey: 1\n',
    'key: 1\n...\n',
    '%YAML 1.1\n---\nkey: 1\n',
    'key: 1\r\nother: 2\r\n',
    '\ufeffkey: 1\n',
    "key: 'ä\u20ac'\n",
    "'<<': 1\nkey: {'<<': 5}\n",
    'key: {=: 1}\n',
]
BROKEN_DOCUMENTS = ['key: {<<: 5}\n', 'a: &a {x: 1}\nkey: {<<: [*a, 5]}\n', 'key: *nobody\n', 'key: [1\nother: 2\n',
                    'key: 1\n other: 2\n', 'key:\n\ta: 1\n', 'key: 1\nother\n', 'key: "\\q"\n', '- a\nkey: 1\n']
SEVERAL_DOCUMENTS = ['key: 1\n---\nother: 2\n']


def by_rosparam(text):
    """The parameters as roslaunch sends them to the master; raises where it would die."""
    documents = rosparam.load_str(text, 'probe.yaml')
    parameters = {}
    for document, _ in documents:
        parameters.update(document)
    for key, value in parameters.items():
        xmlrpc.client.dumps((value,))
        if not isinstance(key, str):
            raise TypeError('dictionary key must be string')
    return parameters


def same(a, b):
    if isinstance(a, float) and isinstance(b, float):
        return a == b or (math.isnan(a) and math.isnan(b)) or math.isclose(a, b, rel_tol=1e-14)
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    return type(a) is type(b) and a == b


class Rosparam(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory(prefix='inverter_bus_yaml_')

    def tearDown(self):
        self.directory.cleanup()

    def by_ours(self, texts):
        paths = []
        for number, text in enumerate(texts):
            paths.append(os.path.join(self.directory.name, '%d.yaml' % number))
            with open(paths[-1], 'wb') as stream:
                stream.write(text.encode())
        lines = subprocess.run([PROBE] + paths, stdout=subprocess.PIPE, universal_newlines=True, check=True, timeout=60,
                               encoding='utf-8').stdout.splitlines()
        self.assertEqual(len(lines), len(texts))
        return [json.loads(line) for line in lines]

    def compare(self, texts):
        for text, ours in zip(texts, self.by_ours(texts)):
            with self.subTest(text=text):
                self.assertIn('value', ours, ours)
                theirs = by_rosparam(text)
                self.assertTrue(same(theirs, ours['value']), '%r is %r to rosparam and %r to us' % (text, theirs, ours))

    def testScalarsMeanTheSame(self):
        self.compare(['key: %s\n' % scalar for scalar in SCALARS + QUOTED])

    def testScalarsInListsAndFlowMapsMeanTheSame(self):
        plain = [scalar for scalar in SCALARS if not set(scalar) & set(',[]{}:')]
        self.compare(['key: [%s]\n' % ', '.join(plain), 'key:\n' + ''.join('  - %s\n' % scalar for scalar in SCALARS if scalar[-1] != ':')])

    def testDocumentsMeanTheSame(self):
        self.compare(DOCUMENTS)

    def testWhatRoslaunchCantLoadIsRefused(self):
        texts = ['key: %s\n' % scalar for scalar in REFUSED_BY_BOTH] + BROKEN_DOCUMENTS
        for text, ours in zip(texts, self.by_ours(texts)):
            with self.subTest(text=text):
                self.assertIn('problem', ours)
                with self.assertRaises(Exception):
                    by_rosparam(text)

    def testWhatTheParameterServerHidesIsRefused(self):
        texts = ['key: %s\n' % scalar for scalar in REFUSED_BY_OURS] + SEVERAL_DOCUMENTS
        for text, ours in zip(texts, self.by_ours(texts)):
            with self.subTest(text=text):
                self.assertIn('problem', ours)
                by_rosparam(text)  # takes it

    def testDatesWouldReachTheNodeAsNothing(self):
        self.assertIsInstance(by_rosparam('key: 2026-11-29 10:00:00\n')['key'], datetime.datetime)


if __name__ == '__main__':
    unittest.main()
