"""The whole simulated robot, with all its nodes, told to explore and to drive."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from hv_msgs.msg import ExploreAction, ExploreGoal, ExploreResult
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal

from whole_robot import Master, Robot

STARTING_S = 90.0
EXPLORING_S = 3600.0
DRIVING_S = 900.0


class Failure(Exception):
    """The robot cannot go on."""


def wait(condition, limit_s: float, otherwise: str):
    """The first true value of `condition`, in wall time."""
    end = time.monotonic() + limit_s
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.05)
    raise Failure(otherwise)


def add_simulation_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--world", required=True, help="as world:= of hv_liom.launch")
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--people", action="store_true", help="people walk around")
    parser.add_argument("--point-share", type=float, default=0.25)
    parser.add_argument("--rate", type=float, default=1.0, help="simulated seconds per second")
    parser.add_argument("--out", type=Path, required=True)


def begin(name: str, given: argparse.Namespace) -> Master:
    """This program as a node of a master of its own; makes the folder of the results."""
    given.out = given.out.resolve()
    given.out.mkdir(parents=True, exist_ok=True)
    master = Master()
    rospy.init_node(name, disable_signals=True)
    return master


def switch_on(given: argparse.Namespace, log: str, *arguments: str, start=None,
              keep: int | None = None) -> Robot:
    """With the arguments of the simulation and those of hv_liom.launch; returns when it runs.
    `keep`: of the true poses; None: all."""
    robot = Robot(str(given.out / log), start, f"world:={given.world}", f"seed:={given.seed}",
                  f"point_share:={given.point_share}", f"sim_rate:={given.rate}",
                  f"people:={str(given.people).lower()}", *arguments, keep=keep)
    wait(lambda: len(robot.truth) > 0, STARTING_S, "the simulation does not start")
    return robot


def connect(name: str, action, what: str) -> actionlib.SimpleActionClient:
    client = actionlib.SimpleActionClient(name, action)
    wait(lambda: client.wait_for_server(rospy.Duration(1.0)), STARTING_S, f"{what} does not start")
    return client


def explore(robot: Robot, client: actionlib.SimpleActionClient) -> tuple[int, ExploreResult]:
    """To the end: status and result."""
    results = []
    client.send_goal(ExploreGoal(), done_cb=lambda *result: results.append(result))
    wait(lambda: results or not robot.is_on(), EXPLORING_S, "exploration does not end")
    if not results:
        raise Failure("a node ended while exploring")
    return results[0]


def connect_exploration() -> actionlib.SimpleActionClient:
    return connect("/hv_explore_sac/explore", ExploreAction, "exploration")


def drive_to(robot: Robot, goal: tuple[float, float]) -> None:
    """In the map [m]."""
    client = connect("move_base", MoveBaseAction, "navigation")
    message = MoveBaseGoal()
    message.target_pose.header.frame_id = "map"
    message.target_pose.pose.position.x, message.target_pose.pose.position.y = goal
    message.target_pose.pose.orientation.w = 1.0
    results = []
    client.send_goal(message, done_cb=lambda status, _: results.append(status))
    wait(lambda: results or not robot.is_on(), DRIVING_S, "the goal is not reached in time")
    if results != [GoalStatus.SUCCEEDED]:
        raise Failure("driving: " + client.get_goal_status_text())
