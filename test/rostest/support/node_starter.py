"""Starts and stops nodes within a test, as roslaunch does."""

import signal
import subprocess
import unittest

import roslib.packages
import rospy


class NodeStarter(unittest.TestCase):
    def start(self, name, parameters, program='organ_collision_node', through=()):
        """Starts a node with these private parameters. It is killed at the end of the test at the
        latest. `through`: the words of a command that runs the node's command."""
        if parameters:
            rospy.set_param(name, parameters)
        path = roslib.packages.find_node('organ_collision', program)[0]
        process = subprocess.Popen(
            [*through, path, '__name:=' + name.strip('/')],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            universal_newlines=True,
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def stop(self, process):
        """Stops the node with SIGINT, checks that it exits with 0, and returns its output."""
        process.send_signal(signal.SIGINT)
        printed, _ = process.communicate(timeout=15)
        self.assertEqual(process.returncode, 0, printed)
        return printed

    def assert_refused(self, process, words):
        """Checks that the node exits with an error by itself, and that it prints all `words`."""
        printed, _ = process.communicate(timeout=30)
        what = '%r: %s' % (words, printed)
        self.assertGreater(process.returncode, 0, what)  # negative: killed by a signal
        for word in words:
            self.assertIn(word, printed, what)
