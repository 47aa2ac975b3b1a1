#!/usr/bin/python3
"""Prints a Markdown page as Doxygen needs it, with links that lead where they lead on GitHub.

Usage: doxygen_page.py PAGE (in the folder of the repository; Doxygen calls it)

Doxygen gives headings no anchors of GitHub's form, so each heading gets a label, and links to pages and headings
become references to labels. Links to other files lead from the folder html in $OUTPUT into the repository.
"""

import os
import re
import sys

FRONT = 'README.md'
REPOSITORY = os.path.relpath('.', os.path.join(os.environ['OUTPUT'], 'html'))


def slug(heading):
    return re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-')


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


def with_labels(page, text):
    """The only heading of the first level is the title of the page."""
    def labelled(heading):
        name = label(page) if heading[1] == '#' else label(page, slug(heading[2]))
        return heading[0] if name == 'index' else '%s {#%s}' % (heading[0], name)
    return re.sub('^(#+) (.*)$', labelled, text, flags=re.M)


def with_references(page, text):
    """Puts the text of each link on one line, because Doxygen does not read references of several lines."""
    return re.sub(r'(?<!!)(\[[^\]]*\])\(([^)\s]+)\)',
                  lambda link: '%s(%s)' % (re.sub(r'\s+', ' ', link[1]), reference(page, link[2])), text)


def convert(page, text):
    """Leaves blocks of code as they are."""
    parts = re.split('(^```.*?^```$)', text, flags=re.M | re.S)
    return ''.join(part if part.startswith('```') else with_references(page, with_labels(page, part))
                   for part in parts)


if __name__ == '__main__':
    page = os.path.relpath(sys.argv[1])
    with open(page, encoding='utf-8') as source:
        print(convert(page, source.read()))
