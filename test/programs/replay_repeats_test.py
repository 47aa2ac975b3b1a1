#!/usr/bin/python3
"""Replays of one bag give the same bytes, also beside others."""

import os
import random
import subprocess
import unittest

from organ_collision.msg import ContactArray, ToolPlacement
from support.scenes import Mesh, box, sheet
from support.tool_over_sheet import SHEET, at_height, depth_at

from recording import CONTACTS, ReplayCase, TOOLS, messages, serialized

STEPS = 120
LARGE = sheet(0.1, 80)  # 12 800 faces: the pipeline builds it in a thread of its own.


class ReplayRepeatsTest(ReplayCase):
    def height(self, step):
        return 0.02 + 0.04 * (1 if step % 7 < 3 else -1) + 0.0001 * step

    def record_busy_simulation(self):
        """Shapes at 1 kHz, whose transforms come up to 30 ms late and in disorder; some never
        come. Large meshes with new triangles come between them."""
        chance = random.Random(1)
        events = []
        for step in range(STEPS):
            time = 2.0 + 0.001 * step
            late = chance.uniform(0.0, 0.03) if step % 50 else 0.0
            if step % 10 != 5:
                events.append((time + late, 'tool', step))
            events.append((time, 'mesh' if step % 40 == 0 else 'vertices', step))
        with self.record() as bag:
            bag.resting(1.0)
            for at, kind, step in sorted(events):
                time = 2.0 + 0.001 * step
                if kind == 'tool':
                    bag.tool(time, at_height(self.height(step)), at)
                elif kind == 'mesh':
                    bag.mesh(time, LARGE, at, organ='large', topology=step)
                    bag.mesh(time, SHEET, at)
                else:
                    bag.vertices(time, SHEET, at)
                    if step % 4 == 1:
                        bag.vertices(time, LARGE, at, organ='large', topology=step - step % 40)

    def test_the_same_bytes_alone_and_beside_others(self):
        self.record_busy_simulation()
        self.replay(out='alone.bag')
        names = [self.path('together_%d.bag' % i) for i in range(2 * os.cpu_count())]
        replays = [subprocess.Popen([os.environ['REPLAY'], '--parameters', self.path('parameters.yaml'), self.recorded, name],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for name in names]
        self.assertEqual([replay.wait(100) for replay in replays], len(names) * [0])
        alone = serialized(self.path('alone.bag'))
        self.assertEqual(len(alone), STEPS + STEPS // 40 + STEPS // 4)
        for name in names:
            self.assertTrue(serialized(name) == alone, name)
        answers = [answer for _, answer in messages(self.path('alone.bag'))]
        self.assertGreater(sum(answer.status == ContactArray.OK for answer in answers), STEPS // 2)
        self.assertTrue(any(answer.contacts for answer in answers))

    def test_sides_are_known_from_the_first_answer_on(self):
        """The node inspects new surfaces in the background; replay waits for that."""
        both_sides = Mesh(LARGE.vertices, LARGE.faces + [face[::-1] for face in LARGE.faces])
        with self.record() as bag:
            bag.resting(1.0)
            for step in range(6):
                time = 2.0 + 0.001 * step
                bag.tool(time, at_height(0.003))
                bag.mesh(time, box((0.3, 0.2, 0.1)), topology=step)
                bag.mesh(time, both_sides, organ='large', topology=step)
        self.replay()
        placements = {'liver': [], 'large': []}
        for _, answer in messages(self.answers):
            placements[answer.organ].append(answer.placement.tip)
        self.assertEqual(placements['liver'], 6 * [ToolPlacement.INSIDE])
        self.assertEqual(placements['large'], 6 * [ToolPlacement.OUTSIDE])

    def test_a_copy_of_the_input(self):
        with self.record() as bag:
            bag.resting(1.0)
            bag.tool(2.0, at_height(-0.01))
            bag.mesh(2.0, SHEET)
            bag.write('/other', ContactArray(tool='kept'), 2.0)
            bag.write(CONTACTS, ContactArray(tool='recorded'), 2.1)
        self.replay(options=['--with-input'])
        copied = serialized(self.answers)
        recorded = [message for message in serialized(self.recorded) if message[0] != CONTACTS]
        self.assertEqual(sorted(message for message in copied if message[0] != CONTACTS), sorted(recorded))
        ((_, answer),) = messages(self.answers)
        self.assert_depth(answer, depth_at(-0.01))

    def test_a_copied_topic_does_not_set_the_time(self):
        """A topic that the node does not hear may be recorded out of order, as in a merged bag."""
        with self.record() as bag:
            bag.resting(1.0)
            for step in range(30):
                time = 2.0 + 0.001 * step
                bag.tool(time, at_height(self.height(step)))
                (bag.vertices if step else bag.mesh)(time, SHEET)
                bag.write('/other', ContactArray(), 1.5 if step % 2 else 2.5)
        self.replay()
        alone = serialized(self.answers)
        self.assertEqual(len(alone), 30)
        self.replay(options=['--with-input'])
        self.assertEqual([m for m in serialized(self.answers) if m[0] == CONTACTS], alone)


if __name__ == '__main__':
    unittest.main(verbosity=2)
