#!/usr/bin/python3
"""The excerpts in README.md agree with the tested files.

Usage: readme_test.py SOURCE_FOLDER
"""

import glob
import os
import re
import sys
import unittest

SOURCE = sys.argv[1]
SHOWN = {'cpp': '.cpp', 'python': '.py', 'xml': '.launch', 'yaml': '.yaml', 'cmake': '.txt'}


def read(path):
    with open(path) as text:
        return text.read()


def without_indent(text):
    return '\n'.join(line.strip() for line in text.strip().splitlines())


class ReadmeTest(unittest.TestCase):

    def setUp(self):
        self.readme = read(os.path.join(SOURCE, 'README.md'))

    def test_each_code_block_is_part_of_a_tested_file(self):
        blocks = re.findall(r'^```(\w+)\n(.*?)^```', self.readme, re.M | re.S)
        self.assertEqual({language for language, _ in blocks} - {'bash'}, set(SHOWN))
        files = [path for folder in ('examples', 'test/install/consumer')
                 for path in glob.glob(os.path.join(SOURCE, folder, '*'))]
        for language, block in blocks:
            if language != 'bash':
                self.assertTrue(any(without_indent(block) in without_indent(read(path))
                                    for path in files if path.endswith(SHOWN[language])), block)

    def test_each_link_leads_to_a_file(self):
        links = re.findall(r'\]\(([^)#]+)\)', self.readme)
        self.assertGreater(len(links), 0)
        for link in links:
            if '://' not in link:
                self.assertTrue(os.path.exists(os.path.join(SOURCE, link)), link)

    def test_each_name_of_the_interface_is_explained(self):
        names = re.findall(r'inline constexpr char k\w+\[\] = "(\w+)"',
                           read(os.path.join(SOURCE, 'include/organ_collision/ros/names.hpp')))
        statuses = re.findall(r'^uint8 (\w+)=', read(os.path.join(SOURCE, 'msg/ContactArray.msg')),
                              re.M)
        self.assertGreater(len(names), 10)
        self.assertGreater(len(statuses), 10)
        text = re.sub(r'^```.*?^```', '', self.readme, flags=re.M | re.S)
        shown = re.findall(r'`([^`]+)`', text)
        self.assertEqual([name for name in names + statuses
                          if not any(re.fullmatch('/?' + name, span) for span in shown)], [])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
