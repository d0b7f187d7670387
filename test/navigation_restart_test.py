#!/usr/bin/python3
"""The navigation node is killed while it drives: the robot stops, and a new node drives on."""
import os
import random
import sys
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Odometry
from std_msgs.msg import String

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mapping import kill, start_node  # noqa: E402
from recording import CONFIG, DEVEL, Collector, Diagnostics, wait_until  # noqa: E402

HV_NAVIGATION_NODE = os.path.join(DEVEL, "lib", "hv_navigation", "hv_navigation_node")
STOP_S = 2.0  # until silence is noticed, and braking from full speed


def start_navigation():
    heard = Diagnostics()
    process = start_node(HV_NAVIGATION_NODE, "hv_navigation", "_config_file:=" + CONFIG)
    assert wait_until(lambda: heard.value("navigation", "place in the map known") == "True")
    return process


class NavigationRestart(unittest.TestCase):

    def setUp(self):
        self.truth = Collector("/truth/odometry", Odometry)
        self.collisions = Collector("/collision", String)

    def state(self):
        message = self.truth.messages[-1]
        return message.header.stamp.to_sec(), message.twist.twist.linear.x

    def drive(self, x, y):
        """Sends a goal in the frame of the map, which begins where the robot started, and waits
        until the robot drives. Returns what tells the state of the goal: from the status that the
        node repeats, as a subscriber that outlives the node can miss the only result."""
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30)))
        goal = MoveBaseGoal()
        goal.target_pose.header.frame_id = "map"
        goal.target_pose.pose.position.x, goal.target_pose.pose.position.y = x, y
        goal.target_pose.pose.orientation.w = 1.0
        client.send_goal(goal)
        self.assertTrue(wait_until(lambda: self.state()[1] > 0.3))
        return client.get_state

    def test_the_robot_stops_and_drives_again(self):
        navigation = start_navigation()
        self.drive(8.0, 0.0)
        random.seed(1)
        begun, _ = self.state()
        pause_s = random.uniform(0.5, 2.0)
        self.assertTrue(wait_until(lambda: self.state()[0] > begun + pause_s))
        kill(navigation)
        killed, _ = self.state()
        self.assertTrue(wait_until(lambda: abs(self.state()[1]) < 1e-3))
        self.assertLess(self.state()[0] - killed, STOP_S)
        navigation = start_navigation()
        self.addCleanup(kill, navigation)
        goal_state = self.drive(8.0, 0.0)

        def has_ended():
            return goal_state() not in (GoalStatus.PENDING, GoalStatus.ACTIVE)
        self.assertTrue(wait_until(has_ended) or wait_until(has_ended))
        self.assertEqual(goal_state(), GoalStatus.SUCCEEDED)
        self.assertEqual(len(self.collisions), 0)


if __name__ == "__main__":
    rospy.init_node("navigation_restart_test")
    rostest.rosrun("hv_bringup", "navigation_restart", NavigationRestart)
