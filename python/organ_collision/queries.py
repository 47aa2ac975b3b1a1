"""Questions to the collision node."""

import time

import rospy
from std_msgs.msg import Header

from organ_collision.answers import CollisionError, contact_table
from organ_collision.messages import link_motions, shaft_motion, shaft_motions
from organ_collision.msg import ContactArray
from organ_collision.srv import QueryCollision, QueryCollisionBatch

_REFUSED = 'was refused: '  # what the node's message says if the organ has no mesh because the node refused it
_PATIENCE = 2.0  # [s]


class Queries:
    """Asks a collision node what a shaft, or one of its tools, would touch. A query changes nothing in the node.

    node     name of the collision node
    timeout  [s] how long to wait for the node; None: without limit

    Raises rospy.ROSException if the node does not come in time. The methods raise CollisionError if the node has no
    answer, such as for an unknown organ, and rospy.ServiceException if it is gone.
    """

    def __init__(self, node='/organ_collision', timeout=None):
        self._query = rospy.ServiceProxy(node + '/query', QueryCollision)
        self._batch = rospy.ServiceProxy(node + '/query_batch', QueryCollisionBatch)
        self._query.wait_for_service(timeout)
        self._batch.wait_for_service(timeout)

    def query(self, organ, trocar, tip, radius, previous_trocar=None, previous_tip=None, frame=None):
        """What a shaft touches, as contact_table() returns it.

        organ                          name of the organ
        trocar, tip                    the ends of the shaft's axis, three numbers each [m]
        radius                         [m]
        previous_trocar, previous_tip  where they were before: the shaft is swept from there. None: that end rests
        frame                          frame of these points; None: the frame has the name of the organ
        """
        return contact_table(self.answer(organ, trocar, tip, radius, previous_trocar, previous_tip, frame))

    def answer(self, organ, trocar, tip, radius, previous_trocar=None, previous_tip=None, frame=None, **asked):
        """The whole ContactArray, for near_table(), crossing_table() and clearance_record().

        asked  what to ask for besides contacts, by the names of QueryCollision.srv: margin [m], clearance, max_near,
               placement, regions, organ_rests
        """
        mode = _mode(previous_trocar, previous_tip)
        motion = shaft_motion(trocar, tip, radius, previous_trocar, previous_tip)
        answer = self._query(header=_header(organ, frame), organ=organ, motion=motion, mode=mode, **asked).result
        if answer.status != ContactArray.OK:
            raise CollisionError(answer.status, answer.message)
        return answer

    def query_many(self, organ, trocars, tips, radius, previous_trocars=None, previous_tips=None, frame=None):
        """The same for k motions in one call. Points are k x 3 arrays. Returns a list of k tables."""
        mode = _mode(previous_trocars, previous_tips)
        motions = shaft_motions(trocars, tips, radius, previous_trocars, previous_tips)
        return [contact_table(result) for result in self._answers(organ, frame, motions=motions, mode=mode)]

    def answer_links(self, organ, tool, links, previous_links=None, shafts=(), frame=None, **asked):
        """What a tool of the node would touch if its links moved so. Returns a list of at most k ContactArrays.

        tool            name of a tool with l links
        links           the poses of its links at the end of each motion: k x l x 7 numbers, position [m] and quaternion
                        (x, y, z, w), or k x l x 4 x 4 matrices
        previous_links  the same at the start of each motion: the links are swept from there. None: static queries
        shafts          the k motions of the tool's shaft, as of shaft_motions(), if it has one
        frame           frame of all these; None: the frame has the name of the organ
        asked           what else to ask for, by the names of QueryCollisionBatch.srv: stop_at_first_contact, margin [m],
                        clearance, max_near, placement, regions, organ_rests

        An illegal motion has an answer whose status says so.
        """
        return self._answers(organ, frame, tool=tool, motions=list(shafts),
                             link_motions=link_motions(links, previous_links),
                             mode=_mode(previous_links, None), **asked)

    def _answers(self, organ, frame, **request):
        answer = self._batch(header=_header(organ, frame), organ=organ, **request)
        if answer.status != ContactArray.OK:
            raise CollisionError(answer.status, answer.message)
        return answer.results

    def wait_for(self, organ, timeout=None, frame=None):
        """Waits until the node has the organ. Raises the node's CollisionError if it has not within `timeout` [s], or
        if the node refused its mesh: the text says why. A refusal counts if no better mesh has come for 2 s."""
        end = None if timeout is None else time.monotonic() + timeout
        refused = None  # since when the refusal stands
        while True:
            try:
                self.query(organ, (0, 0, 0), (0, 0, 0), 1e-6, frame=frame)
                return
            except CollisionError as error:
                if error.status not in (ContactArray.UNKNOWN_ORGAN, ContactArray.NO_MESH):
                    raise
                now = time.monotonic()
                refused = (refused or now) if _REFUSED in str(error) else None
                if (end is not None and now > end) or (refused and now > refused + _PATIENCE):
                    raise
            rospy.rostime.wallsleep(0.01)


def _mode(previous_trocar, previous_tip):
    is_static = previous_trocar is None and previous_tip is None
    return ContactArray.STATIC if is_static else ContactArray.SWEPT


def _header(organ, frame):
    return Header(frame_id=organ if frame is None else frame)
