#!/usr/bin/python3
"""The whole robot in simulation for hours, and the memory of its nodes by the operating system: it
explores a building and drives around in it while it maps, then with the saved map.

Writes memory.csv and soak.json. The ROS environment must be set up."""

from __future__ import annotations

import argparse
import csv
import json
import sys
import threading
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from std_srvs.srv import Trigger

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "test"))
from recording import Collector  # noqa: E402
from whole_robot import Robot, place_of  # noqa: E402

from free_places import FreePlaces  # noqa: E402
from node_load import memory_mb, nodes  # noqa: E402
from robot_driving import (  # noqa: E402
    STARTING_S, Failure, add_simulation_arguments, begin, connect_exploration, drive_to, explore,
    switch_on, wait)

SAMPLE_S = 5.0  # in wall time
MOST_FAILURES = 5  # in a row
ORIGIN = (0.0, 0.0)


@dataclass
class Phase:
    name: str
    hours: float = 0.0  # simulated
    goals: int = 0
    refused: list[str] = field(default_factory=list)
    failure: str = ""


class Watch:
    """Notes the memory of all nodes while the robot is on."""

    def __init__(self, phase: str, robot: Robot, writer) -> None:
        self._phase = phase
        self._robot = robot
        self._writer = writer
        self._begun = self._now()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _now(self) -> float:
        return self._robot.truth.messages[-1].header.stamp.to_sec()

    def seconds(self) -> float:
        return self._now() - self._begun

    def _run(self) -> None:
        while not self._over.wait(SAMPLE_S):
            for process, name in nodes().items():
                try:
                    self._writer.writerow([self._phase, f"{self.seconds():.1f}", name,
                                           f"{memory_mb(process):.2f}"])
                except OSError:
                    pass  # it has ended meanwhile

    def end(self) -> None:
        self._over.set()
        self._thread.join()


class Soak:
    """Both phases."""

    def __init__(self, arguments: argparse.Namespace, writer) -> None:
        self._arguments = arguments
        self._writer = writer
        self._map = arguments.out / "map"
        self._random = np.random.default_rng(arguments.seed)
        self.phases: list[Phase] = []

    def map_and_drive(self) -> None:
        robot = switch_on(self._arguments, "mapping.log", "mode:=exploration",
                          f"save_map:={self._map}", keep=1)
        with self._phase("mapping", robot) as watch:
            status, result = explore(robot, connect_exploration())
            if status != GoalStatus.SUCCEEDED:
                raise Failure(f"exploration: {result.reason}")
            answer = rospy.ServiceProxy("/hv_loop_btc/save_map", Trigger)()
            if not answer.success:
                raise Failure(answer.message)
            self._drive_around(robot, watch)

    def drive_with_map(self) -> None:
        robot = switch_on(self._arguments, "navigation.log", "mode:=navigation",
                          f"map:={self._map}", keep=1)
        with self._phase("navigation", robot) as watch:
            poses = Collector("/localization_pose", PoseWithCovarianceStamped, keep=1)
            wait(lambda: len(poses) > 0, STARTING_S, "the place is not found")
            self._drive_around(robot, watch, lambda: place_of(poses.messages[-1].pose.pose))

    def _phase(self, name: str, robot: Robot):
        return PhaseUnderWay(self.phases, name, robot, self._writer)

    def _drive_around(self, robot: Robot, watch: Watch, here=lambda: ORIGIN) -> None:
        """To places in the map, until time is up."""
        phase = self.phases[-1]
        places = FreePlaces(self._map)
        in_a_row = 0
        while watch.seconds() < 3600.0 * self._arguments.hours and robot.is_on():
            try:
                drive_to(robot, places.far_from(here(), self._random))
                phase.goals += 1
                in_a_row = 0
            except Failure as failure:
                phase.refused.append(str(failure))
                in_a_row += 1
                if in_a_row == MOST_FAILURES:
                    raise


class PhaseUnderWay:
    """Keeps what became of it, and switches the robot off."""

    def __init__(self, phases: list[Phase], name: str, robot: Robot, writer) -> None:
        self._robot = robot
        self._phase = Phase(name)
        phases.append(self._phase)
        self._watch = Watch(name, robot, writer)

    def __enter__(self) -> Watch:
        return self._watch

    def __exit__(self, kind, error, _) -> bool:
        self._phase.hours = self._watch.seconds() / 3600.0
        self._watch.end()
        if not self._robot.is_on():
            self._phase.failure = "a node has ended"
        self._robot.switch_off()
        if isinstance(error, (Failure, ValueError, rospy.ServiceException)):
            self._phase.failure = str(error)
            return True
        return False


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_simulation_arguments(parser)
    parser.add_argument("--hours", type=float, default=2.0, help="simulated, of each phase")
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    master = begin("robot_soak", arguments)
    with (arguments.out / "memory.csv").open("w", newline="", buffering=1) as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["phase", "time_s", "node", "mb"])
        soak = Soak(arguments, writer)
        soak.map_and_drive()
        if not soak.phases[-1].failure:
            soak.drive_with_map()
    phases = [asdict(phase) for phase in soak.phases]
    (arguments.out / "soak.json").write_text(json.dumps(phases, indent=2) + "\n")
    master.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
