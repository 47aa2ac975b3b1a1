"""The node as its users see it: its topics, its services, TF and /diagnostics. Nothing here sleeps for a fixed time.
Instead, functions wait for an event, at most LIMIT seconds."""

import threading
import time

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, PoseStamped, Quaternion, TransformStamped, Vector3
from organ_collision.msg import ContactArray, OrganMesh, OrganVertices, ToolMotion
from organ_collision.srv import QueryCollision, QueryCollisionBatch, QueryCollisionBatchRequest, QueryCollisionRequest
import rospy
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from . import scenes

LIMIT = 30.0  # [s]


def wait_until(condition, what, limit=LIMIT):
    """Waits until condition() is true and returns its value. Raises AssertionError after `limit` seconds. `what`: the
    awaited event for the error's text, or a function that returns it."""
    end = time.monotonic() + limit
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError('waited %g s without success: %s' % (limit, what() if callable(what) else what))
        time.sleep(0.005)


def is_heard(topic, process):
    """Whether the node `process` listens to this publisher. Counting the listeners is not enough, because other nodes
    may listen, too."""
    return process in [listener for _, listener, *_ in topic.impl.get_stats_info()]


def pose_stamped(frame, point, stamp=rospy.Time(), rotation=(0, 0, 0, 1)):
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, stamp
    message.pose.position, message.pose.orientation = Point(*point), Quaternion(*rotation)
    return message


def vertices_message(organ, mesh, stamp=rospy.Time(), topology=1, frame='liver_frame', kind=OrganVertices):
    message = kind(organ=organ, topology=topology, vertices=mesh.flat_vertices())
    message.header.frame_id, message.header.stamp = frame, stamp
    return message


def mesh_message(organ, mesh, *args, **named):
    message = vertices_message(organ, mesh, *args, kind=OrganMesh, **named)
    message.triangles = mesh.flat_faces()
    return message


class TfSender:
    """Sends transforms as a robot would: moving ones on /tf, and resting ones on /tf_static."""

    def __init__(self):
        self.moving = rospy.Publisher('/tf', TFMessage, queue_size=1000)
        self.resting = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        self.resting_transforms = []

    def wait_for(self, node):
        """Waits until the node of this NodeClient listens. It never gets what is sent on /tf before."""
        wait_until(lambda: is_heard(self.moving, node.process) and is_heard(self.resting, node.process),
                   'connections from TF to ' + node.process)

    def send(self, *transforms):
        """Sends transforms (parent, child, pose, stamp) in one message, because queues are short."""
        self.moving.publish([self._message(*transform) for transform in transforms])

    def send_resting(self, *transforms):
        """Sends transforms (parent, child, pose) that hold for all times. Instead of a pose, a point may be given."""
        now = rospy.Time.now()
        self.resting_transforms += [self._message(*transform, now) for transform in transforms]
        self.resting.publish(self.resting_transforms)

    @staticmethod
    def _message(parent, child, pose, stamp):
        if isinstance(pose, tuple):
            pose = scenes.at(pose)
        message = TransformStamped(child_frame_id=child)
        message.header.frame_id, message.header.stamp = parent, stamp
        message.transform.translation = Vector3(*pose.translation)
        message.transform.rotation = Quaternion(*pose.rotation)
        return message


class Log:
    """All messages of a topic so far, in order."""

    def __init__(self, topic, kind):
        self.messages = []
        self.lock = threading.Lock()
        self.subscriber = rospy.Subscriber(topic, kind, self._add, queue_size=1000)

    def _add(self, message):
        with self.lock:
            self.messages.append(message)

    def select(self, wanted):
        with self.lock:
            return [message for message in self.messages if wanted(message)]

    def last(self, wanted=lambda message: True):
        """The last such message; None if there is none."""
        return next(iter(self.select(wanted)[::-1]), None)

    def wait_for_publisher(self):
        wait_until(lambda: self.subscriber.get_num_connections() > 0, self.subscriber.resolved_name)
        return self


class ContactLog(Log):
    """All ContactArrays received so far, in order."""

    def __init__(self, topic):
        super().__init__(topic, ContactArray)

    def of(self, organ, tool=None, stamp=None, **fields):
        """The messages about one organ (and tool, and stamp) whose fields have these values."""
        return self.select(lambda message: message.organ == organ and tool in (None, message.tool)
                           and stamp in (None, message.header.stamp)
                           and all(getattr(message, name) == value for name, value in fields.items()))

    def wait_for(self, organ, tool, **fields):
        """Waits for the first such message."""
        return wait_until(lambda: self.of(organ, tool, **fields),
                          'contacts of %s and %s with %s' % (organ, tool, fields))[0]


class Diagnostics:
    """What a node says on /diagnostics: by the name of each of its tasks all summaries so far and the last level; and
    the last value of each key."""

    def __init__(self, node):
        self.node, self.values, self.summaries, self.levels = node.strip('/'), {}, {}, {}
        self.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self._keep)

    def _keep(self, message):
        for status in message.status:
            if status.message == 'Node starting up':
                continue  # diagnostic_updater says so before the node has said anything.
            if status.name.lstrip('/').startswith(self.node + ':'):
                task = status.name.split(': ')[-1]
                self.levels[task] = status.level
                self.summaries.setdefault(task, []).append(status.message)
                self.values.update((pair.key, pair.value) for pair in status.values)

    def count(self, key):
        return int(self.values.get(key, 0))

    def wait_for_count(self, key, count=1):
        wait_until(lambda: self.count(key) >= count, lambda: '%s: %s' % (key, self.values))

    def wait_for_summary(self, task, *words, level=None):
        """Waits for a summary of the task with all of the words."""
        wait_until(lambda: any(all(word in summary for word in words) for summary in self.summaries.get(task, []))
                   and level in (None, self.levels[task]), lambda: '%s in %s' % (words, self.summaries))


def shaft(trocar, tip, radius, previous=None):
    """A ToolMotion; `previous` is the axis (trocar, tip) at the start of the step."""
    motion = ToolMotion(radius=radius, trocar=Point(*trocar), tip=Point(*tip))
    if previous:
        motion.previous_trocar, motion.previous_tip = Point(*previous[0]), Point(*previous[1])
    return motion


FAR_AWAY = shaft((9.0, 9.0, 9.0), (9.0, 9.0, 9.1), 0.001)


class NodeClient:
    """Publishers, subscribers and services of one running node. `process`: the name of the ROS node that runs it, if it
    is another one: the manager of a nodelet."""

    def __init__(self, node='/organ_collision', frame='liver_frame', process=None):
        self.node, self.frame, self.process = node, frame, process or node
        self.meshes = rospy.Publisher(node + '/organ_mesh', OrganMesh, queue_size=100)
        self.shapes = rospy.Publisher(node + '/organ_vertices', OrganVertices, queue_size=100)
        self.contacts = ContactLog(node + '/contacts')
        self.diagnostics = Diagnostics(node)
        for service in ('query', 'query_batch', 'reset'):
            rospy.wait_for_service(node + '/' + service, LIMIT)
        self.query_service = rospy.ServiceProxy(node + '/query', QueryCollision, persistent=True)
        self.batch_service = rospy.ServiceProxy(node + '/query_batch', QueryCollisionBatch)
        self.reset = rospy.ServiceProxy(node + '/reset', Empty)
        self.contacts.wait_for_publisher()
        wait_until(lambda: all(is_heard(topic, self.process) for topic in (self.meshes, self.shapes)),
                   'connections to ' + node)

    def close(self):
        """Closes all connections. Call this before connecting to another node of the same name."""
        for end in (self.meshes, self.shapes, self.contacts.subscriber, self.diagnostics.subscriber):
            end.unregister()
        self.query_service.close()

    def send_mesh(self, *args, **named):
        self.meshes.publish(mesh_message(*args, frame=self.frame, **named))

    def send_vertices(self, *args, **named):
        self.shapes.publish(vertices_message(*args, frame=self.frame, **named))

    def bring(self, organ, mesh, stamp=rospy.Time(), topology=1):
        """Sends a mesh, and waits until the node has it."""
        self.send_mesh(organ, mesh, stamp, topology)
        self.wait_for_shape(organ, stamp, topology)

    def remove(self, organ):
        self.send_mesh(organ, scenes.Mesh([], []))
        wait_until(lambda: self.query(organ, FAR_AWAY).status in (ContactArray.UNKNOWN_ORGAN, ContactArray.NO_MESH),
                   'removal of ' + organ)

    def wait_for_shape(self, organ, stamp, topology=1):
        """Waits until queries are answered with the organ's shape of `stamp`."""

        def has_it():
            result = self.query(organ, FAR_AWAY)
            seen[:] = [result.status, result.message, result.mesh_stamp, result.topology]
            return seen == [ContactArray.OK, '', stamp, topology]

        seen = []
        wait_until(has_it, lambda: 'shape of %s of %s; there is %s' % (organ, stamp, seen))

    def query(self, organ, motion=None, mode=ContactArray.STATIC, tool='', frame=None, stamp=rospy.Time(), **asked):
        """The answer of the service `query`. `asked`: other fields of the request."""
        request = QueryCollisionRequest(organ=organ, tool=tool, motion=motion or ToolMotion(), mode=mode, **asked)
        request.header.frame_id, request.header.stamp = self.frame if frame is None else frame, stamp
        return self.query_service(request).result

    def answer_batch(self, organ, motions, mode=ContactArray.STATIC, frame=None, **asked):
        """The answer of the service `query_batch`. `asked`: other fields of the request."""
        request = QueryCollisionBatchRequest(organ=organ, motions=motions, mode=mode, **asked)
        request.header.frame_id = self.frame if frame is None else frame
        return self.batch_service(request)

    def query_batch(self, *args, **named):
        """The results of a batch. Raises AssertionError if the batch is refused."""
        answer = self.answer_batch(*args, **named)
        if answer.status != ContactArray.OK:
            raise AssertionError('batch refused: %d, %s' % (answer.status, answer.message))
        return answer.results
