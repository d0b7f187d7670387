#!/usr/bin/python3
"""A robot that is suddenly elsewhere, and what people can say about where it is."""
import os
import sys
import unittest

import numpy
import rospy
import rostest
from actionlib_msgs.msg import GoalID, GoalStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from hv_msgs.msg import RelocalizeActionFeedback, RelocalizeActionGoal, RelocalizeActionResult
from std_srvs.srv import Trigger

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from localization import (  # noqa: E402
    CLOUDS_BEFORE, Localization, Truth, base_in_imu, distance, matrix_of)
from recording import Collector, wait_until  # noqa: E402

KIDNAPPED_AT_NS = 1700000015 * 10**9

UNMISTAKABLE = 100  # cloud; one before does not always tell two crossings of corridors apart


class Relocalize:
    """A client of the action."""

    def __init__(self):
        self._goals = rospy.Publisher("/hv_relocalize_ndt/relocalize/goal", RelocalizeActionGoal,
                                      queue_size=5)
        self._cancels = rospy.Publisher("/hv_relocalize_ndt/relocalize/cancel", GoalID,
                                        queue_size=5)
        self.feedback = Collector("/hv_relocalize_ndt/relocalize/feedback",
                                  RelocalizeActionFeedback)
        self.results = Collector("/hv_relocalize_ndt/relocalize/result", RelocalizeActionResult)
        assert wait_until(lambda: self._goals.get_num_connections() > 0
                          and self._cancels.get_num_connections() > 0
                          and self.results.connected() and self.feedback.connected())

    def start(self, guess=None, frame="map"):
        """Sends a goal, with the pose of a guess or without."""
        goal = RelocalizeActionGoal()
        if guess is not None:
            goal.goal.near_guess = True
            goal.goal.guess.header.frame_id = frame
            goal.goal.guess.pose = guess
        self._goals.publish(goal)

    def wait_for_feedback(self):
        """The next that is said, which means that the goal has been taken."""
        before = len(self.feedback)
        assert wait_until(lambda: len(self.feedback) > before)
        return self.feedback.messages[-1].feedback.state

    def cancel(self):
        self._cancels.publish(GoalID())

    def answer(self, count):
        """Status and result number `count`."""
        assert wait_until(lambda: len(self.results) >= count)
        answer = self.results.messages[count - 1]
        return answer.status.status, answer.result


class LocalizationKidnapped(unittest.TestCase):

    def setUp(self):
        self.nodes = None
        self.truth = Truth()

    def tearDown(self):
        if self.nodes:
            self.nodes.stop()

    def start(self, *arguments):
        self.nodes = Localization(*arguments)
        self.T_base_imu = numpy.linalg.inv(base_in_imu(self.nodes.player))
        return self.nodes

    def error_of(self, message):
        """Distance of a told pose of the base from the truth [m]."""
        pose = matrix_of(message.pose.pose) @ self.T_base_imu
        return distance(pose, self.truth.at(message.header.stamp.to_nsec()))

    def test_1_a_kidnapped_robot_is_lost_and_found_again(self):
        nodes = self.start()
        nodes.play(0)
        self.assertTrue(wait_until(lambda: nodes.count("losses") == 1))
        self.assertTrue(wait_until(lambda: nodes.value("state") == "tracking"))
        after = [message for message in nodes.places.messages
                 if message.header.stamp.to_nsec() > KIDNAPPED_AT_NS]
        is_right = [self.error_of(message) < 0.15 for message in after]
        first = is_right.index(True)
        back = (after[first].header.stamp.to_nsec() - KIDNAPPED_AT_NS) * 1e-9
        print("back after %.2f s" % back)
        self.assertLess(back, 5.0)
        # Half a second until the next comparison, then three scans that contradict.
        self.assertLessEqual(first, 10)
        self.assertTrue(all(is_right[first:]))
        output = nodes.stop()
        self.nodes = None
        self.assertIn("lost: what is seen contradicts the map", output)
        self.assertEqual(output.count("localised at"), 2, output)

    def test_2_a_pose_from_rviz_is_tried(self):
        nodes = self.start()
        publisher = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=5)
        self.assertTrue(wait_until(lambda: publisher.get_num_connections() > 0))
        nodes.play(0, 60)
        self.assertTrue(wait_until(lambda: nodes.count("searches") == 1))
        guess = PoseWithCovarianceStamped()
        guess.header.frame_id = "map"
        guess.pose.pose = nodes.places.messages[-1].pose.pose
        guess.pose.pose.position.x += 0.5
        guess.pose.pose.position.z = 0.0
        publisher.publish(guess)
        rospy.rostime.wallsleep(1.0)
        nodes.play(60, 90)
        self.assertTrue(wait_until(lambda: nodes.count("searches") == 2))
        self.assertLess(self.error_of(nodes.places.messages[-1]), 0.15)

        guess.header.frame_id = "odom"
        publisher.publish(guess)
        guess.header.frame_id = "map"
        guess.pose.pose.orientation.w = float("nan")
        publisher.publish(guess)
        rospy.rostime.wallsleep(1.0)
        nodes.play(90, CLOUDS_BEFORE)
        self.assertEqual(nodes.count("searches"), 2)
        output = nodes.stop()
        self.nodes = None
        self.assertIn("'odom' instead of 'map' is not used", output)
        self.assertIn("not a finite rigid transform is not used", output)

    def test_3_the_service_forgets_the_place(self):
        nodes = self.start()
        relocalize = rospy.ServiceProxy("/hv_relocalize_ndt/relocalize", Trigger)
        nodes.play(0, UNMISTAKABLE)
        answer = relocalize()
        self.assertTrue(answer.success)
        self.assertIn("forgotten", answer.message)
        nodes.play(UNMISTAKABLE, UNMISTAKABLE + 30)
        self.assertTrue(wait_until(lambda: nodes.count("searches") == 2))
        self.assertEqual(nodes.value("state"), "tracking")
        self.assertLess(self.error_of(nodes.places.messages[-1]), 0.15)

    def test_4_the_action_tells_the_place(self):
        nodes = self.start()
        action = Relocalize()
        action.start()
        self.assertEqual(action.wait_for_feedback(), "waiting for a scan")
        action.cancel()
        status, result = action.answer(1)
        self.assertEqual(status, GoalStatus.PREEMPTED)
        self.assertFalse(result.success)

        nodes.play(0, UNMISTAKABLE)
        action.start()
        action.wait_for_feedback()
        nodes.play(UNMISTAKABLE, UNMISTAKABLE + 30)
        status, result = action.answer(2)
        self.assertEqual(status, GoalStatus.SUCCEEDED, result.message)
        self.assertTrue(result.success)
        self.assertIn("the robot is at", result.message)
        self.assertEqual(result.reason, "")
        self.assertEqual(result.pose.header.frame_id, "map")
        self.assertLess(self.error_of(result.pose), 0.15)
        self.assertGreater(min(result.pose.pose.covariance[7 * i] for i in range(6)), 0.0)
        self.assertTrue(0.5 < result.score <= 1.0, result.score)
        self.assertTrue(0.0 < result.margin <= 1.0, result.margin)
        self.assertGreater(result.lead, 0.0)

        action.start(result.pose.pose.pose, frame="odom")
        status, result = action.answer(3)
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertIn("'odom'", result.reason)

        action.start(nodes.places.messages[-1].pose.pose)
        action.wait_for_feedback()
        nodes.play(90, 120)
        status, result = action.answer(4)
        self.assertEqual(status, GoalStatus.SUCCEEDED, result.message)
        self.assertLess(self.error_of(result.pose), 0.15)

    def test_5_a_first_pose_can_be_given(self):
        nodes = self.start()
        nodes.play(0, 30)
        first = nodes.places.messages[0].pose.pose
        yaw = 2.0 * numpy.arctan2(first.orientation.z, first.orientation.w)
        nodes.stop()
        nodes = self.start("_initial_pose:=%f %f %f 0 0 %f" % (
            first.position.x + 0.3, first.position.y, first.position.z, yaw))
        nodes.play(0, 30)
        self.assertTrue(wait_until(lambda: nodes.value("state") == "tracking"))
        self.assertLess(self.error_of(nodes.places.messages[-1]), 0.15)


if __name__ == "__main__":
    rospy.init_node("localization_kidnapped_test")
    rostest.rosrun("hv_bringup", "localization_kidnapped", LocalizationKidnapped)
