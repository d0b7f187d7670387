"""Plays a recording into a node under test and collects what the node says.

The tests publish every message themselves, so that each can spoil the data in its own way and none
depends on the speed of the machine: the player waits for the node to keep up.
"""
import collections
import copy
import os
import struct
import threading

import rosbag
import rospkg
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, PointCloud2
from tf2_msgs.msg import TFMessage

DEVEL = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
TEST_DATA = os.path.join(DEVEL, "share", "hv_bringup", "test")
RECORDING = os.path.join(TEST_DATA, "recording.bag")
LOOP_RECORDING = os.path.join(TEST_DATA, "loop", "recording.bag")
HV_SLAM = os.path.join(DEVEL, "lib", "hv_replay", "hv_slam")
HV_LIO_NODE = os.path.join(DEVEL, "lib", "hv_lio", "hv_lio_node")
HV_LOOP_BTC_NODE = os.path.join(DEVEL, "lib", "hv_loop_btc", "hv_loop_btc_node")
CONFIG = os.path.join(rospkg.RosPack().get_path("hv_bringup"), "..", "config", "robot.yaml")

POINTS = "/points"
IMU = "/imu"
WAIT_S = 30.0  # longest wait for anything; reached only by a failure


def wait_until(condition):
    """Whether `condition` came true before WAIT_S."""
    for _ in range(int(WAIT_S / 0.02)):
        if condition():
            return True
        if rospy.is_shutdown():
            return False
        rospy.rostime.wallsleep(0.02)
    return bool(condition())


class Collector:
    """Every message of a topic, in order of arrival; the last `keep` of them if that is given."""

    def __init__(self, topic, kind, keep=None):
        self.messages = [] if keep is None else collections.deque(maxlen=keep)
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=10000)

    def __len__(self):
        return len(self.messages)

    def connected(self):
        return self._subscriber.get_num_connections() > 0


class Diagnostics:
    """The latest diagnostics of the node, by short name of the status."""

    def __init__(self):
        self._lock = threading.Lock()
        self._latest = {}
        self._subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._store)

    def _store(self, array):
        with self._lock:
            for status in array.status:
                self._latest[status.name.split(": ")[-1]] = status

    def status(self, name):
        with self._lock:
            return self._latest.get(name)

    def message(self, name="odometry"):
        status = self.status(name)
        return status.message if status else ""

    def value(self, name, key):
        status = self.status(name)
        values = {pair.key: pair.value for pair in status.values} if status else {}
        return values.get(key, "")

    def count(self, key, name="input"):
        text = self.value(name, key)
        return int(text) if text else 0


class Player:
    """Publishes the messages of a recording in their order."""

    def __init__(self, path, points=POINTS, imu=IMU):
        with rosbag.Bag(path) as bag:
            everything = list(bag.read_messages())
        self._publishers = {
            POINTS: rospy.Publisher(points, PointCloud2, queue_size=1000),
            IMU: rospy.Publisher(imu, Imu, queue_size=10000),
        }
        self.messages = [(topic, message) for topic, message, _ in everything
                         if topic in self._publishers]
        self._static = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
        self.transforms = [transform for topic, message, _ in everything if topic == "/tf_static"
                           for transform in message.transforms]
        self._static.publish(TFMessage(self.transforms))

    def wait_for_node(self, topics=(POINTS, IMU)):
        return wait_until(lambda: all(self._publishers[topic].get_num_connections() > 0
                                      for topic in topics))

    def close(self):
        """Lets the next player start without the connections of this one."""
        for publisher in self._publishers.values():
            publisher.unregister()

    def clouds(self, start=0, end=None):
        """The messages that belong to clouds number `start` to `end`: those clouds and the IMU
        samples around them."""
        selected = []
        number = -1
        for topic, message in self.messages:
            number += topic == POINTS
            if max(number, 0) >= start and (end is None or number < end):
                selected.append((topic, message))
        return selected

    def send(self, topic, message):
        self._publishers[topic].publish(message)

    def play(self, messages, done=None, ahead=10, patience_s=0.5):
        """Publishes `messages`; `done()` counts what the node has answered, and the player keeps
        at most `ahead` clouds ahead of it, beside those that the node leaves unanswered: what has
        no answer after `patience_s` gets none."""
        sent = 0
        answered_before = done() if done else 0
        for topic, message in messages:
            self.send(topic, message)
            sent += topic == POINTS
            if done and topic == POINTS and sent > ahead:
                self._wait_for_progress(done, answered_before + sent - ahead, patience_s)
                ahead = max(ahead, sent - (done() - answered_before))

    @staticmethod
    def _wait_for_progress(done, wanted, patience_s):
        for _ in range(int(patience_s / 0.02)):
            if done() >= wanted:
                return
            rospy.rostime.wallsleep(0.02)


def shifted(messages, seconds):
    """Copies with all stamps moved; absolute point times move with them."""
    offset = rospy.Duration.from_sec(seconds)
    moved = []
    for topic, message in messages:
        message = copy.copy(message)
        message.header = copy.copy(message.header)
        message.header.stamp = message.header.stamp + offset
        if topic == POINTS:
            message.data = _shift_point_times(message, seconds)
        moved.append((topic, message))
    return moved


def _shift_point_times(cloud, seconds):
    offset = next(field.offset for field in cloud.fields if field.name == "timestamp")
    data = bytearray(cloud.data)
    for start in range(offset, len(data), cloud.point_step):
        time, = struct.unpack_from("<d", data, start)
        struct.pack_into("<d", data, start, time + seconds)
    return bytes(data)


def odometry_collector():
    return Collector("/odometry", Odometry)
