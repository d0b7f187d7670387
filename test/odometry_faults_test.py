#!/usr/bin/python3
"""The odometry node on spoiled data: it says what is wrong and goes on."""
import copy
import math
import os
import struct
import sys
import unittest

import rospy
import rostest
from std_srvs.srv import SetBool, Trigger

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import (  # noqa: E402
    IMU, POINTS, RECORDING, Diagnostics, Player, odometry_collector, shifted, wait_until)

# How far the stamps of the whole recording are moved, each beyond those before [s].
UNDISTURBED_S = 5000.0
LOST_POINTS_S = 6000.0
LOST_IMU_S = 7000.0
MANY_POINTS_S = 8000.0


def clouds_of(messages):
    return [message for topic, message in messages if topic == POINTS]


class OdometryFaults(unittest.TestCase):
    """The tests share one node and run in the order of their names; each plays a later part of the
    recording with one fault in it."""

    @classmethod
    def setUpClass(cls):
        cls.odometry = odometry_collector()
        cls.diagnostics = Diagnostics()
        cls.player = Player(RECORDING)
        assert wait_until(cls.odometry.connected)
        assert cls.player.wait_for_node()

    def play(self, messages):
        self.player.play(messages, lambda: len(self.odometry))

    def expect_count(self, key, least):
        self.assertTrue(wait_until(lambda: self.diagnostics.count(key) >= least),
                        "%s: %d" % (key, self.diagnostics.count(key)))

    def expect_tracking_after(self, seconds):
        """Odometry beyond the stamp `seconds`, and a healthy state."""
        self.assertTrue(wait_until(
            lambda: self.odometry.messages
            and self.odometry.messages[-1].header.stamp.to_sec() > seconds))
        self.assertTrue(wait_until(lambda: self.diagnostics.message() == "tracking"),
                        self.diagnostics.message())

    @staticmethod
    def last_stamp(messages):
        return max(message.header.stamp.to_sec() for topic, message in messages
                   if topic == POINTS)

    def spoil_one_cloud(self, part, change):
        """`part` with its third cloud changed."""
        number = 0
        for index, (topic, message) in enumerate(part):
            number += topic == POINTS
            if topic == POINTS and number == 3:
                message = copy.copy(message)
                change(message)
                part[index] = (topic, message)
                return part
        raise AssertionError("no third cloud")

    def test_01_starts(self):
        part = self.player.clouds(0, 22)
        self.play(part)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)

    def test_02_empty_cloud(self):
        def empty(cloud):
            cloud.width = 0
            cloud.row_step = 0
            cloud.data = b""
        part = self.spoil_one_cloud(self.player.clouds(22, 28), empty)
        before = len(self.odometry)
        self.play(part)
        self.expect_count("scans on imu only", 1)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)
        self.assertGreaterEqual(len(self.odometry) - before, 5)

    def test_03_cloud_of_nan(self):
        def spoil(cloud):
            data = bytearray(cloud.data)
            for start in range(0, len(data), cloud.point_step):
                struct.pack_into("<fff", data, start, *[float("nan")] * 3)
            cloud.data = bytes(data)
        part = self.spoil_one_cloud(self.player.clouds(28, 34), spoil)
        self.play(part)
        self.expect_count("points not finite", 1000)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)

    def test_04_wrong_fields(self):
        def rename(cloud):
            cloud.fields = [copy.copy(field) for field in cloud.fields]
            cloud.fields[0].name = "u"
        part = self.spoil_one_cloud(self.player.clouds(34, 40), rename)
        self.play(part)
        self.expect_count("clouds unusable", 1)
        self.assertTrue(self.diagnostics.value("input", "last unusable cloud"))
        self.expect_tracking_after(self.last_stamp(part) - 0.3)

    def test_05_sizes_that_contradict_each_other(self):
        def cut(cloud):
            cloud.data = cloud.data[:len(cloud.data) // 2]
        part = self.spoil_one_cloud(self.player.clouds(40, 46), cut)
        self.play(part)
        self.expect_count("clouds unusable", 2)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)

    def test_06_imu_gap(self):
        part = self.player.clouds(46, 54)
        start = part[0][1].header.stamp.to_sec() + 0.3
        part = [(topic, message) for topic, message in part
                if topic != IMU or not 0.0 < message.header.stamp.to_sec() - start < 0.12]
        self.play(part)
        self.expect_count("imu gaps", 1)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)

    def test_07_imu_that_is_not_a_number(self):
        part = self.player.clouds(54, 58)
        index = next(i for i, (topic, _) in enumerate(part) if topic == IMU)
        bad = copy.deepcopy(part[index][1])
        bad.linear_acceleration.x = float("inf")
        part[index] = (IMU, bad)
        self.play(part)
        self.expect_count("imu invalid", 1)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)

    def test_08_clock_jumps_back(self):
        part = shifted(self.player.clouds(58, 66), -1000.0)
        self.play(part)
        self.expect_count("clock jumps", 1)
        self.assertTrue(wait_until(
            lambda: self.odometry.messages[-1].header.stamp.to_sec() < self.last_stamp(part) + 1
            and self.odometry.messages[-1].header.stamp.to_sec() > self.last_stamp(part) - 0.3))
        self.assertTrue(wait_until(lambda: self.diagnostics.message() == "tracking"))

    def test_09_pause_ignores_input(self):
        pause = rospy.ServiceProxy("/hv_lio/pause", SetBool)
        self.assertTrue(pause(True).success)
        self.assertTrue(wait_until(lambda: self.diagnostics.message() == "paused"))
        before = len(self.odometry)
        scans = self.diagnostics.count("scans")
        self.play(shifted(self.player.clouds(66, 68), -1000.0))
        self.assertTrue(pause(False).success)
        part = shifted(self.player.clouds(68, 72), -1000.0)
        self.play(part)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)
        self.assertLessEqual(self.diagnostics.count("scans") - scans, 4)
        self.assertGreater(len(self.odometry), before)

    def test_10_reset_keeps_odom_continuous(self):
        before = self.odometry.messages[-1].pose.pose.position
        answer = rospy.ServiceProxy("/hv_lio/reset", Trigger)()
        self.assertTrue(answer.success, answer.message)
        part = shifted(self.player.messages[:], UNDISTURBED_S)
        self.play(part)
        self.expect_count("resets", 1)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)
        first = next(message for message in self.odometry.messages
                     if message.header.stamp > part[0][1].header.stamp)
        self.assertAlmostEqual(first.pose.pose.position.x, before.x, delta=0.3)
        self.assertAlmostEqual(first.pose.pose.position.y, before.y, delta=0.3)

    def test_11_points_are_lost_and_come_back(self):
        part = shifted(self.player.clouds(0, 66), LOST_POINTS_S)
        first, last = (clouds_of(part)[number].header.stamp for number in (30, 45))
        self.play([(topic, message) for topic, message in part
                   if topic == IMU or not first < message.header.stamp < last])
        self.expect_tracking_after(self.last_stamp(part) - 0.3)
        self.expect_the_way_of_undisturbed(LOST_POINTS_S, 20, 58)

    def test_12_imu_is_lost_and_comes_back(self):
        part = shifted(self.player.clouds(0, 70), LOST_IMU_S)
        first, last = (clouds_of(part)[number].header.stamp for number in (30, 45))
        gaps = self.diagnostics.count("imu gaps")
        self.play([(topic, message) for topic, message in part
                   if topic == POINTS or not first < message.header.stamp < last])
        self.expect_count("imu gaps", gaps + 1)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)

    def test_13_ten_times_the_points(self):
        def repeat(cloud):
            cloud.data = 10 * cloud.data
            cloud.width *= 10
            cloud.row_step *= 10
        part = shifted(self.player.clouds(0, 66), MANY_POINTS_S)
        for cloud in clouds_of(part)[15:]:
            repeat(cloud)
        self.play(part)
        self.expect_tracking_after(self.last_stamp(part) - 0.3)
        self.expect_the_way_of_undisturbed(MANY_POINTS_S, 20, 58)

    def way(self, shift_s, start, end):
        """How far the robot came between two clouds of a part that was played with shifted
        stamps [m]."""
        places = []
        for cloud in (clouds_of(self.player.messages)[number] for number in (start, end)):
            after = cloud.header.stamp.to_sec() + shift_s
            stamp = min((message.header.stamp.to_sec() for message in self.odometry.messages
                         if message.header.stamp.to_sec() > after))
            places.append(next(message.pose.pose.position for message in self.odometry.messages
                               if message.header.stamp.to_sec() == stamp))
        return math.dist(*((place.x, place.y, place.z) for place in places))

    def expect_the_way_of_undisturbed(self, shift_s, start, end):
        expected = self.way(UNDISTURBED_S, start, end)
        self.assertGreater(expected, 0.3)
        self.assertAlmostEqual(self.way(shift_s, start, end), expected, delta=0.05)


if __name__ == "__main__":
    rospy.init_node("odometry_faults_test")
    rostest.rosrun("hv_bringup", "odometry_faults", OdometryFaults)
