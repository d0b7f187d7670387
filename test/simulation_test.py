#!/usr/bin/python3
"""The simulated robot: topics, frames, rates, and that it does what cmd_vel says."""
import math
import os
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image, Imu, PointCloud2
from std_msgs.msg import String
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import Collector, Diagnostics, wait_until  # noqa: E402

SPEED = 0.6
TIMEOUT_S = 0.5  # of commands, by default


def position(odometry):
    p = odometry.pose.pose.position
    return (p.x, p.y, p.z)


def periods(messages):
    stamps = [message.header.stamp.to_nsec() for message in messages]
    return [1e-9 * (later - earlier) for earlier, later in zip(stamps, stamps[1:])]


class Simulation(unittest.TestCase):
    """One drive serves every test: rest, straight on, silence, into a wall, back to the start."""

    @classmethod
    def setUpClass(cls):
        cls.points = Collector("/points", PointCloud2)
        cls.imu = Collector("/imu", Imu)
        cls.images = Collector("/depth/image_rect_raw", Image)
        cls.infos = Collector("/depth/camera_info", CameraInfo)
        cls.truth = Collector("/truth/odometry", Odometry)
        cls.collisions = Collector("/collision", String)
        cls.clock = Collector("/clock", Clock)
        cls.static = Collector("/tf_static", TFMessage)
        cls.world = Collector("/world_marker", Marker)
        cls.diagnostics = Diagnostics()
        cls.publisher = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        assert wait_until(lambda: cls.publisher.get_num_connections() > 0)
        assert wait_until(lambda: len(cls.points) > 10 and len(cls.truth) > 50)
        cls.rest = cls.truth.messages[-1]
        cls.drive(SPEED, seconds=1.5)
        cls.driving = cls.truth.messages[-1]
        cls.collisions_while_free = len(cls.collisions)
        cls.wait(3.0)
        cls.silent = cls.truth.messages[-1]
        for _ in range(30):
            cls.drive(1.0, seconds=1.0)
            if len(cls.collisions) > 0:
                break
        cls.drive(1.0, seconds=0.5)
        cls.blocked = cls.truth.messages[-1]
        cls.collisions_of_the_wall = [message.data for message in cls.collisions.messages]
        cls.clock_before_reset = cls.clock.messages[-1].clock
        cls.answer = rospy.ServiceProxy("/hv_sim/reset", Trigger)()
        cls.wait(1.0)
        cls.reset = cls.truth.messages[-1]
        cls.publish(math.nan)
        assert wait_until(lambda: cls.diagnostics.count("commands refused", "simulation") > 0)

    @classmethod
    def publish(cls, speed):
        command = Twist()
        command.linear.x = speed
        cls.publisher.publish(command)

    @classmethod
    def seconds(cls):
        return cls.truth.messages[-1].header.stamp.to_sec()

    @classmethod
    def wait(cls, seconds):
        end = cls.seconds() + seconds
        assert wait_until(lambda: cls.seconds() > end)

    @classmethod
    def drive(cls, speed, seconds):
        end = cls.seconds() + seconds
        while cls.seconds() < end:
            cls.publish(speed)
            rospy.rostime.wallsleep(0.02)

    def test_rates_are_exact(self):
        for messages, period in ((self.points.messages, 0.1), (self.imu.messages, 0.005),
                                 (self.images.messages, 1.0 / 15.0),
                                 (self.truth.messages, 0.02)):
            self.assertGreater(len(messages), 20)
            for step in periods(messages[-200:]):
                self.assertAlmostEqual(step, period, delta=1e-4)

    def test_frames(self):
        for collector, frame in ((self.points, "lidar_link"), (self.imu, "imu_link"),
                                 (self.images, "camera_depth_optical_frame"),
                                 (self.infos, "camera_depth_optical_frame"),
                                 (self.truth, "world"), (self.world, "world")):
            self.assertEqual({message.header.frame_id for message in collector.messages}, {frame})
        self.assertEqual(self.truth.messages[0].child_frame_id, "base_link")

    def test_transforms_of_the_sensors_are_latched(self):
        children = {transform.child_frame_id: transform.header.frame_id
                    for message in self.static.messages for transform in message.transforms}
        self.assertEqual(children, {"imu_link": "base_link", "lidar_link": "base_link",
                                    "camera_link": "base_link",
                                    "camera_depth_optical_frame": "camera_link"})

    def test_clouds_are_those_of_the_driver(self):
        cloud = self.points.messages[-1]
        self.assertEqual([(field.name, field.offset) for field in cloud.fields],
                         [("x", 0), ("y", 4), ("z", 8), ("intensity", 16), ("timestamp", 24),
                          ("ring", 32)])
        self.assertGreater(cloud.width, 1000)

    def test_images_are_in_millimetres(self):
        image = self.images.messages[-1]
        self.assertEqual(image.encoding, "16UC1")
        self.assertEqual(len(image.data), 2 * image.width * image.height)
        self.assertEqual((self.infos.messages[-1].width, self.infos.messages[-1].height),
                         (image.width, image.height))
        depths = [image.data[i] + 256 * image.data[i + 1] for i in range(0, len(image.data), 2)]
        seen = [depth for depth in depths if depth > 0]
        self.assertGreater(len(seen), len(depths) // 3)
        self.assertGreaterEqual(min(seen), 280)
        self.assertLessEqual(max(seen), 10000)

    def test_clock_is_not_behind_and_never_steps_back(self):
        clock = [message.clock.to_nsec() for message in self.clock.messages]
        self.assertEqual(clock, sorted(clock))
        self.assertGreater(clock[-1], self.imu.messages[-1].header.stamp.to_nsec() - 1e7)

    def test_at_rest_until_told(self):
        first = self.truth.messages[0]
        self.assertLess(math.dist(position(first), position(self.rest)), 1e-6)
        self.assertAlmostEqual(self.imu.messages[0].linear_acceleration.z, 9.81, delta=0.2)

    def test_drives_as_told(self):
        self.assertAlmostEqual(self.driving.twist.twist.linear.x, SPEED, delta=0.08)
        self.assertGreater(math.dist(position(self.rest), position(self.driving)), 0.3)
        self.assertEqual(self.collisions_while_free, 0)

    def test_stops_on_silence(self):
        self.assertAlmostEqual(self.silent.twist.twist.linear.x, 0.0, delta=1e-6)
        way = math.dist(position(self.driving), position(self.silent))
        self.assertLess(way, SPEED * (TIMEOUT_S + 0.7) + 0.1)

    def test_a_wall_stops_it_and_is_reported_once(self):
        self.assertEqual(self.collisions_of_the_wall, ["obstacle"])
        self.assertAlmostEqual(self.blocked.twist.twist.linear.x, 0.0, delta=0.05)
        self.assertEqual(self.diagnostics.count("collisions", "simulation"), 1)

    def test_reset_goes_back_to_the_start(self):
        self.assertTrue(self.answer.success)
        self.assertGreater(math.dist(position(self.blocked), position(self.rest)), 0.5)
        self.assertLess(math.dist(position(self.reset), position(self.rest)), 0.01)
        self.assertGreater(self.clock.messages[-1].clock, self.clock_before_reset)

    def test_the_world_is_shown(self):
        self.assertGreater(len(self.world.messages[0].points), 1000)

    def test_diagnostics_count_what_is_refused(self):
        self.assertEqual(self.diagnostics.count("commands refused", "simulation"), 1)
        self.assertGreater(self.diagnostics.count("commands", "simulation"), 50)
        self.assertEqual(self.diagnostics.count("resets", "simulation"), 1)


if __name__ == "__main__":
    rospy.init_node("simulation_test")
    rostest.rosrun("hv_bringup", "simulation", Simulation)
