"""Figures of loops: which are true, how many revisits are found, how exact their poses are."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import odometry_figures as figures

FALSE_LOOP_M = 0.5         # a loop is false when its pose is off by more than this
RECENT_SHARE = 3.0         # of the loop distance: way back that is no revisit
SAME_FLOOR_M = 2.0
SAME_SUBMAP_S = 0.05       # stamps of two programs for one submap


@dataclass
class Detections:
    """Loops that a program reports; arrays hold a value for each."""

    query: np.ndarray          # stamps [s]
    match: np.ndarray
    T_match_query: np.ndarray  # 4 x 4 each
    score: np.ndarray          # the higher, the surer

    def above(self, threshold: float) -> Detections:
        kept = self.score > threshold
        return Detections(self.query[kept], self.match[kept], self.T_match_query[kept],
                          self.score[kept])


@dataclass
class Loops:
    """Loops against the truth."""

    reported: int
    places: int          # of these, true places: closer than the loop distance, on the same floor
    true: int            # of these, with a pose that is right as well
    revisits: int        # submaps with an older one close by
    places_found: int    # of these, with a true place
    found: int           # of these, with a true loop
    error_m: np.ndarray  # of the true loops
    error_deg: np.ndarray

    @property
    def false(self) -> int:
        return self.reported - self.true

    def precision(self) -> float:
        return self.places / self.reported if self.reported else 1.0

    def recall(self) -> float:
        return self.places_found / max(1, self.revisits)

    def f1(self) -> float:
        both = self.precision() + self.recall()
        return 2.0 * self.precision() * self.recall() / both if both else 0.0


def angles(rotations: np.ndarray) -> np.ndarray:
    """Rotation angles of matrices [deg]."""
    traces = np.trace(rotations, axis1=1, axis2=2)
    return np.degrees(np.arccos(np.clip((traces - 1.0) / 2.0, -1.0, 1.0)))


def nearest(stamps: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Index of the nearest of sorted `stamps` for each wanted one."""
    after = np.clip(np.searchsorted(stamps, wanted), 1, len(stamps) - 1)
    before = after - 1
    return np.where(wanted - stamps[before] < stamps[after] - wanted, before, after)


class Truth:
    """True poses, looked up by the nearest stamp."""

    def __init__(self, path: Path) -> None:
        self.stamps, self.poses = figures.read_tum(path)

    def at(self, stamps: np.ndarray) -> np.ndarray:
        return self.poses[nearest(self.stamps, stamps)]


def revisits(poses: np.ndarray, distance_m: float) -> np.ndarray:
    """Which places were seen before, from closer than `distance_m` and on the same floor."""
    positions = poses[:, :3, 3]
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    again = np.zeros(len(positions), dtype=bool)
    for i, position in enumerate(positions):
        older = way < way[i] - RECENT_SHARE * distance_m
        again[i] = bool(np.any(same_place(positions[older] - position, distance_m)))
    return again


def same_place(offsets: np.ndarray, distance_m: float) -> np.ndarray:
    close = np.linalg.norm(offsets, axis=1) < distance_m
    return close & (np.abs(offsets[:, 2]) < SAME_FLOOR_M)


def submap_stamps(folder: Path) -> np.ndarray:
    """A submap is named by its middle keyframe: every fifth keyframe."""
    stamps, _ = figures.read_tum(folder / "map" / "poses.tum")
    return stamps[5::5]


def read_detections(path: Path, accepted_only: bool) -> Detections:
    """Reads loops.csv, or the file of another program: a row without match is no loop."""
    with path.open(newline="") as file:
        rows = [row for row in csv.DictReader(file)
                if row["match_stamp"] and (not accepted_only or row["accepted"] == "1")]
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    if rows:
        quaternions = np.array([[float(row[k]) for k in ("qx", "qy", "qz", "qw")] for row in rows])
        poses[:, :3, :3] = figures.rotations(quaternions)
        poses[:, :3, 3] = [[float(row[k]) for k in "xyz"] for row in rows]
    columns = [np.array([float(row[k]) for row in rows])
               for k in ("query_stamp", "match_stamp", "score")]
    return Detections(columns[0], columns[1], poses, columns[2])


def judge(loops: Detections, truth: Truth, submaps: np.ndarray, distance_m: float) -> Loops:
    """Compares with the truth; `submaps`: stamps of all that were asked for."""
    again = revisits(truth.at(submaps), distance_m)
    if len(loops.query) == 0:
        return Loops(0, 0, 0, int(again.sum()), 0, 0, np.zeros(0), np.zeros(0))
    true = np.linalg.inv(truth.at(loops.match)) @ truth.at(loops.query)
    offsets = truth.at(loops.match)[:, :3, 3] - truth.at(loops.query)[:, :3, 3]
    error = np.linalg.inv(true) @ loops.T_match_query
    error_m = np.linalg.norm(error[:, :3, 3], axis=1)
    place = same_place(offsets, distance_m)
    good = place & (error_m < FALSE_LOOP_M)
    asked = nearest(submaps, loops.query)
    known = np.abs(submaps[asked] - loops.query) < SAME_SUBMAP_S

    def found(kept: np.ndarray) -> int:
        return int(again[np.unique(asked[kept & known])].sum())

    return Loops(len(place), int(place.sum()), int(good.sum()), int(again.sum()), found(place),
                 found(good), error_m[good], angles(error[good, :3, :3]))


def best_threshold(loops: Detections, truth: Truth, submaps: np.ndarray,
                   distance_m: float) -> float:
    """The score above which loops have the highest F1."""
    scores = np.concatenate([[0.0], np.unique(loops.score)])
    f1 = [judge(loops.above(score), truth, submaps, distance_m).f1() for score in scores]
    return float(scores[int(np.argmax(f1))])


def detect_times(path: Path) -> np.ndarray:
    """Extraction and query of each submap by the file of another program [ms]."""
    with path.open(newline="") as file:
        return np.array([float(row["extract_ms"]) + float(row["query_ms"])
                         for row in csv.DictReader(file)])
