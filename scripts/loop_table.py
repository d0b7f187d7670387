#!/usr/bin/python3
"""Prints the table of scripts/bench_loop.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import odometry_figures as figures
from table_report import Report, machine, show

DRIFTED_M = 0.10           # odometry error from which loops must halve it
HALVED = 0.5
UNHARMED = 1.05
STRAIGHTENED_M = {5.0: 0.10, 10.0: 0.30}  # by the distance of the places of a loop
RECALL = 0.9
LOOP_ERROR_M = 0.05
LOOP_ERROR_DEG = 0.5
DETECT_MS = 20.0
FALSE_LOOP_M = 0.5         # an accepted loop is false when its pose is off by more than this
RECENT_SHARE = 3.0         # of the loop distance: way back that is no revisit
SAME_FLOOR_M = 2.0


@dataclass
class Loops:
    """Accepted loops of one run against the truth."""

    accepted: int
    false: int
    revisits: int        # submaps with an older one close by
    found: int           # of these, with an accepted true loop
    error_m: np.ndarray
    error_deg: np.ndarray


def angles(rotations: np.ndarray) -> np.ndarray:
    """Rotation angles of matrices [deg]."""
    traces = np.trace(rotations, axis1=1, axis2=2)
    return np.degrees(np.arccos(np.clip((traces - 1.0) / 2.0, -1.0, 1.0)))


class Truth:
    """True poses, looked up by the nearest stamp."""

    def __init__(self, path: Path) -> None:
        self.stamps, self.poses = figures.read_tum(path)

    def at(self, stamps: np.ndarray) -> np.ndarray:
        after = np.clip(np.searchsorted(self.stamps, stamps), 1, len(self.stamps) - 1)
        before = after - 1
        nearer = stamps - self.stamps[before] < self.stamps[after] - stamps
        return self.poses[np.where(nearer, before, after)]


def revisits(poses: np.ndarray, distance_m: float) -> np.ndarray:
    """Which places were seen before, from closer than `distance_m` and on the same floor."""
    positions = poses[:, :3, 3]
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    again = np.zeros(len(positions), dtype=bool)
    for i, position in enumerate(positions):
        older = way < way[i] - RECENT_SHARE * distance_m
        offset = positions[older] - position
        close = np.linalg.norm(offset, axis=1) < distance_m
        again[i] = bool(np.any(close & (np.abs(offset[:, 2]) < SAME_FLOOR_M)))
    return again


def read_loops(folder: Path, truth: Truth, distance_m: float) -> Loops:
    with (folder / "loops.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["accepted"] == "1"]
    # A submap is named by its middle keyframe: every fifth keyframe.
    stamps, _ = figures.read_tum(folder / "map" / "poses.tum")
    again = revisits(truth.at(stamps[5::5]), distance_m)
    if not rows:
        return Loops(0, 0, int(again.sum()), 0, np.zeros(0), np.zeros(0))
    query = truth.at(np.array([float(row["query_stamp"]) for row in rows]))
    match = truth.at(np.array([float(row["match_stamp"]) for row in rows]))
    true = np.linalg.inv(match) @ query
    measured = np.tile(np.eye(4), (len(rows), 1, 1))
    quaternions = np.array([[float(row[k]) for k in ("qx", "qy", "qz", "qw")] for row in rows])
    measured[:, :3, :3] = figures.rotations(quaternions)
    measured[:, :3, 3] = [[float(row[k]) for k in "xyz"] for row in rows]
    error = np.linalg.inv(true) @ measured
    error_m = np.linalg.norm(error[:, :3, 3], axis=1)
    close = np.linalg.norm(true[:, :3, 3], axis=1) < distance_m
    good = (error_m < FALSE_LOOP_M) & close
    found = {row["query"] for row, is_good in zip(rows, good) if is_good}
    return Loops(len(rows), int((~good).sum()), int(again.sum()), len(found), error_m[good],
                 angles(error[:, :3, :3])[good])


def rmse(arguments: argparse.Namespace, name: str, variant: str, trajectory: str) -> float:
    folder = arguments.results / name / variant
    error = figures.ape(arguments.ape, arguments.data / name / "truth.tum", folder / trajectory)
    return error["ape_m"]["rmse"]


def map_row(arguments: argparse.Namespace, name: str, distance_m: float,
            report: Report) -> list[str]:
    before = rmse(arguments, name, "as_is", "odometry.tum")
    after = rmse(arguments, name, "as_is", "trajectory.tum")
    limit = HALVED if before > DRIFTED_M else UNHARMED
    kept = report.verdict(f"{name}: error with loops {after / before:.2f} x odometry",
                          after <= limit * before)
    drifted = rmse(arguments, name, "drift", "odometry.tum")
    mended = rmse(arguments, name, "drift", "trajectory.tum")
    most = STRAIGHTENED_M[distance_m]
    straight = report.verdict(f"{name}: {100 * mended:.1f} cm after injected drift", mended < most)
    return [name, f"{100 * before:.2f}", f"{100 * after:.2f}", f"{after / before:.2f}",
            f"<= {limit}", kept, f"{100 * drifted:.0f}", f"{100 * mended:.1f}",
            f"< {100 * most:.0f}", straight]


def loop_row(arguments: argparse.Namespace, name: str, distance_m: float, variant: str,
             report: Report) -> list[str]:
    folder = arguments.results / name / variant
    loops = read_loops(folder, Truth(arguments.data / name / "truth.tum"), distance_m)
    detect = json.loads((folder / "run.json").read_text())["loops"]["detect_ms"]["median"]
    recall = loops.found / max(1, loops.revisits)
    precise = report.verdict(f"{name}, {variant}: {loops.false} false loops", loops.false == 0)
    complete = report.verdict(f"{name}, {variant}: recall {recall:.2f}", recall >= RECALL)
    if loops.accepted == loops.false:
        return [name, variant, str(loops.accepted), str(loops.false), precise, f"{recall:.2f}",
                complete, "-", "-", f"{detect:.1f}"]
    metres, degrees = np.median(loops.error_m), np.median(loops.error_deg)
    worst = f"{100 * metres:.1f} / {100 * loops.error_m.max():.1f}"
    turned = f"{degrees:.2f} / {loops.error_deg.max():.2f}"
    report.verdict(f"{name}, {variant}: error of a loop {worst} cm, {turned} deg",
                   metres < LOOP_ERROR_M and degrees < LOOP_ERROR_DEG)
    report.verdict(f"{name}, {variant}: extraction and query {detect:.1f} ms", detect < DETECT_MS)
    return [name, variant, str(loops.accepted), str(loops.false), precise, f"{recall:.2f}",
            complete, worst, turned, f"{detect:.1f}"]


def make_report(arguments: argparse.Namespace) -> Report:
    sequences = [(name, float(distance)) for name, distance in arguments.sequence]
    report = Report()
    report.text(machine(1))
    report.text("### Maps")
    report.table(["sequence", "odometry [cm]", "with loops [cm]", "ratio", "limit", "reached",
                  "drifting odometry [cm]", "with loops [cm]", "limit", "reached"],
                 [map_row(arguments, *sequence, report) for sequence in sequences])
    report.text("### Loops")
    report.table(["sequence", "odometry", "accepted", "false", "none false", "recall",
                  f">= {RECALL}", "error median / max [cm]", "[deg]", "detection, median [ms]"],
                 [loop_row(arguments, *sequence, variant, report)
                  for sequence in sequences for variant in ("as_is", "drift")])
    report.text(f"{report.checked - len(report.missed)} of {report.checked} limits reached.")
    for missed in report.missed:
        report.lines.append(f"- missed: {missed}")
    return report


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--ape", type=Path, required=True, help="the program hv_ape")
    parser.add_argument("--sequence", nargs=2, action="append", required=True,
                        metavar=("NAME", "DISTANCE"))
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    try:
        text = "\n".join(make_report(arguments).lines).rstrip() + "\n"
    except (OSError, ValueError, KeyError, subprocess.CalledProcessError) as error:
        print(f"loop_table: {error}", file=sys.stderr)
        return 1
    show(text, arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
