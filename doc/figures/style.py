"""What all figures share: colours, panels, arrows, and how a figure is saved."""

import matplotlib

matplotlib.use('Agg')

import matplotlib.pyplot as plt  # noqa: E402

TOOL, FACE, BOUND, GUIDE, TEXT = '#1f5fa8', '#b8442c', '#2d7d46', '#8a8a8a', '#222222'

plt.rcParams.update({
    'svg.hashsalt': 'organ_collision', 'svg.fonttype': 'none', 'font.family': 'DejaVu Sans',
    'font.size': 9, 'axes.titlesize': 10, 'figure.facecolor': 'white', 'savefig.facecolor': 'white',
    'axes.spines.top': False, 'axes.spines.right': False})


def panels(count, width=10.0, height=3.8, ratios=None):
    """A figure with panels side by side; always returns a list of axes."""
    figure, axes = plt.subplots(1, count, figsize=(width, height), squeeze=False,
                                gridspec_kw={'width_ratios': ratios} if ratios else None)
    return figure, list(axes[0])


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


def save(figure, path):
    figure.tight_layout()
    if path.endswith('.png'):
        figure.savefig(path, dpi=90, bbox_inches='tight')
    else:
        figure.savefig(path + '.svg', bbox_inches='tight', metadata={'Date': None, 'Creator': None})
    plt.close(figure)
