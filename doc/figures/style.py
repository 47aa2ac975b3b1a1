"""What all figures share: colours, panels, arrows, and how a figure is saved.

Pages show a figure about 800 pixels wide. A figure of the width `WIDTH` with texts of 9 points then has texts
of 12 pixels. save() refuses smaller ones.
"""

import io
import re

import matplotlib

matplotlib.use('Agg')

import matplotlib.pyplot as plt  # noqa: E402

WIDTH = 8.2  # [inches]
SHOWN_WIDTH, LEAST_TEXT = 800, 12  # [pixels]
TOOL, FACE, BOUND, GUIDE, TEXT = '#1f5fa8', '#b8442c', '#2d7d46', '#707070', '#222222'

plt.rcParams.update({
    'svg.hashsalt': 'organ_collision', 'svg.fonttype': 'none', 'font.family': 'DejaVu Sans',
    'font.size': 9, 'axes.titlesize': 10, 'figure.facecolor': 'white', 'savefig.facecolor': 'white',
    'axes.spines.top': False, 'axes.spines.right': False})


def panels(count, height=3.6, ratios=None):
    """A figure with panels side by side; always returns a list of axes."""
    figure, axes = plt.subplots(1, count, figsize=(WIDTH, height), squeeze=False,
                                gridspec_kw={'width_ratios': ratios} if ratios else None)
    return figure, list(axes[0])


def two_and_one(height, ratios=(1, 1)):
    """A figure with two panels above and a wide one below; `ratios` of the heights of both rows."""
    figure, axes = plt.subplot_mosaic([['left', 'right'], ['below', 'below']], figsize=(WIDTH, height),
                                      gridspec_kw={'height_ratios': ratios})
    return figure, [axes['left'], axes['right'], axes['below']]


def drawing(axes, title):
    """A panel that shows shapes: equal scales, no frame."""
    axes.set_aspect('equal')
    axes.axis('off')
    axes.set_title(title, color=TEXT)


def arrow(axes, start, end, color=TEXT, style='-|>', width=1.2):
    axes.annotate('', end, start, arrowprops={'arrowstyle': style, 'color': color, 'lw': width,
                                              'shrinkA': 0, 'shrinkB': 0})


def label(axes, place, text, color=TEXT, **options):
    axes.text(place[0], place[1], text, color=color, **options)


def check_texts(file, svg):
    """A figure with a text that is too small on a page is not accepted."""
    width = float(re.search(r'viewBox="0 0 ([0-9.]+)', svg)[1])
    sizes = [float(size) for size in re.findall(r'font: (?:[a-z]+ )?([0-9.]+)px', svg)]
    smallest = min(sizes) * SHOWN_WIDTH / width
    if smallest < LEAST_TEXT:
        raise SystemExit(f'{file}: a text has {smallest:.1f} pixels if the figure is {SHOWN_WIDTH} pixels wide')


def save(figure, path):
    """Writes path.svg."""
    figure.tight_layout()
    text = io.StringIO()
    figure.savefig(text, format='svg', bbox_inches='tight', metadata={'Date': None, 'Creator': None})
    plt.close(figure)
    # A browser without this font takes one of the same width.
    svg = text.getvalue().replace("'DejaVu Sans'", "'DejaVu Sans', Verdana, sans-serif")
    check_texts(path, svg)
    with open(path + '.svg', 'w', encoding='utf-8') as file:
        file.write(svg)


def save_picture(figure, path, border=0.1):
    """Writes a figure that contains pictures as PNG, twice as wide as a page shows it. `border`: [inches]"""
    figure.savefig(path, dpi=2 * SHOWN_WIDTH / WIDTH, bbox_inches='tight', pad_inches=border,
                   metadata={'Software': None}, pil_kwargs={'optimize': True})
    plt.close(figure)
