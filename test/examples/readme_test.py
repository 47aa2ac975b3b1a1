#!/usr/bin/python3
"""What the pages show is what the tested files say, and their links lead somewhere.

Usage: readme_test.py SOURCE_FOLDER
"""

import glob
import os
import re
import sys
import unittest

SOURCE = sys.argv[1]
SHOWN = {'cpp': '.cpp', 'python': '.py', 'xml': '.launch', 'yaml': '.yaml', 'cmake': '.txt'}
# The pages that explain the interface. Their code blocks are parts of tested files.
USER_PAGES = ('README.md', 'doc/interface.md', 'doc/robots.md', 'doc/meshes.md', 'doc/forces.md', 'doc/python.md',
              'doc/dvrk.md')


def read(path):
    with open(os.path.join(SOURCE, path)) as text:
        return text.read()


def without_indent(text):
    return '\n'.join(line.strip() for line in text.strip().splitlines())


def without_code_blocks(text):
    return re.sub(r'^```.*?^```', '', text, flags=re.M | re.S)


def anchors(path):
    """The anchors that GitHub gives the headings of a page."""
    headings = re.findall(r'^#+ (.*)$', without_code_blocks(read(path)), re.M)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


class ReadmeTest(unittest.TestCase):

    def setUp(self):
        self.text = '\n'.join(read(page) for page in USER_PAGES)

    def test_each_code_block_is_part_of_a_tested_file(self):
        blocks = re.findall(r'^```(\w+)\n(.*?)^```', self.text, re.M | re.S)
        self.assertEqual({language for language, _ in blocks} - {'bash'}, set(SHOWN))
        files = [path for folder in ('examples', 'test/install/consumer')
                 for path in glob.glob(os.path.join(SOURCE, folder, '*'))]
        for language, block in blocks:
            if language != 'bash':
                self.assertTrue(any(without_indent(block) in without_indent(read(path))
                                    for path in files if path.endswith(SHOWN[language])), block)

    def test_each_link_leads_to_a_file_and_a_heading(self):
        pages = [os.path.relpath(path, SOURCE) for folder in ('.', 'doc')
                 for path in glob.glob(os.path.join(SOURCE, folder, '*.md'))]
        for page in pages:
            prose = re.sub(r'`[^`\n]*`', '', without_code_blocks(read(page)))
            links = re.findall(r'\]\(([^)#\s]*)(?:#([^)\s]+))?\)', prose)
            for target, anchor in links:
                if '://' in target:
                    continue
                path = os.path.normpath(os.path.join(os.path.dirname(page), target)) \
                    if target else page
                with self.subTest(page=page, link=target, anchor=anchor):
                    self.assertTrue(os.path.exists(os.path.join(SOURCE, path)))
                    if anchor:
                        self.assertIn(anchor, anchors(path))

    def test_readme_leads_to_each_page(self):
        for path in glob.glob(os.path.join(SOURCE, 'doc', '*.md')):
            self.assertIn('(doc/' + os.path.basename(path) + ')', read('README.md'))

    def test_each_name_of_the_interface_is_explained(self):
        names = re.findall(r'inline constexpr char k\w+\[\] = "(\w+)"',
                           read('include/organ_collision/ros/names.hpp'))
        statuses = re.findall(r'^uint8 (\w+)=', read('msg/ContactArray.msg'), re.M)
        self.assertGreater(len(names), 10)
        self.assertGreater(len(statuses), 10)
        shown = re.findall(r'`([^`]+)`', without_code_blocks(self.text))
        self.assertEqual([name for name in names + statuses
                          if not any(re.fullmatch('/?' + name, span) for span in shown)], [])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
