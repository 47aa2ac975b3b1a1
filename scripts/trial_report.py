#!/usr/bin/python3
"""Tells how a trial went, from a bag or from the running nodes: an HTML page that needs no network, and CSV.

Limits in a yaml are kept or broken: the page says so first, and standard output, too. doc/trials.md explains limits and
measures. Writes NAME.html, NAME.csv (tools and organs), NAME_touches.csv and NAME_limits.csv.
"""

import argparse
import base64
import csv
import difflib
import html
import io
import os
import sys
import time

from matplotlib.figure import Figure
import numpy as np
from organ_collision.msg import Grasp
from organ_collision.recordings import BagError, Listener, read_bag
from organ_collision.trial import Trial, TrialError
from organ_collision.trial_plots import draw
import rospy
import yaml

# Limits of a tool with an organ, and those of a tool: the measure, how it is shown, and its factor from SI units.
OF_PAIR = {'max_touches': ('touches', '%d touches', 1), 'max_touch_sec': ('touch_sec', '%.1f s in touch', 1),
           'max_depth': ('depth', '%.2f mm deep', 1e3), 'max_force': ('force', '%.2f N', 1),
           'min_distance': ('distance', '%.2f mm away', 1e3)}
LIMITS = {**OF_PAIR, 'max_path': ('path', '%.0f mm of path', 1e3), 'max_path_sec': ('path_sec', '%.1f s of path', 1),
          'max_idle_sec': ('idle_sec', '%.1f s idle', 1)}
UNKNOWN_SHARE = 0.01  # If a larger share of the time has no answer OK, it is not known whether a limit was kept.
ONE_TIME = 0.1        # [s] A limit that is broken again within this time was broken all the time.
MOST_TIMES = 20       # of a limit that the page shows
STYLE = ('body{font:15px sans-serif;margin:2em auto;max-width:75em;color:#222}table{border-collapse:collapse;margin:1em 0}'
         'td,th{border:1px solid #ccc;padding:.3em .6em;text-align:right}td:first-child,th:first-child{text-align:left}'
         'h1{padding:.5em}img{max-width:100%}.kept{background:#d8f0dc}.broken{background:#f8d3cf}.unknown{background:#f3ecc8}')


def read_limits(path):
    """The limits of a yaml: (key, value, tool, organ). Raises TrialError, which names the entry and what is legal."""
    try:
        with open(path, encoding='utf-8') as text:
            entries = [{**entry} for entry in yaml.safe_load(text)['limits']]
    except (OSError, yaml.YAMLError, TypeError, KeyError, UnicodeError) as error:
        raise TrialError('%s has no list `limits`: %s' % (path, ' '.join(str(error).split()))) from error
    for number, keys in enumerate(entries, 1):
        tool, organ = (None if name is None else str(name) for name in (keys.pop('tool', None), keys.pop('organ', None)))
        where = '%s, limit %d: ' % (path, number)
        if not keys:
            raise TrialError(where + 'it limits nothing; legal are ' + ', '.join(LIMITS))
        for key, value in keys.items():
            if key not in LIMITS:
                near = difflib.get_close_matches(str(key), LIMITS, 1) or ['one of tool, organ, ' + ', '.join(LIMITS)]
                raise TrialError(where + 'unknown key %r; did you mean %s?' % (key, near[0]))
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < float('inf'):
                raise TrialError(where + '%s is %r; must be a number from 0 on' % (key, value))
            if organ is not None and key not in OF_PAIR:
                raise TrialError(where + '%s is about a tool; leave out organ' % key)
            yield key, value, tool, organ


class Report:
    """A trial that is over."""

    def __init__(self, name, trial, limits, notes):
        self.name, self.trial, self.limits = name, trial, limits
        tools = {name: trial.tools[name] for name in {*trial.tools, *(name for name, _ in trial.pairs)}}
        self.paths = {name: tool.paths[tool.tip].measures() if tool.tip else None for name, tool in tools.items()}
        clocks = [of.clock for of in (*tools.values(), *trial.pairs.values())]
        self.start, self.end = min(clock.first for clock in clocks), max(clock.last for clock in clocks)
        self.notes = notes + ['The stamps about %s and %s step back by %.3f s at %.3f s. The trial goes on from there.' % (
            *names, by, at - self.start) for names, pair in trial.pairs.items() for at, by in pair.clock.back]
        self.verdicts = [self.judge(*limit) for limit in limits]
        states = [row['state'] for row in self.verdicts]
        self.state = next((state for state in ('broken', 'unknown') if state in states), 'kept' if states else 'unknown')
        self.headline = 'No limits were given' if not states else {
            'kept': 'GOOD: all %d limits were kept', 'unknown': 'NOT KNOWN: %d of %d limits cannot be judged',
            'broken': 'NOT GOOD: %d of %d limits were broken'}[self.state] % (
                (len(states),) if self.state == 'kept' else (states.count(self.state), len(states)))

    def judge(self, key, legal, tool, organ):
        """Whether a limit was kept, when it was broken, and why this is not known: a row of the table."""
        (name, text, scale), worst, times, why = LIMITS[key], max if key.startswith('max') else min, [], ''
        if key in OF_PAIR:
            about = [pair for pair in self.trial.pairs.values() if tool in (None, pair.tool) and organ in (None, pair.organ)]
            for pair in about:
                times += self.times_over(pair, name, legal, worst)
                why = why or self.why_unknown(pair, name, legal)
        else:
            about = [one for one in self.trial.tools if tool in (None, one)]
            for one in about:
                path = self.paths[one]
                if path and getattr(path, name) > legal:
                    times.append((self.end, self.end, getattr(path, name)))
                if not path or path.path_sec < (1 - UNKNOWN_SHARE) * (self.end - path.first) - 0.1:
                    why = 'the tip of %s was seen for %.1f s only' % (one, path.path_sec if path else 0)
        times.sort()
        shown = ', '.join('%.2f to %.2f' % (begin - self.start, end - self.start) for begin, end, _ in times[:MOST_TIMES])
        names = ' with '.join(filter(None, (tool, organ)))
        why = '' if times else why if about else '%s never came' % (names or 'tools')
        return {'limit': '%s: at %s %s' % (names or 'all', 'most' if worst is max else 'least', text % (scale * legal)),
                'state': 'broken' if times else 'unknown' if why else 'kept',
                'worst': text % (scale * worst(value for _, _, value in times)) if times else None,
                'times_sec': shown + (', and %d more' % (len(times) - MOST_TIMES) if len(times) > MOST_TIMES else ''),
                'why_not_known': why}

    def why_unknown(self, pair, name, legal):
        """Why it is not known whether a pair broke a limit that no message shows to be broken; '' if it is known."""
        names, was_touched = '%s and %s' % (pair.tool, pair.organ), bool(pair.touches or pair.deepest is not None)
        share = (self.trial.tools[pair.tool] if name == 'force' else pair).clock.unknown_share(self.end)
        if name == 'force' and (pair.largest_force is None or was_touched and not pair.is_of_proxy):
            return 'haptic_proxy tells no force between ' + names
        if name == 'distance' and pair.least is None and not legal <= pair.margin < np.inf:
            return 'the margin of %s is smaller, or it has none' % pair.tool
        if name.startswith('touch') and was_touched and not pair.touches:
            return 'there are contacts of %s, but no events on `touches`' % names
        if share is None or share > UNKNOWN_SHARE:
            return 'no answers OK about %s in %.0f %% of the time' % (names, 100 * (share or 1))
        return ''

    @staticmethod
    def times_over(pair, name, legal, worst):
        """(begin, end, worst value) of each time in which a pair breaks a limit."""
        if name.startswith('touch'):
            values = range(1, len(pair.touches) + 1) if name == 'touches' else np.cumsum(pair.touch_sec()).tolist()
            return [(touch.begin, touch.begin + lasted, value)
                    for touch, lasted, value in zip(pair.touches, pair.touch_sec(), values) if value > legal]
        times, low, high = pair.series[name].points()
        values = high if worst is max else low
        over = np.flatnonzero(values > legal if worst is max else values < legal)
        parts = np.split(over, np.flatnonzero(np.diff(times[over]) > max(ONE_TIME, 1.5 * pair.series[name].width)) + 1)
        return [(times[part[0]], times[part[-1]], worst(values[part])) for part in parts if len(part)]

    def pair_rows(self):
        for (name, organ), pair in sorted(self.trial.pairs.items()):
            tool, path = self.trial.tools[name], self.paths[name]
            ends = [rest for event, *rest in pair.grasps if event == Grasp.RELEASED]
            has_touches = pair.touches or pair.statuses and pair.deepest is None
            yield {'tool': name, 'organ': organ, 'answers': sum(pair.statuses.values()),
                   'not_ok_share': pair.clock.unknown_share(self.end), 'path_incomplete': pair.incomplete,
                   'touches': len(pair.touches) if has_touches else None,
                   'touch_sec': sum(pair.touch_sec()) if has_touches else None, 'deepest_m': pair.deepest,
                   'mean_force_N': pair.force_sum / pair.pressed if pair.pressed else None,
                   'largest_force_N': pair.largest_force, 'largest_hand_force_N': tool.largest_force,
                   'least_distance_m': pair.least, 'tip': tool.tip, 'path_m': path and path.path,
                   **{key: path and getattr(path, key) for key in ('path_sec', 'idle_sec', 'movements', 'sparc', 'ldlj')},
                   'grasps': len(pair.grasps) - len(ends) if pair.grasps else None,
                   **{'grasps_' + how: [reason for _, reason in ends].count(how) if pair.grasps else None
                      for how in ('opened', 'slipped')},
                   'grasp_sec': sum(duration for duration, _ in ends) or None}

    def touch_rows(self):
        rows = [{'begin_sec': touch.begin - self.start, 'duration_sec': lasted, 'tool': pair.tool, 'organ': pair.organ,
                 'deepest_m': touch.deepest, 'faces': touch.faces, 'end': touch.reason}
                for pair in self.trial.pairs.values() for touch, lasted in zip(pair.touches, pair.touch_sec())]
        return sorted(rows, key=lambda row: (row['begin_sec'], row['tool'], row['organ']))

    def write(self, base):
        """Writes the page and the tables."""
        pairs, touches = list(self.pair_rows()), self.touch_rows()
        for ending, rows in ('', pairs), ('_touches', touches), ('_limits', self.verdicts):
            with open(base + ending + '.csv', 'w', newline='', encoding='utf-8') as text:
                writer = csv.DictWriter(text, rows[0].keys() if rows else ['none'])
                writer.writeheader()
                writer.writerows(rows)
        about = '%s: from %s UTC, %.1f s' % (self.name, time.strftime('%Y-%m-%d %H:%M:%S', time.gmtime(self.start)),
                                             self.end - self.start)
        columns = [{'': key, **{'%s, %s' % (row['tool'], row['organ']): row[key] for row in pairs}} for key in pairs[0]]
        page = ['<!DOCTYPE html><meta charset="utf-8"><title>%s</title><style>%s</style><h1 class="%s">%s</h1>' % (
            html.escape(self.name), STYLE, self.state, html.escape(self.headline)), table(self.verdicts),
            *('<p>%s</p>' % html.escape(line) for line in [about, *self.notes[:MOST_TIMES]]), '<h2>Tools and organs</h2>',
            table(columns), *map(self.picture, sorted(self.trial.tools)), '<h2>Touches</h2>', table(touches)]
        with open(base + '.html', 'w', encoding='utf-8') as text:
            text.write('\n'.join(page))

    def picture(self, tool):
        """Plots of a tool over the whole trial."""
        figure, png, path = Figure((11, 8), constrained_layout=True), io.BytesIO(), self.paths[tool]
        draw(figure, self.trial, tool, self.start, path and path.speed,
             [(LIMITS[key][0], legal) for key, legal, about, _ in self.limits if about in (None, tool)])
        figure.savefig(png, dpi=100)
        return '<img alt="plots of %s" src="data:image/png;base64,%s">' % (
            html.escape(tool), base64.b64encode(png.getvalue()).decode())


def table(rows):
    """Rows as HTML, with numbers of four digits. The column `state` colours its row."""
    def cell(value):
        return '' if value is None else '%.4g' % value if isinstance(value, float) else html.escape(str(value))

    lines = ['<tr><th>' + '<th>'.join(map(html.escape, rows[0]))] if rows else ['<tr><td>none']
    return '<table>%s</table>' % '\n'.join(lines + [
        '<tr class="%s"><td>%s' % (row.get('state', ''), '<td>'.join(map(cell, row.values()))) for row in rows])


def listen(duration, trial):
    listener = Listener(trial, 'trial_report')
    print('Listening for %g s, or until Ctrl-C' % duration, file=sys.stderr)
    listener.listen(duration)
    rospy.signal_shutdown('the trial is over')
    listener.lock.acquire()  # Nothing comes any more.


def main():
    options = argparse.ArgumentParser(prog='trial_report.py', description=__doc__,
                                      formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument('bag', nargs='?', help='what `rosbag record` wrote: contacts, touches, states of haptic_proxy, TF')
    options.add_argument('--live', type=float, metavar='SECONDS', help='listens so long instead, or until Ctrl-C')
    options.add_argument('--limits', metavar='FILE', help='a yaml with limits')
    options.add_argument('--out', metavar='NAME', help='path of the results without ending; default: that of the bag')
    options.add_argument('--node', action='append', default=[], help='a node that counts; give it again for others; '
                         'default: all')
    options.add_argument('--tip', action='append', default=[], metavar='TOOL=FRAME', help='TF frame of the tip of a tool, or '
                         'a topic of PoseStamped; default: TOOL_tip, its first link, or the hand of haptic_proxy')
    asked = options.parse_args(rospy.myargv()[1:])
    if (asked.bag is None) == (asked.live is None) or not all('=' in tip for tip in asked.tip):
        options.error('give a bag, or --live SECONDS; and each --tip as TOOL=FRAME')
    limits = list(read_limits(asked.limits)) if asked.limits else []
    trial, name = Trial(asked.node, dict(tip.split('=', 1) for tip in asked.tip)), asked.bag or 'live'
    fault = read_bag(asked.bag, trial) if asked.bag else listen(asked.live, trial)
    notes = ['The bag is %s. This is what is there.' % fault] if fault else []
    if not any(pair.statuses or pair.largest_force is not None for pair in trial.pairs.values()):
        raise TrialError('%s has no answers of a collision node and no forces of haptic_proxy; record the topics contacts, '
                         'touches and state. %s' % (name, *notes[:1], ''))
    report, base = Report(name, trial, limits, notes), asked.out or os.path.splitext(name)[0]
    report.write(base)
    print('\n'.join([report.headline, *('  %s: %s %s' % (row['limit'], row['state'], row['times_sec'] or row['why_not_known'])
                                        for row in report.verdicts), *report.notes, base + '.html']))


if __name__ == '__main__':
    try:
        main()
    except (TrialError, BagError, OSError, rospy.ROSException) as error:
        print('trial_report.py: %s' % error, file=sys.stderr)
        sys.exit(2)
