#!/usr/bin/python3
"""The launch files of examples/ and their programs do what the pages say. Other tests run the robots."""

import csv
import os
import re
import signal
import subprocess
import sys
import tempfile
import zipfile

from geometry_msgs.msg import Vector3, WrenchStamped
import matplotlib.image
import numpy as np
from organ_collision.msg import OrganMesh, OrganVertices, ProxyState, VertexForces
import rosnode
import rospy
from rosgraph_msgs.msg import Log as LogLine
import rostest
from std_msgs.msg import Bool
from tf2_msgs.msg import TFMessage

from support.launch_case import LaunchCase, files
from support.node_client import LIMIT, ContactLog, Log, wait_until
from support.processes import NodeStarter, program

LONG = 90.0  # [s]
TESTED = {'ambf/ambf', 'sofa/sofa', 'start', 'mesh_adapter', 'haptics', 'dvrk', 'fem_tissue', 'forces',
          'numpy', 'sculpt'}
ELSEWHERE = {'dvrk_arm', 'grasper', 'plan', 'guarded_arm'}  # within dvrk.launch, robots.test, guarded_arm.test
FEM_STEP = 0.004  # [s] of fem_tissue
CLAY, CELL, BALL = (65, 45), 0.001, 0.006  # vertices of the top of sculpt.py's block; [m], [m] radius


def vector(v):
    return np.array([v.x, v.y, v.z])


def force_of(message):
    return vector(message.wrench.force)


def depths(said):
    """The depths [mm] in what a program prints."""
    return [float(depth) for depth in re.findall(r'(-?[\d.]+) mm', said)]


class ExamplesTest(LaunchCase, NodeStarter):
    def test_every_launch_file_is_tested(self):
        self.assertEqual({'examples/%s.launch' % name for name in TESTED | ELSEWHERE},
                         files('examples', '.launch') | files('examples/ambf', '.launch')
                         | files('examples/sofa', '.launch'))

    def test_start(self):
        """In both minimal simulators the probe presses the tissue by some millimetres, straight down. Both ask programs
        get an answer."""
        with self.launched('examples/start.launch'):
            for simulator, asker in (('simulator.py', 'ask.py'), ('example_simulator', 'example_ask')):
                log, contacts = Log('/rosout', LogLine), ContactLog('/organ_collision/contacts')
                simulation = subprocess.Popen([program(simulator)])
                try:
                    wait_until(lambda: log.last(lambda line: line.name == '/simulator' and re.match(
                        r'probe: .* mm deep in face \d+; faces touched: \d+$', line.msg) and
                        1.0 < depths(line.msg)[0] < 4.0),
                               'an ordinary touch')
                    wait_until(lambda: contacts.last(lambda answer: any(
                        0.001 < c.depth < 0.004 and c.normal.z < -0.95 and not c.behind for c in answer.contacts)),
                               'contacts')
                    said = subprocess.check_output([program(asker)], text=True, timeout=LIMIT)
                    self.assertEqual(said.splitlines()[0].strip(), 'status 0')
                    self.assertTrue(0.9 < max(depths(said)) < 3.1, said)
                    self.assertRegex(said, r'\ndistance -\d\.\d mm\n')
                finally:
                    simulation.send_signal(signal.SIGINT)
                    self.assertEqual(simulation.wait(LIMIT), 0)

    def test_mesh_adapter(self):
        with self.launched('examples/mesh_adapter.launch'):
            self.check_mesh_adapter(rospy.get_param('/organ_mesh_adapter/organs'))

    def test_ambf(self):
        """The nodes that run beside AMBF. AMBF itself is not needed."""
        with self.launched('examples/ambf/ambf.launch', 'forces:=true'):
            self.check_collision_node('/organ_collision')
            rospy.wait_for_message('/haptic_proxy/hand/state', ProxyState, timeout=LIMIT)
            self.assertEqual(rospy.get_param('/organ_collision_plugin/tools'), {'hand': 'probe'})

    def test_sofa(self):
        """The nodes that run beside SOFA, which is not needed."""
        with self.launched('examples/sofa/sofa.launch', 'forces:=true'):
            self.check_collision_node('/organ_collision')
            rospy.wait_for_message('/haptic_proxy/hand/state', ProxyState, timeout=LIMIT)

    def test_sculpt(self):
        """The carved clay is what the ball swept, to a cell."""
        path, frames = os.path.join(tempfile.mkdtemp(), 'clay.npz'), Log('/tf', TFMessage)
        with self.launched('examples/sculpt.launch', 'seconds:=6', 'save:=' + path):
            wait_until(lambda: os.path.exists(path) and zipfile.is_zipfile(path), 'the clay', 200.0)
        vertices = np.load(path)['vertices']
        top = vertices[:CLAY[0] * CLAY[1]]
        swept = np.zeros(len(top))
        for place in {vector(one.transform.translation).tobytes() for m in frames.messages for one in m.transforms}:
            x, y, z = np.frombuffer(place)
            above = BALL ** 2 - (top[:, 0] - x) ** 2 - (top[:, 1] - y) ** 2
            swept = np.minimum(swept, np.where(above > 0, z - np.sqrt(np.maximum(0, above)), 0))
        self.assertLess(swept.min(), -0.002)
        self.assertLess(np.abs(top[:, 2] - swept).max(), CELL)
        self.assertLess(np.abs(top[:, 2] - swept).mean(), 0.1 * CELL)
        self.assertEqual(len(np.unique(top[:, :2], axis=0)), len(top))  # The rest of the block is as it was.
        self.assertEqual(set(vertices[len(top):, 2]), {vertices[-1, 2]})

    def check_report_and_plot(self):
        """trial_report.py and plot.py about the running nodes."""
        folder = tempfile.mkdtemp()
        limits = os.path.join(folder, 'limits.yaml')
        with open(limits, 'w') as text:
            text.write('limits:\n  - {organ: tissue, max_force: 0.001}\n  - {organ: bone, max_touches: 0}\n')
        states, answers = Log('/haptic_proxy/probe/state', ProxyState), ContactLog('/organ_collision/contacts')
        said = subprocess.check_output([program('trial_report.py'), '--live', '8', '--limits', limits, '--out', folder + '/live'],
                                       text=True)
        self.assertIn('NOT GOOD: 1 of 2 limits were broken', said)
        self.assertIn('bone never came', said)
        with open(folder + '/live.csv') as text:
            (row,) = csv.DictReader(text)
        self.assertEqual((row['tool'], row['organ'], row['tip']), ('probe', 'tissue', 'hand of haptic_proxy'))
        # This test listened a little longer.
        self.assertLessEqual(float(row['largest_hand_force_N']),
                             max(np.linalg.norm(force_of(state)) for state in states.messages) + 1e-9)
        self.assertTrue(0 < float(row['deepest_m']) <= max(c.depth for a in answers.messages for c in a.contacts))
        self.assertGreater(float(row['path_m']), 0.001)
        self.assertGreater(int(row['answers']), 10)
        picture = folder + '/plot.png'
        subprocess.check_call([program('plot.py'), 'probe', '--seconds', '3', '--png', picture])
        self.assertGreater(len({tuple(colour) for colour in matplotlib.image.imread(picture)[:, :, :3].reshape(-1, 3)}), 20)
        refused = subprocess.run([program('plot.py'), 'prob', '--seconds', '1', '--png', picture], stderr=subprocess.PIPE,
                                 text=True)
        self.assertEqual((refused.returncode, refused.stderr),
                         (2, 'plot.py: no answers about prob within 1 s; tools with answers: probe\n'))

    def test_numpy(self):
        """Contacts and a force come back, and no shape is refused. The report and the plots show them."""
        with self.launched('examples/numpy.launch') as launched:
            log, states = ContactLog('/organ_collision/contacts'), Log('/haptic_proxy/probe/state', ProxyState)
            wait_until(lambda: any(answer.contacts for answer in log.of('tissue', 'probe', status=0)), 'contacts')
            wait_until(lambda: states.last(lambda state: state.state == ProxyState.TOUCHING
                                           and state.wrench.force.z > 0.2), lambda: 'a force: %s' % states.last())
            self.check_report_and_plot()
        self.assertNotIn('refused', launched.printed)

    def test_haptics(self):
        """The tissue holds the stylus back, and the driver passes the force on. When haptic_proxy ends, the driver
        switches the force off."""
        def pushes(line):
            force = re.match(r'the force on the hand is \(\S+, \S+, (\S+)\) N', line.msg)
            return line.name == '/stylus_driver' and force and float(force.group(1)) > 0.3

        with self.launched('examples/haptics.launch') as launched:
            log, states = Log('/rosout', LogLine), Log('/haptic_proxy/stylus/state', ProxyState)
            state = wait_until(lambda: states.last(lambda state: state.state == ProxyState.TOUCHING
                                                   and state.wrench.force.z > 0.3), 'a proxy that tissue holds back')
            self.assertEqual(state.header.frame_id, 'stylus_base')
            self.assertGreater(state.proxy.position.z, state.hand.position.z + 0.001)
            wait_until(lambda: log.last(pushes), 'a driver that pushes the hand up')
            del log.messages[:]
            rosnode.kill_nodes(['/haptic_proxy'])
            wait_until(lambda: log.last(lambda line: line.msg.endswith('the force is off')),
                       'the force to be switched off')
            launched.nodes.remove('/haptic_proxy')

    def test_dvrk(self):
        """Both arms touch the organ with both jaws, and the hands feel forces out of it, within the limit of 2 N."""
        jaws = {arm + link for arm in ('PSM1', 'PSM2') for link in ('_left_jaw', '_right_jaw')}
        outwards = (0, 0, -1)  # where the arms touch the organ, in the camera's axes
        with self.launched('examples/dvrk.launch'):
            contacts = ContactLog('/organ_collision/contacts')
            hands = [Log('/%s/body/servo_cf' % hand, WrenchStamped) for hand in ('MTMR', 'MTML')]
            absolute = [Log('/%s/body/set_cf_orientation_absolute' % hand, Bool) for hand in ('MTMR', 'MTML')]
            touched = lambda: {a.links[c.link] for a in contacts.select(lambda a: True) for c in a.contacts}
            wait_until(lambda: jaws <= touched(), touched, LONG)
            for log in hands:
                wait_until(lambda: log.last(lambda m: force_of(m) @ outwards > 0.1), 'forces out of the organ', LONG)
                for message in log.select(lambda message: True):
                    self.assertEqual((message.header.frame_id, message.wrench.torque), ('ECM', Vector3()))
                    self.assertLessEqual(np.linalg.norm(force_of(message)), 2.0 + 1e-9)
            for log in absolute:
                self.assertTrue(wait_until(log.last, 'absolute axes').data)
            self.check_robot('urdf/psm.urdf', ('PSM_', 'PSM1_'))

    def test_forces(self):
        """The tissue pushes the probe up. The tip frame is not turned."""
        with self.launched('examples/forces.launch'):
            wrenches = Log('/haptic_proxy/probe/wrench', WrenchStamped)
            simulation = subprocess.Popen([program('simulator.py')])
            try:
                wrench = wait_until(lambda: wrenches.last(lambda w: w.wrench.force.z > 0.3), 'a force')
                self.assertEqual(wrench.header.frame_id, 'probe_tip')
                self.assertLess(abs(vector(wrench.wrench.torque)).max(), 1e-9)  # The trocar bears it.
            finally:
                simulation.send_signal(signal.SIGINT)
                self.assertEqual(simulation.wait(LIMIT), 0)

    def test_fem_tissue(self):
        """The vertex forces alone move the tissue: it yields under the probe, and comes back. What its nodes are given
        is their sum, times the duration of a step."""
        with self.launched('examples/fem_tissue.launch'):
            forces, impulses, shapes = (Log(topic, kind) for topic, kind in (
                ('/haptic_proxy/tissue/probe/vertex_forces', VertexForces),
                ('/fem_tissue/impulse', WrenchStamped), ('/haptic_proxy/organ_vertices', OrganVertices)))
            rest = rospy.wait_for_message('/haptic_proxy/organ_mesh', OrganMesh, LIMIT)
            heights = np.array(rest.vertices)[2::3]
            depth = lambda shape: (heights - np.array(shape.vertices)[2::3]).max()
            dented = lambda: [depth(shape) for shape in shapes.select(lambda shape: True)]
            wait_until(lambda: max(dented(), default=0) > 0.002 > 0.0002 > dented()[-1], 'a dent that comes back', LONG)
            self.assertLess(max(dented()), 0.013)  # The probe's surface goes down to 13 mm below the tissue at rest.

            shape_at, forces_at, impulse_at = ({stamp(m): m for m in log.select(lambda m: True)} for log, stamp in (
                (shapes, lambda m: m.header.stamp), (forces, lambda m: m.mesh_stamp),
                (impulses, lambda m: m.header.stamp)))
            strongest, stamps = 0.0, set(shape_at).intersection(forces_at, impulse_at)
            self.assertGreater(len(stamps), 100)
            for stamp in stamps:
                on_vertices, impulse = forces_at[stamp], impulse_at[stamp]
                each = np.array([vector(force) for force in on_vertices.forces]).reshape(-1, 3)
                places = np.array(shape_at[stamp].vertices).reshape(-1, 3)[list(on_vertices.vertices)]
                force, torque = each.sum(axis=0), np.cross(places, each).sum(axis=0)
                strongest = max(strongest, np.linalg.norm(force))
                # [N s], [N m s] Bullet computes with 32-bit floats.
                rounding = FEM_STEP * (1e-8 + 1e-5 * np.linalg.norm(force))
                self.assertLess(abs(vector(impulse.wrench.force) - FEM_STEP * force).max(), rounding)
                self.assertLess(abs(vector(impulse.wrench.torque) - FEM_STEP * torque).max(), rounding)
                self.assertEqual((on_vertices.organ, on_vertices.tool, on_vertices.topology), ('tissue', 'probe', 0))
            self.assertGreater(strongest, 0.3)


if __name__ == '__main__':
    rospy.init_node('examples_test')
    rostest.rosrun('organ_collision', 'examples', ExamplesTest, sys.argv)
