#!/usr/bin/python3
"""Prints a Markdown page as Doxygen needs it, with links that lead where they lead on GitHub.

Usage: doxygen_page.py PAGE (in the folder of the repository; Doxygen calls it)

Doxygen gives headings no anchors of GitHub's form, so each heading gets a label, and links to pages and headings
become references to labels. Links to other files lead from the folder html in $OUTPUT into the repository.
"""

import collections
import os
import re
import sys

FRONT = 'README.md'
REPOSITORY = os.path.relpath('.', os.path.join(os.environ['OUTPUT'], 'html'))


def slug(heading):
    return re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-')


def plain(text):
    """In headings and references, Doxygen shows the signs of Markdown as they are."""
    return re.sub('[`*]', '', text)


def label(page, anchor=''):
    """The label of a page, or of the heading of a page that GitHub gives this anchor."""
    if page == FRONT and not anchor:
        return 'index'
    return 'page-' + slug(page.replace('/', '-')[:-len('.md')]) + ('-' + anchor if anchor else '')


def reference(page, target):
    """The target of a link, as Doxygen resolves it."""
    if '://' in target or target.startswith('mailto:'):
        return target
    path, _, anchor = target.partition('#')
    path = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
    return '@ref ' + label(path, anchor) if path.endswith('.md') else os.path.join(REPOSITORY, path)


def with_labels(page, text, used):
    """The only heading of the first level is the title of the page. `used` counts the anchors, which GitHub numbers."""
    def labelled(heading):
        anchor = slug(heading[2])
        number = '-%d' % used[anchor] if used[anchor] else ''
        used[anchor] += 1
        name = label(page) if heading[1] == '#' else label(page, anchor + number)
        words = plain(heading[0])
        return words if name == 'index' else '%s {#%s}' % (words, name)
    return re.sub('^(#+) (.*)$', labelled, text, flags=re.M)


def with_references(page, text):
    """Doxygen reads the text of a reference only on one line, and stumbles over <https://...>."""
    def link(found):
        target = reference(page, found[2])
        words = re.sub(r'\s+', ' ', found[1])
        return '[%s](%s)' % (plain(words) if target.startswith('@ref') else words, target)
    text = re.sub(r'<(https?://[^>\s]+)>', r'[\1](\1)', text)
    text = re.sub(r'(!\[[^\]]*\]\()(?:\.\./|doc/)+', r'\1', text)  # Doxygen looks for figures in doc/.
    return re.sub(r'(?<!!)\[([^\]]*)\]\(([^)\s]+)\)', link, text)


def convert(page, text):
    """Leaves blocks of code as they are."""
    used = collections.Counter()
    parts = re.split('(^ *```.*?^ *```$)', text, flags=re.M | re.S)
    return ''.join(part if part.lstrip().startswith('```')
                   else with_references(page, with_labels(page, part, used)) for part in parts)


if __name__ == '__main__':
    page = os.path.relpath(sys.argv[1])
    with open(page, encoding='utf-8') as source:
        print(convert(page, source.read()))
