#!/usr/bin/python3
"""Topics, frames and transforms of localization.launch, and that its poses are those of
hv_localize."""
import os
import subprocess
import sys
import tempfile
import unittest

import numpy
import rospy
import rostest
from nav_msgs.msg import OccupancyGrid, Path
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from localization import (  # noqa: E402
    CLOUDS_BEFORE, HV_LOCALIZE, KIDNAPPED, MAP, STATE, Launch, Places, Truth, base_in_imu,
    distance, matrix_of, nearest, play_slowly, read_tum, wait_for_nodes)
from recording import (  # noqa: E402
    CONFIG, Collector, Diagnostics, Player, odometry_collector, wait_until)

TOLERANCE_NS = 100000000


class LocalizationTopics(unittest.TestCase):
    """One replay serves every test."""

    @classmethod
    def setUpClass(cls):
        cls.launch = Launch("map:=" + MAP)
        cls.odometry = odometry_collector()
        cls.transforms = Collector("/tf", TFMessage)
        cls.places = Places()
        cls.path = Collector("/localization_path", Path)
        cls.scan = Collector("/localization_scan", PointCloud2)
        cls.diagnostics = Diagnostics()
        cls.player = Player(KIDNAPPED)
        wait_for_nodes(cls)
        assert wait_until(lambda: cls.path.connected() and cls.scan.connected())
        # The first scans wait for the search over the map.
        play_slowly(cls, cls.player.clouds(0, 20))
        assert wait_until(lambda: len(cls.places) > 0)
        play_slowly(cls, cls.player.clouds(20, CLOUDS_BEFORE))

    @classmethod
    def tearDownClass(cls):
        cls.launch.stop()

    def corrections(self):
        """Stamp of the odometry in ns -> the transform map -> odom."""
        return {transform.header.stamp.to_nsec() - TOLERANCE_NS: transform
                for message in list(self.transforms.messages)
                for transform in message.transforms if transform.child_frame_id == "odom"}

    def test_poses_are_those_of_hv_localize(self):
        T_imu_base = base_in_imu(self.player)
        with tempfile.TemporaryDirectory() as out:
            subprocess.run([HV_LOCALIZE, "--config", CONFIG, "--map", MAP, "--bag", KIDNAPPED,
                            "--out", out], check=True, stdout=subprocess.DEVNULL)
            offline = read_tum(os.path.join(out, "trajectory.tum"))
        online = self.places.poses()
        both = sorted(set(online) & set(offline))
        self.assertGreater(len(both), 0.9 * CLOUDS_BEFORE - 10)
        worst = max(distance(online[stamp], offline[stamp] @ T_imu_base) for stamp in both)
        print("largest difference from hv_localize: %.2f mm" % (1e3 * worst))
        self.assertLess(worst, 0.01)

    def test_poses_are_where_the_robot_is(self):
        truth = Truth()
        T_base_imu = numpy.linalg.inv(base_in_imu(self.player))
        worst = max(distance(pose @ T_base_imu, truth.at(stamp))
                    for stamp, pose in self.places.poses().items())
        print("largest error: %.1f mm" % (1e3 * worst))
        self.assertLess(worst, 0.15)

    def test_covariance_is_filled(self):
        for message in self.places.messages:
            self.assertEqual(message.header.frame_id, "map")
            covariance = numpy.array(message.pose.covariance).reshape(6, 6)
            self.assertEqual(numpy.abs(covariance - covariance.T).max(), 0.0)
            self.assertGreater(numpy.linalg.eigvalsh(covariance).min(), 0.0)
            sigma = numpy.sqrt(covariance[:3, :3].trace())
            self.assertTrue(0.005 < sigma < 0.1, sigma)

    def test_transforms_come_with_the_odometry_and_agree_with_the_poses(self):
        corrections = self.corrections()
        odometry = {message.header.stamp.to_nsec(): matrix_of(message.pose.pose)
                    for message in self.odometry.messages}
        self.assertTrue(set(corrections).issubset(odometry))
        self.assertGreater(len(corrections), 0.8 * len(odometry))
        places = self.places.poses()
        for stamp in set(corrections) & set(places):
            self.assertEqual(corrections[stamp].header.frame_id, "map")
            moved = matrix_of(corrections[stamp].transform) @ odometry[stamp]
            self.assertLess(distance(moved, places[stamp]), 0.05)

    def test_the_map_is_latched(self):
        cloud = Collector("/map_cloud", PointCloud2)
        grid = Collector("/map", OccupancyGrid)
        self.assertTrue(wait_until(lambda: len(cloud) > 0 and len(grid) > 0))
        cloud, grid = cloud.messages[0], grid.messages[0]
        self.assertEqual((cloud.header.frame_id, grid.header.frame_id), ("map", "map"))
        self.assertGreater(cloud.width, 5000)
        self.assertEqual(len(grid.data), grid.info.width * grid.info.height)
        self.assertGreater(sum(cell == 100 for cell in grid.data), 50)

    def test_scan_and_path_are_in_the_map(self):
        self.assertTrue(wait_until(lambda: len(self.scan) > 0 and len(self.path) > 0))
        self.assertEqual(self.scan.messages[-1].header.frame_id, "map")
        self.assertGreater(self.scan.messages[-1].width, 500)
        path = self.path.messages[-1]
        self.assertEqual(path.header.frame_id, "map")
        self.assertGreater(len(path.poses), 20)
        places = self.places.poses()
        for pose in path.poses:
            place = nearest(places, pose.header.stamp.to_nsec())
            self.assertLess(distance(matrix_of(pose.pose), place), 1e-6)

    def test_diagnostics_are_complete(self):
        self.assertTrue(wait_until(
            lambda: self.diagnostics.value(STATE, "state") == "tracking"))
        for key in ("fit", "overlap", "sigma of the position [m]", "sigma of the rotation [deg]",
                    "last comparison [ms]", "last search [ms]"):
            self.assertGreater(float(self.diagnostics.value(STATE, key)), 0.0, key)
        self.assertEqual(self.diagnostics.count("losses", STATE), 0)
        self.assertEqual(self.diagnostics.count("searches", STATE), 1)
        self.assertEqual(self.diagnostics.count("scans unusable", STATE), 0)
        self.assertEqual(self.diagnostics.value("map", "map"), MAP)


if __name__ == "__main__":
    rospy.init_node("localization_topics_test")
    rostest.rosrun("hv_bringup", "localization_topics", LocalizationTopics)
