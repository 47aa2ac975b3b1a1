#!/usr/bin/python3
"""In both minimal simulators the probe presses the tissue by some millimetres, straight down. Both ask programs get an
answer."""

import re
import signal
import subprocess
import sys
import threading
import unittest

from organ_collision.msg import ContactArray
import roslib.packages
import rospy
from rosgraph_msgs.msg import Log
import rostest

LIMIT = 20.0  # [s]


def example(name):
    """The path of examples/NAME.py, or of the program built from examples/NAME.cpp."""
    return roslib.packages.find_node('organ_collision', name)[0]


def depths(said):
    """The depths [mm] in what a program prints."""
    return [float(depth) for depth in re.findall(r'(-?[\d.]+) mm', said)]


class ExamplesTest(unittest.TestCase):

    def setUp(self):
        self.pressed = threading.Event()
        self.log = rospy.Subscriber('/rosout', Log, self.on_log)

    def tearDown(self):
        self.log.unregister()

    def on_log(self, line):
        if line.name == '/simulator' and re.match(r'probe: .* mm deep in face \d+; faces touched: \d+$', line.msg):
            depth, = depths(line.msg)
            if 1.0 < depth < 4.0:
                self.pressed.set()

    def check(self, simulator, asker):
        simulation = subprocess.Popen([example(simulator)])
        try:
            self.assertTrue(self.pressed.wait(LIMIT), 'waited without success for an ordinary touch')
            self.check_directions()
            said = subprocess.check_output([example(asker)], text=True, timeout=LIMIT)
            self.assertEqual(said.splitlines()[0].strip(), 'status 0')
            self.assertTrue(0.9 < max(depths(said)) < 3.1, said)
            self.assertRegex(said, r'\ndistance -\d\.\d mm\n')
        finally:
            simulation.send_signal(signal.SIGINT)
            self.assertEqual(simulation.wait(LIMIT), 0)

    def check_directions(self):
        """Waits for an answer whose deepest contact is 1 to 4 mm deep, straight into the tissue."""
        found = threading.Event()
        seen = []

        def on_contacts(answer):
            deepest = max(answer.contacts, key=lambda contact: contact.depth, default=None)
            if deepest is None:
                return
            seen.append((deepest.depth, deepest.normal.z, deepest.behind))
            if 0.001 < deepest.depth < 0.004 and deepest.normal.z < -0.95 and not deepest.behind:
                found.set()

        contacts = rospy.Subscriber('/organ_collision/contacts', ContactArray, on_contacts)
        try:
            self.assertTrue(found.wait(LIMIT), 'no ordinary touch; the last ones are %s' % seen[-5:])
        finally:
            contacts.unregister()

    def test_python(self):
        self.check('simulator.py', 'ask.py')

    def test_cpp(self):
        self.check('example_simulator', 'example_ask')


if __name__ == '__main__':
    rospy.init_node('examples_test')
    rostest.rosrun('organ_collision', 'examples', ExamplesTest, sys.argv)
