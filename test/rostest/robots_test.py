#!/usr/bin/python3
"""The grasper of the examples lifts a fold of tissue by what the node says. The planner of plan.launch takes it to the liver's
hilum: on its way it touches nothing, in no step of the node and at no pose of TF. The straight way would have touched
the liver."""

import sys

from geometry_msgs.msg import Point, Pose, Quaternion
import numpy as np
from organ_collision.msg import ContactArray, Grasp, LinkMotion, OrganMesh, OrganVertices
from organ_collision.srv import QueryCollisionBatch, QueryCollisionBatchRequest
import rospy
import rostest
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
import tf2_ros

from support import scenes
from support.launch_case import LaunchCase
from support.node_client import ContactLog, Log, shaft, wait_until

LINKS = ['grasper_shaft', 'grasper_wrist', 'grasper_left_jaw', 'grasper_right_jaw']
SHAFT_RADIUS = 0.0025
TIP = (0.0, 0.0, 0.029)  # of the closed jaws, in the frame of the wrist
START, TARGET = (0.0, -0.01, 0.06), (0.004, -0.004, -0.017)
LONG = 250.0  # [s] A plan takes a second or two on a machine that does nothing else.


class RobotLog:
    """All transforms and joint states since the start. On a busy machine, a tf2_ros.TransformListener would drop
    some."""

    def __init__(self):
        self.states = []
        self.stamps = set()  # for which TF has the wrist, without interpolation
        self.transforms = tf2_ros.Buffer(rospy.Duration(1000.0))
        self.subscribers = [
            rospy.Subscriber('/tf', TFMessage, self._add, queue_size=10000),
            rospy.Subscriber('/tf_static', TFMessage, self._add, True, queue_size=100),
            rospy.Subscriber('/joint_states', JointState, self.states.append, queue_size=10000),
        ]

    def _add(self, message, resting=False):
        add = self.transforms.set_transform_static if resting else self.transforms.set_transform
        for transform in message.transforms:
            add(transform, 'test')
            if transform.child_frame_id == 'grasper_wrist':
                self.stamps.add(transform.header.stamp)

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()

    def knows(self, *stamps):
        """Whether it knows where all links were in the frame of the liver."""
        return all(self.transforms.can_transform('liver', link, stamp) for link in LINKS for stamp in stamps)

    def pose(self, frame, stamp, organ='liver'):
        """Where the frame was in that of the organ."""
        transform = self.transforms.lookup_transform(organ, frame, stamp).transform
        r, t = transform.rotation, transform.translation
        return scenes.Pose((r.x, r.y, r.z, r.w), (t.x, t.y, t.z))


class RobotsTest(LaunchCase):
    def setUp(self):
        self.robot, self.log = RobotLog(), ContactLog('/organ_collision/contacts')
        self.addCleanup(self.robot.close)
        self.addCleanup(self.log.subscriber.unregister)

    def test_the_grasper_lifts_a_fold(self):
        """While it is grasped, the vertices of the faces that the node named stay between the jaws."""
        rospy.set_param('/organ_collision/tf_timeout_sec', 20.0)  # On a busy machine, transforms are late.
        self.addCleanup(rospy.delete_param, '/organ_collision/tf_timeout_sec')
        grasps, meshes, shapes = (Log('/organ_collision/' + topic, kind) for topic, kind in (
            ('grasps', Grasp), ('organ_mesh', OrganMesh), ('organ_vertices', OrganVertices)))
        with self.launched('examples/grasper.launch', 'clear_params:=false'):
            wait_until(lambda: len(grasps.messages) > 1, 'a grasp and its end', LONG)
            self.check_robot('urdf/grasper.urdf')
        grasped, released = grasps.messages[:2]
        self.assertEqual([(g.event, g.organ, g.tool, g.grasp, g.reason) for g in (grasped, released)],
                         [(Grasp.GRASPED, 'fold', 'grasper', 1, ''), (Grasp.RELEASED, 'fold', 'grasper', 1, 'opened')])
        self.assertTrue(0.003 < grasped.thickness < 0.0055, grasped)  # The fold is 4.8 mm thick.
        self.assert_held(grasped, released, meshes.messages[0], shapes.messages)
        answers = self.log.messages
        self.assertEqual({(answer.tool, answer.organ, *answer.links) for answer in answers},
                         {('grasper', 'fold', *LINKS)})
        first = next(i for i, answer in enumerate(answers) if answer.status == ContactArray.OK)
        self.assertEqual([answer.message for answer in answers[first:] if answer.status], [])

    def assert_held(self, grasped, released, mesh, shapes):
        faces = np.array(mesh.triangles).reshape(-1, 3)
        held = np.unique(faces[list(grasped.faces_first + grasped.faces_second)])
        rest, places, heights = np.array(mesh.vertices).reshape(-1, 3), [], []
        for shape in shapes:
            stamp, vertices = shape.header.stamp, np.array(shape.vertices).reshape(-1, 3)
            is_within = grasped.header.stamp < stamp < released.header.stamp
            # Between the grasp and the message about it, the tissue rests.
            if is_within and np.any(vertices[held] != rest[held]) and stamp in self.robot.stamps:
                wrist = self.robot.pose('grasper_wrist', stamp, organ='fold')
                places.append([wrist.inverse().apply(v) for v in vertices[held]])
                heights.append(np.mean((vertices - rest)[held, 2]))
        places = np.array(places)
        self.assertGreater(len(places), 20)
        self.assertLess(np.abs(places - places[0]).max(), 1e-6)
        self.assertLess(np.abs(places[0, :, 0]).max(), 0.005)
        self.assertTrue(np.all((places[0, :, 2] > 0.009) & (places[0, :, 2] < TIP[2] + 0.002)), places[0])
        self.assertAlmostEqual(max(heights), 0.012, delta=0.001)

    def has_left(self):
        states = self.robot.states
        return states and states[0].position != states[-1].position

    def has_arrived(self):
        last = [state.position for state in self.robot.states[-20:]]
        return self.has_left() and last == last[:1] * 20

    def way(self):
        """The stamps of the joints from the last ones at rest until the grasper has arrived."""
        states = self.robot.states
        steps = [i for i in range(1, len(states)) if states[i].position != states[i - 1].position]
        stamps = [states[i].header.stamp for i in [steps[0] - 1, *steps]]
        wait_until(lambda: self.robot.knows(*stamps), 'all transforms')
        return stamps

    def test_the_planner_takes_the_grasper_to_its_target(self):
        with self.launched('examples/plan.launch') as launched:
            for event in (self.has_left, self.has_arrived):
                wait_until(lambda: launched.process.poll() is not None or event(), event.__name__, LONG)
            stamps = self.way()
            self.assertGreater(len(stamps), 300)
            # TF may lack single states: it interpolates between those around it, which are the same at rest.
            rests = [next(stamp for stamp in (state.header.stamp for state in states) if self.robot.knows(stamp))
                     for states in (self.robot.states, self.robot.states[-20:])]
            ends = [self.robot.pose('grasper_wrist', stamp).apply(TIP) for stamp in rests]
            for found, expected in zip(ends, (START, TARGET)):
                self.assert_near(found, expected, 1e-6, 'the ends of the way')
            self.assert_nothing_is_touched(stamps)
        self.assertIn('from the liver', launched.printed)

    def touches_nothing(self, **asked):
        """For each motion of a batch: whether it touches nothing."""
        request = QueryCollisionBatchRequest(organ='liver', mode=ContactArray.STATIC, **asked)
        request.header.frame_id = 'liver'
        answer = rospy.ServiceProxy('/organ_collision/query_batch', QueryCollisionBatch)(request)
        self.assertEqual((answer.status, answer.message), (ContactArray.OK, ''))
        self.assertEqual({result.status for result in answer.results}, {ContactArray.OK})
        return [not result.contacts for result in answer.results]

    def assert_nothing_is_touched(self, stamps):
        """Neither at the poses of TF, nor in a step between them."""
        for first in range(0, len(stamps), 500):
            part = stamps[first:first + 500]
            poses = [[self.robot.pose(link, stamp) for link in LINKS] for stamp in part]
            motions = [LinkMotion(links=[Pose(Point(*p.translation), Quaternion(*p.rotation)) for p in links])
                       for links in poses]
            self.assertEqual(self.touches_nothing(tool='grasper', link_motions=motions), [True] * len(part))
        steps = self.log.of('liver', 'grasper', status=ContactArray.OK, mode=ContactArray.SWEPT)
        self.assertGreater(len(steps), 100)
        self.assertEqual([step.contacts for step in steps if step.contacts], [])
        trocar = self.robot.pose('grasper_trocar', stamps[0]).translation
        straight = [shaft(trocar, tuple(a + part * (b - a) for a, b in zip(START, TARGET)), SHAFT_RADIUS)
                    for part in (0.1, 0.3, 0.5, 0.7, 0.9)]
        self.assertIn(False, self.touches_nothing(motions=straight))

    def test_the_planner_refuses_a_target_without_a_place(self):
        with self.launched('examples/plan.launch', 'target:=[0.0, 0.0, 1.0]', ends_itself=True) as launched:
            wait_until(lambda: launched.process.poll() is not None, 'the end of the planner', LONG)
        self.assertIn('the tip cannot be at (0, 0, 1) without touching the liver', launched.printed)


if __name__ == '__main__':
    rospy.init_node('robots_test')
    rostest.rosrun('organ_collision', 'robots', RobotsTest, sys.argv)
