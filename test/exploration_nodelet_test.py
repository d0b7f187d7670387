#!/usr/bin/python3
"""Exploration as a nodelet that starts by itself."""
import os
import sys
import unittest

import rospy
import rostest
from hv_msgs.msg import ExploreActionResult

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import Collector, wait_until  # noqa: E402
from toy_robot import ToyRobot  # noqa: E402


class ExplorationNodelet(unittest.TestCase):

    def test_explores_without_being_asked(self):
        results = Collector("/hv_explore_sac/explore/result", ExploreActionResult)
        robot = ToyRobot()
        self.assertTrue(wait_until(lambda: results.messages))
        self.assertTrue(results.messages[0].result.success, results.messages[0].result.reason)
        self.assertGreater(robot.share_known(), 0.97)


if __name__ == "__main__":
    rospy.init_node("exploration_nodelet_test")
    rostest.rosrun("hv_bringup", "exploration_nodelet", ExplorationNodelet)
