"""What is wrong with a run of a soak."""

from organ_collision.msg import ContactArray

MEBIBYTE, HOUR = 2**20, 3600.0
# Of a run, this share from the start is left out: the node's pools and queues grow to their size.
WARM_UP = 0.3
# Memory may grow by so much from the first third of the rest to the last one. The noise is that of queues that are full
# when a program was stopped. In a run of less than two minutes, the pools may not have their size after the warm-up.
MOST_GROWTH, MOST_GROWTH_OF_SHORT_RUN = 24 * MEBIBYTE, 200 * MEBIBYTE
SHORT_RUN = 120.0  # [s]
# What a node may answer whose transforms have gaps, whose organs come and go, and some of whose shapes are illegal.
LEGAL = {ContactArray.OK, ContactArray.NO_MESH, ContactArray.NO_TRANSFORM, ContactArray.INVALID_REQUEST}
# Counts of the judge that are above zero in a run that has proven something.
WANTED = ('ok', 'rechecked', 'rechecked contacts')


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


def is_short(run):
    return run['memory'][-1][0] < SHORT_RUN


def most_growth(run):
    return MOST_GROWTH_OF_SHORT_RUN if is_short(run) else MOST_GROWTH


def wrong_sums(counts, tools):
    """What of the node's own counts does not add up, as sentences. `tools`: how many the node has."""
    if counts['organ messages received'] != sum(counts['organ messages ' + fate] for fate in (
            'applied', 'that remove', 'refused', 'dropped behind a large mesh', 'waiting')):
        yield "the node's counts of organ messages do not add up"
    if counts['shapes due'] != tools * counts['organ messages applied']:
        yield 'not every accepted shape became due for each tool'
    if counts['shapes due'] != sum(counts['shapes ' + fate] for fate in (
            'answered', 'superseded by newer ones', 'forgotten before their step', 'waiting')):
        yield "the node's counts of shapes do not add up"


def open_accounts(run):
    """What was sent and is not accounted for, as sentences."""
    judged, sent, counts, wrong = run['judged'], run['sent'], run['counts'], []
    messages = sent['meshes'] + sent['vertices']
    known = counts['organ messages received'] + counts['organ messages lost before they came']
    if messages != known:
        wrong.append('of %d organ messages, the node knows of %d' % (messages, known))
    for waiting in ('organ messages waiting', 'shapes waiting'):
        if counts[waiting] != 0:
            wrong.append('%d %s at the end' % (counts[waiting], waiting))
    answers = judged['answers'] + judged['lost']
    if answers != counts['answers published']:
        wrong.append('of %d published answers, %d were received or known as lost' % (counts['answers published'],
                                                                                     answers))
    return wrong


def missing(run):
    """What must happen in a long run, and did not."""
    wanted = {'answers of %s evaluated a second time' % tool: run['judged']['rechecked tools'].get('swept ' + tool, 0)
              for tool in run['tools']}
    wanted.update({'disturbances: ' + name: count for name, count in run['disturbances'].items()})
    wanted.update({'simulator: ' + name: count for name, count in run['sent'].items()})
    return ['there were no ' + what for what, count in wanted.items() if count == 0]


def findings(run):
    """Sentences; none: the run was good."""
    if run['ended']:
        return ['%s has ended with %d' % ended for ended in run['ended'].items()]
    judged = run['judged']
    wrong = judged['findings'] + run['users'] + run['wrong sums'] + open_accounts(run)
    if run['exit code'] != 0:
        wrong.append('at the end, %s shut down with exit code %d' % (run['kind'], run['exit code']))
    growth, _ = memory_trend(run['memory'])
    if run['with memory'] and growth > most_growth(run):
        wrong.append('memory has grown by %.1f MiB' % (growth / MEBIBYTE))
    wrong += ['%d answers have the status %s' % (count, status) for status, count in judged['statuses'].items()
              if int(status) not in LEGAL]
    if not is_short(run):
        wrong += missing(run)
    return wrong + ['nothing was judged: %s is 0' % what for what in WANTED if judged[what] == 0]


def told(result):
    """What was found, and how the memory of each run has grown. All counts are in soak.json."""
    lines = ['Soak of %g minutes, seed %d' % (result['minutes'], result['seed'])]
    lines += result['findings'] or ['Nothing was found.']
    for kind, run in result['runs'].items():
        if 'judged' not in run:
            continue
        growth, slope = memory_trend(run['memory'])
        lines.append('%s: memory has grown by %.2f MiB (%.1f MiB/h) after the first %d %%; it may grow by %d MiB' % (
            kind, growth / MEBIBYTE, slope * HOUR / MEBIBYTE, 100 * WARM_UP, most_growth(run) // MEBIBYTE))
    return '\n'.join(lines)
