"""Tables in Markdown."""


def table(head, rows):
    lines = ['| ' + ' | '.join(map(str, head)) + ' |', '|' + '---|' * len(head)]
    lines += ['| ' + ' | '.join(map(str, row)) + ' |' for row in rows]
    return '\n'.join(lines) + '\n'


def whole(value):
    """A number without decimals; empty for None."""
    return '' if value is None else f'{value:.0f}'
