#!/usr/bin/python3
"""Nodes that are killed at any moment and started again, beside others that go on."""
import os
import random
import subprocess
import sys
import tempfile
import threading
import unittest

import actionlib
import numpy
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from hv_msgs.msg import ExploreAction, ExploreGoal
from std_srvs.srv import Trigger

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from localization import (  # noqa: E402
    START_IN_MOTION, Localization, Truth, base_in_imu, distance, matrix_of)
from mapping import Mapping, kill, poses_of, start_node  # noqa: E402
from recording import CONFIG, DEVEL, Diagnostics, wait_until  # noqa: E402
from toy_robot import ToyRobot  # noqa: E402

HV_MAP = os.path.join(DEVEL, "lib", "hv_replay", "hv_map")
HV_EXPLORE_SAC_NODE = os.path.join(DEVEL, "lib", "hv_explore_sac", "hv_explore_sac_node")
ERROR_M = 0.15


def vertices_of(map_folder):
    """Keyframes in the graph, those that have not been joined yet, too."""
    with open(os.path.join(map_folder, "graph.g2o")) as file:
        return sum(line.startswith("VERTEX_SE3:QUAT") for line in file)


def start_explorer():
    return start_node(HV_EXPLORE_SAC_NODE, "hv_explore_sac", "_config_file:=" + CONFIG,
                      "_exploration/choice/period_s:=0.2", "_exploration/goals/settle_s:=1.0")


class Restarts(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.map = os.path.join(self.folder.name, "map")
        self.random = random.Random(self.id())

    def expect_sound(self, folder):
        check = subprocess.run([HV_MAP, "verify", folder], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
        self.assertEqual(check.returncode, 0, check.stdout)

    def test_the_odometry_beside_mapping(self):
        mapping = Mapping("_map_path:=" + self.map)
        cut = self.random.randint(100, 300)
        mapping.play(mapping.player.clouds(0, cut))
        mapping.player.play(mapping.player.clouds(cut, cut + 3))
        mapping.restart_odometry()
        before = len(mapping.keyframes)
        mapping.play(mapping.player.clouds(cut + 3))
        self.assertGreater(len(mapping.keyframes), before + 20)
        mapping.stop()
        self.expect_sound(self.map)
        self.assertEqual(vertices_of(self.map), len(mapping.keyframes))
        segments = {message.id for message in mapping.keyframes.messages[before:]}
        self.assertIn(0, segments)

    def test_mapping_while_it_saves(self):
        mapping = Mapping("_map_path:=" + self.map)
        mapping.play(mapping.player.clouds(0, 200))
        service = rospy.ServiceProxy("/hv_loop_btc/save_map", Trigger)
        self.assertTrue(service().success)
        saved = len(poses_of(self.map))
        mapping.play(mapping.player.clouds(200, 300))

        def save():
            try:
                service()
            except rospy.ServiceException:
                pass  # killed
        saving = threading.Thread(target=save)
        saving.start()
        rospy.rostime.wallsleep(self.random.uniform(0.0, 0.2))
        mapping.kill_mapping()
        saving.join()
        self.expect_sound(self.map)
        self.assertIn(len(poses_of(self.map)), (saved, len(mapping.keyframes)))

        known = len(poses_of(self.map))
        taken = len(mapping.keyframes)
        mapping.start_mapping("_map_path:=" + self.map, "_continue_map:=" + self.map)
        mapping.player.play(mapping.player.clouds(300), lambda: len(mapping.odometry))
        self.assertTrue(wait_until(lambda: mapping.count("keyframes") == known + len(
            mapping.keyframes) - taken))
        self.assertGreater(len(mapping.keyframes), taken + 20)
        mapping.stop()
        self.expect_sound(self.map)
        self.assertEqual(vertices_of(self.map), known + len(mapping.keyframes) - taken)

    def test_localisation_and_the_odometry_beside_it(self):
        nodes = Localization()
        self.addCleanup(nodes.stop)
        self.T_base_imu = numpy.linalg.inv(base_in_imu(nodes.player))
        self.truth = Truth()
        cuts = [self.random.randint(40, 60), self.random.randint(85, 100)]
        nodes.play(0, cuts[0])
        nodes.restart_localizer()
        before = len(nodes.places)
        nodes.play(cuts[0], cuts[1])
        self.assertGreater(len(nodes.places), before)
        self.expect_right(nodes.places.messages[-1])
        nodes.restart_odometry()
        before = len(nodes.places)
        nodes.play(cuts[1], 145, START_IN_MOTION)
        self.assertGreater(len(nodes.places), before)
        self.expect_right(nodes.places.messages[-1])

    def expect_right(self, message):
        pose = matrix_of(message.pose.pose) @ self.T_base_imu
        self.assertLess(distance(pose, self.truth.at(message.header.stamp.to_nsec())), ERROR_M)

    def test_exploration(self):
        robot = ToyRobot()
        client = actionlib.SimpleActionClient("/hv_explore_sac/explore", ExploreAction)
        explorer = start_explorer()
        self.assertTrue(client.wait_for_server(rospy.Duration(30)))
        client.send_goal(ExploreGoal())
        goals = self.random.randint(2, 4)
        self.assertTrue(wait_until(lambda: len(robot.goals) > goals))
        kill(explorer)
        known = robot.share_known()
        heard = Diagnostics()
        explorer = start_explorer()
        self.addCleanup(kill, explorer)
        self.assertTrue(wait_until(lambda: heard.message("exploration") != ""))
        client = actionlib.SimpleActionClient("/hv_explore_sac/explore", ExploreAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30)))
        results = []
        client.send_goal(ExploreGoal(), done_cb=lambda *result: results.append(result))
        self.assertTrue(wait_until(lambda: results))
        self.assertEqual(results[0][0], GoalStatus.SUCCEEDED, results[0][1])
        self.assertLess(known, 0.9)
        self.assertGreater(robot.share_known(), 0.97)


if __name__ == "__main__":
    rospy.init_node("restarts_test")
    rostest.rosrun("hv_bringup", "restarts", Restarts)
