#!/usr/bin/python3
"""Poses of links from arrays."""

import unittest

import numpy as np

from organ_collision import link_motions, shaft_motions
from organ_collision.arrays import poses_array

RANDOM = np.random.default_rng(17)


def matrix(x, y, z, w):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def poses(motions, links):
    """Random poses, some of them half turns, as numbers and as matrices."""
    numbers = RANDOM.normal(size=(motions, links, 7))
    numbers[0, :, 6] = 0
    numbers[1, :, 3:5] = 0
    numbers[:, :, 3:] /= np.linalg.norm(numbers[:, :, 3:], axis=2, keepdims=True)
    matrices = np.zeros((motions, links, 4, 4))
    matrices[..., 3, 3] = 1
    matrices[..., :3, 3] = numbers[..., :3]
    for place in np.ndindex(motions, links):
        matrices[place][:3, :3] = matrix(*numbers[place][3:])
    return numbers, matrices


class PosesArrayTest(unittest.TestCase):

    def test_matrices_have_the_poses_of_their_numbers(self):
        numbers, matrices = poses(40, 3)
        made = poses_array(matrices, 'links')
        sign = np.sign((made[..., 3:] * numbers[..., 3:]).sum(axis=2, keepdims=True))
        np.testing.assert_allclose(made[..., :3], numbers[..., :3])
        np.testing.assert_allclose(made[..., 3:] * sign, numbers[..., 3:], atol=1e-14)

    def test_numbers_stay_as_they_are(self):
        numbers, _ = poses(2, 5)
        np.testing.assert_array_equal(poses_array(numbers.tolist(), 'links'), numbers)

    def test_wrong_shapes_and_matrices_are_explained(self):
        numbers, matrices = poses(3, 2)
        for wrong in (numbers[0], numbers[..., :6], matrices[..., :3, :], [[1, 2], [3]]):
            with self.assertRaisesRegex(ValueError, 'links .* must be k x l x 7'):
                poses_array(wrong, 'links')
        for place, value in (((2, 1, 0, 0), 3.0), ((2, 1, 3, 0), 0.5), ((2, 1, 2, 2), np.nan)):
            bad = matrices.copy()
            bad[place] = value
            with self.assertRaisesRegex(ValueError, r'links\[2, 1\] is no matrix'):
                poses_array(bad, 'links')
        mirrored = matrices.copy()
        mirrored[1, 0, :3, :3] *= -1
        with self.assertRaisesRegex(ValueError, r'links\[1, 0\] is no matrix'):
            poses_array(mirrored, 'links')


class LinkMotionsTest(unittest.TestCase):

    def test_each_motion_has_a_pose_for_each_link(self):
        ends, _ = poses(4, 2)
        starts, _ = poses(4, 2)
        motions = link_motions(ends, starts)
        self.assertEqual(len(motions), 4)
        pose = motions[3].links[1]
        self.assertEqual([pose.position.x, pose.position.y, pose.position.z, pose.orientation.x, pose.orientation.y,
                          pose.orientation.z, pose.orientation.w], ends[3, 1].tolist())
        self.assertEqual(motions[2].previous[0].position.y, starts[2, 0, 1])
        self.assertEqual(link_motions(ends)[0].previous, [])

    def test_as_many_starts_as_ends(self):
        ends, _ = poses(4, 2)
        with self.assertRaisesRegex(ValueError, '4 poses of links and 3 previous'):
            link_motions(ends, ends[:3])

    def test_shafts_beside_links(self):
        trocars, tips = RANDOM.normal(size=(2, 5, 3))
        motions = shaft_motions(trocars, tips, 0.0)
        self.assertEqual((len(motions), motions[4].tip.z, motions[4].radius), (5, tips[4, 2], 0.0))
        with self.assertRaisesRegex(ValueError, '5 trocars, 4 tips'):
            shaft_motions(trocars, tips[:4], 0.0)


if __name__ == '__main__':
    unittest.main()
