#!/usr/bin/python3
"""Topics, frames, rates and covariances of the odometry node, and its agreement with hv_slam."""
import os
import struct
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from hv_msgs.msg import Keyframe
from nav_msgs.msg import Odometry, Path
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import (  # noqa: E402
    CONFIG, HV_SLAM, POINTS, RECORDING, Collector, Diagnostics, Player, odometry_collector,
    wait_until)

START = 15  # clouds in which the odometry starts; the robot stands in the first


def is_symmetric_positive(covariance):
    diagonal = all(covariance[7 * i] > 0.0 for i in range(6))
    return diagonal and all(covariance[6 * i + j] == covariance[6 * j + i]
                            for i in range(6) for j in range(6))


def xyz_of(cloud):
    return [struct.unpack_from("<fff", cloud.data, start)
            for start in range(0, len(cloud.data), cloud.point_step)]


class OdometryTopics(unittest.TestCase):
    """One replay of the whole recording serves every test."""

    @classmethod
    def setUpClass(cls):
        cls.odometry = odometry_collector()
        cls.odometry_imu = Collector("/odometry_imu", Odometry)
        cls.clouds = Collector("/cloud_registered", PointCloud2)
        cls.paths = Collector("/path", Path)
        cls.voxels = Collector("/voxels", MarkerArray)
        cls.keyframes = Collector("/keyframe", Keyframe)
        cls.transforms = Collector("/tf", TFMessage)
        cls.diagnostics = Diagnostics()
        cls.player = Player(RECORDING)
        collectors = (cls.odometry, cls.odometry_imu, cls.clouds, cls.paths, cls.voxels,
                      cls.keyframes, cls.transforms)
        assert wait_until(lambda: all(collector.connected() for collector in collectors))
        assert cls.player.wait_for_node()
        cls.play()
        cls.sent = sum(topic == "/points" for topic, _ in cls.player.messages)
        assert wait_until(lambda: len(cls.odometry) > 0.75 * cls.sent)
        assert wait_until(lambda: cls.diagnostics.count("scans tracked") > 0.75 * cls.sent)

    @classmethod
    def play(cls):
        """Close behind the player: a prediction at IMU rate reaches as far as it is ahead."""
        start = cls.player.clouds(end=START)
        cls.player.play(start)
        last = max(message.header.stamp for topic, message in start if topic == POINTS)
        assert wait_until(lambda: len(cls.odometry) > 0
                          and cls.odometry.messages[-1].header.stamp >= last)
        cls.player.play(cls.player.clouds(start=START), lambda: len(cls.odometry), ahead=2,
                        patience_s=10.0)

    def test_odometry_comes_for_every_scan_after_the_start(self):
        stamps = [message.header.stamp.to_nsec() for message in self.odometry.messages]
        self.assertEqual(stamps, sorted(set(stamps)))
        steps = [later - earlier for earlier, later in zip(stamps, stamps[1:])]
        self.assertLess(max(steps), 1.5e8)

    def test_odometry_has_frames_and_covariances(self):
        for message in self.odometry.messages + self.odometry_imu.messages:
            self.assertEqual(message.header.frame_id, "odom")
            self.assertEqual(message.child_frame_id, "base_link")
            self.assertTrue(is_symmetric_positive(message.pose.covariance))
            self.assertTrue(is_symmetric_positive(message.twist.covariance))

    def test_twist_is_in_the_child_frame(self):
        """A robot drives along its own x axis, wherever it heads."""
        fast = [message.twist.twist.linear for message in self.odometry.messages
                if message.twist.twist.linear.x > 0.3]
        self.assertGreater(len(fast), 10)
        for linear in fast:
            self.assertLess(abs(linear.y), 0.5 * linear.x)

    def test_odometry_at_imu_rate_agrees_with_the_scans(self):
        self.assertGreater(len(self.odometry_imu), 10 * len(self.odometry))
        by_stamp = {message.header.stamp.to_nsec(): message
                    for message in self.odometry_imu.messages}
        stamps = sorted(by_stamp)
        steps = [later - earlier for earlier, later in zip(stamps, stamps[1:])]
        self.assertEqual(sorted(steps)[len(steps) // 2] // 1000000, 5)
        compared = 0
        for message in self.odometry.messages[1:-1]:
            stamp = message.header.stamp.to_nsec()
            nearest = min(stamps, key=lambda other: abs(other - stamp))
            if abs(nearest - stamp) > 5e6:
                continue  # lost on the way to this subscriber
            compared += 1
            position = message.pose.pose.position
            predicted = by_stamp[nearest].pose.pose.position
            self.assertAlmostEqual(position.x, predicted.x, delta=0.05)
            self.assertAlmostEqual(position.y, predicted.y, delta=0.05)
        self.assertGreater(compared, 0.8 * len(self.odometry))

    def test_clouds_are_registered_in_odom(self):
        self.assertGreater(len(self.clouds), 0.75 * len(self.odometry))
        cloud = self.clouds.messages[-1]
        self.assertEqual(cloud.header.frame_id, "odom")
        self.assertEqual([field.name for field in cloud.fields], ["x", "y", "z", "intensity"])
        self.assertEqual(len(cloud.data), cloud.row_step * cloud.height)
        heights = sorted(z for _, _, z in xyz_of(cloud))
        self.assertLess(heights[len(heights) // 50], heights[len(heights) // 2])

    def test_path_follows_the_odometry(self):
        path = self.paths.messages[-1]
        self.assertEqual(path.header.frame_id, "odom")
        self.assertGreater(len(path.poses), 5)
        self.assertLess(len(path.poses), len(self.odometry))

    def test_voxels_show_every_kind(self):
        shown = {marker.ns for array in self.voxels.messages for marker in array.markers
                 if marker.points}
        self.assertTrue(shown.issuperset({"merged_planes", "gaussians"}), shown)
        for marker in self.voxels.messages[-1].markers:
            self.assertEqual(marker.header.frame_id, "odom")
            self.assertEqual(len(marker.points), len(marker.colors))

    def test_keyframes_are_numbered_and_complete(self):
        self.assertGreaterEqual(len(self.keyframes), 3)
        for number, keyframe in enumerate(self.keyframes.messages):
            self.assertEqual(keyframe.id, number)
            self.assertEqual(keyframe.segment, 0)
            self.assertEqual(keyframe.header.frame_id, "odom")
            self.assertEqual(keyframe.cloud.header.frame_id, keyframe.child_frame_id)
            self.assertEqual(keyframe.cloud.header.stamp, keyframe.header.stamp)
            self.assertLess(keyframe.scan_start, keyframe.header.stamp)
            self.assertTrue(is_symmetric_positive(keyframe.pose.covariance))
            self.assertAlmostEqual(keyframe.gravity.z, -9.81, delta=0.1)
            self.assertGreater(keyframe.cloud.width, 1000)

    def test_transform_is_the_odometry(self):
        transforms = [transform for message in self.transforms.messages
                      for transform in message.transforms]
        poses = {message.header.stamp: message.pose.pose for message in self.odometry.messages}
        self.assertGreater(len(transforms), 0.75 * len(poses))
        for transform in transforms:
            self.assertEqual(transform.header.frame_id, "odom")
            self.assertEqual(transform.child_frame_id, "base_link")
            position = poses[transform.header.stamp].position
            self.assertEqual(transform.transform.translation.x, position.x)

    def test_base_link_is_taken_from_tf(self):
        """The recording's /tf_static puts the IMU 0.21 m above base_link."""
        first = self.odometry.messages[0].pose.pose.position
        self.assertAlmostEqual(first.z, -0.21, delta=0.02)

    def test_diagnostics_are_complete(self):
        self.assertEqual(self.diagnostics.message(), "tracking")
        for name, key in (("odometry", "residuals"), ("odometry", "gravity norm [m/s^2]"),
                          ("odometry", "degenerate translation (odom axes)"),
                          ("input", "imu rate [Hz]"), ("input", "point time"),
                          ("resources", "memory [MB]"), ("resources", "scan time max [ms]")):
            self.assertTrue(self.diagnostics.value(name, key), key)
        self.assertGreater(
            float(self.diagnostics.value("resources", "scan to pose median [ms]")), 0.0)
        self.assertEqual(self.diagnostics.count("scans dropped"), 0)
        self.assertAlmostEqual(float(self.diagnostics.value("input", "points rate [Hz]")), 10.0,
                               delta=0.5)

    def test_trajectory_is_that_of_hv_slam(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([HV_SLAM, "--config", CONFIG, "--bag", RECORDING, "--out", folder],
                           check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "odometry.tum")) as file:
                rows = [line.split() for line in file if not line.startswith("#")]
        offline = {int(row[0].replace(".", "")): [float(value) for value in row[1:4]]
                   for row in rows}
        online = {keyframe.header.stamp.to_nsec(): keyframe.pose.pose.position
                  for keyframe in self.keyframes.messages}
        self.assertGreaterEqual(len(online), 3)
        for stamp, position in online.items():
            for value, reference in zip((position.x, position.y, position.z), offline[stamp]):
                self.assertAlmostEqual(value, reference, delta=1e-6)
        missing = {message.header.stamp.to_nsec() for message in self.odometry.messages}
        self.assertEqual(missing - set(offline), set())


if __name__ == "__main__":
    rospy.init_node("odometry_topics_test")
    rostest.rosrun("hv_bringup", "odometry_topics", OdometryTopics)
