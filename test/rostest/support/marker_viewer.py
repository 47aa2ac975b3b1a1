"""What a viewer of markers shows."""

import threading

import rospy
from visualization_msgs.msg import Marker, MarkerArray

from .node_client import wait_until


class Viewer:
    """Keeps the markers of a topic as RViz does."""

    def __init__(self, topic):
        self.lock = threading.Lock()
        self.markers, self.surfaces = {}, 0
        self.subscriber = rospy.Subscriber(topic, MarkerArray, self._show, queue_size=4000)

    def _show(self, array):
        with self.lock:
            for marker in array.markers:
                assert marker.header.frame_id and marker.header.stamp.is_zero()
                if marker.action == Marker.DELETEALL:
                    self.markers.clear()
                elif marker.action == Marker.DELETE:
                    self.markers.pop((marker.ns, marker.id), None)
                else:
                    assert marker.lifetime > rospy.Duration(0)
                    self.markers[marker.ns, marker.id] = marker
                    self.surfaces += marker.ns.startswith('surface/')

    def namespaces(self):
        with self.lock:
            return {name for name, _ in self.markers}

    def of(self, namespace):
        with self.lock:
            return [m for (name, _), m in sorted(self.markers.items()) if name == namespace]

    def wait_for(self, namespaces):
        wait_until(
            lambda: self.namespaces() == namespaces,
            lambda: 'the markers %s; there are %s' % (namespaces, self.namespaces()),
        )

    def close(self):
        self.subscriber.unregister()
