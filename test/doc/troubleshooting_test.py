#!/usr/bin/python3
"""doc/troubleshooting.md has every status, every reason of a refusal, and every line that a program logs.

Usage: troubleshooting_test.py SOURCE_FOLDER
"""

import glob
import os
import re
import sys
import unittest

SOURCE = sys.argv[1]
SHORTEST_FRAGMENT = 10  # [characters] fixed text of a log line by which one can search the page
LITERALS = r'((?:"(?:[^"\\]|\\.)*"\s*)+)'  # adjacent string literals are one


def read(path):
    with open(os.path.join(SOURCE, path), encoding='utf-8') as text:
        return text.read()


def sources():
    return [read(path) for path in glob.glob(os.path.join(SOURCE, 'src', '**', '*.cpp'), recursive=True)]


def joined(literals):
    return ''.join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals))


def reasons():
    """The texts under which refusals and failures are counted."""
    found = set()
    for code in sources():
        for pattern in (r'\bRejection\(\s*[\w:.]+,\s*', r'\bMessageError\(\s*',
                        r'\b(?:rejected_?|refused_?|failures_?|failed_?|clipped_?)\.add\(\s*'):
            found.update(re.findall(pattern + '"([^"]+)"', code))
    organs = read('src/ros/organs/organ_registry.cpp')
    found.update(re.findall(r'\brefuse\("([^"]+)"', organs))
    for code in (organs, read('src/ros/messages/failure_log.cpp')):
        found.update(re.findall(r'^\s*return "([^"]+)";', code, re.M))
    return found - {'ok'}


def log_lines():
    """The longest fixed text of each line that is logged."""
    for code in sources():
        call = r'\b(?:ROS|NODELET)_(?:DEBUG|INFO|WARN|ERROR|FATAL)\w*\(\s*(?:[\d.]+,\s*)?'
        for literals in re.findall(call + LITERALS, code):
            fragment = max(re.split(r'%[-+ #0\d.]*(?:l|z)*[a-z]', joined(literals)), key=len)
            if len(fragment) >= SHORTEST_FRAGMENT:
                yield fragment


class TroubleshootingTest(unittest.TestCase):

    def setUp(self):
        self.page = read('doc/troubleshooting.md')
        self.spans = {once or twice for twice, once in re.findall(r'``(.+?)``|`([^`\n]+)`', self.page)}

    def test_it_has_every_status(self):
        statuses = re.findall(r'^uint8 (\w+)=', read('msg/ContactArray.msg').split('# modes')[0], re.M)
        statuses.remove('STATIC')
        self.assertGreater(len(statuses), 8)
        self.assertEqual(sorted(set(statuses) - self.spans), [])

    def test_it_has_every_reason(self):
        found = reasons()
        self.assertGreater(len(found), 40)
        self.assertEqual(sorted(found - self.spans), [])

    def test_it_has_every_line_that_is_logged(self):
        lines = list(log_lines())
        self.assertGreater(len(lines), 6)
        self.assertEqual([line for line in lines if line not in self.page], [])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
