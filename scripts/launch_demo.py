#!/usr/bin/python3
"""roslaunch with an exit code: 1 if a required node failed, else 0.

Usage: launch_demo.py LAUNCH_FILE [ARGUMENT:=VALUE]...
"""

import sys

import roslaunch
import rospkg


class ExitCodes(roslaunch.pmon.ProcessListener):
    """Of the nodes that ended by themselves, by name."""

    def __init__(self):
        self.by_name = {}

    def process_died(self, process_name, exit_code):
        name = process_name.rsplit('-', 1)[0]  # without the number that roslaunch adds
        self.by_name[name] = exit_code


def main(launch_file, *arguments):
    run_id = roslaunch.rlutil.get_or_generate_uuid(None, False)
    roslaunch.configure_logging(run_id)
    ended = ExitCodes()
    launch = roslaunch.parent.ROSLaunchParent(run_id, [(launch_file, list(arguments))],
                                              process_listeners=[ended], show_summary=False)
    launch.start()
    launch.spin()
    failed = [node.name for node in launch.config.nodes
              if node.required and ended.by_name.get(node.name, 0) != 0]
    if failed:
        sys.exit('failed: ' + ', '.join(failed))


if __name__ == '__main__':
    try:
        main(*sys.argv[1:])
    except (roslaunch.RLException, rospkg.ResourceNotFound) as error:
        sys.exit(str(error))
