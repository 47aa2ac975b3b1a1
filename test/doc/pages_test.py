#!/usr/bin/python3
"""The pages of doc/ name figures, sections and files that exist.

Usage: pages_test.py SOURCE_FOLDER
"""

import glob
import os
import re
import sys
import unittest

SOURCE = sys.argv[1]
CODE = ['include', 'src', 'test', 'benchmark', 'examples', 'msg', 'srv']
FOLDERS = '(?:benchmark|doc|examples|include|msg|scripts|src|srv|test)/'


def read(path):
    with open(path, encoding='utf-8') as text:
        return text.read()


def pages():
    return sorted(glob.glob(os.path.join(SOURCE, 'doc', '*.md')))


def sections(page):
    return re.findall(r'^#{2,} (.+)$', page, re.M)


def references():
    """All (file, text after "doc/geometry.md, ") in the code, with line breaks removed."""
    for folder in CODE:
        for path in glob.glob(os.path.join(SOURCE, folder, '**', '*.*'), recursive=True):
            if path.endswith(('.cpp', '.hpp', '.py', '.msg', '.srv')) and path != __file__:
                text = re.sub(r'\s*\n\s*(?:///?<?|#|\*)?\s*', ' ', read(path))
                for found in re.finditer(r'doc/geometry\.md, (.{1,60})', text):
                    yield os.path.relpath(path, SOURCE), found.group(1)


class PagesTest(unittest.TestCase):

    def setUp(self):
        self.geometry = read(os.path.join(SOURCE, 'doc/geometry.md'))

    def test_each_figure_that_a_page_shows_exists(self):
        for page in pages():
            for image in re.findall(r'!\[[^\]]*\]\(([^)]+)\)', read(page)):
                self.assertTrue(os.path.exists(os.path.join(SOURCE, 'doc', image)),
                                f'{page} shows {image}')

    def test_each_figure_is_shown_and_drawn(self):
        shown = ''.join(read(page) for page in pages())
        drawn = read(os.path.join(SOURCE, 'doc/figures/draw.py'))
        figures = [os.path.basename(path)
                   for path in glob.glob(os.path.join(SOURCE, 'doc/figures/*.svg'))]
        self.assertGreater(len(figures), 10)
        for figure in figures:
            self.assertIn(f'figures/{figure}', shown)
            self.assertIn(f"'{figure[:-len('.svg')]}'", drawn)

    def test_each_section_of_the_geometry_shows_a_figure(self):
        parts = re.split(r'^## (.+)$', self.geometry, flags=re.M)[1:]
        for name, text in zip(parts[::2], parts[1::2]):
            if name != 'Sources':
                self.assertIn('](figures/', text, name)

    def test_each_section_that_the_code_refers_to_exists(self):
        names = sections(self.geometry)
        self.assertGreater(len(names), 10)
        for path, reference in references():
            self.assertTrue(any(reference.startswith(name) for name in names),
                            f'{path} refers to "{reference}"')

    def test_each_link_within_a_page_leads_to_a_section(self):
        for page in pages():
            text = read(page)
            anchors = {re.sub(r'[^\w -]', '', name.lower()).replace(' ', '-')
                       for name in re.findall(r'^#+ (.+)$', text, re.M)}
            for anchor in re.findall(r'\]\(#([^)]+)\)', text):
                self.assertIn(anchor, anchors, page)

    def test_each_file_that_the_geometry_names_exists(self):
        files = re.findall(f'`({FOLDERS}[^`]+)`', self.geometry)
        links = re.findall(r'\]\(([\w./]+\.md)\)', self.geometry)
        self.assertGreater(len(files), 20)
        for path in files + [os.path.join('doc', link) for link in links]:
            self.assertTrue(os.path.exists(os.path.join(SOURCE, path)), path)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
