#!/usr/bin/python3
"""Plans how the grasper of plan.launch gets from the front of the liver to its hilum without touching it, and lets it
go there."""

import argparse
import math
import random

from geometry_msgs.msg import Point, Pose, Quaternion, Transform, TransformStamped, Vector3
import grasper_kinematics as grasper
from organ_collision.msg import ContactArray, LinkMotion
from organ_collision.srv import QueryCollisionBatch, QueryCollisionBatchRequest
import rospy
import rrt_connect
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA, Header
import tf2_ros
from visualization_msgs.msg import Marker, MarkerArray

# In the liver's frame: the trocar is below the liver and in front of it. Its z axis points at the liver's middle.
TROCAR = (-0.0413637326, -0.9032105840, -0.4177331430, 0.0894354727), (0.02, -0.12, 0.10)
START = (0.0, -0.01, 0.06)         # [m] of the tip, in the liver's frame: in front of the liver
TARGET = [0.004, -0.004, -0.017]   # [m] in the hollow of its underside, some millimetres from the surface
JAW = 0.1                          # [rad] the jaws stay nearly closed
# [m per rad, or 1] About how far the tip goes if a joint moves. The planner measures distances in these metres.
REACH = (0.15, 0.15, 1.0, 0.02, 0.03, 0.03)
PIECE, FINE_PIECE = 0.002, 0.0005  # [m] An edge is asked for in pieces of this length, the whole path in finer ones.
GOALS, SAMPLES, SHORTCUTS = 5, 1000, 100
SPEED, RATE = 0.03, 100.0          # [m/s], [Hz] of the grasper on its way


def scaled(joints):
    return tuple(j * reach for j, reach in zip(joints, REACH))


def unscaled(place):
    return tuple(p / reach for p, reach in zip(place, REACH))


def straight(a, b, piece):
    """The places on the way from a to b, with both."""
    count = max(1, math.ceil(math.dist(a, b) / piece))
    return [tuple(x + (y - x) * i / count for x, y in zip(a, b)) for i in range(count)] + [b]


class Tissue:
    """Asks the collision node what the grasper would touch."""

    def __init__(self):
        rospy.wait_for_service('/organ_collision/query_batch')
        self.service = rospy.ServiceProxy('/organ_collision/query_batch', QueryCollisionBatch, persistent=True)

    def links(self, place):
        poses = grasper.link_poses(TROCAR, unscaled(place))
        return [Pose(Point(*position), Quaternion(*rotation)) for rotation, position in poses]

    def sweep(self, places, **asked):
        """The answers for the motions from place to place. The last one touches, or all are free."""
        poses = [self.links(place) for place in places]
        request = QueryCollisionBatchRequest(organ='liver', tool='grasper', mode=ContactArray.SWEPT, **asked)
        request.header.frame_id = 'liver'
        request.link_motions = [LinkMotion(previous=a, links=b) for a, b in zip(poses, poses[1:])]
        request.stop_at_first_contact = True
        answer = self.service(request)
        if answer.status != ContactArray.OK:
            raise RuntimeError(answer.message)
        return answer.results

    def advance(self, a, b):
        """The last place that the grasper reaches freely on its straight way from a to b."""
        places = straight(a, b, PIECE)
        return places[sum(is_free(answer) for answer in self.sweep(places))]

    def least_distance(self, path):
        """The smallest distance from the tissue on the way [m]. None: something is touched."""
        answers = []
        for a, b in zip(path, path[1:]):
            answers += self.sweep(straight(a, b, FINE_PIECE), clearance=True)
        if all(map(is_free, answers)):
            return min(answer.clearance.least for answer in answers)


def is_free(answer):
    return answer.status == ContactArray.OK and not answer.contacts


def plan(tissue, start, target, chance):
    """The path from a place to where the tip is at the target [m], and its distance from the tissue."""
    goals = []
    while len(goals) < GOALS:
        roll, wrist = (chance.uniform(*grasper.LIMITS[joint]) for joint in (3, 4))
        joints = grasper.joints_for(TROCAR, target, roll, wrist, JAW)
        if joints and is_free(tissue.sweep([scaled(joints)] * 2)[0]):
            goals.append(scaled(joints))
    limits = grasper.LIMITS[:-1] + ((JAW, JAW),)
    path = rrt_connect.connect(start, goals, tissue.advance,
                               lambda: scaled([chance.uniform(*limit) for limit in limits]), SAMPLES)
    if not path:
        raise RuntimeError('no way was found')
    path = rrt_connect.shortened(path, tissue.advance, chance, SHORTCUTS)
    return path, tissue.least_distance(path)


def show(publisher, path):
    """Shows the way of the tip in RViz, beside the markers of the collision node."""
    places = [place for a, b in zip(path, path[1:]) for place in straight(a, b, PIECE)]
    line = Marker(header=Header(frame_id='liver'), ns='path', type=Marker.LINE_STRIP, scale=Vector3(0.001, 0, 0),
                  color=ColorRGBA(0.1, 0.8, 0.3, 1.0))
    line.pose.orientation.w = 1.0
    line.points = [Point(*grasper.tip(TROCAR, unscaled(place))) for place in places]
    publisher.publish([line])


def main():
    argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
    # If Ctrl-C arrives during a publish, rospy's own signal handler can deadlock. An exception cannot.
    rospy.init_node('plan_grasper', disable_signals=True)
    joint_states = rospy.Publisher('joint_states', JointState, queue_size=10)
    markers = rospy.Publisher('/organ_collision/markers', MarkerArray, queue_size=1, latch=True)
    trocar = tf2_ros.StaticTransformBroadcaster()
    trocar.sendTransform(TransformStamped(Header(0, rospy.Time.now(), 'liver'), 'grasper_trocar',
                                          Transform(Vector3(*TROCAR[1]), Quaternion(*TROCAR[0]))))
    tissue = Tissue()
    start = scaled(grasper.joints_for(TROCAR, START, 0.0, 0.0, JAW))
    target = rospy.get_param('~target', TARGET)
    path, distance = plan(tissue, start, target, random.Random(rospy.get_param('~seed', 0)))
    if distance is None:
        raise RuntimeError('finer motions touch the tissue')
    rospy.loginfo('%d legs, at least %.1f mm from the liver', len(path) - 1, 1000.0 * distance)
    show(markers, path)
    rate = rospy.Rate(RATE)
    way = [place for a, b in zip(path, path[1:]) for place in straight(a, b, SPEED / RATE)]
    while not rospy.is_shutdown():
        place = way.pop(0) if len(way) > 1 else way[0]  # It stays at the target.
        joint_states.publish(JointState(header=Header(stamp=rospy.Time.now()), name=list(grasper.JOINTS),
                                        position=unscaled(place)))
        rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        rospy.signal_shutdown('interrupted')
