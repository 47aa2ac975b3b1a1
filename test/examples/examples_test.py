#!/usr/bin/python3
"""In both minimal simulators the probe touches the tissue, and both ask programs get an answer."""

import signal
import subprocess
import sys
import threading
import unittest

import roslib.packages
import rospy
from rosgraph_msgs.msg import Log
import rostest

LIMIT = 20.0  # [s]


def example(name):
    """The path of examples/NAME.py, or of the program built from examples/NAME.cpp."""
    return roslib.packages.find_node('organ_collision', name)[0]


class ExamplesTest(unittest.TestCase):

    def setUp(self):
        self.awaited = {'probe: face 0', 'probe: face 1'}
        self.all_seen = threading.Event()
        self.log = rospy.Subscriber('/rosout', Log, self.on_log)

    def tearDown(self):
        self.log.unregister()

    def on_log(self, line):
        if line.name == '/simulator':
            self.awaited -= {line.msg.split(',')[0]}
            if not self.awaited:
                self.all_seen.set()

    def check(self, simulator, asker, answer):
        simulation = subprocess.Popen([example(simulator)])
        try:
            self.assertTrue(self.all_seen.wait(LIMIT), 'waited without success for %s' % self.awaited)
            printed = subprocess.check_output([example(asker)], text=True, timeout=LIMIT)
            self.assertEqual(printed.strip(), answer)
        finally:
            simulation.send_signal(signal.SIGINT)
            self.assertEqual(simulation.wait(LIMIT), 0)

    def test_python(self):
        self.check('simulator.py', 'ask.py', '0 [0, 1]')

    def test_cpp(self):
        self.check('example_simulator', 'example_ask', '0 0 1')


if __name__ == '__main__':
    rospy.init_node('examples_test')
    rostest.rosrun('organ_collision', 'examples', ExamplesTest, sys.argv)
