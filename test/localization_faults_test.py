#!/usr/bin/python3
"""The localisation node on bad input: refused at the start, or counted and said while it runs."""
import copy
import os
import shutil
import struct
import sys
import tempfile
import unittest

import rospy
import rostest
from hv_msgs.msg import TrackedScan
from nav_msgs.msg import Odometry

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from localization import (  # noqa: E402
    CLOUDS_BEFORE, HV_RELOCALIZE_NDT_NODE, MAP, Launch, Localization)
from mapping import start_node  # noqa: E402
from recording import Collector, wait_until  # noqa: E402


class LocalizationFaults(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def path(self, *names):
        return os.path.join(self.folder.name, *names)

    def refusal_of(self, *arguments):
        """The line that the node ends with."""
        process = start_node(HV_RELOCALIZE_NDT_NODE, "started", *arguments)
        output, _ = process.communicate(timeout=60)
        if rospy.has_param("/started"):
            rospy.delete_param("/started")
        self.assertEqual(process.returncode, 1, output)
        lines = output.strip().splitlines()
        self.assertEqual(lines[0], "hv_relocalize_ndt cannot start:")
        self.assertEqual(len(lines), 2, output)
        return lines[1]

    def test_1_wrong_parameters_are_refused(self):
        self.assertIn("no map is given", self.refusal_of())
        self.assertIn("not an absolute path", self.refusal_of("_map:=maps/office"))
        self.assertIn("six numbers", self.refusal_of("_map:=" + MAP, "_initial_pose:=1 2 3"))
        self.assertIn("'map'", self.refusal_of("_map:=" + MAP, "_maps:=/maps/office"))
        self.assertIn("correction_s", self.refusal_of(
            "_map:=" + MAP, "_localization/output/correction_s:=-1"))
        self.assertIn("nowhere.yaml", self.refusal_of(
            "_map:=" + MAP, "_config_file:=/nowhere.yaml"))

    def test_2_a_missing_or_damaged_map_is_refused(self):
        self.assertIn("/nowhere", self.refusal_of("_map:=/nowhere"))
        self.assertIn(self.folder.name, self.refusal_of("_map:=" + self.folder.name))
        shutil.copytree(MAP, self.path("map"))
        for name in ("cloud.pcd", "descriptors.bin", "graph.g2o", "grid.pgm", "manifest.yaml"):
            with open(self.path("map", name), "r+b") as file:
                file.seek(200)
                byte = file.read(1)[0]
                file.seek(200)
                file.write(bytes([byte ^ 0x55]))
            self.assertIn(name, self.refusal_of("_map:=" + self.path("map")))
            shutil.copy(os.path.join(MAP, name), self.path("map", name))
        os.remove(self.path("map", "cloud.pcd"))
        self.assertIn("cloud.pcd", self.refusal_of("_map:=" + self.path("map")))

    def test_3_the_launch_file_ends_without_a_map(self):
        launch = Launch("map:=/nowhere")
        launch.exit_code()

    def test_4_nonsense_in_between_is_survived(self):
        nodes = Localization()
        scans = Collector("/tracked_scan", TrackedScan)
        scan_publisher = rospy.Publisher("/tracked_scan", TrackedScan, queue_size=50)
        odometry_publisher = rospy.Publisher("/odometry", Odometry, queue_size=50)
        self.assertTrue(wait_until(lambda: scans.connected()
                                   and scan_publisher.get_num_connections() >= 2
                                   and odometry_publisher.get_num_connections() >= 2))
        nodes.play(0, 40)
        self.assertTrue(wait_until(lambda: nodes.value("state") == "tracking"))
        good = scans.messages[-1]

        unusable = [TrackedScan()]
        for spoil in (self.spoil_pose, self.spoil_fields, self.spoil_size):
            unusable.append(copy.deepcopy(good))
            spoil(unusable[-1])
        for message in unusable:
            scan_publisher.publish(message)
        self.assertTrue(wait_until(
            lambda: nodes.count("scans unusable") == len(unusable)),
            nodes.count("scans unusable"))
        self.assertTrue(nodes.value("last unusable scan"))

        for message in self.strange_scans(good):
            scan_publisher.publish(message)
            rospy.rostime.wallsleep(0.3)
        odometry = copy.deepcopy(nodes.odometry.messages[-1])
        odometry.pose.pose.position.x = float("nan")
        odometry_publisher.publish(odometry)
        odometry_publisher.publish(Odometry())
        nodes.play(40, CLOUDS_BEFORE)
        self.assertTrue(wait_until(lambda: nodes.value("state") == "tracking"))
        self.assertEqual(nodes.count("scans unusable"), len(unusable))
        self.assertTrue(nodes.is_running())
        nodes.stop()

    @staticmethod
    def spoil_pose(scan):
        scan.pose.position.y = float("inf")

    @staticmethod
    def spoil_fields(scan):
        scan.cloud.fields = []

    @staticmethod
    def spoil_size(scan):
        scan.cloud.data = scan.cloud.data[:100]

    @staticmethod
    def strange_scans(good):
        """Well-formed, but of no use: NaN points only, some, none, one, later and earlier clocks,
        another segment, far away."""
        def changed(seconds=0, **fields):
            scan = copy.deepcopy(good)
            scan.header.stamp += rospy.Duration(seconds)
            for name, value in fields.items():
                setattr(scan, name, value)
            return scan

        def with_points(seconds, data):
            scan = changed(seconds)
            scan.cloud.data = data
            scan.cloud.width = len(data) // scan.cloud.point_step
            scan.cloud.row_step = len(data)
            return scan
        nan = struct.pack("<4f", *[float("nan")] * 4)
        far = struct.pack("<4f", 1e30, -1e30, 3e38, 0.0)
        size = len(good.cloud.data) // len(nan)
        half = size // 2 * len(nan)
        away = copy.deepcopy(good.pose)
        away.position.x = 1e9
        return [with_points(0.1, nan * size),
                with_points(0.2, good.cloud.data[:half] + nan * (size - size // 2)),
                with_points(0.3, b""),
                with_points(0.4, good.cloud.data[:len(nan)]),
                with_points(0.5, far * 100),
                changed(100), changed(0.6), changed(-1000), changed(0.7, segment=9),
                changed(0.8, segment=9, pose=away), changed(0.9, segment=9)]


if __name__ == "__main__":
    rospy.init_node("localization_faults_test")
    rostest.rosrun("hv_bringup", "localization_faults", LocalizationFaults)
