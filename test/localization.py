"""Odometry and localisation nodes under test, in the map that hv_slam makes of another drive."""
import atexit
import os
import signal
import subprocess

import numpy
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped

from mapping import (
    CONNECTING_S, interrupt, kill, poses_of, restart_odometry, start_node, start_odometry)
from recording import (
    CONFIG, DEVEL, POINTS, TEST_DATA, Collector, Diagnostics, Player,
    odometry_collector, wait_until)

HV_LOCALIZE = os.path.join(DEVEL, "lib", "hv_replay", "hv_localize")
HV_RELOCALIZE_NDT_NODE = os.path.join(
    DEVEL, "lib", "hv_relocalize_ndt", "hv_relocalize_ndt_node")
MAP = os.path.join(TEST_DATA, "slam", "map")
MAP_TRUTH = os.path.join(TEST_DATA, "loop", "truth.tum")
# Fifteen seconds of another drive in the same office, then fifteen from another place.
KIDNAPPED = os.path.join(TEST_DATA, "kidnapped", "recording.bag")
KIDNAPPED_TRUTH = os.path.join(TEST_DATA, "kidnapped", "truth.tum")
START = 12  # clouds without odometry, at most, until it has started
START_IN_MOTION = 40
CLOUDS_BEFORE = 145  # the last of them well before the kidnapping

STATE = "localisation"  # name of the status in the diagnostics


def matrix(position, quaternion):
    """4 x 4, from x y z and qx qy qz qw."""
    x, y, z, w = quaternion
    pose = numpy.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = position
    return pose


def matrix_of(message):
    """4 x 4, from a geometry_msgs Pose or Transform."""
    is_pose = hasattr(message, "position")
    t = message.position if is_pose else message.translation
    q = message.orientation if is_pose else message.rotation
    return matrix((t.x, t.y, t.z), (q.x, q.y, q.z, q.w))


def distance(one, other):
    """Between the origins of two poses [m]."""
    return float(numpy.linalg.norm(one[:3, 3] - other[:3, 3]))


def read_tum(path):
    """Stamp in ns -> pose."""
    poses = {}
    with open(path) as file:
        for words in (line.split() for line in file if not line.startswith("#")):
            seconds, nanoseconds = words[0].split(".")
            values = [float(word) for word in words[1:]]
            poses[int(seconds) * 10**9 + int(nanoseconds)] = matrix(values[:3], values[3:])
    return poses


def nearest(poses, stamp):
    """The pose whose stamp [ns] is nearest."""
    return poses[min(poses, key=lambda other: abs(other - stamp))]


class Truth:
    """Where the IMU is in the map. The map begins where its recording has begun, at rest."""

    def __init__(self):
        stamp = min(poses_of(MAP), key=float)
        pose = poses_of(MAP)[stamp]
        start = int(stamp.replace(".", ""))
        self._T_map_world = matrix(pose[:3], pose[3:]) @ numpy.linalg.inv(
            nearest(read_tum(MAP_TRUTH), start))
        self._poses = read_tum(KIDNAPPED_TRUTH)

    def at(self, stamp):
        """T_map_imu at a stamp in ns."""
        return self._T_map_world @ nearest(self._poses, stamp)


def base_in_imu(player):
    """T_imu_base, as the recording tells it."""
    for transform in player.transforms:
        if (transform.header.frame_id, transform.child_frame_id) == ("base_link", "imu_link"):
            return numpy.linalg.inv(matrix_of(transform.transform))
    raise AssertionError("the recording has no transform from base_link to imu_link")


class Places:
    """What `localization_pose` tells."""

    def __init__(self):
        self._collector = Collector("/localization_pose", PoseWithCovarianceStamped)
        self.connected = self._collector.connected

    def __len__(self):
        return len(self._collector)

    @property
    def messages(self):
        return list(self._collector.messages)

    def poses(self):
        """Stamp in ns -> T_map_base."""
        return {message.header.stamp.to_nsec(): matrix_of(message.pose.pose)
                for message in self.messages}


def start_localizer(*arguments):
    return start_node(HV_RELOCALIZE_NDT_NODE, "hv_relocalize_ndt", "_config_file:=" + CONFIG,
                      "_map:=" + MAP, *arguments)


class Localization:
    """A fresh pair of nodes that localises the robot in a recording which the test plays."""

    def __init__(self, *arguments):
        self.diagnostics = Diagnostics()
        self.odometry = odometry_collector()
        self.places = Places()
        self.player = Player(KIDNAPPED)
        self._lio = start_odometry()
        self._localizer = start_localizer(*arguments)
        wait_for_nodes(self)

    def restart_odometry(self):
        self._lio = restart_odometry(self._lio)

    def restart_localizer(self):
        kill(self._localizer)
        heard = Diagnostics()
        self._localizer = start_localizer()
        assert wait_until(lambda: heard.value(STATE, "state") != "")
        rospy.rostime.wallsleep(CONNECTING_S)

    def value(self, key):
        return self.diagnostics.value(STATE, key)

    def count(self, key):
        return self.diagnostics.count(key, STATE)

    def play(self, first, last=None, start=START):
        """Plays these clouds, and waits until all of them have been taken in."""
        play_slowly(self, self.player.clouds(first, last), start)

    def is_running(self):
        return self._localizer.poll() is None

    def stop(self):
        """Interrupts both nodes; returns what the localiser has said."""
        interrupt(self._lio, "hv_lio")
        output = interrupt(self._localizer, "hv_relocalize_ndt")
        self.player.close()
        return output


class Launch:
    """localization.launch, which ends with the tests."""

    def __init__(self, *arguments):
        self._process = subprocess.Popen(
            ["roslaunch", "hv_bringup", "localization.launch", "sensor:=robot"] + list(arguments))
        atexit.register(self.stop)

    def stop(self):
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            self._process.wait(timeout=30)

    def exit_code(self):
        """Once it has ended on its own."""
        return self._process.wait(timeout=30)


def wait_for_nodes(nodes):
    """Until everybody hears everybody; `nodes` has diagnostics, odometry, places and player."""
    assert nodes.player.wait_for_node()
    assert wait_until(lambda: nodes.odometry.connected() and nodes.places.connected())

    def is_ready():
        described = nodes.diagnostics.value(STATE, "state") != ""
        return described and "nobody publishes" not in nodes.diagnostics.message(STATE)
    assert wait_until(is_ready)


def play_slowly(nodes, messages, start=START):
    """Plays with at most two clouds on their way, so that hardly any is dropped; returns when the
    last has been taken in."""
    def taken():
        return len(nodes.places) if len(nodes.places) > 0 else len(nodes.odometry)
    before = len(nodes.odometry)
    nodes.player.play(messages, taken, ahead=2)
    sent = sum(topic == POINTS for topic, _ in messages)
    assert wait_until(lambda: len(nodes.odometry) - before > sent - start), len(nodes.odometry)
    count = ()
    while count != (len(nodes.odometry), len(nodes.places)):
        count = (len(nodes.odometry), len(nodes.places))
        rospy.rostime.wallsleep(1.5)
