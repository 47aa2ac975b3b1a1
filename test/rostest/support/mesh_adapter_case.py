"""A test case for organ_mesh_adapter. It publishes meshes as a simulator does, and asks the
collision node about the organs."""

import threading

from diagnostic_msgs.msg import DiagnosticArray
from organ_collision.msg import ContactArray
import rospy

from . import oracle
from .contact_case import ContactCase
from .node_client import FAR_AWAY, NodeClient, shaft, wait_until

AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
RADIUS = 0.005


class MessageLog:
    """All messages received on a topic so far, in order."""

    def __init__(self, topic, message_type):
        self.messages, self.lock = [], threading.Lock()
        self.subscriber = rospy.Subscriber(topic, message_type, self._add, queue_size=1000)
        wait_until(lambda: self.subscriber.get_num_connections() > 0, topic)

    def _add(self, message):
        with self.lock:
            self.messages.append(message)

    def of(self, organ):
        with self.lock:
            return [message for message in self.messages if message.organ == organ]


class AdapterDiagnostics:
    """The latest of what the adapter publishes on /diagnostics."""

    def __init__(self, adapter):
        self.values, self.summary = {}, ''
        self.name = adapter.lstrip('/') + ': meshes'
        self.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self._keep)

    def _keep(self, message):
        for status in message.status:
            if status.name.lstrip('/') == self.name:
                self.summary = status.message
                self.values = {pair.key: pair.value for pair in status.values}


class MeshAdapterCase(ContactCase):
    adapter = '/organ_mesh_adapter'

    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.publishers = {}

    @classmethod
    def publish(cls, topic, message, adapter=None):
        """Publishes once the adapter listens to the topic."""
        adapter = adapter or cls.adapter
        if topic not in cls.publishers:
            cls.publishers[topic] = rospy.Publisher(topic, type(message), queue_size=100)
        publisher = cls.publishers[topic]
        wait_until(
            lambda: [
                listener
                for _, listener, *_ in publisher.impl.get_stats_info()
                if listener == adapter
            ],
            '%s to listen to %s' % (adapter, topic),
        )
        publisher.publish(message)

    def wait_for_contacts(self, organ, mesh, node=None):
        """Waits until the node's answer about the organ has the contacts of `mesh`, at least
        one."""
        expected = oracle.static_contacts(mesh, AXIS, RADIUS)
        self.assertGreater(len(expected), 0)

        def same():
            result = (node or self.node).query(organ, shaft(*AXIS, RADIUS))
            seen[:] = [result.status, result.message, [c.face for c in result.contacts]]
            try:
                self.assert_contacts(result, expected, 1e-6)
            except AssertionError as error:
                seen[3:] = [str(error)]
                return None
            return result

        seen = []
        return wait_until(same, lambda: 'contacts of %s; there are %s' % (organ, seen))

    def wait_until_removed(self, organ, node=None):
        wait_until(
            lambda: (node or self.node).query(organ, FAR_AWAY).status == ContactArray.NO_MESH,
            'removal of ' + organ,
        )
