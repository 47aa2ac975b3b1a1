#!/usr/bin/python3
"""A quiet roslaunch for the demo: shows only errors and what the nodes print. The exit code is 1 if
a required node failed, and 0 otherwise.

Usage: launch_demo.py LAUNCH_FILE [ARGUMENT:=VALUE]...
"""

import contextlib
import os
import sys

import roslaunch
import rospkg


class ExitCodes(roslaunch.pmon.ProcessListener):
    """The exit codes of the nodes that ended by themselves, by name of the node."""

    def __init__(self):
        self.by_name = {}

    def process_died(self, process_name, exit_code):
        name = process_name.rsplit('-', 1)[0]  # removes the number that roslaunch appends
        self.by_name[name] = exit_code


def run(launch_file, arguments):
    """Runs the launch file and returns the names of the required nodes that failed."""
    run_id = roslaunch.rlutil.get_or_generate_uuid(None, False)
    roslaunch.configure_logging(run_id)
    ended = ExitCodes()
    launch = roslaunch.parent.ROSLaunchParent(run_id, [(launch_file, arguments)],
                                              process_listeners=[ended], show_summary=False)
    launch.start()
    launch.spin()
    return [node.name for node in launch.config.nodes
            if node.required and ended.by_name.get(node.name, 0) != 0]


def main():
    try:
        with open(os.devnull, 'w') as nowhere, contextlib.redirect_stdout(nowhere):
            failed = run(sys.argv[1], sys.argv[2:])
    except (roslaunch.RLException, rospkg.ResourceNotFound) as error:
        sys.exit(str(error))
    if failed:
        sys.exit('failed: ' + ', '.join(failed))


if __name__ == '__main__':
    main()
