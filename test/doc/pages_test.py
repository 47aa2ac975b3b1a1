#!/usr/bin/python3
"""What the pages show is what the tested files say. The files, figures, sections and links that they name exist. They
explain every name of the interface, every status, every reason of a refusal, and every line that a program logs.

Usage: pages_test.py SOURCE_FOLDER
"""

import glob
import os
import re
import sys
import unittest

SOURCE = sys.argv[1]
CODE = ['include', 'src', 'test', 'benchmark', 'examples', 'msg', 'srv']
FOLDERS = '(?:%s)/' % '|'.join(['benchmark', 'doc', 'examples', 'include', 'msg', 'scripts', 'src', 'srv', 'test',
                                r'\.ci'])
SHOWN = {'cpp': '.cpp', 'python': '.py', 'xml': '.launch', 'yaml': '.yaml', 'cmake': '.txt'}
SHOWN_FOLDERS = ('examples', 'config', 'launch', 'test/install/consumer')
# The pages that explain the names of the interface.
INTERFACE_PAGES = ('doc/interface.md', 'doc/reference/nodes.md')
INDEX, FRONT_PAGE_LINES = 'doc/pages.md', 100
SHORTEST_FRAGMENT = 10  # [characters] fixed text of a log line by which one can search the page
LITERALS = r'((?:"(?:[^"\\]|\\.)*"\s*)+)'  # adjacent string literals are one


def read(path):
    with open(os.path.join(SOURCE, path), encoding='utf-8') as text:
        return text.read()


def found(*pattern):
    return [os.path.relpath(path, SOURCE) for path in glob.glob(os.path.join(SOURCE, *pattern), recursive=True)]


PAGES = {path: read(path) for path in sorted(found('*.md') + found('doc', '**', '*.md'))}
GEOMETRY, README, TROUBLESHOOTING = (PAGES[name] for name in ('doc/theory/geometry.md', 'README.md',
                                                              'doc/troubleshooting.md'))


def without_indent(text):
    return '\n'.join(line.strip() for line in text.strip().splitlines())


def without_code_blocks(text):
    return re.sub(r'^```.*?^```', '', text, flags=re.M | re.S)


def anchors(page):
    """The anchors that GitHub gives the headings of a page."""
    headings = re.findall(r'^#+ (.*)$', without_code_blocks(PAGES[page]), re.M)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


def spans(text):
    """What is set as code within lines."""
    return {once or twice for twice, once in re.findall(r'``(.+?)``|`([^`\n]+)`', text)}


def references():
    """All (file, text after "doc/theory/geometry.md, ") in the code, with line breaks removed."""
    for folder in CODE:
        for path in found(folder, '**', '*.*'):
            if path.endswith(('.cpp', '.hpp', '.py', '.msg', '.srv')) and path != os.path.relpath(__file__, SOURCE):
                text = re.sub(r'\s*\n\s*(?:///?<?|#|\*)?\s*', ' ', read(path))
                for reference in re.finditer(r'doc/theory/geometry\.md, (.{1,60})', text):
                    yield path, reference.group(1)


def sources():
    return [read(path) for path in found('src', '**', '*.cpp')]


def reasons():
    """The texts under which refusals and failures are counted."""
    adapter = read('python/organ_collision/surfaces.py') + read('scripts/organ_mesh_adapter')
    texts = set(re.findall(r"MessageError\((?:'.*' if .* else )?'([^']+)'", adapter))
    for code in sources():
        for pattern in (r'\bRejection\(\s*[\w:.]+,\s*',
                        r'\b(?:rejected_?|refused_?|failures_?|failed_?|clipped_?)\.add\(\s*'):
            texts.update(re.findall(pattern + '"([^"]+)"', code))
        if 'return "no triangles";' in code or 'return "no mesh";' in code:  # The reasons of meshes and of statuses.
            texts.update(re.findall(r'^\s*return "([^"]+)";|\brefuse\("([^"]+)"', code, re.M))
    return {text if isinstance(text, str) else ''.join(text) for text in texts} - {'ok'}


def log_lines():
    """The longest fixed text of each line that is logged."""
    for code in sources():
        call = r'\b(?:ROS|NODELET)_(?:DEBUG|INFO|WARN|ERROR|FATAL)\w*\(\s*(?:[\d.]+,\s*)?'
        for literals in re.findall(call + LITERALS, code):
            text = ''.join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals))
            fragment = max(re.split(r'%[-+ #0\d.]*(?:l|z)*[a-z]', text), key=len)
            if len(fragment) >= SHORTEST_FRAGMENT:
                yield fragment


class PagesTest(unittest.TestCase):

    def test_each_code_block_is_part_of_a_tested_file(self):
        files = [path for folder in SHOWN_FOLDERS for path in found(folder, '**', '*.*')]
        shown = set()
        for page, text in PAGES.items():
            for language, block in re.findall(r'^```(\w+)\n(.*?)^```', text, re.M | re.S):
                if language not in ('bash', 'mermaid'):
                    shown.add(language)
                    self.assertTrue(any(without_indent(block) in without_indent(read(path)) for path in files
                                        if path.endswith(SHOWN[language])), '%s shows\n%s' % (page, block))
        self.assertEqual(shown, set(SHOWN))

    def test_each_link_leads_to_a_file_and_a_heading(self):
        for page, text in PAGES.items():
            prose = re.sub(r'`[^`\n]*`', '', without_code_blocks(text))
            for target, anchor in re.findall(r'\]\(([^)#\s]*)(?:#([^)\s]+))?\)', prose):
                if '://' not in target:
                    path = os.path.normpath(os.path.join(os.path.dirname(page), target)) if target else page
                    self.assertTrue(os.path.exists(os.path.join(SOURCE, path)), '%s leads to %s' % (page, target))
                    if anchor:
                        self.assertIn(anchor, anchors(path), '%s leads to %s' % (page, target))

    def test_each_table_has_a_head(self):
        for page, text in PAGES.items():
            for table in re.findall(r'(?:^\|.*\n)+', without_code_blocks(text), re.M):
                self.assertRegex(table, r'\A\|.*\n\|[ :|-]+\|\n\|', page)

    def test_readme_is_a_front_page_and_each_page_is_two_links_away(self):
        self.assertLessEqual(len(README.splitlines()), FRONT_PAGE_LINES)
        self.assertIn('(%s)' % INDEX, README)
        self.assertEqual([page for page in PAGES if page not in (INDEX, 'README.md')
                          and '(%s)' % os.path.relpath(page, os.path.dirname(INDEX)) not in PAGES[INDEX]], [])

    def test_each_figure_is_shown_and_drawn(self):
        drawn, shown = read('doc/figures/draw.py'), ''.join(PAGES.values())
        figures = [os.path.basename(path) for path in found('doc', 'figures', '*.svg')]
        self.assertGreater(len(figures), 10)
        for figure in figures:
            self.assertIn('figures/' + figure, shown)
            self.assertIn("'%s'" % figure[:-len('.svg')], drawn)

    def test_sections_of_the_geometry(self):
        """Those that the code refers to exist."""
        names = re.findall(r'^#{2,} (.+)$', GEOMETRY, re.M)
        self.assertEqual([(path, reference) for path, reference in references()
                          if not any(reference.startswith(name) for name in names)], [])

    def test_each_file_that_a_page_names_exists(self):
        """node_parameters.{hpp,cpp} names two files, and NAME stands for any name."""
        named = [(page, path) for page, text in PAGES.items()
                 for path in re.findall(r'`(%s[^`\s]*)' % FOLDERS, without_code_blocks(text))
                 if not re.search('[A-Z]{4}', os.path.basename(path))]
        self.assertGreater(len(named), 30)
        for page, path in list(named):
            choice = re.search(r'\{(.*)\}', path)
            if choice:
                named.remove((page, path))
                named += [(page, path.replace(choice.group(), ending)) for ending in choice.group(1).split(',')]
        self.assertEqual([(page, path) for page, path in named if not found(path)], [])

    def test_each_program_that_a_page_names_is_installed(self):
        """Except those that stand with their path in the devel space, on pages that users do not need."""
        build_files = {path: read(path) for path in found('*', 'CMakeLists.txt') + found('*', '*', 'CMakeLists.txt')
                       + found('src', '*', '*', 'CMakeLists.txt') + ['cmake/Install.cmake']}
        installed = {name for text in build_files.values()
                     for name in re.findall(r'(?:organ_collision_program\(\s*|OUTPUT_NAME )(\w+)', text)} | set(re.findall(r'\w+\.py', build_files['cmake/Install.cmake']))
        built = {name for text in build_files.values() for name in re.findall(r'add_executable\(\s*(\w+)', text)}
        self.assertGreater(min(len(installed), len(built)), 5)
        called = {(page, name) for page, text in PAGES.items()
                  for name in re.findall(r'\brosrun organ_collision (\w[\w.]*\w)', text)}
        self.assertEqual({(page, name) for page, name in called if name not in installed}, set())
        self.assertEqual({(page, name) for page in PAGES if re.fullmatch(r'README\.md|doc/\w+\.md', page)
                          for name in (built - installed) & {span.split()[0] for span in spans(PAGES[page])}}, set())

    def test_the_changelog_begins_with_this_version_or_with_what_is_not_released_yet(self):
        version = re.search('<version>(.*)</version>', read('package.xml')).group(1)
        newest = re.search(r'^(.*)\n-+$', read('CHANGELOG.rst'), re.M).group(1)
        self.assertRegex(newest, r'^(Forthcoming|%s \(\d{4}-\d\d-\d\d\))$' % re.escape(version))
        self.assertIn('\nversion: %s\n' % version, read('CITATION.cff'))

    def test_each_name_of_the_interface_is_explained(self):
        names = re.findall(r'inline constexpr char k\w+\[\] = "(\w+)"', read('include/organ_collision/ros/names.hpp'))
        statuses = re.findall(r'^uint8 (\w+)=', read('msg/ContactArray.msg'), re.M)
        self.assertGreater(min(len(names), len(statuses)), 10)
        shown = re.findall(r'`([^`]+)`', without_code_blocks('\n'.join(PAGES[page] for page in INTERFACE_PAGES)))
        self.assertEqual([name for name in names + statuses
                          if not any(re.fullmatch('/?' + name, span) for span in shown)], [])

    def test_troubleshooting_has_every_status_every_reason_and_every_line_that_is_logged(self):
        statuses = re.findall(r'^uint8 (\w+)=', read('msg/ContactArray.msg').split('# Modes')[0], re.M)
        self.assertGreater(len(statuses), 8)
        self.assertEqual(sorted(set(statuses) - spans(TROUBLESHOOTING)), [])
        self.assertGreater(len(reasons()), 30)
        self.assertEqual(sorted(reasons() - spans(TROUBLESHOOTING)), [])
        lines = list(log_lines())
        self.assertGreater(len(lines), 6)
        self.assertEqual([line for line in lines if line not in TROUBLESHOOTING], [])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
