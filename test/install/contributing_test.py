#!/usr/bin/python3
"""The files and folders that CONTRIBUTING.md names exist, and so do the targets of its links. CHANGELOG.rst begins with
this version.

Usage: contributing_test.py SOURCE_FOLDER
"""

import glob
import os
import re
import sys
import unittest

SOURCE = sys.argv[1]
FOLDERS = ('benchmark', 'doc', 'include', 'msg', 'scripts', 'src', 'srv', 'test', r'\.ci')


def variants(path):
    """node_parameters.{hpp,cpp} names two files."""
    choice = re.search(r'\{(.*)\}', path)
    return [path.replace(choice.group(), ending) for ending in choice.group(1).split(',')] if choice else [path]


class ContributingTest(unittest.TestCase):

    def test_everything_that_it_names_exists(self):
        with open(os.path.join(SOURCE, 'CONTRIBUTING.md')) as text:
            page = text.read()
        named = re.findall(r'`((?:%s)/[^`\s]*)' % '|'.join(FOLDERS), page)
        named += re.findall(r'^((?:%s)/[^`\s]*)' % '|'.join(FOLDERS), page, re.M)
        named += re.findall(r'\]\(([^)#]+)\)', page)
        self.assertGreater(len(named), 30)
        for path in named:
            if not re.search(r'[A-Z]{4}', os.path.basename(path)):  # NAME stands for any name.
                for variant in variants(path):
                    self.assertTrue(glob.glob(os.path.join(SOURCE, variant)), variant)

    def test_the_changelog_begins_with_this_version_or_with_what_is_not_released_yet(self):
        with open(os.path.join(SOURCE, 'package.xml')) as text:
            version = re.search('<version>(.*)</version>', text.read()).group(1)
        with open(os.path.join(SOURCE, 'CHANGELOG.rst')) as text:
            newest = re.search(r'^(.*)\n-+$', text.read(), re.M).group(1)
        self.assertRegex(newest, r'^(Forthcoming|%s \(\d{4}-\d\d-\d\d\))$' % re.escape(version))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
