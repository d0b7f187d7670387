#!/usr/bin/python3
"""Topics, frames and transforms of mapping.launch."""
import copy
import os
import sys
import unittest

import rospy
import rostest
from hv_msgs.msg import Keyframe
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mapping import LOOPS, is_ready, settle  # noqa: E402
from recording import (  # noqa: E402
    LOOP_RECORDING, POINTS, Collector, Diagnostics, Player, odometry_collector, wait_until)

TOLERANCE_NS = 100000000


class MappingTopics(unittest.TestCase):
    """One replay of the whole recording serves every test."""

    @classmethod
    def setUpClass(cls):
        cls.odometry = odometry_collector()
        cls.keyframes = Collector("/keyframe", Keyframe)
        cls.transforms = Collector("/tf", TFMessage)
        cls.path = Collector("/map_path", Path)
        cls.markers = Collector("/loop_markers", MarkerArray)
        cls.cloud = Collector("/map_cloud", PointCloud2)
        cls.grid = Collector("/map", OccupancyGrid)
        cls.diagnostics = Diagnostics()
        cls.player = Player(LOOP_RECORDING)
        latched = (cls.path, cls.markers, cls.cloud, cls.grid)
        assert cls.player.wait_for_node()
        assert wait_until(lambda: all(topic.connected() for topic in latched)
                          and cls.odometry.connected() and cls.keyframes.connected())
        assert wait_until(lambda: is_ready(cls.diagnostics))
        cls.player.play(cls.player.messages, lambda: len(cls.odometry))
        sent = sum(topic == POINTS for topic, _ in cls.player.messages)
        assert wait_until(lambda: len(cls.odometry) > 0.75 * sent)
        settle(cls.odometry, cls.keyframes, cls.diagnostics)
        assert wait_until(lambda: len(cls.path) and len(cls.grid)
                          and len(cls.path.messages[-1].poses) == len(cls.keyframes))
        cls.settle_the_correction()

    @classmethod
    def settle_the_correction(cls):
        """Odometry that goes on at rest, until the last correction is reached."""
        publisher = rospy.Publisher("/odometry", Odometry, queue_size=10)
        assert wait_until(lambda: publisher.get_num_connections() >= 2)
        last = copy.deepcopy(cls.odometry.messages[-1])
        for _ in range(2):
            last.header.stamp += rospy.Duration(5)
            publisher.publish(last)
        end = last.header.stamp.to_nsec() + TOLERANCE_NS
        assert wait_until(lambda: any(transform.header.stamp.to_nsec() == end
                                      for transform in cls.corrections()))

    @classmethod
    def corrections(cls):
        """The transforms map -> odom."""
        return [transform for message in list(cls.transforms.messages)
                for transform in message.transforms if transform.child_frame_id == "odom"]

    def test_transforms_come_with_the_odometry(self):
        stamps = [transform.header.stamp.to_nsec() for transform in self.corrections()]
        self.assertEqual(stamps, sorted(set(stamps)))
        odometry = {message.header.stamp.to_nsec() + TOLERANCE_NS
                    for message in self.odometry.messages}
        self.assertTrue(set(stamps).issubset(odometry))
        self.assertGreater(len(stamps), 0.9 * len(odometry))
        for transform in self.corrections():
            self.assertEqual(transform.header.frame_id, "map")

    def test_transforms_do_not_jump(self):
        """A correction is spread over a second: it cannot move the robot by much in one scan."""
        translations = [transform.transform.translation for transform in self.corrections()]
        first = translations[0]
        self.assertEqual((first.x, first.y, first.z), (0.0, 0.0, 0.0))
        for before, after in zip(translations[:-2], translations[1:-1]):
            self.assertLess(abs(after.x - before.x) + abs(after.y - before.y), 0.05)

    def test_the_last_transform_is_that_of_the_graph(self):
        last = self.corrections()[-1].transform.translation
        shown = self.diagnostics.value(LOOPS, "position of odom in map [m]").split()
        for value, text in zip((last.x, last.y, last.z), shown):
            self.assertAlmostEqual(value, float(text), delta=6e-4)

    def test_path_holds_every_keyframe(self):
        path = self.path.messages[-1]
        self.assertEqual(path.header.frame_id, "map")
        self.assertEqual([pose.header.stamp for pose in path.poses],
                         [keyframe.header.stamp for keyframe in self.keyframes.messages])

    def test_markers_show_the_graph(self):
        def shown():
            return {marker.ns: marker for marker in self.markers.messages[-1].markers}
        self.assertTrue(wait_until(lambda: len(self.markers) and "loops_accepted" in shown()))
        self.assertEqual(self.markers.messages[-1].markers[0].action, Marker.DELETEALL)
        self.assertTrue({"keyframes", "odometry", "scores"}.issubset(shown()))
        color = shown()["loops_accepted"].color
        self.assertGreater(color.g, 2 * max(color.r, color.b))
        for marker in self.markers.messages[-1].markers:
            self.assertEqual(marker.header.frame_id, "map")

    def test_cloud_is_that_of_the_map(self):
        self.assertTrue(wait_until(lambda: len(self.cloud) > 0))
        cloud = self.cloud.messages[-1]
        self.assertEqual(cloud.header.frame_id, "map")
        self.assertEqual([field.name for field in cloud.fields], ["x", "y", "z", "intensity"])
        self.assertGreater(cloud.width, 5000)
        self.assertEqual(len(cloud.data), cloud.row_step * cloud.height)

    def test_grid_has_floor_and_walls(self):
        grid = self.grid.messages[-1]
        self.assertEqual(grid.header.frame_id, "map")
        self.assertEqual(len(grid.data), grid.info.width * grid.info.height)
        self.assertAlmostEqual(grid.info.resolution, 0.1, delta=1e-6)
        self.assertGreater(sum(cell == 0 for cell in grid.data), 200)
        self.assertGreater(sum(cell == 100 for cell in grid.data), 50)

    def test_diagnostics_are_complete(self):
        self.assertIn("keyframes", self.diagnostics.message(LOOPS))
        self.assertGreaterEqual(self.diagnostics.count("loops accepted", LOOPS), 3)
        self.assertGreater(self.diagnostics.count("candidates", LOOPS), 3)
        self.assertEqual(self.diagnostics.count("keyframes missing", LOOPS), 0)
        self.assertEqual(self.diagnostics.count("keyframes unusable", LOOPS), 0)
        self.assertEqual(self.diagnostics.count("queue", LOOPS), 0)
        for key in ("last detection [ms]", "last optimisation [ms]"):
            self.assertGreater(float(self.diagnostics.value(LOOPS, key)), 0.0)
        for key in ("memory [MB]", "working files [MB]"):
            self.assertGreater(float(self.diagnostics.value("map", key)), 0.0)


if __name__ == "__main__":
    rospy.init_node("mapping_topics_test")
    rostest.rosrun("hv_bringup", "mapping_topics", MappingTopics)
