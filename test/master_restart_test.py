#!/usr/bin/python3
"""The ROS master ends and comes back: who talks to each other goes on, and the map is saved."""
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from hv_msgs.msg import Keyframe

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from mapping import start_mapping, start_node, start_odometry  # noqa: E402
from recording import DEVEL, Collector, odometry_collector, wait_until  # noqa: E402
from whole_robot import Master  # noqa: E402

HV_SIM_NODE = os.path.join(DEVEL, "lib", "hv_sim", "hv_sim_node")
HV_MAP = os.path.join(DEVEL, "lib", "hv_replay", "hv_map")
SCANS = 30


class MasterRestart(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.map = os.path.join(self.folder.name, "map")

    def expect_to_go_on(self):
        before = (len(self.odometry), len(self.keyframes))
        self.assertTrue(wait_until(lambda: len(self.odometry) > before[0] + SCANS))
        self.assertTrue(wait_until(lambda: len(self.keyframes) > before[1] + 1))
        self.assertEqual([node.poll() for node in self.nodes], [None] * len(self.nodes))

    def test_nodes_go_on_without_a_master_and_with_a_new_one(self):
        self.odometry = odometry_collector()
        self.keyframes = Collector("/keyframe", Keyframe)
        commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        turn = Twist()
        turn.angular.z = 0.4
        timer = rospy.Timer(rospy.Duration(0.1), lambda _: commands.publish(turn))
        self.addCleanup(timer.shutdown)
        self.nodes = [start_node(HV_SIM_NODE, "hv_sim", "_rate:=0.5", "_point_share:=0.1",
                                 "_people:=false"),
                      start_odometry(), start_mapping("_map_path:=" + self.map)]
        self.expect_to_go_on()
        master.stop()
        self.expect_to_go_on()
        master.start()
        self.expect_to_go_on()
        self.save_and_verify()

    def save_and_verify(self):
        for node in reversed(self.nodes):
            node.send_signal(signal.SIGINT)
            output, _ = node.communicate(timeout=30)
            self.assertEqual(node.returncode, 0, output)
        check = subprocess.run([HV_MAP, "verify", self.map], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
        self.assertEqual(check.returncode, 0, check.stdout)
        with open(os.path.join(self.map, "poses.tum")) as file:
            last = max(float(line.split()[0]) for line in file if not line.startswith("#"))
        stamps = [message.header.stamp.to_sec() for message in self.keyframes.messages]
        self.assertGreaterEqual(last, stamps[-2] - 1e-6)


if __name__ == "__main__":
    master = Master()
    rospy.init_node("master_restart_test")
    rostest.rosrun("hv_bringup", "master_restart", MasterRestart)
