"""What is wrong with a run."""

import statistics

from organ_collision.msg import ContactArray

MEBIBYTE = 2**20
# Of a run, this share from the start is left out: the node's pools and queues grow to their size.
WARM_UP = 0.3
# Memory may grow by so much from the first third of the rest to the last one. The noise is that of queues that are full
# when a program was stopped. In a run of less than two minutes, the pools may not have their size after the warm-up.
MOST_GROWTH = 24 * MEBIBYTE
MOST_GROWTH_OF_SHORT_RUN = 200 * MEBIBYTE
SHORT_RUN = 120.0  # [s]
# What a node may answer whose transforms have gaps, whose organs come and go, and some of whose shapes are illegal.
LEGAL = {ContactArray.OK, ContactArray.NO_MESH, ContactArray.NO_TRANSFORM, ContactArray.INVALID_REQUEST}
TOOLS = ('probe', 'needle', 'jaw', 'stylus')


def lowest(samples, begin, end):
    """The lowest memory in a window [s]. Messages in queues only add to it."""
    return min(size for time, size in samples if begin <= time <= end)


def memory_trend(samples):
    """(growth [bytes], slope [bytes/s]) of the lower envelope after the warm-up."""
    end = samples[-1][0]
    begin = WARM_UP * end
    third = (end - begin) / 3.0
    growth = lowest(samples, end - third, end) - lowest(samples, begin, begin + third)
    return growth, growth / (2.0 * third)


def open_accounts(run):
    """What was sent and is not accounted for, as sentences."""
    judged, sent = run['judged'], run['sent']
    counts = judged['counts']
    wrong = []
    messages = sent['meshes'] + sent['vertices']
    known = counts['organ messages received'] + counts['organ messages lost before they came']
    if messages != known:
        wrong.append(f'of {messages} organ messages, the node knows of {known}')
    for waiting in ('organ messages waiting', 'shapes waiting'):
        if counts[waiting] != 0:
            wrong.append(f'{counts[waiting]} {waiting} at the end')
    answers = judged['answers'] + judged['lost']
    if answers != counts['answers published']:
        wrong.append(f'of {counts["answers published"]} published answers, {answers} were received or known as lost')
    return wrong


def is_short(run):
    return run['memory'][-1][0] < SHORT_RUN


def most_growth(run):
    return MOST_GROWTH_OF_SHORT_RUN if is_short(run) else MOST_GROWTH


def missing(run):
    """What must happen in a long run, and did not."""
    wanted = {f'answers of {tool} evaluated a second time': run['judged']['rechecked tools'].get(f'swept {tool}', 0)
              for tool in TOOLS}
    wanted.update({f'disturbances: {name}': count for name, count in run['disturbances'].items()})
    wanted.update({f'simulator: {name}': count for name, count in run['sent'].items()})
    return [f'there were no {what}' for what, count in wanted.items() if count == 0]


def findings(run):
    """Sentences; none: the run was good."""
    if run['ended']:
        return [f'{name} has ended with {code}' for name, code in run['ended'].items()]
    judged = run['judged']
    wrong = judged['findings'] + open_accounts(run)
    if run['exit code'] != 0:
        wrong.append(f'at the end, {run["kind"]} shut down with exit code {run["exit code"]}')
    growth, _ = memory_trend(run['memory'])
    if growth > most_growth(run):
        wrong.append(f'memory has grown by {growth / MEBIBYTE:.1f} MiB')
    wrong += [f'{count} answers have the status {status}' for status, count in judged['statuses'].items()
              if int(status) not in LEGAL]
    if not is_short(run):
        wrong += missing(run)
    for what in ('ok', 'rechecked', 'rechecked contacts', 'sums'):
        if judged[what] == 0:
            wrong.append(f'nothing was judged: {what} is 0')
    return wrong


def median_memory(samples):
    return statistics.median(size for time, size in samples if time >= WARM_UP * samples[-1][0])
