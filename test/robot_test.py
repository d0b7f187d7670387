#!/usr/bin/python3
"""robot.launch: the URDF says where the sensors sit, and odometry takes it from there."""
import os
import sys
import unittest

import rospy
import rostest
import yaml
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import CONFIG, Collector, Diagnostics, wait_until  # noqa: E402

# Of the simulated sensors, seen from base_link: x y z [m], quaternion x y z w.
SENSORS = {
    "imu_link": (-0.06, 0.02, 0.21, 0.0, 0.0, 0.0, 1.0),
    "lidar_link": (0.12, 0.0, 0.60, 0.0, 0.0, -0.7071068, 0.7071068),
    "camera_link": (0.25, 0.0, 0.45, 0.0, 0.1521234, 0.0, 0.9883615),
}
OPTICAL = (0.0, 0.0, 0.0, -0.5, 0.5, -0.5, 0.5)  # seen from camera_link


def numbers(transform):
    t, q = transform.translation, transform.rotation
    return (t.x, t.y, t.z, q.x, q.y, q.z, q.w)


class RobotLaunch(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.static = Collector("/tf_static", TFMessage)
        cls.odometry = Collector("/odometry", Odometry)
        cls.diagnostics = Diagnostics()
        assert wait_until(lambda: len(cls.odometry) > 5)
        cls.transforms = {transform.child_frame_id: transform
                          for message in cls.static.messages for transform in message.transforms}

    def expect_pose(self, frame, parent, pose):
        transform = self.transforms[frame]
        self.assertEqual(transform.header.frame_id, parent)
        for value, expected in zip(numbers(transform.transform), pose):
            self.assertAlmostEqual(value, expected, delta=1e-6)

    def test_the_urdf_places_the_sensors(self):
        for frame, pose in SENSORS.items():
            self.expect_pose(frame, "base_link", pose)
        self.expect_pose("camera_depth_optical_frame", "camera_link", OPTICAL)

    def test_configuration_and_urdf_agree(self):
        with open(CONFIG) as file:
            extrinsic = yaml.safe_load(file)["odometry"]["extrinsic"]
        imu, lidar = SENSORS["imu_link"], SENSORS["lidar_link"]
        for value, a, b in zip(extrinsic["translation_m"], lidar, imu):
            self.assertAlmostEqual(value, a - b, delta=1e-6)
        for value, expected in zip(extrinsic["rotation_xyzw"], lidar[3:]):
            self.assertAlmostEqual(value, expected, delta=1e-6)

    def test_odometry_reads_tf(self):
        self.assertIs(rospy.get_param("/hv_lio/output/extrinsic_from_tf"), True)
        self.assertTrue(wait_until(lambda: self.diagnostics.status("odometry") is not None and
                                   self.diagnostics.status("odometry").level == 0))
        self.assertEqual(self.odometry.messages[-1].child_frame_id, "base_link")


if __name__ == "__main__":
    rospy.init_node("robot_test")
    rostest.rosrun("hv_bringup", "robot", RobotLaunch)
