#!/usr/bin/python3
"""trial_report.py on bags of known contents: all numbers are compared with plain numpy on the same bag, read by rosbag.
Bags and limits that are wrong give one line, or a row of the report."""

import contextlib
import csv
import importlib.machinery
import io
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import genpy
from geometry_msgs.msg import Point, Quaternion, Transform, TransformStamped, Vector3
import numpy as np
from organ_collision.msg import Clearance, Contact, ContactArray, Grasp, ProxyContact, ProxyState, TouchEvent
from organ_collision.recordings import BagError, Connection
from organ_collision.trial import Trial, TrialError
from PyKDL import Frame, Rotation, Vector
import rosbag
from std_msgs.msg import Header, String
from tf2_msgs.msg import TFMessage

REPORT = os.environ['TRIAL_REPORT']
PROGRAM = importlib.machinery.SourceFileLoader('trial_report', REPORT).load_module()
NODE, STATE = '/organ_collision', '/haptic_proxy/probe/state'
START, SECONDS, RATE = 1.7e9, 12.0, 200
ORGANS = {'liver': 0.0, 'vena_cava': -0.004}  # [m] heights of two sheets
RADIUS, MARGIN = 0.005, 0.004
FAILS = (5.0, 6.5)  # [s] without transforms
BASE = Frame(Rotation.RPY(0.3, -0.2, 0.5), Vector(0.1, 0.2, 0.3))  # of the tip's parent in the world
NEAR = dict(rtol=1e-9, atol=1e-9)


def tip(t):
    """Where the tip is [m]: it rests from 8 s to 10 s."""
    t = t if t < 8.0 else 8.0 if t < 10.0 else t - 2.0
    return np.array([0.03 * math.sin(0.9 * t), 0.02 * math.sin(0.5 * t + 1), 0.006 + 0.008 * math.sin(1.7 * t)])


class Scene:
    """What the nodes would publish, with the simplest physics: depths below two sheets."""

    def __init__(self, random):
        self.random, self.open, self.count = random, {}, {}

    def messages(self, t):
        """Yields (topic, message) at a time."""
        stamp, place = genpy.Time.from_sec(START + t), tip(t)
        yield '/tf', TFMessage([TransformStamped(Header(stamp=stamp, frame_id='base'), 'probe_tip', Transform(
            Vector3(*place), Quaternion(0, 0, 0, 1)))])
        pressed = []
        for organ, height in ORGANS.items():
            gap = place[2] - RADIUS - height
            yield NODE + '/contacts', self.answer(organ, gap, t, stamp)
            pressed += [ProxyContact(organ=organ, force=Vector3(10 * -gap, 0, -200 * -gap))] if gap < 0 else []
        state = ProxyState(header=Header(stamp=stamp), tool='probe', state=ProxyState.TOUCHING if pressed else ProxyState.FREE,
                           contacts=pressed)
        state.hand.position = Point(*place)
        state.wrench.force = Vector3(0, 0, sum(contact.force.z for contact in pressed) * -0.9)
        yield STATE, state
        for organ, height in ORGANS.items():
            yield from self.events(organ, place[2] - RADIUS - height, t, stamp)

    def answer(self, organ, gap, t, stamp):
        answer = ContactArray(header=Header(stamp=stamp, frame_id=organ), organ=organ, tool='probe', mode=1)
        answer.step_start = genpy.Time.from_sec(START + t - 1 / RATE)
        if FAILS[0] <= t < FAILS[1]:
            answer.status, answer.message = ContactArray.NO_TRANSFORM, 'no transform'
            return answer
        if gap <= 0:
            answer.contacts = [Contact(face=face, touching=True, depth=-gap - 1e-4 * face, since=answer.step_start)
                               for face in range(self.random.integers(1, 6))]
        answer.near = [Contact(face=9, depth=-gap)] * 3
        known = gap <= MARGIN
        answer.clearance = Clearance(state=Clearance.KNOWN if known else Clearance.BEYOND_MARGIN, margin=MARGIN,
                                     distance=gap if known else 0, least=max(0, gap) if known else 0)
        return answer

    def events(self, organ, gap, t, stamp):
        event = TouchEvent(header=Header(stamp=stamp, frame_id=organ), organ=organ, tool='probe')
        if FAILS[0] <= t < FAILS[1] or (gap <= 0) == (organ in self.open):
            return
        if gap <= 0:
            self.open[organ], self.count[organ] = t, self.count.get(organ, 0) + 1
            event.event = TouchEvent.BEGIN
        else:
            event.event, event.duration_sec = TouchEvent.END, t - self.open.pop(organ)
            event.deepest, event.faces = self.random.uniform(0, 0.01), int(self.random.integers(1, 9))
        event.touch = self.count[organ]
        yield NODE + '/touches', event
        if organ == 'liver':  # Who touches it also grasps it.
            yield NODE + '/grasps', Grasp(header=event.header, organ=organ, tool='probe', grasp=event.touch, faces_first=[1, 2],
                                          event=Grasp.GRASPED if gap <= 0 else Grasp.RELEASED,
                                          reason=('opened', 'reset', 'slipped')[event.touch % 3] if gap > 0 else '',
                                          duration_sec=0.5 * event.duration_sec)


def write_bag(path, seconds=SECONDS, warp=lambda t: t, node=NODE, header=None, compression='none'):
    """A trial as rosbag record writes it, with the receipts 1 ms after the stamps. warp: of the stamps."""
    scene = Scene(np.random.default_rng(3))
    with rosbag.Bag(path, 'w', compression=compression, chunk_threshold=40000) as bag:
        base = TransformStamped(Header(frame_id='world', stamp=genpy.Time.from_sec(START - 50)), 'base', Transform(
            Vector3(*BASE.p), Quaternion(*BASE.M.GetQuaternion())))
        bag.write('/tf_static', TFMessage([base]), genpy.Time.from_sec(START))
        for t in np.arange(0, seconds, 1 / RATE).tolist():
            for topic, message in scene.messages(t):
                of = message.transforms[0] if topic == '/tf' else message
                of.header.stamp = genpy.Time.from_sec(START + warp(t))
                bag.write(topic.replace(NODE, node), message, genpy.Time.from_sec(START + t + 0.001),
                          connection_header=header and header(topic, message))
    return path


def judged(*limits, seconds=3.0, change=lambda topic, message, t: [(topic, message)], node=NODE):
    """The report of a trial whose messages were changed: `change` returns what comes instead of a message."""
    scene, trial = Scene(np.random.default_rng(3)), Trial(tips={})
    for t in np.arange(0, seconds, 1 / RATE).tolist():
        for topic, message in (its for given in scene.messages(t) for its in change(*given, t)):
            data = io.BytesIO()
            message.serialize(data)
            trial.take(Connection(topic, message._type, message._md5sum, node), START + t, data.getvalue())
    return PROGRAM.Report('trial', trial, limits, [])


def read(path):
    """{topic: messages} by rosbag's own reader."""
    topics = {}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages():
            topics.setdefault(topic, []).append(message)
    return topics


def path_measures(transforms, idle_speed=0.005):
    """Length, time and idle time of the tip's path and the smoothness of its movements, as doc/trials.md defines them, by
    loops over samples."""
    times, places = [], []
    for one in (message.transforms[0] for message in transforms):
        t = one.header.stamp.secs + 1e-9 * one.header.stamp.nsecs
        if not times or t >= times[-1] + 0.005:
            times.append(t)
            places.append(list(BASE * Vector(one.transform.translation.x, one.transform.translation.y,
                                             one.transform.translation.z)))
    count = math.ceil((times[-1] - times[0]) * 100)
    grid = times[0] + 0.01 * np.arange(count)
    raw = np.stack([np.interp(grid, times, np.array(places)[:, axis]) for axis in range(3)], axis=1)
    weights = np.array([math.sin(math.pi * (k + 1) / 12) ** 2 for k in range(11)])
    # Beyond its ends, the path goes on as if turned about them.
    raw = np.concatenate([2 * raw[0] - raw[5:0:-1], raw, 2 * raw[-1] - raw[-2:-7:-1]])
    smooth = np.array([sum(w * raw[i + k] for k, w in enumerate(weights)) / weights.sum() for i in range(count)])
    speed = np.linalg.norm(smooth[1:] - smooth[:-1], axis=1) * 100
    slow, idle, begin = speed < idle_speed, np.zeros(len(speed), bool), 0
    movements = []
    for i in range(1, len(speed) + 1):
        if i == len(speed) or slow[i] != slow[begin]:
            if slow[begin] and i - begin >= 50:
                idle[begin:i] = True
            begin = i
    begin = 0
    for i in range(1, len(speed) + 1):
        if i == len(speed) or idle[i] != idle[begin]:
            if not idle[begin] and i - begin >= 50:
                movements.append(speed[begin:i])
            begin = i
    return {'path_m': speed.sum() / 100, 'path_sec': len(speed) / 100, 'idle_sec': idle.sum() / 100,
            'movements': len(movements), 'sparc': np.mean([arc_length(v, 100) for v in movements]),
            'ldlj': np.mean([log_jerk(v, 100) for v in movements])}


def arc_length(v, rate):
    """Equations 6 and 7 of Balasubramanian et al. 2015, by frequencies."""
    padded = int(2 ** (np.ceil(np.log2(len(v))) + 4))
    frequencies, amplitudes = np.arange(padded) * rate / padded, np.abs(np.fft.fft(v, padded))
    kept = frequencies <= 10.0
    frequencies, amplitudes = frequencies[kept], amplitudes[kept] / amplitudes.max()
    last = max(i for i, amplitude in enumerate(amplitudes) if amplitude >= 0.05)
    frequencies, amplitudes = frequencies[:last + 1], amplitudes[:last + 1]
    return -sum(math.sqrt(((frequencies[i + 1] - frequencies[i]) / (frequencies[-1] - frequencies[0])) ** 2
                          + (amplitudes[i + 1] - amplitudes[i]) ** 2) for i in range(last))


def log_jerk(v, rate):
    jerk = [(v[i + 2] - 2 * v[i + 1] + v[i]) * rate ** 2 for i in range(len(v) - 2)]
    return -math.log((len(v) / rate) ** 3 / max(v) ** 2 * sum(j * j for j in jerk) / rate)


def seconds(stamp):
    return stamp.secs + 1e-9 * stamp.nsecs


def pair_measures(topics, organ):
    """What the summary should say of a pair."""
    answers = [m for m in topics[NODE + '/contacts'] if m.organ == organ]
    events = [m for m in topics[NODE + '/touches'] if m.organ == organ]
    stamps = np.array([seconds(m.header.stamp) for m in answers])
    bad = np.array([m.status != 0 for m in answers])[1:]
    forces = np.array([np.linalg.norm([sum(c.force.x for c in m.contacts if c.organ == organ),
                                       sum(c.force.z for c in m.contacts if c.organ == organ)]) for m in topics[STATE]])
    known = [m.clearance.least for m in answers if m.clearance.state == Clearance.KNOWN] + [
        0.0 for m in answers if m.contacts]
    begins = [e for e in events if e.event == TouchEvent.BEGIN]
    ends = [e for e in events if e.event == TouchEvent.END]
    lasting = sum(e.duration_sec for e in ends)
    if len(begins) > len(ends):
        lasting += stamps[-1] - seconds(begins[-1].header.stamp)
    grasps = [m for m in topics[NODE + '/grasps'] if m.organ == organ]
    return {'grasps': len([m for m in grasps if m.event == Grasp.GRASPED]) or None,
            **{'grasps_' + reason: len([m for m in grasps if m.reason == reason]) if grasps else None
               for reason in ('opened', 'slipped')},
            'grasp_sec': sum(m.duration_sec for m in grasps if m.event == Grasp.RELEASED) or None,
            'answers': len(answers), 'not_ok_share': np.diff(stamps)[bad].sum() / (stamps[-1] - stamps[0]),
            'touches': len(begins), 'touch_sec': lasting,
            'deepest_m': max(c.depth for m in answers for c in m.contacts), 'mean_force_N': forces[forces > 0].mean(),
            'largest_force_N': forces.max(), 'least_distance_m': min(known),
            'largest_hand_force_N': max(abs(m.wrench.force.z) for m in topics[STATE])}


class TrialTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.kept.cleanup)
        cls.whole = write_bag(os.path.join(cls.kept.name, 'whole.bag'))

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def trial(self):
        """A copy of the bag of the whole trial."""
        return shutil.copy(self.whole, self.file('trial.bag'))

    def file(self, name, text=None):
        path = os.path.join(self.folder, name)
        if text is not None:
            with open(path, 'w') as file:
                file.write(text)
        return path

    def run_report(self, *words):
        """What the program prints. It runs within this process, which saves its start."""
        with mock.patch.object(sys, 'argv', [REPORT, *words]), contextlib.redirect_stdout(io.StringIO()) as printed, \
                contextlib.redirect_stderr(io.StringIO()):
            PROGRAM.main()
        return printed.getvalue()

    def assert_refused(self, *words, says):
        """One line, and no report."""
        before = sorted(os.listdir(self.folder))
        with self.assertRaises((TrialError, BagError, OSError)) as raised:
            self.run_report(*words)
        self.assertEqual(len(str(raised.exception).splitlines()), 1)
        for word in says:
            self.assertIn(word, str(raised.exception))
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def rows(self, name):
        with open(self.file(name)) as text:
            return list(csv.DictReader(text))

    def limits(self, *entries):
        return self.file('limits.yaml', 'limits:\n' + ''.join('  - %s\n' % entry for entry in entries))

    def page(self, name='trial.html'):
        with open(self.file(name)) as text:
            return text.read()

    def test_all_numbers_are_those_of_numpy(self):
        for compression in ('none', 'bz2', 'lz4'):
            bag = self.trial() if compression == 'none' else write_bag(self.file('trial.bag'), 7.0, compression=compression)
            self.run_report(bag)
            topics, rows = read(bag), {row['organ']: row for row in self.rows('trial.csv')}
            self.assertEqual(set(rows), set(ORGANS))
            for organ, row in rows.items():
                # The tool is known from its first answer on.
                expected = {**pair_measures(topics, organ), **path_measures(topics['/tf'][1:])}
                self.assertEqual((row['tool'], row['tip']), ('probe', 'frame probe_tip'))
                for key, value in expected.items():
                    if value is None:
                        self.assertEqual(row[key], '', key)
                        continue
                    np.testing.assert_allclose(float(row[key]), value, err_msg='%s of %s' % (key, organ), **NEAR)

    def test_limits_are_kept_broken_or_not_known(self):
        bag = self.trial()
        limits = self.limits('{organ: vena_cava, max_touches: 0}', '{organ: liver, max_force: 0.9}',
                             '{tool: probe, max_depth: 0.1, max_path: 10}', '{organ: 5, max_touches: 0}',
                             '{organ: liver, min_distance: 0.001}', '{tool: probe, max_idle_sec: 1}',
                             '{organ: liver, max_touch_sec: 1.5}')
        done = self.run_report(bag, '--limits', limits)
        topics, rows = read(bag), self.rows('trial_limits.csv')
        self.assertEqual([row['state'] for row in rows],
                         ['broken', 'broken', 'unknown', 'kept', 'unknown', 'broken', 'broken', 'broken'])
        self.assertIn('13 %', rows[2]['why_not_known'])  # Answers failed for 1.5 of 12 s.
        self.assertIn('5 never came', rows[4]['why_not_known'])
        touches = [e for e in topics[NODE + '/touches'] if e.organ == 'vena_cava' and e.event == TouchEvent.BEGIN]
        self.assertEqual([float(word) for word in re.findall(r'(\S+) to', rows[0]['times_sec'])],
                         [round(seconds(e.header.stamp) - START, 2) for e in touches])
        # The times of a force above the limit, by plain comparison.
        over = [seconds(m.header.stamp) - START for m in topics[STATE]
                if np.linalg.norm([sum(c.force.x for c in m.contacts if c.organ == 'liver'),
                                   sum(c.force.z for c in m.contacts if c.organ == 'liver')]) > 0.9]
        parts = np.split(over, np.flatnonzero(np.diff(over) > 0.1) + 1)
        np.testing.assert_allclose([float(time) for time in re.findall(r'[\d.]+', rows[1]['times_sec'])],
                                   [time for part in parts for time in (part[0], part[-1])], atol=0.011)
        self.assertTrue(done.startswith('NOT GOOD: 5 of 8 limits were broken\n'), done)
        page = self.page()
        self.assertLess(page.index('NOT GOOD: 5 of 8'), page.index('<h2>'))  # on the first screen, with the times
        self.assertLess(page.index(rows[1]['times_sec']), page.index('<h2>'))
        self.assertNotRegex(page, r'(src|href)="(?!data:)')  # needs no network

    def test_the_program_prints_a_good_trial_or_one_line(self):
        bag = write_bag(self.file('trial.bag'), seconds=1.0)
        for limit, code, printed in (('{organ: liver, max_force: 10, max_depth: 0.01}', 0, r'GOOD: all 2 limits were kept\n'),
                                     ('{organ: liver, max_forse: 10}', 2, r'trial_report\.py: .*max_forse.*\n\Z')):
            done = subprocess.run([sys.executable, REPORT, bag, '--limits', self.limits(limit)], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertRegex(done.stderr if code else done.stdout, r'\A' + printed)

    def test_a_damaged_bag_is_read_up_to_the_damage_and_an_unclosed_one_to_its_end(self):
        bag = self.trial()
        with open(bag, 'r+b') as file:
            whole = file.read()
            at = whole.index(b'op=\x05', len(whole) // 2)
            file.seek(at - 8)
            file.write(b'\xff' * 16)
        self.assertIn('damaged before', self.run_report(bag))
        with open(bag, 'wb') as file:  # In a message: no count of contacts is that large.
            at = whole.index(b'probe' + bytes(4), len(whole) // 2) + 9  # An answer: the tool has no links.
            file.write(whole[:at] + b'\xff' * 60 + whole[at + 60:])
        self.assertIn('damaged before', self.run_report(bag))
        self.assertAlmostEqual(float(self.rows('trial.csv')[0]['answers']) / (SECONDS * RATE), 0.5, delta=0.06)
        with open(bag, 'wb') as file:
            file.write(whole.replace(b'index_pos=' + whole.split(b'index_pos=')[1][:8], b'index_pos=' + bytes(8), 1))
        self.assertIn('not closed by its recorder', self.run_report(bag))
        self.assertEqual(float(self.rows('trial.csv')[0]['answers']), SECONDS * RATE)

    def test_clocks_that_step_back_are_told_and_the_trial_goes_on(self):
        bag = write_bag(self.file('trial.bag'), warp=lambda t: t if t < 7.0 else t - 5.0)
        done = self.run_report(bag)
        self.assertIn('The stamps about probe and liver step back by 4.995 s at 6.995 s', done)
        whole = self.rows('trial.csv')
        self.trial()
        self.run_report(bag)
        for row, smooth in zip(whole, self.rows('trial.csv')):
            for key in ('answers', 'touches', 'deepest_m', 'largest_force_N'):
                self.assertEqual(row[key], smooth[key])
            self.assertAlmostEqual(float(row['path_m']), float(smooth['path_m']), delta=0.005)
            self.assertAlmostEqual(float(row['touch_sec']), float(smooth['touch_sec']), delta=0.01)

    def test_wrong_bags_are_one_line(self):
        other = self.file('other.bag')
        with rosbag.Bag(other, 'w') as bag:
            bag.write('/chatter', String('hello'), genpy.Time(1))
        self.assert_refused(other, says=['other.bag has no answers of a collision node'])
        with rosbag.Bag(other, 'w') as bag:
            bag.write(NODE + '/touches', TouchEvent(organ='liver', tool='probe'), genpy.Time(1))
        self.assert_refused(other, says=['other.bag has no answers of a collision node'])
        self.assert_refused(self.file('limits.yaml', 'limits: []'), says=['limits.yaml is no bag'])
        self.assert_refused(self.file('none.bag'), says=['none.bag'])
        old = write_bag(self.file('old.bag'), seconds=0.1, header=lambda topic, message: {
            'topic': topic, 'type': message._type, 'md5sum': '0' * 32, 'message_definition': message._full_text})
        self.assert_refused(old, says=['/organ_collision/contacts has organ_collision/ContactArray of another version'])

    def assert_unknown(self, report, *says):
        (row,) = report.verdicts
        self.assertEqual(row['state'], 'unknown', row)
        for word in says:
            self.assertIn(word, row['why_not_known'])

    def test_what_was_not_recorded_is_not_known(self):
        """Each of these trials was once called good."""
        def without(topic, after=0.0):
            return lambda where, message, t: [] if where.endswith(topic) and t >= after else [(where, message)]

        def only_the_liver_has_forces(topic, message, t):
            if topic == STATE:
                message.contacts = [contact for contact in message.contacts if contact.organ == 'liver']
            return [(topic, message)]

        limit = ('max_touches', 5, 'probe', 'liver')
        self.assertEqual(judged(limit).state, 'kept')
        report = judged(limit, change=without('/touches'))
        self.assert_unknown(report, 'no events on `touches`')
        self.assertEqual([row['touches'] for row in report.pair_rows() if row['organ'] == 'liver'], [None])
        self.assert_unknown(judged(limit, change=without('/contacts', 1.0)), 'no answers OK about probe and liver', '67 %')
        self.assert_unknown(judged(('max_force', 50, None, 'vena_cava'), seconds=4.5, change=only_the_liver_has_forces),
                            'haptic_proxy tells no force between probe and vena_cava')
        self.assert_unknown(judged(('max_path', 50, 'probe', None), change=lambda topic, message, t: [] if t > 0.5 and (
            topic in ('/tf', STATE)) else [(topic, message)]), 'the tip of probe was seen for 0.5 s only')

    def test_two_nodes_with_an_organ_each_are_one_trial(self):
        def shared(topic, message, t):
            return [(topic.replace(NODE, '/second') if getattr(message, 'organ', '') == 'liver' else topic, message)]

        self.assertEqual({row['organ']: row['answers'] for row in judged(seconds=0.5, change=shared).pair_rows()},
                         {organ: RATE / 2 for organ in ORGANS})
        with self.assertRaisesRegex(TrialError, 'ContactArray about probe and liver from two nodes'):
            judged(seconds=0.5, change=lambda topic, message, t: [*shared(topic, message, t), (topic, message)])

    def test_wrong_limits_are_one_line(self):
        bag = write_bag(self.file('trial.bag'), seconds=0.1)
        for entry, says in (('{organ: liver, max_forse: 2}', ["limit 1: unknown key 'max_forse'", 'max_force']),
                            ('{organ: liver, max_force: two}', ["max_force is 'two'"]),
                            ('{organ: liver, max_force: -1}', ['max_force is -1']),
                            ('{organ: 5}', ['limits nothing']), ('liver', ['limits.yaml']),
                            ('{organ: liver, max_path: 1}', ['is about a tool'])):
            self.assert_refused(bag, '--limits', self.limits(entry), says=says)
        self.assert_refused(bag, '--limits', self.file('limits.yaml', 'liver: 2'), says=['limits.yaml has no list `limits`'])
        self.assert_refused(bag, '--limits', self.file('none.yaml'), says=['none.yaml'])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
