#!/usr/bin/python3
"""Loop closing as a nodelet beside that of the odometry."""
import os
import sys
import unittest

import rospy
import rostest
from nav_msgs.msg import Path

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mapping import LOOPS  # noqa: E402
from recording import (  # noqa: E402
    RECORDING, Collector, Diagnostics, Player, odometry_collector, wait_until)


class MappingNodelet(unittest.TestCase):

    def test_keyframes_are_taken_in(self):
        odometry = odometry_collector()
        path = Collector("/map_path", Path)
        diagnostics = Diagnostics()
        player = Player(RECORDING)
        self.assertTrue(player.wait_for_node() and wait_until(odometry.connected)
                        and wait_until(path.connected))
        player.play(player.messages, lambda: len(odometry))
        self.assertTrue(wait_until(lambda: diagnostics.count("keyframes", LOOPS) >= 2))
        self.assertTrue(wait_until(lambda: path.messages and len(path.messages[-1].poses) >= 2))


if __name__ == "__main__":
    rospy.init_node("mapping_nodelet_test")
    rostest.rosrun("hv_bringup", "mapping_nodelet", MappingNodelet)
