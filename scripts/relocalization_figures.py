"""Figures of relocalisation: trials against the truth, and runs of localisation in a map."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import odometry_figures as figures
from loop_figures import angles, nearest

SUCCESS_M = 0.10       # of the paper's Table 6
SUCCESS_DEG = 3.0
SAME_STAMP_S = 0.006
ASTRAY_M = 0.5         # a place that is further off is wrong


@dataclass
class Trials:
    """Arrays hold a value a trial."""

    localized: np.ndarray
    error_m: np.ndarray
    error_deg: np.ndarray
    ms: np.ndarray

    def successes(self) -> np.ndarray:
        return (self.localized > 0) & (self.error_m < SUCCESS_M) & (self.error_deg < SUCCESS_DEG)

    def percent(self) -> float:
        return 100.0 * float(np.mean(self.successes()))

    def rmse_m(self) -> float:
        errors = self.error_m[self.successes()]
        return float(np.sqrt(np.mean(errors**2))) if errors.size else float("nan")


def read_trials(path: Path) -> Trials:
    with path.open() as file:
        rows = list(csv.DictReader(file))
    column = lambda name, default: np.array([float(row.get(name, default)) for row in rows])
    return Trials(column("localized", "1"), column("error_m", "-1"), column("error_deg", "-1"),
                  column("ms", "0"))


@dataclass
class Run:
    """Localisation over a recording; arrays hold a value for each pose that was given."""

    seconds: np.ndarray      # from the start of the truth
    error_m: np.ndarray
    error_deg: np.ndarray
    lost_s: list[float]      # moments at which the place was lost
    track_ms: float          # median of a comparison with the map
    localized_share: float   # of the scans
    first_pose_s: float      # after the first scan

    def growth_m(self) -> float:
        """Mean error of the last fifth of the run less that of the first."""
        fifth = len(self.error_m) // 5
        return float(np.mean(self.error_m[-fifth:]) - np.mean(self.error_m[:fifth]))

    def back_after_s(self, event_s: float) -> float:
        """From an event to the first pose from which all are right."""
        late = self.seconds >= event_s
        wrong = np.nonzero(late & (self.error_m > ASTRAY_M))[0]
        first = wrong[-1] + 1 if wrong.size else int(np.argmax(late))
        return float(self.seconds[first] - event_s) if first < len(self.seconds) else float("inf")

    def says_lost(self, event_s: float, within_s: float) -> bool:
        return any(event_s <= moment <= event_s + within_s for moment in self.lost_s)


def matched(a: Path, b: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stamps of the first TUM file for which the second has a pose, and the poses of both."""
    stamps, poses = figures.read_tum(a)
    others, other_poses = figures.read_tum(b)
    at = nearest(others, stamps)
    together = np.abs(others[at] - stamps) < SAME_STAMP_S
    return stamps[together], poses[together], other_poses[at[together]]


def overlay(to: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Transform that lays points over others (Umeyama 1991, without scale)."""
    center_to, center = to.mean(axis=0), points.mean(axis=0)
    u, _, vt = np.linalg.svd((to - center_to).T @ (points - center))
    transform = np.eye(4)
    transform[:3, :3] = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    transform[:3, 3] = center_to - transform[:3, :3] @ center
    return transform


def read_run(folder: Path, map_folder: Path) -> Run:
    """`map_folder`: the map and truth.tum of the run that made it, in the frame of all truth."""
    _, keyframes, true_keyframes = matched(map_folder / "map" / "poses.tum",
                                           map_folder / "truth.tum")
    T_map_world = overlay(keyframes[:, :3, 3], true_keyframes[:, :3, 3])
    truth_file = folder / "recording" / "truth.tum"
    stamps, poses, truth = matched(folder / "trajectory.tum", truth_file)
    error = np.linalg.inv(T_map_world @ truth) @ poses
    start = figures.read_tum(truth_file)[0][0]
    with (folder / "localization.csv").open() as file:
        lost = [float(row["stamp"]) - start for row in csv.DictReader(file)
                if row["state"] == "lost"]
    summary = json.loads((folder / "summary.json").read_text())
    return Run(stamps - start, np.linalg.norm(error[:, :3, 3], axis=1), angles(error[:, :3, :3]),
               lost, summary["track_ms"]["median"], summary["localized"] / summary["scans"],
               summary["first_pose_s"])
