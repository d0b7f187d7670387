#!/usr/bin/python3
"""A simulated robot in a corridor with people: goals, a new goal on the way, cancelling, sensors
that fall silent. Without a saved map: plans are made in what is seen on the way."""
import math
import os
import sys
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import Collector, Diagnostics, wait_until  # noqa: E402

TOLERANCE_M = 0.25  # of the goal (0.1 m) and of odometry over the way
PERIOD_S = 0.1
STOP_S = 2.0  # silence until it is noticed (0.5 s), and braking from full speed


def wait_long(condition):
    """As wait_until(), for a drive."""
    return any(wait_until(condition) for _ in range(3))


def pose_of(message):
    """x, y, yaw of a Pose or Transform."""
    is_pose = hasattr(message, "position")
    p = message.position if is_pose else message.translation
    q = message.orientation if is_pose else message.rotation
    return (p.x, p.y, 2.0 * math.atan2(q.z, q.w))


def seen_from(start, pose):
    """Ahead and to the left of a start [m]."""
    x, y = pose[0] - start[0], pose[1] - start[1]
    cos, sin = math.cos(start[2]), math.sin(start[2])
    return (x * cos + y * sin, y * cos - x * sin)


def moved(start, step):
    """A pose that is given as seen from a start."""
    cos, sin = math.cos(start[2]), math.sin(start[2])
    return (start[0] + step[0] * cos - step[1] * sin, start[1] + step[0] * sin + step[1] * cos,
            start[2] + step[2])


def goal_in(frame, x, y, yaw=0.0):
    goal = MoveBaseGoal()
    goal.target_pose.header.frame_id = frame
    goal.target_pose.pose.position.x = x
    goal.target_pose.pose.position.y = y
    goal.target_pose.pose.orientation.z = math.sin(yaw / 2.0)
    goal.target_pose.pose.orientation.w = math.cos(yaw / 2.0)
    return goal


class Navigation(unittest.TestCase):
    """One drive serves every test."""

    @classmethod
    def setUpClass(cls):
        cls.truth = Collector("/truth/odometry", Odometry)
        cls.collisions = Collector("/collision", String)
        cls.commands = Collector("/cmd_vel", Twist)
        cls.command_times = []
        cls.plans = Collector("/plan", Path)
        cls.local_plans = Collector("/local_plan", Path)
        cls.maps = Collector("/map", OccupancyGrid)
        cls.local_grids = Collector("/local_grid", OccupancyGrid)
        cls.diagnostics = Diagnostics()
        cls.odometry = Collector("/odometry", Odometry)
        cls.transforms = Collector("/tf", TFMessage)
        cls.client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        assert cls.client.wait_for_server()
        assert wait_until(lambda: len(cls.local_grids) > 2 and len(cls.truth) > 0 and
                          cls.place_of_odometry())
        cls.start = pose_of(cls.truth.messages[-1].pose.pose)
        cls.start_in_map = moved(cls.place_of_odometry()[-1],
                                 pose_of(cls.odometry.messages[-1].pose.pose))
        cls.commands_before = len(cls.commands)
        cls.subscriber = rospy.Subscriber(
            "/cmd_vel", Twist, lambda _: cls.command_times.append(rospy.Time.now().to_sec()))
        cls.drive_to_a_goal()
        cls.take_another_goal_on_the_way()
        cls.lose_the_sensors_on_the_way()
        cls.cancel_on_the_way()
        cls.ask_for_nonsense()

    @classmethod
    def here(cls):
        """Where the robot truly is, from where it started."""
        return seen_from(cls.start, pose_of(cls.truth.messages[-1].pose.pose))

    @classmethod
    def place_of_odometry(cls):
        """All T_map_odom so far."""
        return [pose_of(transform.transform) for message in cls.transforms.messages
                for transform in message.transforms if transform.child_frame_id == "odom"]

    @classmethod
    def goal_at(cls, ahead, left):
        """From where the robot started, in the map."""
        return goal_in("map", *moved(cls.start_in_map, (ahead, left, 0.0)))

    @classmethod
    def speed(cls):
        return abs(cls.truth.messages[-1].twist.twist.linear.x)

    @classmethod
    def seconds(cls):
        return cls.truth.messages[-1].header.stamp.to_sec()

    @classmethod
    def send(cls, goal):
        results = []
        cls.feedback = []
        cls.client.send_goal(goal, done_cb=lambda status, _: results.append(
            (status, cls.client.get_goal_status_text())), feedback_cb=cls.feedback.append)
        return results

    @classmethod
    def get_going(cls):
        return wait_until(lambda: cls.speed() > 0.3)

    @classmethod
    def drive_to_a_goal(cls):
        begun = cls.seconds()
        results = cls.send(cls.goal_at(8.0, 0.0))
        assert wait_long(lambda: results)
        cls.reached = results[0]
        cls.reached_feedback = list(cls.feedback)
        cls.reached_in_s = cls.seconds() - begun
        cls.reached_at = cls.here()
        cls.reached_gaps = [b - a for a, b in zip(cls.command_times, cls.command_times[1:])]
        assert wait_until(lambda: cls.seconds() > begun + cls.reached_in_s + 1.0)
        cls.quiet_since = len(cls.commands)
        assert wait_until(lambda: cls.seconds() > begun + cls.reached_in_s + 2.0)
        cls.commands_while_idle = len(cls.commands) - cls.quiet_since
        cls.last_command = cls.commands.messages[-1]

    @classmethod
    def take_another_goal_on_the_way(cls):
        cls.send(cls.goal_at(1.0, 0.0))
        assert cls.get_going()
        # By the topic of rviz: a goal of somebody else.
        publisher = rospy.Publisher("/move_base_simple/goal", PoseStamped, queue_size=1)
        assert wait_until(lambda: publisher.get_num_connections() > 0)
        publisher.publish(cls.goal_at(5.0, 0.2).target_pose)
        assert wait_until(lambda: cls.client.get_state() == GoalStatus.PREEMPTED)
        assert wait_long(lambda: cls.diagnostics.count("goals reached", "navigation") == 2)
        cls.second_at = cls.here()

    @classmethod
    def lose_the_sensors_on_the_way(cls):
        results = cls.send(cls.goal_at(-3.0, 0.0))
        assert cls.get_going()
        pause = rospy.ServiceProxy("/hv_lio/pause", SetBool)
        pause(True)
        silent = cls.seconds()
        assert wait_until(lambda: cls.speed() < 1e-3)
        cls.stopped_in_s = cls.seconds() - silent
        assert wait_until(lambda: cls.diagnostics.value("navigation", "state") == "paused")
        cls.pause_reason = cls.diagnostics.message("navigation")
        cls.ended_by_silence = bool(results)
        pause(False)
        cls.goes_on = cls.get_going()

    @classmethod
    def cancel_on_the_way(cls):
        cls.client.cancel_goal()
        begun = cls.seconds()
        assert wait_until(lambda: cls.client.get_state() == GoalStatus.PREEMPTED)
        cls.cancel_text = cls.client.get_goal_status_text()
        assert wait_until(lambda: cls.speed() < 1e-3)
        cls.cancelled_in_s = cls.seconds() - begun
        cls.cleared = rospy.ServiceProxy("/hv_navigation/clear_obstacles", Trigger)()

    @classmethod
    def ask_for_nonsense(cls):
        cls.nonsense = []
        for goal in (goal_in("map", math.nan, 0.0), goal_in("nowhere", 1.0, 0.0), MoveBaseGoal()):
            results = cls.send(goal)
            assert wait_until(lambda: results)
            cls.nonsense.append(results[0])

    def test_reaches_the_goal(self):
        self.assertEqual(self.reached[0], GoalStatus.SUCCEEDED, self.reached)
        self.assertEqual(self.reached[1], "Goal reached.")
        self.assertLess(math.dist(self.reached_at, (8.0, 0.0)), TOLERANCE_M)

    def test_tells_where_it_is_meanwhile(self):
        feedback = [message.base_position for message in self.reached_feedback]
        self.assertEqual({message.header.frame_id for message in feedback}, {"map"})
        self.assertGreater(len(feedback), 0.9 * self.reached_in_s / PERIOD_S)
        last = seen_from(self.start_in_map, pose_of(feedback[-1].pose))
        self.assertLess(math.dist(last, (8.0, 0.0)), TOLERANCE_M)

    def test_runs_into_nobody(self):
        kinds = {message.data for message in self.collisions.messages}
        self.assertLessEqual(kinds, {"hit_by_person"})

    def test_velocities_come_in_time(self):
        late = [gap for gap in self.reached_gaps if gap > 1.5 * PERIOD_S]
        self.assertGreater(len(self.reached_gaps), 50)
        self.assertLess(len(late), 0.05 * len(self.reached_gaps), late)

    def test_is_silent_without_a_goal(self):
        self.assertEqual(self.commands_before, 0)
        self.assertEqual(self.commands_while_idle, 0)
        self.assertEqual(self.last_command, Twist())

    def test_a_new_goal_takes_the_place_of_the_old_one(self):
        self.assertLess(math.dist(self.second_at, (5.0, 0.2)), TOLERANCE_M)

    def test_stops_when_the_sensors_are_silent_and_goes_on_with_them(self):
        self.assertLess(self.stopped_in_s, STOP_S)
        self.assertTrue(self.pause_reason.startswith("paused: "), self.pause_reason)
        self.assertFalse(self.ended_by_silence)
        self.assertTrue(self.goes_on)

    def test_stops_when_cancelled(self):
        self.assertEqual(self.cancel_text, "Goal cancelled.")
        self.assertLess(self.cancelled_in_s, STOP_S)
        self.assertTrue(self.cleared.success)

    def test_nonsense_is_answered(self):
        for status, text in self.nonsense:
            self.assertEqual(status, GoalStatus.ABORTED)
            self.assertTrue("finite" in text or "tf cannot" in text, text)

    def test_shows_what_it_does(self):
        self.assertEqual(self.plans.messages[0].header.frame_id, "map")
        self.assertGreater(len(self.plans.messages[0].poses), 50)
        self.assertEqual(self.local_plans.messages[0].header.frame_id, "odom")
        self.assertEqual(self.maps.messages[-1].header.frame_id, "map")
        self.assertEqual(self.local_grids.messages[-1].header.frame_id, "odom")
        self.assertIn(100, self.maps.messages[-1].data)

    def test_diagnostics(self):
        self.assertEqual(self.diagnostics.count("goals reached", "navigation"), 2)
        self.assertGreater(self.diagnostics.count("octree nodes", "obstacles"), 1000)
        self.assertGreater(self.diagnostics.count("depth images", "obstacles"), 100)
        self.assertGreater(float(self.diagnostics.value(
            "navigation", "obstacles to velocity median [ms]")), 0.0)
        self.assertEqual(self.diagnostics.count("scans unusable", "obstacles"), 0)


if __name__ == "__main__":
    rospy.init_node("navigation_test")
    rostest.rosrun("hv_bringup", "navigation", Navigation)
