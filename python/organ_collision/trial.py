"""What happened in a trial: touches, depths, distances, forces and paths, from the messages of the nodes in their order.

doc/trials.md defines all measures. Only the tips' paths (23 MB an hour and tool) and the touches make memory grow.
"""

from array import array
from collections import Counter, defaultdict
from math import hypot
from operator import add
from types import SimpleNamespace

import numpy as np
from PyKDL import Frame, Rotation, Vector

from organ_collision.msg import Clearance, ContactArray, Grasp, ProxyState, TouchEvent
from organ_collision.recordings import decoder, seconds

GAP = 1.0  # [s] Without an answer OK for longer, it is not known what happened. A longer step back of stamps is a jump.
IDLE_SPEED, IDLE_TIME = 0.005, 0.5         # [m/s], [s] A tip that is slower for longer is idle.
RATE, THINNED, PATH_GAP = 100, 0.005, 0.2  # [Hz], [s], [s] of paths
HAND = 'hand of haptic_proxy'              # a source of a tip's poses
KINDS = {kind._type: kind._md5sum for kind in (ContactArray, Grasp, ProxyState, TouchEvent)}
# What is read of each message, in its order there.
FIELDS = {
    'organ_collision/ContactArray': 'header.stamp organ tool links status contacts clearance.state clearance.margin '
                                    'clearance.distance clearance.least path_incomplete',
    'organ_collision/TouchEvent': 'header.stamp event organ tool touch duration_sec deepest faces reason',
    'organ_collision/Grasp': 'header.stamp event organ tool duration_sec reason',
    'organ_collision/ProxyState': 'header.stamp tool state hand.position wrench.force contacts.organ contacts.force',
    'geometry_msgs/PoseStamped': 'header.stamp pose.position',
    'tf2_msgs/TFMessage': 'transforms.header.stamp transforms.header.frame_id transforms.child_frame_id transforms.transform'}


class TrialError(RuntimeError):
    """The messages cannot be reported, and the text says why."""


class Clock:
    """Stamps of one stream of messages without their jumps back: the trial goes on where it was."""

    def __init__(self):
        self.first, self.last, self.offsets, self.back, self.unknown = np.inf, -np.inf, [0.0], [], 0.0

    def __call__(self, stamp, is_known=True):
        """The time of a stamp. `is_known`: whether the message tells what happened since the one before."""
        time = stamp + self.offsets[-1]
        if time < self.last - GAP:
            self.back.append((self.last, self.last - time))
            self.offsets.append(self.last - stamp)
            time = self.last
        if time > self.last > -np.inf and (not is_known or time - self.last > GAP):
            self.unknown += time - self.last
        self.first, self.last = min(self.first, time), max(self.last, time)
        return time

    def unknown_share(self, end):
        """The share of the time up to `end` in which messages told nothing, or did not come. None: there was no time."""
        missing = self.unknown + (end - self.last if end - self.last > GAP else 0.0)
        return missing / (end - self.first) if end > self.first else None

    def of_event(self, stamp):
        """The time of an event that may come just after a jump and be about the time before."""
        return min((stamp + offset for offset in self.offsets[-2:]), key=lambda time: abs(time - self.last))


class Envelope:
    """The least and the greatest value in each of at most 20000 equal times, of 2 ms at first; or the latest of them.

    lasting  keep times of 2 ms, but only so many seconds; None: keep all, in coarser times
    """

    def __init__(self, lasting=None):
        self.width, self.bins, self.lasting = 0.002, {}, lasting

    def add(self, time, low, high):
        key = int(time / self.width)
        old = self.bins.get(key, (low, high))
        self.bins[key] = (min(low, old[0]), max(high, old[1]))
        while self.lasting and next(iter(self.bins)) < key - self.lasting / self.width:
            del self.bins[next(iter(self.bins))]
        if len(self.bins) > 20000 and not self.lasting:
            finer, self.bins, self.width = self.points().T, {}, 2 * self.width
            for time, low, high in finer.tolist():
                self.add(time + self.width / 4, low, high)  # The middle of the finer time does not depend on rounding.

    def points(self):
        """Times, least and greatest values."""
        return np.array(sorted((key * self.width, *values) for key, values in self.bins.items())).reshape(-1, 3).T


class Path:
    """The way of a tool's tip."""

    def __init__(self):
        self.clock, self.times, self.places, self.cuts = Clock(), array('d'), array('d'), [0]

    def add(self, stamp, place):
        """A stamp of the tip, and a function that gives its place then."""
        jumps, time = len(self.clock.back), self.clock(stamp)
        has_jumped = len(self.clock.back) > jumps
        if self.times and not has_jumped and time < self.times[-1] + THINNED:
            return
        if has_jumped or self.times and time > self.times[-1] + PATH_GAP:
            self.cuts.append(len(self.times))
        self.times.append(time)
        self.places.extend(place())

    def measures(self):
        """Its length, time and idle time, the mean smoothness of its movements, and an Envelope of its speed."""
        of, smoothness = SimpleNamespace(first=self.clock.first, path=0.0, path_sec=0.0, idle_sec=0.0, sparc=None, ldlj=None,
                                         speed=Envelope()), []
        for begin, end in zip(self.cuts, self.cuts[1:] + [len(self.times)]):
            times = np.array(self.times[begin:end])
            grid = times[:1] + np.arange(np.ceil(np.ptp(times) * RATE) if len(times) else 0) / RATE
            if len(grid) < 2:
                continue
            places = np.array(self.places[3 * begin:3 * end]).reshape(-1, 3)
            places = np.stack([_smoothed(np.interp(grid, times, axis)) for axis in places.T], axis=1)
            speed = np.linalg.norm(np.diff(places, axis=0), axis=1) * RATE
            is_idle = np.zeros(len(speed), bool)
            for first, last in _long_runs(speed < IDLE_SPEED):
                is_idle[first:last] = True
            of.path += speed.sum() / RATE
            of.path_sec += len(speed) / RATE
            of.idle_sec += is_idle.sum() / RATE
            smoothness += [(sparc(speed[first:last]), ldlj(speed[first:last])) for first, last in _long_runs(~is_idle)]
            for time, value in zip(grid.tolist(), speed.tolist()):
                of.speed.add(time, value, value)
        of.movements = len(smoothness)
        if smoothness:
            of.sparc, of.ldlj = np.mean(smoothness, axis=0).tolist()
        return of


def _smoothed(values):
    """Without what is faster than about 10 Hz: the mean over 0.1 s, weighted by a Hann window."""
    window = np.hanning(13)[1:-1]
    return np.convolve(np.pad(values, 5, 'reflect', reflect_type='odd'), window / window.sum(), 'valid')


def _long_runs(flags):
    """The (first, last + 1) of each run of true values that lasts IDLE_TIME."""
    runs = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]]))).reshape(-1, 2)
    return runs[np.diff(runs)[:, 0] >= IDLE_TIME * RATE].tolist()


def sparc(speed):
    """The spectral arc length of a movement, with the constants of Balasubramanian et al., On the analysis of movement
    smoothness, J NeuroEng Rehabil 12:112 (2015): up to 10 Hz, and to the last amplitude of 5 % of the largest."""
    size = 2 ** (int(np.ceil(np.log2(len(speed)))) + 4)
    spectrum = np.abs(np.fft.rfft(speed, size))[:int(10 * size / RATE) + 1]
    spectrum = spectrum / spectrum.max()
    last = np.flatnonzero(spectrum >= 0.05)[-1]
    return -np.hypot(1 / last, np.diff(spectrum[:last + 1])).sum() if last else 0.0


def ldlj(speed):
    """The log dimensionless jerk of a movement, from its speed: Hogan and Sternad, J Mot Behav 41:529 (2009), and
    Balasubramanian et al."""
    jerk = np.diff(speed, 2) * RATE ** 2
    return -np.log((len(speed) / RATE) ** 3 / speed.max() ** 2 * (jerk ** 2).sum() / RATE)


class Pair:
    """What happened between a tool and an organ. None is what is not known."""

    def __init__(self, tool, organ, series):
        self.tool, self.organ, self.clock, self.series = tool, organ, Clock(), defaultdict(series)
        self.statuses, self.incomplete, self.margin, self.is_of_proxy = Counter(), 0, np.inf, False
        self.deepest = self.least = self.largest_force = None
        self.force_sum, self.pressed, self.touches, self.grasps = 0.0, 0, [], []

    def answer(self, stamp, status, contacts, state, margin, distance, least, is_incomplete):
        time = self.clock(stamp, status == ContactArray.OK)
        self.statuses[status] += 1
        if status != ContactArray.OK:
            return
        self.incomplete += is_incomplete
        is_known = state == Clearance.KNOWN
        least, distance = (least, distance) if is_known else (0.0, 0.0)
        if len(contacts):
            depth, least = float(contacts['depth'].max()), 0.0
            self.deepest = depth if self.deepest is None else max(depth, self.deepest)
            self.series['depth'].add(time, depth, depth)
        if len(contacts) or is_known:
            self.least = least if self.least is None else min(least, self.least)
            self.series['distance'].add(time, min(least, distance), distance)
        elif state == Clearance.BEYOND_MARGIN:
            self.margin = min(self.margin, margin)

    def event(self, stamp, event, number, duration, deepest, faces, reason):
        time, is_begin = self.clock.of_event(stamp), event == TouchEvent.BEGIN
        begin = time if is_begin else time - duration
        last = self.touches[-1] if self.touches and self.touches[-1].seconds is None else None
        if last and (is_begin or last.number != number):
            last.seconds, last.reason, last = begin - last.begin, 'its end is missing', None
        if not last:
            self.touches.append(SimpleNamespace(begin=begin, seconds=None, deepest=None, faces=None, number=number,
                                                reason='goes on at the end'))
        if not is_begin:
            self.touches[-1].__dict__.update(seconds=duration, deepest=deepest, faces=faces, reason=reason or 'moved off')

    def touch_sec(self):
        """The time of each touch."""
        return [max(0.0, self.clock.last - touch.begin) if touch.seconds is None else touch.seconds for touch in self.touches]

    def force(self, time, force):
        self.largest_force, self.force_sum = max(force, self.largest_force or 0.0), self.force_sum + force
        self.pressed += force > 0
        self.series['force'].add(time, force, force)


class Tool:
    """The paths of a tool's tip, by where its poses come from, and the force on its hand."""

    def __init__(self):
        self.clock, self.paths, self.links, self.largest_force, self.organ = Clock(), defaultdict(Path), [], None, None

    @property
    def tip(self):
        """Where the poses of its tip come from, TF or a topic before the hand. None: there are none."""
        return min(self.paths, key=lambda source: source == HAND, default=None)


class Trial:
    """Takes the messages, and keeps what a report needs.

    nodes   names of the nodes that count; empty: all. Answers about one tool and organ come from one of them
    tips    {tool: TF frame of its tip, or topic of its poses, which begins with /}; None: no paths are kept
    series  makes what keeps the depths, distances and forces of a pair
    """

    def __init__(self, nodes=(), tips=None, series=Envelope):
        self.nodes, self.tips, self.series = nodes, tips, series
        self.pairs, self.tools, self.sources, self.frames = {}, defaultdict(Tool), {}, {}

    def wants(self, topic, kind):
        """Whether a topic may belong to a trial."""
        return kind in KINDS or self.tips is not None and (
            kind == 'tf2_msgs/TFMessage' and topic.endswith(('/tf', '/tf_static'))
            or kind == 'geometry_msgs/PoseStamped' and topic in self.tips.values())

    def has(self, connection):
        """Whether a topic of a node belongs to this trial. Raises TrialError if it is of another version."""
        topic, kind, md5, node = connection
        if kind in KINDS and self.nodes and node not in self.nodes and not topic.startswith(
                tuple(name + '/' for name in self.nodes)):
            return False
        if KINDS.get(kind, md5) != md5:
            raise TrialError('%s has %s of another version of this package; report it with the version that recorded it, or '
                             'convert it with `rosbag fix`' % (topic, kind))
        return self.wants(topic, kind)

    def take(self, connection, receipt, data):
        """A message of a topic for which has() is true: the time of receipt [s], and its bytes. Raises TrialError if another
        node has answered about the same tool and organ, and ValueError if the bytes are damaged."""
        values, kind = decoder(connection.kind, FIELDS[connection.kind])(data), connection.kind.split('/')[1]
        if kind == 'TFMessage':
            return self.transforms(*values, connection.topic.endswith('static'))
        secs, nsecs, *values = values
        stamp = seconds(secs, nsecs) or receipt
        if kind == 'PoseStamped':
            for tool in (tool for tool, tip in self.tips.items() if tip == connection.topic):
                self.tools[tool].paths[connection.topic].add(stamp, lambda: values)
            return
        if kind == 'ProxyState':
            self.check(connection, values[0])
            self.state(stamp, *values)
        elif kind == 'ContactArray':
            organ, tool, links, *values = values
            self.check(connection, tool, organ)
            self.tools[tool].links = links
            self.pair(tool, organ).answer(stamp, *values)
        else:
            event, organ, tool, *values = values
            self.check(connection, tool, organ)
            if kind == 'TouchEvent':
                self.pair(tool, organ).event(stamp, event, *values)
            else:
                self.pair(tool, organ).grasps.append((event, *values))

    def check(self, connection, *about):
        """Raises TrialError if another node has sent such a message about the same tool, or tool and organ."""
        known = self.sources.setdefault((connection.kind, *about), connection)
        if known is not connection and known != connection:
            raise TrialError('%s about %s from two nodes: %s from %s and %s from %s; choose with --node' % (
                connection.kind.split('/')[1], ' and '.join(about), known.topic, known.node or '?', connection.topic,
                connection.node or '?'))

    def pair(self, *names):
        if names not in self.pairs:
            self.pairs[names] = Pair(*names, self.series)
        return self.pairs[names]

    def state(self, stamp, name, state, *numbers):
        """A state of haptic_proxy: the place of the hand, the force on it, and the force on each organ."""
        tool, hand, force, contacts = self.tools[name], numbers[:3], numbers[3:6], numbers[6]
        time = tool.clock(stamp, state != ProxyState.NO_ANSWER)
        if state == ProxyState.NO_ANSWER:
            return
        on_hand = hypot(*force)
        tool.largest_force = max(on_hand, tool.largest_force or 0.0)
        if self.tips is not None:
            tool.paths[HAND].add(stamp, lambda: hand)
        forces = {organ: (0.0, 0.0, 0.0) for other, organ in self.pairs if other == name}
        for organ, *force in contacts:
            self.pair(name, organ).is_of_proxy = True
            forces[organ] = [*map(add, forces.get(organ, (0.0, 0.0, 0.0)), force)]
        if state == ProxyState.PUNCTURED and tool.organ:
            forces[tool.organ] = (on_hand,)  # The state names no organ: it is the one that was pressed last.
        for organ, force in forces.items():
            force = hypot(*force)
            tool.organ = organ if force > 0 else tool.organ
            self.pair(name, organ).force(time, force)

    def transforms(self, transforms, is_static):
        """Transforms of TF: where the tips are in the frame above all others. For frames that are not in this message,
        the transforms that came last count."""
        moved = {}
        for secs, nsecs, parent, child, *numbers in transforms:
            child = child.lstrip('/')
            self.frames[child] = parent.lstrip('/'), numbers
            moved[child] = 0.0 if is_static else seconds(secs, nsecs)
        for name, tool in self.tools.items():
            tips = [self.tips[name]] if name in self.tips else [name + '_tip', *(link for link, in tool.links[:1])]
            frame = tip = next((frame for frame in tips if frame in self.frames), None)
            chain, stamp = [], 0.0
            while frame in self.frames and len(chain) < 100:  # A loop of frames ends, too.
                stamp = max(stamp, moved.get(frame, 0.0))
                frame, numbers = self.frames[frame]
                chain.append(numbers)
            if stamp:
                tool.paths['frame ' + tip].add(stamp, lambda: _origin(chain))


def _origin(chain):
    """The origin of the first of some frames in the frame above the last: each has its place and quaternion in the next."""
    place = Vector()
    for x, y, z, *quaternion in chain:
        place = Frame(Rotation.Quaternion(*quaternion), Vector(x, y, z)) * place
    return place
