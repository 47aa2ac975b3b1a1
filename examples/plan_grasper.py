#!/usr/bin/python3
"""Plans how the grasper of plan.launch gets from the front of the liver to its hilum without touching it, and lets it
go there."""

import argparse
import itertools
import math
import random
import sys

from geometry_msgs.msg import Point, Quaternion, Transform, TransformStamped, Vector3
import grasper_kinematics as grasper
from organ_collision import Queries
from organ_collision.msg import Clearance, ContactArray
from PyKDL import Frame, Rotation, Vector
import rospy
import rrt_connect
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA, Header
import tf2_ros
from visualization_msgs.msg import Marker, MarkerArray

# In the liver's frame: the trocar is below the liver and in front of it. Its z axis points at the liver's middle.
TROCAR = Frame(Rotation.Quaternion(-0.0413637326, -0.9032105840, -0.4177331430, 0.0894354727), Vector(0.02, -0.12, 0.10))
START = Vector(0.0, -0.01, 0.06)   # [m] of the tip, in the liver's frame: in front of the liver
TARGET = [0.004, -0.004, -0.017]   # [m] in the hollow of its underside, some millimetres from the surface
JAW = 0.1                          # [rad] the jaws stay nearly closed
# [m per rad, or 1] About how far the tip goes if a joint moves. The planner measures distances in these metres.
REACH = (0.15, 0.15, 1.0, 0.02, 0.03, 0.03)
PIECE, FINE_PIECE = 0.002, 0.0005  # [m] An edge is asked for in pieces of this length, the whole path in finer ones.
MARGIN = 0.02                      # [m] Up to this distance from the tissue the whole path is measured.
GOALS, SAMPLES, SHORTCUTS = 5, 1000, 100
ATTEMPTS = 200                     # for each goal, with random roll and wrist
SPEED, RATE = 0.03, 100.0          # [m/s], [Hz] of the grasper on its way


def scaled(joints):
    return tuple(j * reach for j, reach in zip(joints, REACH))


def unscaled(place):
    return tuple(p / reach for p, reach in zip(place, REACH))


def straight(a, b, piece):
    """The places on the way from a to b, with both."""
    count = max(1, math.ceil(math.dist(a, b) / piece))
    return [tuple(x + (y - x) * i / count for x, y in zip(a, b)) for i in range(count)] + [b]


def links(place):
    """Position and quaternion of each link of the grasper, in the liver's frame."""
    return [(*pose.p, *pose.M.GetQuaternion()) for pose in grasper.link_poses(TROCAR, unscaled(place))]


class Robot:
    """Goes along `way`, places at intervals of 1 / RATE, and stays at its end."""

    def __init__(self, start):
        self.way = [start]
        self.publisher = rospy.Publisher('joint_states', JointState, queue_size=10)
        self.timer = rospy.Timer(rospy.Duration(1.0 / RATE), self.go)

    def go(self, _):
        place = self.way.pop(0) if len(self.way) > 1 else self.way[0]
        self.publisher.publish(JointState(header=Header(stamp=rospy.Time.now()), name=list(grasper.JOINTS),
                                          position=unscaled(place)))


class Tissue:
    """Asks the collision node what the grasper would touch."""

    def __init__(self):
        self.queries = Queries()
        self.queries.wait_for('liver')

    def sweep(self, places, **asked):
        """The answers for the motions from place to place. The last one touches, or all are free."""
        poses = [links(place) for place in places]
        return self.queries.answer_links('liver', 'grasper', poses[1:], previous_links=poses[:-1],
                                         stop_at_first_contact=True, **asked)

    def advance(self, a, b):
        """The last place that the grasper reaches freely on its straight way from a to b."""
        places = straight(a, b, PIECE)
        free = itertools.takewhile(is_free, self.sweep(places))
        return places[sum(1 for _ in free)]

    def least_distance(self, path):
        """The smallest distance from the tissue on the way [m], at most MARGIN. None: something is touched."""
        answers = []
        for a, b in zip(path, path[1:]):
            answers += self.sweep(straight(a, b, FINE_PIECE), margin=MARGIN)
        if all(map(is_free, answers)):
            known = [answer.clearance for answer in answers if answer.clearance.state == Clearance.KNOWN]
            return min([clearance.least for clearance in known] + [MARGIN])


def is_free(answer):
    return answer.status == ContactArray.OK and not answer.contacts


def free_goals(tissue, target, chance):
    """Up to GOALS places where the tip is at the target and nothing is touched. Raises RuntimeError if there is none."""
    goals = []
    for _ in range(GOALS * ATTEMPTS):
        roll, wrist = (chance.uniform(*grasper.LIMITS[joint]) for joint in (3, 4))
        joints = grasper.joints_for(TROCAR, target, roll, wrist, JAW)
        if joints and is_free(tissue.sweep([scaled(joints)] * 2)[0]):
            goals.append(scaled(joints))
            if len(goals) == GOALS:
                break
    if not goals:
        raise RuntimeError('the tip cannot be at (%g, %g, %g) without touching the liver' % tuple(target))
    return goals


def plan(tissue, start, target, chance):
    """The path from a place to where the tip is at the target [m], and its distance from the tissue."""
    limits = grasper.LIMITS[:-1] + ((JAW, JAW),)
    path = rrt_connect.connect(start, free_goals(tissue, target, chance), tissue.advance,
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
    markers = rospy.Publisher('/organ_collision/markers', MarkerArray, queue_size=1, latch=True)
    trocar = tf2_ros.StaticTransformBroadcaster()
    trocar.sendTransform(TransformStamped(Header(0, rospy.Time.now(), 'liver'), 'grasper_trocar',
                                          Transform(Vector3(*TROCAR.p), Quaternion(*TROCAR.M.GetQuaternion()))))
    start = scaled(grasper.joints_for(TROCAR, START, 0.0, 0.0, JAW))
    robot = Robot(start)
    target = Vector(*rospy.get_param('~target', TARGET))
    path, distance = plan(Tissue(), start, target, random.Random(rospy.get_param('~seed', 1)))
    if distance is None:
        raise RuntimeError('finer motions touch the tissue')
    rospy.loginfo('%d legs, at least %.1f mm from the liver', len(path) - 1, 1000.0 * distance)
    robot.way = [place for a, b in zip(path, path[1:]) for place in straight(a, b, SPEED / RATE)]
    while not rospy.is_shutdown():
        show(markers, path)  # Again and again: for each new viewer, the collision node deletes all markers.
        rospy.sleep(2.0)


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        rospy.signal_shutdown('interrupted')
    except RuntimeError as error:
        rospy.logfatal('%s', error)
        sys.exit(1)
