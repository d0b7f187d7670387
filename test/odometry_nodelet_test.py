#!/usr/bin/python3
"""The nodelet publishes odometry like the node."""
import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import RECORDING, Player, odometry_collector, wait_until  # noqa: E402


class OdometryNodelet(unittest.TestCase):

    def test_odometry_is_published(self):
        odometry = odometry_collector()
        player = Player(RECORDING)
        self.assertTrue(player.wait_for_node() and wait_until(odometry.connected))
        player.play(player.clouds(0, 40), lambda: len(odometry))
        self.assertTrue(wait_until(lambda: len(odometry) >= 20), len(odometry))


if __name__ == "__main__":
    rospy.init_node("odometry_nodelet_test")
    rostest.rosrun("hv_bringup", "odometry_nodelet", OdometryNodelet)
