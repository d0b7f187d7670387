#!/usr/bin/python3
"""A simulated robot explores a small building with everything that a real one runs: odometry,
mapping, navigation and exploration."""
import math
import os
import sys
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from hv_msgs.msg import ExploreAction, ExploreGoal
from nav_msgs.msg import OccupancyGrid, Odometry
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import Collector, Diagnostics, wait_until  # noqa: E402

FREE_M2 = 75.0  # of the building, about
WAITS = 25  # of half a minute each; reached only by a failure


class Exploration(unittest.TestCase):
    """One exploration serves every test."""

    @classmethod
    def setUpClass(cls):
        cls.truth = Collector("/truth/odometry", Odometry)
        cls.collisions = Collector("/collision", String)
        cls.viewpoints = Collector("/viewpoints", MarkerArray)
        cls.maps = Collector("/map", OccupancyGrid)
        cls.diagnostics = Diagnostics()
        cls.feedback = []
        results = []
        client = actionlib.SimpleActionClient("/hv_explore_sac/explore", ExploreAction)
        assert client.wait_for_server()
        assert wait_until(lambda: len(cls.truth) > 0 and len(cls.maps) > 0)
        cls.start = cls.truth.messages[-1].pose.pose.position
        client.send_goal(ExploreGoal(return_home=True), feedback_cb=cls.feedback.append,
                         done_cb=lambda status, result: results.append((status, result)))
        assert any(wait_until(lambda: results) for _ in range(WAITS))
        cls.status, cls.result = results[0]
        cls.end = cls.truth.messages[-1].pose.pose.position

    def test_explores_the_building(self):
        self.assertEqual(self.status, GoalStatus.SUCCEEDED, self.result)
        self.assertTrue(self.result.success)
        self.assertGreater(self.result.explored_m2, 0.9 * FREE_M2)
        known = [cell for cell in self.maps.messages[-1].data if cell == 0]
        self.assertGreater(0.01 * len(known), 0.9 * FREE_M2)

    def test_says_why_it_ends(self):
        # The second may go on with what navigation said of the last goal.
        self.assertRegex(self.result.reason, "^(explored: no frontiers are left$|"
                                             "nothing is left that can be reached($|; ))")
        self.assertGreater(self.result.travelled_m, 10.0)
        self.assertGreater(self.result.elapsed_s, 20.0)

    def test_returns_home(self):
        distance = math.dist((self.start.x, self.start.y), (self.end.x, self.end.y))
        self.assertLess(distance, 0.4)

    def test_tells_what_it_does_meanwhile(self):
        states = {message.state for message in self.feedback}
        self.assertLessEqual({"exploring", "returning"}, states)
        explored = [message.explored_m2 for message in self.feedback]
        self.assertLess(explored[0], max(explored))
        self.assertGreater(len(self.viewpoints), 5)

    def test_runs_into_nothing(self):
        self.assertEqual([message.data for message in self.collisions.messages], [])

    def test_diagnostics(self):
        self.assertTrue(wait_until(lambda: self.diagnostics.value(
            "exploration", "last result") == self.result.reason))
        self.assertEqual(self.diagnostics.count("maps unusable", "exploration"), 0)


if __name__ == "__main__":
    rospy.init_node("exploration_test")
    rostest.rosrun("hv_bringup", "exploration", Exploration)
