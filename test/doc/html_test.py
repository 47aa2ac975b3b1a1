#!/usr/bin/python3
"""Doxygen makes the HTML documentation without a warning, and its links and images lead somewhere.

Usage: html_test.py SOURCE_FOLDER OUTPUT_FOLDER
"""

import glob
import html.parser
import os
import re
import shutil
import subprocess
import sys
import unittest
import urllib.parse

SOURCE, OUTPUT = sys.argv[1:3]
HTML = os.path.join(OUTPUT, 'html')


class Page(html.parser.HTMLParser):
    """The links of a page, and the names that links can lead to."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors, self.text = [], set(), ''
        with open(path, encoding='utf-8') as page:
            self.feed(page.read())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ('href', 'src', 'data'):
                self.links.append(value)
            elif name in ('id', 'name'):
                self.anchors.add(value)

    def handle_data(self, data):
        self.text += data


class HtmlTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        shutil.rmtree(OUTPUT, ignore_errors=True)
        os.makedirs(OUTPUT)
        made = subprocess.run(['doxygen', 'doc/Doxyfile'], cwd=SOURCE, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env={**os.environ, 'VERSION': '', 'OUTPUT': OUTPUT})
        assert made.returncode == 0 and not made.stdout, made.stdout
        cls.pages = {path: Page(path) for path in glob.glob(os.path.join(HTML, '*.html'))}

    def test_readme_is_the_front(self):
        with open(os.path.join(SOURCE, 'README.md'), encoding='utf-8') as readme:
            section = next(line for line in readme if line.startswith('## '))[3:].strip()
        self.assertIn(section, self.pages[os.path.join(HTML, 'index.html')].text)

    def test_each_page_and_public_class_is_there(self):
        written = glob.glob(os.path.join(SOURCE, 'doc', '**', '*.md'), recursive=True)
        self.assertGreater(len(written), 5)
        for path in written:
            with open(path, encoding='utf-8') as page:
                title = re.sub('[`*]', '', page.readline().lstrip('# ').strip())
            self.assertTrue(any(title in page.text for page in self.pages.values()), path)
        self.assertIn(os.path.join(HTML, 'classorgan__collision_1_1CollisionQuery.html'), self.pages)

    def test_no_command_of_doxygen_is_left_in_a_page(self):
        for path, page in self.pages.items():
            if not path.endswith('_source.html'):
                self.assertNotRegex(page.text, r'@(section|subsection|ref|page|image)\b', path)

    def test_each_link_leads_somewhere(self):
        checked = 0
        for path, page in self.pages.items():
            for link in page.links:
                target, anchor = urllib.parse.urldefrag(link)
                if urllib.parse.urlparse(target).scheme:
                    continue
                checked += 1
                found = os.path.normpath(os.path.join(HTML, urllib.parse.unquote(target))) if target else path
                self.assertTrue(os.path.exists(found), '%s leads to %s' % (path, link))
                if anchor and found in self.pages:
                    self.assertIn(anchor, self.pages[found].anchors, '%s leads to %s' % (path, link))
        self.assertGreater(checked, 100)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
