#!/usr/bin/python3
"""A node whose IMU publishes under another name says so and names the other topic."""
import os
import sys
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import (  # noqa: E402
    POINTS, RECORDING, Collector, Diagnostics, Player, wait_until)


class MissingImu(unittest.TestCase):

    def test_warning_names_the_topic_and_the_alternative(self):
        log = Collector("/rosout", Log)
        diagnostics = Diagnostics()
        player = Player(RECORDING, imu="/other_imu")
        self.assertTrue(player.wait_for_node((POINTS,)))
        stop = rospy.get_rostime() + rospy.Duration(20.0)
        while "/imu" not in diagnostics.message() and rospy.get_rostime() < stop:
            player.play(player.clouds(0, 3))
            rospy.rostime.wallsleep(0.3)
        self.assertIn("no messages on /imu (sensor_msgs/Imu)", diagnostics.message())
        self.assertTrue(wait_until(lambda: any("/other_imu" in message.msg
                                               for message in log.messages)))


if __name__ == "__main__":
    rospy.init_node("missing_imu_test")
    rostest.rosrun("hv_bringup", "missing_imu", MissingImu)
