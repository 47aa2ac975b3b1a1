#!/usr/bin/python3
"""Prints what the collision node finds and what the palpator's proxy does: one line each second, and a summary at the
end. demo.launch starts it.

Parameters: ~seconds it listens (0: until it is stopped), ~collision_node, ~haptic_node: names of the nodes;
~ends_launch: if true, roslaunch ends when it ends.
"""

import argparse
from collections import defaultdict
import os
import signal
import sys
import threading
import time

from diagnostic_msgs.msg import DiagnosticArray
import numpy
from organ_collision.msg import ContactArray, OrganMesh, OrganVertices, ProxyState
import rospy

FIRST_PATIENCE, PATIENCE = 60.0, 10.0  # [s] until the collision node answers for the first time, and again
STATES = {getattr(ProxyState, name): name for name in ('NO_ANSWER', 'FREE', 'TOUCHING', 'SQUEEZED', 'PUNCTURED')}
# The end of a key on /diagnostics, where the collision node tells its query times [microseconds].
MEDIAN, PERCENTILE_99, WORST = ('query time, %s [us]' % name for name in ('median', '99th percentile', 'worst'))


class ContactTally:
    """What the collision node found of a tool: the faces since the last line, and contacts since the start. A static
    test would have missed those that had ended when the step ended."""

    def __init__(self):
        self.faces, self.contacts, self.missed = set(), 0, 0


class DemoReport:
    """The callbacks run in threads of rospy, and the lines are printed in the main thread."""

    def __init__(self, collision_node, haptic_node):
        self.lock = threading.Lock()
        self.last_answer = None  # when the collision node answered last, even if only with a failure
        self.failure = ''        # the latest one since the last line
        self.shapes = self.answers = 0  # since the last line, as are the next two
        self.poses, self.recent_force = 0, 0.0  # of the palpator that had an answer; the greatest force [N]
        self.tallies, self.delays = defaultdict(ContactTally), []  # by tool; [s] from shape to answer
        self.state, self.answered, self.held, self.force, self.tick_sec = ProxyState(), 0, 0, 0.0, 0.0
        self.query_times = defaultdict(float)
        self.subscribers = [rospy.Subscriber(topic, kind, self.locked, callback, queue_size=1000, tcp_nodelay=True)
                            for topic, kind, callback in (
                                (collision_node + '/organ_mesh', OrganMesh, self.on_mesh),
                                (collision_node + '/organ_vertices', OrganVertices, self.on_vertices),
                                (collision_node + '/contacts', ContactArray, self.on_contacts),
                                (haptic_node + '/palpator/state', ProxyState, self.on_state),
                                ('/diagnostics', DiagnosticArray, self.on_diagnostics))]

    def locked(self, message, callback):
        with self.lock:
            callback(message)

    def on_mesh(self, mesh):
        self.shapes += 1
        if mesh.topology > 0:
            print('        a cut: %d faces' % (len(mesh.triangles) // 3))

    def on_vertices(self, _):
        self.shapes += 1

    def on_contacts(self, answer):
        self.last_answer = time.monotonic()
        if answer.status != ContactArray.OK:
            self.failure = answer.message
            return
        self.answers += 1
        self.delays.append((rospy.Time.now() - answer.mesh_stamp).to_sec())
        tally = self.tallies[answer.tool]
        tally.faces.update(contact.face for contact in answer.contacts)
        tally.contacts += len(answer.contacts)
        tally.missed += sum(not contact.touching for contact in answer.contacts)

    def on_state(self, state):
        self.state = state
        if state.state == ProxyState.NO_ANSWER:
            return
        force = numpy.linalg.norm((state.wrench.force.x, state.wrench.force.y, state.wrench.force.z))
        self.poses += 1
        self.answered += 1
        self.held += state.state != ProxyState.FREE
        self.recent_force, self.force = max(self.recent_force, force), max(self.force, force)
        self.tick_sec += state.tick_sec

    def on_diagnostics(self, array):
        for entry in (entry for status in array.status for entry in status.values):
            if entry.key in (MEDIAN, PERCENTILE_99):
                self.query_times[entry.key] = float(entry.value)
            elif entry.key == WORST:
                self.query_times[WORST] = max(self.query_times[WORST], float(entry.value))

    def print_line(self, since_start, seconds):
        """One line about the last `seconds`."""
        line = '%4.0f s  %3.0f shapes/s  %3.0f answers/s' % (since_start, self.shapes / seconds, self.answers / seconds)
        for tool, tally in sorted(self.tallies.items()):
            line += '  %s %d faces' % (tool, len(tally.faces))
            tally.faces.clear()
        if self.query_times[MEDIAN] > 0:
            line += '  query %.0f us' % self.query_times[MEDIAN]
        line += '  palpator ' + STATES[self.state.state]
        if self.state.state == ProxyState.NO_ANSWER:
            line += ': ' + self.state.message
        else:
            line += ', up to %.1f N, %.0f poses/s' % (self.recent_force, self.poses / seconds)
        print(line + ('\n        ' + self.failure if self.failure else ''), flush=True)
        self.shapes = self.answers = self.poses = 0
        self.recent_force, self.failure = 0.0, ''

    def print_summary(self, since_start):
        """Returns false if there were no contacts, or if the proxy gave no answer."""
        contacts, missed = (sum(getattr(tally, name) for tally in self.tallies.values())
                            for name in ('contacts', 'missed'))
        print('\nIn %.0f s: %d contacts.' % (since_start, contacts), end='')
        if contacts > 0:
            print(' A static test at the same instants would have missed %d of them (%.0f%%):'
                  % (missed, 100.0 * missed / contacts), end='')
        print()
        for tool, tally in sorted(self.tallies.items()):
            print('  %-10s %6d contacts, %6d missed' % (tool, tally.contacts, tally.missed))
        print('Query time: median %.0f us, 99%% within %.0f us, worst %.0f us.'
              % tuple(self.query_times[key] for key in (MEDIAN, PERCENTILE_99, WORST)))
        print('From shape to answer, through ROS: median %.0f us, 99%% within %.0f us.'
              % tuple(1e6 * numpy.percentile(self.delays or [0.0], (50, 99))))
        poses = max(1, self.answered)
        print("The palpator's hand: %d poses, tissue held the proxy in %.0f%% of them, with at most %.1f N; %.0f us a tick "
              'on average.' % (self.answered, 100.0 * self.held / poses, self.force, 1e6 * self.tick_sec / poses), flush=True)
        return contacts > 0 and self.answered > 0


def report(node, haptic_node, seconds):
    """Reports for `seconds`, or until Ctrl-C if that is 0. Returns what print_summary() returns, and whether there was
    a Ctrl-C."""
    def wait(since, patience):
        time.sleep(0.02)
        if time.monotonic() > since + patience:
            raise RuntimeError(node + ' does not answer')

    demo = DemoReport(node, haptic_node)
    start, since_start, last_line, is_interrupted = time.monotonic(), 0.0, 0.0, False
    try:
        while demo.last_answer is None:
            wait(start, FIRST_PATIENCE)
        start = time.monotonic()
        while not seconds or since_start < seconds:
            wait(demo.last_answer, PATIENCE)
            since_start = time.monotonic() - start
            if int(since_start) > int(last_line):
                with demo.lock:
                    demo.print_line(since_start, since_start - last_line)
                last_line = since_start
    except KeyboardInterrupt:
        is_interrupted = True
    with demo.lock:
        return demo.print_summary(since_start), is_interrupted


def main():
    argparse.ArgumentParser(prog='demo_report.py', description=__doc__,
                            formatter_class=argparse.RawDescriptionHelpFormatter).parse_args(rospy.myargv()[1:])
    # Without rospy's signal handler: Ctrl-C ends the report, and then the summary is printed.
    rospy.init_node('demo_report', disable_signals=True)
    has_answers, is_interrupted = report(rospy.get_param('~collision_node', '/organ_collision'),
                                         rospy.get_param('~haptic_node', '/haptic_proxy'),
                                         float(rospy.get_param('~seconds', 0.0)))
    if not has_answers:
        sys.exit(1)
    if rospy.get_param('~ends_launch', False) and not is_interrupted:
        # Ends roslaunch, which has started this program, as Ctrl-C does. If this program ended first, roslaunch would
        # report the death of a required node as an error.
        os.kill(os.getppid(), signal.SIGINT)
        signal.pause()


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        pass
    except RuntimeError as error:
        sys.exit('demo_report.py: %s' % error)
    finally:
        rospy.signal_shutdown('the report ends')  # Signs off from the master, which rospy's own handler would do.
