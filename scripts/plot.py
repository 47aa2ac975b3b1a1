#!/usr/bin/python3
"""Plots depth, distance and force of a tool while it moves, over the last seconds.

Each organ has a line, and its touches are bands. The distance needs a `margin` of the tool, the force haptic_proxy. With
--png, no display is needed.
"""

import argparse
import sys

import matplotlib
from organ_collision.recordings import Listener
from organ_collision.trial import Envelope, Trial, TrialError
from organ_collision.trial_plots import draw
import rospy


def show(figure, listener, tool, duration):
    """Draws what came in the last seconds."""
    listener.look()
    with listener.lock:
        pairs = [pair for pair in listener.trial.pairs.values() if pair.tool == tool]
        end = max((pair.clock.last for pair in pairs if pair.statuses), default=0.0)
        for pair in pairs:
            del pair.touches[:-1000]
        draw(figure, listener.trial, tool, end)
    figure.axes[0].set_xlim(-duration, 0)


def main():
    options = argparse.ArgumentParser(prog='plot.py', description=__doc__,
                                      formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument('tool', help='name of the tool')
    options.add_argument('--seconds', type=float, default=10.0, help='how much is shown; default: 10')
    options.add_argument('--png', metavar='FILE', help='listens so long, writes a picture, and ends')
    options.add_argument('--node', action='append', default=[], help='a node that counts; default: all')
    asked = options.parse_args(rospy.myargv()[1:])
    if not 0 < asked.seconds <= 3600:
        options.error('--seconds is %g; must be above 0 and at most 3600' % asked.seconds)
    if asked.png:
        matplotlib.use('Agg')
    from matplotlib import animation, pyplot  # They choose where to draw.
    figure = pyplot.figure(asked.tool, (9, 6), constrained_layout=True)
    if not asked.png and matplotlib.get_backend().lower() == 'agg':
        raise TrialError('there is no display, or no python3-tk; write a picture with --png FILE')
    listener = Listener(Trial(asked.node, series=lambda: Envelope(asked.seconds)), 'plot')
    if not asked.png:
        shown = animation.FuncAnimation(figure, lambda _: show(figure, listener, asked.tool, asked.seconds), interval=200,
                                        cache_frame_data=False)
        pyplot.show()
        return shown
    listener.listen(asked.seconds)
    show(figure, listener, asked.tool, asked.seconds)
    if asked.tool not in {name for name, _ in listener.trial.pairs}:
        raise TrialError('no answers about %s within %g s; tools with answers: %s' % (
            asked.tool, asked.seconds, ', '.join(sorted(listener.trial.tools)) or 'none'))
    figure.savefig(asked.png, dpi=100)


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        pass
    except (TrialError, OSError, rospy.ROSException) as error:
        print('plot.py: %s' % error, file=sys.stderr)
        sys.exit(2)
    finally:
        rospy.signal_shutdown('the plot ends')
