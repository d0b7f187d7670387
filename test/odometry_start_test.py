#!/usr/bin/python3
"""Start and end of the odometry node: bad configuration, interrupt, saved trajectory."""
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import (  # noqa: E402
    CONFIG, HV_LIO_NODE, HV_SLAM, IMU, POINTS, RECORDING, Player, odometry_collector, wait_until)


def rows_of(path):
    """Stamp text -> numbers of a TUM file."""
    with open(path) as file:
        rows = [line.split() for line in file if not line.startswith("#")]
    return {row[0]: [float(value) for value in row[1:]] for row in rows}


class OdometryStart(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def start_with(self, *arguments):
        return subprocess.Popen([HV_LIO_NODE, "__name:=started"] + list(arguments),
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def refusal_of(self, *arguments):
        process = self.start_with(*arguments)
        output, _ = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 1, output)
        return output

    def config_with(self, text):
        path = os.path.join(self.folder.name, "config.yaml")
        with open(path, "w") as file:
            file.write(text)
        return "_config_file:=" + path

    def test_unknown_and_wrong_parameters_are_refused_together(self):
        output = self.refusal_of(self.config_with("odometry:\n  thread: 2\n  use_imu: perhaps\n"))
        self.assertIn("threads", output)
        self.assertIn("use_imu", output)
        rospy.set_param("/started/input/point_topic", "/x")
        output = self.refusal_of()
        rospy.delete_param("/started")
        self.assertIn("points_topic", output)

    def test_missing_file_is_refused(self):
        self.assertIn("/nowhere.yaml", self.refusal_of("_config_file:=/nowhere.yaml"))
        rospy.delete_param("/started")

    def trajectory_with(self, config, topics=(POINTS, IMU)):
        """What a node that listens to `topics` saves when it is interrupted after the recording."""
        saved = os.path.join(self.folder.name, "new", "node.tum")
        player = Player(RECORDING)
        odometry = odometry_collector()
        process = self.start_with(config, "_save_trajectory:=" + saved)
        self.assertTrue(player.wait_for_node(topics) and wait_until(odometry.connected))
        player.play(player.messages, lambda: len(odometry))
        sent = sum(topic == POINTS for topic, _ in player.messages)
        self.assertTrue(wait_until(lambda: len(odometry) > 0.75 * sent))
        count = -1
        while count != len(odometry):
            count = len(odometry)
            rospy.rostime.wallsleep(0.5)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=5)
        self.assertEqual(process.returncode, 0, output)
        rospy.delete_param("/started")
        player.close()
        return rows_of(saved)

    def offline_trajectory(self):
        subprocess.run([HV_SLAM, "--config", CONFIG, "--bag", RECORDING, "--out",
                        self.folder.name], check=True, stdout=subprocess.DEVNULL)
        return rows_of(os.path.join(self.folder.name, "odometry.tum"))

    def expect_equal(self, online, offline, tolerance):
        self.assertEqual(sorted(online), sorted(offline))
        for stamp, pose in online.items():
            for value, reference in zip(pose, offline[stamp]):
                self.assertAlmostEqual(value, reference, delta=tolerance)

    def test_interrupt_saves_the_trajectory_of_hv_slam(self):
        online = self.trajectory_with("_config_file:=" + CONFIG)
        self.expect_equal(online, self.offline_trajectory(), 1e-6)

    def test_extrinsic_from_tf_is_that_of_the_file(self):
        online = self.trajectory_with(self.config_with("output:\n  extrinsic_from_tf: true\n"))
        self.expect_equal(online, self.offline_trajectory(), 2e-3)

    def test_runs_without_an_imu(self):
        online = self.trajectory_with(self.config_with("odometry:\n  use_imu: false\n"),
                                      topics=(POINTS,))
        self.assertNotIn("/odometry_imu", dict(rospy.get_published_topics()))
        last = online[max(online)]
        self.assertLess(max(abs(value) for value in last[:3]), 10.0)


if __name__ == "__main__":
    rospy.init_node("odometry_start_test")
    rostest.rosrun("hv_bringup", "odometry_start", OdometryStart)
