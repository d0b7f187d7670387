#!/usr/bin/python3
"""The loop closing node on bad input: refused at the start, or counted and said while it runs."""
import copy
import os
import shutil
import sys
import tempfile
import unittest

import rospy
import rostest
from hv_msgs.msg import Keyframe

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mapping import LOOPS, Mapping, interrupt, start_node  # noqa: E402
from recording import CONFIG, HV_LOOP_BTC_NODE, Diagnostics, wait_until  # noqa: E402


class MappingFaults(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def path(self, *names):
        return os.path.join(self.folder.name, *names)

    def refusal_of(self, *arguments):
        process = start_node(HV_LOOP_BTC_NODE, "started", *arguments)
        output, _ = process.communicate(timeout=30)
        if rospy.has_param("/started"):
            rospy.delete_param("/started")
        self.assertEqual(process.returncode, 1, output)
        self.assertIn("hv_loop_btc cannot start:", output)
        return output

    def test_1_wrong_parameters_are_refused_together(self):
        with open(self.path("config.yaml"), "w") as file:
            file.write("loop:\n  submaps: {}\nmapping:\n  correction_s: soon\n"
                       "odometry:\n  whatever: 1\n")
        output = self.refusal_of("_config_file:=" + self.path("config.yaml"))
        self.assertIn("'submap'", output)
        self.assertIn("correction_s", output)
        self.assertNotIn("whatever", output)
        self.assertIn("not an absolute path", self.refusal_of("_map_path:=maps/office"))
        self.assertIn("map_paths", self.refusal_of("_map_paths:=/maps/office"))

    def test_2_a_place_that_cannot_be_written_is_refused(self):
        self.assertIn("/proc/", self.refusal_of("_map_path:=/proc/office"))

    def test_3_a_missing_map_is_refused(self):
        self.assertIn("there is no such map", self.refusal_of("_continue_map:=/nowhere"))

    def test_4_bad_keyframes_are_counted(self):
        diagnostics = Diagnostics()
        publisher = rospy.Publisher("/keyframe", Keyframe, queue_size=10)
        process = start_node(HV_LOOP_BTC_NODE, "hv_loop_btc", "_config_file:=" + CONFIG)
        self.assertTrue(wait_until(lambda: publisher.get_num_connections() > 0))
        publisher.publish(Keyframe())
        self.assertTrue(wait_until(lambda: diagnostics.count("keyframes unusable", LOOPS) == 1))
        good = Keyframe()
        good.pose.pose.orientation.w = 1.0
        for index in range(6):
            good.pose.covariance[7 * index] = 1e-4
        good.gravity.z = -9.81
        good.header.stamp.secs = 5
        bad = copy.deepcopy(good)
        bad.pose.pose.position.x = float("nan")
        publisher.publish(bad)
        publisher.publish(good)  # its cloud has no fields
        self.assertTrue(wait_until(lambda: diagnostics.count("keyframes unusable", LOOPS) == 3))
        self.assertIn("no float32 fields", diagnostics.value(LOOPS, "last unusable keyframe"))
        self.assertEqual(diagnostics.count("keyframes", LOOPS), 0)
        self.assertIsNone(process.poll())
        output = interrupt(process, "hv_loop_btc")
        self.assertIn("is unusable", output)
        publisher.unregister()

    def test_5_a_damaged_map_is_refused_and_a_map_is_not_replaced(self):
        mapping = Mapping("_map_path:=" + self.path("map"))
        mapping.play(mapping.player.clouds(0, 120))
        mapping.stop()
        shutil.copytree(self.path("map"), self.path("damaged"))
        for name in ("graph.g2o", "descriptors.bin", os.path.join("keyframes", "000002.pcd")):
            with open(self.path("damaged", name), "r+b") as file:
                file.seek(300)
                byte = file.read(1)[0]
                file.seek(300)
                file.write(bytes([byte ^ 0x55]))
            output = self.refusal_of("_continue_map:=" + self.path("damaged"))
            self.assertIn(os.path.basename(name), output)
            self.assertEqual(len(output.strip().splitlines()), 2, output)
            shutil.copy(self.path("map", name), self.path("damaged", name))
        # A session without keyframes leaves the map that it continues as it is.
        before = os.stat(self.path("map", "manifest.yaml"))
        process = start_node(HV_LOOP_BTC_NODE, "started", "_map_path:=" + self.path("map"),
                             "_continue_map:=" + self.path("map"))
        diagnostics = Diagnostics()
        self.assertTrue(wait_until(
            lambda: diagnostics.count("keyframes of the continued map", LOOPS) > 0))
        interrupt(process, "started")
        after = os.stat(self.path("map", "manifest.yaml"))
        self.assertEqual(before.st_mtime_ns, after.st_mtime_ns)


if __name__ == "__main__":
    rospy.init_node("mapping_faults_test")
    rostest.rosrun("hv_bringup", "mapping_faults", MappingFaults)
