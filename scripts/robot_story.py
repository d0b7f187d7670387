#!/usr/bin/python3
"""One story of the whole robot in simulation, measured: it explores an unknown building, saves the
map, is switched off, wakes up elsewhere, finds out where it is and drives to a goal.

Writes story.json and the logs. The ROS environment must be set up."""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseWithCovarianceStamped

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "test"))
from recording import Collector  # noqa: E402
from whole_robot import IMU, Robot, place_of  # noqa: E402

from free_places import FreePlaces  # noqa: E402
from node_load import NodeLoad  # noqa: E402
from robot_driving import (  # noqa: E402
    Failure, add_simulation_arguments, begin, connect_exploration, drive_to, explore, switch_on,
    wait)

LOCALIZING_S = 120.0
FOUND_M = 0.2
ARRIVED_M = 0.3
LATENCIES = {"scan_to_pose": ("resources", "scan to pose"),
             "obstacles_to_velocity": ("navigation", "obstacles to velocity")}


@dataclass
class Stage:
    """What the robot did between being switched on and off."""

    seconds: float = 0.0  # simulated
    wall_s: float = 0.0
    travelled_m: float = 0.0
    collisions: int = 0
    latency_ms: dict[str, dict[str, float]] = field(default_factory=dict)
    load: dict[str, dict[str, float]] = field(default_factory=dict)


@dataclass
class Story:
    """How far it came; `failure` is empty when it came to its end."""

    failure: str = ""
    explored_m2: float = 0.0
    end_of_exploration: str = ""
    exploration: Stage = field(default_factory=Stage)
    found_after_s: float = -1.0
    found_error_m: float = -1.0
    goal_error_m: float = -1.0
    drive: Stage = field(default_factory=Stage)


def travelled(robot: Robot) -> float:
    places = np.array([place_of(message.pose.pose) for message in robot.truth.messages])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


def latencies(robot: Robot) -> dict[str, dict[str, float]]:
    values = {}
    for name, (status, key) in LATENCIES.items():
        texts = {what: robot.diagnostics.value(status, f"{key} {entry} [ms]")
                 for what, entry in (("median", "median"), ("p99", "99th percentile"),
                                     ("max", "max since start"))}
        values[name] = {what: float(text) for what, text in texts.items() if text}
    return values


def measured(robot: Robot, load: NodeLoad) -> Stage:
    stamps = [message.header.stamp.to_sec() for message in robot.truth.messages]
    return Stage(stamps[-1] - stamps[0], load.wall_s(), travelled(robot),
                 len(robot.collisions), latencies(robot), load.measure())


class Teller:
    """Plays one story."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self._arguments = arguments
        self._map = arguments.out / "map"
        self._random = np.random.default_rng(arguments.seed)
        self.story = Story()

    def _switch_on(self, log: str, *arguments: str, start=None) -> tuple[Robot, NodeLoad]:
        return switch_on(self._arguments, log, *arguments, start=start), NodeLoad()

    def explore(self) -> None:
        robot, load = self._switch_on("exploration.log", "mode:=exploration",
                                      f"save_map:={self._map}")
        try:
            client = connect_exploration()
            self._begin_in_building(robot)
            status, result = explore(robot, client)
            self.story.end_of_exploration = result.reason
            self.story.explored_m2 = result.explored_m2
            if status != GoalStatus.SUCCEEDED:
                raise Failure(f"exploration: {result.reason}")
        finally:
            self.story.exploration = measured(robot, load)
            robot.switch_off()
        self._expect_map()

    def _begin_in_building(self, robot: Robot) -> None:
        """Where the map begins: at the IMU, with the axes of the base."""
        pose = robot.truth.messages[-1].pose.pose
        self._yaw = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        self._origin = self._turned(IMU) + np.array(place_of(pose))

    def _turned(self, vector) -> np.ndarray:
        cos, sin = math.cos(self._yaw), math.sin(self._yaw)
        return np.array([[cos, -sin], [sin, cos]]) @ np.asarray(vector)

    def _in_building(self, place) -> tuple[float, float]:
        return tuple(self._turned(place) + self._origin)

    def _expect_map(self) -> None:
        check = subprocess.run([str(self._arguments.hv_map), "verify", str(self._map)],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if check.returncode != 0:
            raise Failure(f"the saved map: {check.stdout.strip().splitlines()[-1]}")

    def wake_up_elsewhere(self) -> None:
        places = FreePlaces(self._map)
        woken = places.far_from((-IMU[0], -IMU[1]), self._random)
        goal = places.far_from(woken, self._random)
        start = (*self._in_building(woken), float(self._random.uniform(-180.0, 180.0)))
        robot, load = self._switch_on("navigation.log", "mode:=navigation", f"map:={self._map}",
                                      start=start)
        try:
            poses = Collector("/localization_pose", PoseWithCovarianceStamped)
            begun = robot.truth.messages[0].header.stamp.to_sec()
            wait(lambda: len(poses) > 0, LOCALIZING_S, "the place is not found")
            found = poses.messages[-1]
            self.story.found_after_s = found.header.stamp.to_sec() - begun
            self.story.found_error_m = self._error(robot, place_of(found.pose.pose))
            if self.story.found_error_m > FOUND_M:
                raise Failure(f"the place is wrong by {self.story.found_error_m:.2f} m")
            self._drive_to(robot, goal)
        finally:
            self.story.drive = measured(robot, load)
            robot.switch_off()

    def _error(self, robot: Robot, place_in_map) -> float:
        return math.dist(self._in_building(place_in_map), robot.here())

    def _drive_to(self, robot: Robot, goal: tuple[float, float]) -> None:
        drive_to(robot, goal)
        self.story.goal_error_m = self._error(robot, goal)
        if self.story.goal_error_m > ARRIVED_M:
            raise Failure(f"the goal is missed by {self.story.goal_error_m:.2f} m")


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_simulation_arguments(parser)
    parser.add_argument("--hv-map", type=Path, required=True, help="the program hv_map")
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    master = begin("robot_story", arguments)
    teller = Teller(arguments)
    try:
        teller.explore()
        teller.wake_up_elsewhere()
    except (Failure, ValueError) as failure:
        teller.story.failure = str(failure)
    (arguments.out / "story.json").write_text(json.dumps(asdict(teller.story), indent=2) + "\n")
    master.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
