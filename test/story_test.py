#!/usr/bin/python3
"""The whole robot: it explores an unknown building, saves the map, is switched off, wakes up at
another place, finds out where it is and drives to a goal. With the launch file that users start."""
import math
import os
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
from hv_msgs.msg import ExploreAction, ExploreGoal
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import DEVEL, Collector, wait_until  # noqa: E402
from whole_robot import IMU, Robot, place_of  # noqa: E402

HV_MAP = os.path.join(DEVEL, "lib", "hv_replay", "hv_map")
WORLD = os.path.join(rospkg.RosPack().get_path("hv_bringup"), "..", "test", "small_building.yaml")
FIRST_START = (1.2, 1.3, 0.0)  # x, y [m], yaw [deg] in the building
SECOND_START = (4.0, 7.4, 250.0)  # in a room
FREE_M2 = 75.0  # of the building, about
WAITS = 25  # of half a minute each; reached only by a failure


def wait_long(condition):
    return any(wait_until(condition) for _ in range(WAITS))


def in_map(place):
    """Of a place in the building: the first start looks along its x axis."""
    return (place[0] - FIRST_START[0] - IMU[0], place[1] - FIRST_START[1] - IMU[1])


def switch_on(folder, name, start, *arguments):
    return Robot(os.path.join(folder, name + ".log"), start, "world:=" + WORLD, "people:=false",
                 "point_share:=0.1", "sim_rate:=0.5", *arguments)


class Story(unittest.TestCase):
    """One story serves every test."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.map = os.path.join(cls.folder.name, "map")
        cls.explore()
        cls.wake_up_elsewhere()

    @classmethod
    def explore(cls):
        robot = switch_on(cls.folder.name, "exploration", FIRST_START, "mode:=exploration",
                          "save_map:=" + cls.map)
        cls.addClassCleanup(robot.switch_off)
        cls.explorer = robot
        cls.viewpoints = Collector("/viewpoints", MarkerArray)
        cls.maps = Collector("/map", OccupancyGrid)
        cls.feedback = []
        results = []
        client = actionlib.SimpleActionClient("/hv_explore_sac/explore", ExploreAction)
        assert client.wait_for_server(rospy.Duration(60))
        client.send_goal(ExploreGoal(return_home=True), feedback_cb=cls.feedback.append,
                         done_cb=lambda status, result: results.append((status, result)))
        assert wait_long(lambda: results), robot.output()
        cls.explored, cls.exploration = results[0]
        cls.back_at = robot.here()
        wait_until(lambda: robot.diagnostics.value("exploration", "last result")
                   == cls.exploration.reason)
        robot.switch_off()

    @classmethod
    def wake_up_elsewhere(cls):
        robot = switch_on(cls.folder.name, "navigation", SECOND_START, "mode:=navigation",
                          "map:=" + cls.map)
        cls.addClassCleanup(robot.switch_off)
        cls.driver = robot
        poses = Collector("/localization_pose", PoseWithCovarianceStamped)
        cls.localized = wait_until(lambda: len(poses) > 0 and len(robot.truth) > 0)
        cls.found_at = place_of(poses.messages[-1].pose.pose) if cls.localized else None
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
        self.assertEqual(self.explored, GoalStatus.SUCCEEDED, self.explorer.output())
        # The second may go on with what navigation said of the last goal.
        self.assertRegex(self.exploration.reason, "^(explored: no frontiers are left$|"
                                                  "nothing is left that can be reached($|; ))")
        self.assertGreater(self.exploration.explored_m2, 0.9 * FREE_M2)
        known = sum(cell == 0 for cell in self.maps.messages[-1].data)
        self.assertGreater(0.01 * known, 0.9 * FREE_M2)
        self.assertGreater(self.exploration.travelled_m, 10.0)
        self.assertGreater(self.exploration.elapsed_s, 20.0)
        self.assertLess(math.dist(self.back_at, FIRST_START[:2]), 0.4)
        self.assertEqual([message.data for message in self.explorer.collisions.messages], [])

    def test_1_tells_meanwhile_what_it_does(self):
        states = {message.state for message in self.feedback}
        self.assertLessEqual({"exploring", "returning"}, states)
        explored = [message.explored_m2 for message in self.feedback]
        self.assertLess(explored[0], max(explored))
        self.assertGreater(len(self.viewpoints), 5)
        diagnostics = self.explorer.diagnostics
        self.assertEqual(diagnostics.value("exploration", "last result"), self.exploration.reason)
        self.assertEqual(diagnostics.count("maps unusable", "exploration"), 0)

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
