#!/usr/bin/python3
"""The options of snapshot, without a ROS master: legal ones are followed by the lack of the master."""

import os
import subprocess
import unittest


def run(*arguments):
    return subprocess.run([os.environ['SNAPSHOT'], *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env={**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'}, timeout=60)


class SnapshotOptionsTest(unittest.TestCase):
    def test_legal_ones(self):
        for arguments in (
                [],
                ['--topic', '/a', '--topic=/b', '--hide', 'surface', '--hide=names', '--output', 'x.png', '--frame', 'world'],
                ['--size', '640x480', '--up', '0,2,0', '--target', '-0.1,0.2,3e-1', '--distance', '0.4', '--view', '-3,0,4'],
                ['--background', '#ff8000', '--after', '0', '--frames', '12', '--rate', '25', '--timeout', '3.5'],
                ['--view', '0, 30', '--font', 'a.ttf', '__name:=other']):
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stdout), (1, ''), done.stderr)
            self.assertIn('there is no ROS master', done.stderr)

    def test_illegal_ones_are_refused_with_their_values(self):
        for arguments, *words in [
                (['--size', '800'], '--size is "800"; must be WIDTHxHEIGHT, each from 16 to 4096'),
                (['--size', '800x5000'], '"800x5000"'),
                (['--size', '80.5x80'], '"80.5x80"'),
                (['--view', '1'], '--view is "1"; must be AZIMUTH,ELEVATION in degrees, or X,Y,Z'),
                (['--view', '0,0,0'], '"0,0,0"', 'not all 0'),
                (['--up', '0,0,0'], '--up is "0,0,0"; must be X,Y,Z, not all 0'),
                (['--target', '1,2,x'], '--target is "1,2,x"; must be X,Y,Z'),
                (['--target', '1,2,3,'], '"1,2,3,"'),
                (['--background', 'white'], '--background is "white"; must be #RRGGBB'),
                (['--frames', '0'], '--frames is "0"; must be a whole number from 1 to 9999'),
                (['--frames', '1.5'], '"1.5"'),
                (['--rate', 'nan'], '--rate is "nan"; must be a number from 0.01 to 1000'),
                (['--distance', '-1'], '--distance is "-1"'),
                (['stray'], 'unknown argument "stray"'),
                (['--siz', '20x20'], 'unknown option "--siz"', '--topic', '--timeout'),
                (['--size', '20x20', '--size', '20x20'], '--size')]:
            with self.subTest(arguments=arguments):
                done = run(*arguments)
                self.assertEqual((done.returncode, done.stdout), (2, ''), done.stderr)
                self.assertRegex(done.stderr, r'\Asnapshot: .* \(--help explains\)\n\Z')
                for word in words:
                    self.assertIn(word, done.stderr)

    def test_help_alone_matters(self):
        for arguments in ['-h'], ['--size', 'nonsense', '--help']:
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stderr), (0, ''))
            for option in ('topic', 'hide', 'frame', 'after', 'timeout', 'view', 'up', 'target', 'distance', 'output',
                           'size', 'background', 'font', 'frames', 'rate'):
                self.assertIn('--' + option + ' ', done.stdout)


if __name__ == '__main__':
    unittest.main()
