#!/usr/bin/python3
"""The whole robot: it explores an unknown building, saves the map, is switched off, wakes up at
another place, finds out where it is and drives to a goal. With the launch file that users start."""
import math
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import actionlib
import rospkg
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Odometry
from std_msgs.msg import String

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import DEVEL, Collector, Diagnostics, wait_until  # noqa: E402

HV_MAP = os.path.join(DEVEL, "lib", "hv_replay", "hv_map")
WORLD = os.path.join(rospkg.RosPack().get_path("hv_bringup"), "..", "test", "small_building.yaml")
FIRST_START = (1.2, 1.3, 0.0)  # x, y [m], yaw [deg] in the building
SECOND_START = (4.0, 7.4, 250.0)  # in a room
IMU = (-0.06, 0.02)  # where the map begins, seen from the base at the first start [m]
WAITS = 25  # of half a minute each; reached only by a failure


def wait_long(condition):
    return any(wait_until(condition) for _ in range(WAITS))


def place_of(pose):
    return (pose.position.x, pose.position.y)


def in_map(place):
    """Of a place in the building: the first start looks along its x axis."""
    return (place[0] - FIRST_START[0] - IMU[0], place[1] - FIRST_START[1] - IMU[1])


class Robot:
    """Everything of the robot, running."""

    def __init__(self, folder, name, start, *arguments):
        self.log = os.path.join(folder, name + ".log")
        self._file = open(self.log, "w")
        self._process = subprocess.Popen(
            ["roslaunch", "hv_bringup", "hv_liom.launch", "sim:=true", "world:=" + WORLD,
             "people:=false", "point_share:=0.1", "sim_rate:=0.5",
             "start:=%g, %g, 0, %g" % start] + list(arguments),
            stdout=self._file, stderr=subprocess.STDOUT)
        self.truth = Collector("/truth/odometry", Odometry)
        self.collisions = Collector("/collision", String)
        self.poses = Collector("/localization_pose", PoseWithCovarianceStamped)
        self.diagnostics = Diagnostics()

    def here(self):
        return place_of(self.truth.messages[-1].pose.pose)

    def switch_off(self):
        self._process.send_signal(signal.SIGINT)
        self._process.wait(60)
        self._file.close()

    def output(self):
        with open(self.log) as file:
            return file.read()


class Story(unittest.TestCase):
    """One story serves every test."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.map = os.path.join(cls.folder.name, "map")
        cls.explore()
        cls.wake_up_elsewhere()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def explore(cls):
        robot = Robot(cls.folder.name, "exploration", FIRST_START, "mode:=exploration",
                      "explore:=true", "save_map:=" + cls.map)
        cls.explorer = robot
        cls.explored = wait_long(
            lambda: robot.diagnostics.value("exploration", "last result") not in ("", "none"))
        cls.end_of_exploration = robot.diagnostics.value("exploration", "last result")
        robot.switch_off()

    @classmethod
    def wake_up_elsewhere(cls):
        robot = Robot(cls.folder.name, "navigation", SECOND_START, "mode:=navigation",
                      "map:=" + cls.map)
        cls.driver = robot
        cls.localized = wait_until(lambda: len(robot.poses) > 0 and len(robot.truth) > 0)
        cls.found_at = place_of(robot.poses.messages[-1].pose.pose) if cls.localized else None
        cls.woke_up_at = robot.here()
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        assert client.wait_for_server(rospy.Duration(60))
        goal = MoveBaseGoal()
        goal.target_pose.header.frame_id = "map"
        cls.goal = in_map(FIRST_START)
        goal.target_pose.pose.position.x, goal.target_pose.pose.position.y = cls.goal
        goal.target_pose.pose.orientation.w = 1.0
        results = []
        client.send_goal(goal, done_cb=lambda status, _: results.append(status))
        wait_long(lambda: results)
        cls.result = results
        cls.arrived_at = robot.here()
        robot.switch_off()

    def test_1_explores_all_of_it(self):
        self.assertTrue(self.explored, self.explorer.output())
        self.assertRegex(self.end_of_exploration,
                         "explored: no frontiers are left|nothing is left that can be reached")
        self.assertEqual([message.data for message in self.explorer.collisions.messages], [])

    def test_2_saves_the_map_when_it_is_switched_off(self):
        self.assertIn("map saved in " + self.map, self.explorer.output())
        check = subprocess.run([HV_MAP, "verify", self.map], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(check.returncode, 0, check.stdout)

    def test_3_finds_its_place(self):
        self.assertTrue(self.localized, self.driver.output())
        self.assertLess(math.dist(self.found_at, in_map(self.woke_up_at)), 0.2)
        self.assertGreater(math.dist(self.woke_up_at, FIRST_START[:2]), 5.0)

    def test_4_drives_to_the_goal(self):
        self.assertEqual(self.result, [GoalStatus.SUCCEEDED], self.driver.output())
        self.assertLess(math.dist(in_map(self.arrived_at), self.goal), 0.3)
        self.assertEqual([message.data for message in self.driver.collisions.messages], [])


if __name__ == "__main__":
    rospy.init_node("story_test")
    rostest.rosrun("hv_bringup", "story", Story)
