#!/usr/bin/python3
"""Draws guard_lag.png, a figure of doc/haptics.md: how far a tool is from tissue that moves, at the tissue's true time,
with the parameter guard_lag and without it. Runs haptic_proxy.

Usage: . devel/setup.bash && doc/figures/guard_lag.py
"""

import math
import os
import sys
import time

from geometry_msgs.msg import PoseStamped, TransformStamped
from live_scene import HERE, ros_master, started, wait_until
from organ_collision.msg import OrganMesh, ProxyState
import rospy
from tf2_ros import StaticTransformBroadcaster

import style

PERIOD = LATE = 1.0 / 60  # [s] between shapes, and from a shape to its arrival
SPEED, TURN = 0.031, 4.0  # [m/s] the highest of the tissue, and its rate [rad/s]
RADIUS, CLEARANCE, DEPTH = 0.003, 0.002, 0.02  # [m]; the hand is so far below the tissue
SHOWN = 2 * math.pi / TURN  # [s] one breath
SIZE = 0.3  # [m]


def height(seconds):
    """Of the tissue [m]."""
    return SPEED / TURN * math.sin(TURN * seconds)


def shape_at(stamp):
    z = height(stamp)
    mesh = OrganMesh(organ='liver', topology=1, triangles=[0, 1, 2])
    mesh.header.frame_id, mesh.header.stamp = 'liver', rospy.Time.from_sec(stamp)
    mesh.vertices = [-SIZE, -SIZE, z, SIZE, -SIZE, z, 0.0, SIZE, z]
    return mesh


def distances(guards):
    """Times [s] and distances [m] of one breath."""
    rospy.set_param('/haptic_proxy', {
        'tools': [{'name': 'probe', 'trocar_frame': 'trocar', 'tip_pose_topic': 'pose', 'radius': RADIUS}],
        'clearance': CLEARANCE, 'guard_lag': guards, 'pose_timeout_sec': 1.0})
    states = []
    log = rospy.Subscriber('/haptic_proxy/probe/state', ProxyState, states.append)
    meshes = rospy.Publisher('/haptic_proxy/organ_mesh', OrganMesh, queue_size=10)
    poses = rospy.Publisher('/pose', PoseStamped, queue_size=10)
    with started('rosrun', 'organ_collision', 'haptic_proxy'):
        wait_until(lambda: meshes.get_num_connections() and poses.get_num_connections(), 'haptic_proxy')
        start = last = time.time()
        while time.time() < start + 4 * SHOWN:
            now = time.time()
            if now > last + PERIOD:
                last += PERIOD
                meshes.publish(shape_at(last - LATE))
            pose = PoseStamped()
            pose.header.frame_id, pose.header.stamp = 'liver', rospy.Time.from_sec(now)
            pose.pose.position.z = max(-DEPTH, 0.1 - 0.1 * (now - start))
            pose.pose.orientation.w = 1.0
            poses.publish(pose)
            time.sleep(0.003)
    log.unregister()
    held = [(state.header.stamp.to_sec(), state.proxy.position.z) for state in states
            if state.state == ProxyState.TOUCHING]
    begin = SHOWN * math.ceil(held[0][0] / SHOWN + 0.5)
    return [(stamp - begin, z - RADIUS - height(stamp)) for stamp, z in held if 0 <= stamp - begin <= SHOWN]


def main():
    with ros_master('guard_lag'):
        trocar = TransformStamped()
        trocar.header.frame_id, trocar.child_frame_id = 'liver', 'trocar'
        trocar.transform.translation.z, trocar.transform.rotation.w = 0.3, 1.0
        sender = StaticTransformBroadcaster()
        sender.sendTransform(trocar)
        found = {guards: distances(guards) for guards in (False, True)}
    figure, (axes,) = style.panels(1, 2.6)
    for guards, color in ((False, style.FACE), (True, style.TOOL)):
        times, values = zip(*found[guards])
        axes.plot(times, [1e3 * value for value in values], color=color, lw=1.2,
                  label='guard_lag: ' + str(guards).lower())
        print('guard_lag %s: at least %.3f mm, in %d states' % (guards, 1e3 * min(values), len(values)))
    axes.axhline(1e3 * CLEARANCE, color=style.GUIDE, lw=1, ls='--')
    axes.set(xlabel='time [s], one breath of tissue that moves at up to 31 mm/s', ylabel='true distance [mm]')
    axes.set_ylim(0, None)
    axes.legend(frameon=False, loc='lower right')
    style.save_picture(figure, os.path.join(HERE, 'guard_lag.png'))
    sys.stdout.flush()


if __name__ == '__main__':
    main()
