#!/usr/bin/python3
"""The action of the exploration node, beside a toy robot in place of mapping and navigation."""
import itertools
import math
import os
import sys
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point32
from hv_msgs.msg import ExploreAction, ExploreGoal
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import Collector, Diagnostics, wait_until  # noqa: E402
from toy_robot import HOME, ToyRobot  # noqa: E402

NAME = "/hv_explore_sac"


def bounded(corners, frame="map"):
    goal = ExploreGoal()
    goal.bounds.header.frame_id = frame
    goal.bounds.polygon.points = [Point32(x=x, y=y) for x, y in corners]
    return goal


class ExplorationAction(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.robot = ToyRobot()
        cls.viewpoints = Collector("/viewpoints", MarkerArray)
        cls.frontiers = Collector("/frontiers", PointCloud2)
        cls.diagnostics = Diagnostics()
        cls.client = actionlib.SimpleActionClient(NAME + "/explore", ExploreAction)
        assert cls.client.wait_for_server()
        cls.pause = rospy.ServiceProxy(NAME + "/pause", SetBool)

    def setUp(self):
        self.robot.mode = "drive"
        self.robot.reset()
        self.feedback = []
        self.results = []

    def explore(self, goal=None):
        self.client.send_goal(
            goal or ExploreGoal(), feedback_cb=self.feedback.append,
            done_cb=lambda status, result: self.results.append((status, result)))

    def begin(self, goal=None):
        """Explores, and waits for the first goal."""
        goals = len(self.robot.goals)
        self.explore(goal)
        self.assertTrue(wait_until(lambda: len(self.robot.goals) > goals))
        self.assertTrue(wait_until(lambda: self.state() == "exploring"))

    def wait_for_result(self):
        self.assertTrue(wait_until(lambda: self.results))
        status, result = self.results[0]
        self.assertEqual(self.client.get_goal_status_text(), result.reason)
        return status, result

    def state(self):
        return self.feedback[-1].state if self.feedback else ""

    def test_explores_everything_and_returns(self):
        self.explore(ExploreGoal(return_home=True))
        status, result = self.wait_for_result()
        self.assertEqual(status, GoalStatus.SUCCEEDED, result)
        self.assertTrue(result.success)
        self.assertEqual(result.reason, "explored: no frontiers are left")
        self.assertGreater(self.robot.share_known(), 0.97)
        self.assertLess(math.dist(self.robot.position, HOME), 0.05)
        self.assertGreater(result.explored_m2, 60.0)
        self.assertGreater(result.travelled_m, 10.0)
        self.assertGreater(result.elapsed_s, 1.0)
        self.assertEqual(result.failed_goals, 0)
        self.check_feedback()
        self.check_pictures()
        self.assertTrue(wait_until(
            lambda: self.diagnostics.value("exploration", "last result") == result.reason))

    def check_feedback(self):
        states = [state for state, _ in itertools.groupby(m.state for m in self.feedback)]
        self.assertEqual(states[-2:], ["exploring", "returning"])
        self.assertLessEqual(set(states[:-2]), {"waiting"})
        explored = [m.explored_m2 for m in self.feedback if m.state == "exploring"]
        self.assertEqual(explored, sorted(explored))
        goals = [message.goal for message in self.feedback if message.goal.header.frame_id]
        self.assertGreater(len(goals), 3)
        self.assertEqual({goal.header.frame_id for goal in goals}, {"map"})

    def check_pictures(self):
        names = {marker.ns for message in self.viewpoints.messages for marker in message.markers}
        self.assertLessEqual({"viewpoints", "edges", "utilities", "way", "goal"}, names)
        self.assertGreater(max(cloud.width for cloud in self.frontiers.messages), 10)
        self.assertEqual(self.frontiers.messages[-1].header.frame_id, "map")

    def test_pauses_and_goes_on(self):
        self.robot.mode = "hang"
        self.begin()
        cancelled = self.robot.cancelled
        self.assertTrue(self.pause(True).success)
        self.assertTrue(wait_until(lambda: self.robot.cancelled == cancelled + 1))
        self.assertTrue(wait_until(lambda: self.state() == "paused"))
        goals = len(self.robot.goals)
        elapsed_s = self.feedback[-1].elapsed_s
        rospy.rostime.wallsleep(1.0)
        self.assertEqual(len(self.robot.goals), goals)
        self.assertEqual(self.feedback[-1].elapsed_s, elapsed_s)
        self.robot.mode = "drive"
        self.assertTrue(self.pause(False).success)
        self.assertEqual(self.wait_for_result()[0], GoalStatus.SUCCEEDED)
        self.assertFalse(self.pause(True).success)

    def test_stops_when_cancelled(self):
        self.robot.mode = "hang"
        self.begin()
        cancelled = self.robot.cancelled
        self.client.cancel_goal()
        status, result = self.wait_for_result()
        self.assertEqual(status, GoalStatus.PREEMPTED)
        self.assertFalse(result.success)
        self.assertEqual(result.reason, "cancelled")
        self.assertTrue(wait_until(lambda: self.robot.cancelled == cancelled + 1))

    def test_tells_when_navigation_fails(self):
        self.robot.mode = "refuse"
        self.explore()
        status, result = self.wait_for_result()
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertEqual(result.reason, "navigation fails; no path: walled in")
        self.assertEqual(result.failed_goals, 3)

    def test_stays_inside_of_bounds_and_time(self):
        count = len(self.robot.goals)
        self.explore(bounded([(0.0, 0.0), (7.2, 0.0), (7.2, 5.4), (0.0, 5.4)]))
        status, result = self.wait_for_result()
        self.assertEqual(status, GoalStatus.SUCCEEDED, result)
        self.assertLess(max(goal.pose.position.x for goal in self.robot.goals[count:]), 7.2)
        self.robot.reset()
        self.robot.mode = "hang"
        self.results.clear()
        self.explore(ExploreGoal(time_budget_s=1.5))
        status, result = self.wait_for_result()
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertEqual(result.reason, "out of time")

    def test_pauses_when_somebody_else_drives(self):
        self.robot.mode = "hang"
        self.begin()
        other = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        self.assertTrue(other.wait_for_server())
        other.send_goal(MoveBaseGoal())
        self.assertTrue(wait_until(lambda: self.state() == "paused"))
        self.client.cancel_goal()
        self.assertEqual(self.wait_for_result()[0], GoalStatus.PREEMPTED)
        other.cancel_goal()

    def test_nonsense_is_answered(self):
        for goal, words in ((bounded([(0.0, 0.0), (1.0, 1.0)]), "fewer than three"),
                            (bounded([(0.0, 0.0), (math.nan, 0.0), (5.0, 5.0)]), "not finite"),
                            (bounded([(0, 0), (5, 5), (5, 0), (0, 5)]), "cross"),
                            (bounded([(0, 0), (5, 0), (5, 5)], "nowhere"), "tf cannot"),
                            (ExploreGoal(time_budget_s=-1.0), "time budget")):
            self.results.clear()
            self.explore(goal)
            status, result = self.wait_for_result()
            self.assertEqual(status, GoalStatus.ABORTED)
            self.assertFalse(result.success)
            self.assertIn(words, result.reason)

    def test_maps_that_make_no_sense_are_counted(self):
        before = self.diagnostics.count("maps unusable", "exploration")
        wide = self.robot.map_message()
        wide.info.width += 1
        elsewhere = self.robot.map_message()
        elsewhere.header.frame_id = "odom"
        # One after the other: the newest map takes the place of one that waits.
        for number, unusable in enumerate((wide, elsewhere), start=1):
            self.robot.publish_map(unusable)
            self.assertTrue(wait_until(lambda: self.diagnostics.count(
                "maps unusable", "exploration") == before + number))


if __name__ == "__main__":
    rospy.init_node("exploration_action_test")
    rostest.rosrun("hv_bringup", "exploration_action", ExplorationAction)
