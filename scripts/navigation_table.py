#!/usr/bin/python3
"""Prints the table of scripts/bench_navigation.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from navigation_figures import Drives, read_drives
from table_report import Report, machine, show

REACHED_SHARE = 0.98
LENGTH_RATIO = 1.15
PLAN_MS = 100.0
LATE_PERCENT = 1.0
UPDATE_MS = 50.0
OCTREE_GROWTH = 1.5  # what grew with the way would double
RESPONSE_S = 5.0


def folders_of(arguments: argparse.Namespace, name: str, pattern: str) -> list[Path]:
    return sorted(path.parent for path in (arguments.results / name).glob(f"{pattern}/trials.csv"))


def drive_row(name: str, drives: Drives, report: Report) -> list[str]:
    goals = len(drives.reached)
    reached = int(drives.reached.sum())
    collisions = int(drives.collisions.sum())
    ratio = drives.length_ratio()
    return [name, f"{reached} of {goals}",
            report.verdict(f"{name}: {reached} of {goals} reached",
                           reached >= REACHED_SHARE * goals),
            str(collisions),
            report.verdict(f"{name}: {collisions} collisions", collisions == 0),
            str(int(drives.hit_by_people.sum())), f"{ratio:.3f}",
            report.verdict(f"{name}: {ratio:.3f} times the grid-optimal length",
                           ratio <= LENGTH_RATIO),
            str(int(drives.recoveries.sum())), f"{100 * drives.worst_place_m.max():.0f}"]


def time_row(name: str, drives: Drives, report: Report) -> list[str]:
    plan_ms = float(np.median(drives.plan_ms))
    late = drives.late_percent()
    update = float(np.percentile(drives.update_ms, 95))
    return [name, f"{plan_ms:.0f} / {drives.plan_ms.max():.0f}",
            report.verdict(f"{name}: plan in {plan_ms:.0f} ms", plan_ms < PLAN_MS),
            f"{np.median(drives.control_ms):.1f} / {drives.control_ms.max():.0f}", f"{late:.2f}",
            report.verdict(f"{name}: {late:.2f} % of cycles late", late <= LATE_PERCENT),
            f"{np.median(drives.update_ms):.0f} / {update:.0f}",
            report.verdict(f"{name}: map update in {update:.0f} ms", update < UPDATE_MS),
            f"{drives.octree_nodes.max() / 1e6:.2f}", f"{drives.octree_growth:.2f}",
            report.verdict(f"{name}: the octree grows {drives.octree_growth:.2f} times",
                           drives.octree_growth <= OCTREE_GROWTH)]


def low_row(name: str, drives: Drives, report: Report) -> list[str]:
    good = int(np.count_nonzero((drives.reached > 0) & (drives.collisions == 0)))
    return [name, "box 0.15 m high", f"{good} of {len(drives.reached)} reached, no collision",
            report.verdict(f"{name}: low boxes avoided in {good} of {len(drives.reached)}",
                           good == len(drives.reached))]


def blocked_row(name: str, drives: Drives, report: Report) -> list[str]:
    answered = drives.response_s >= 0.0
    slowest = float(drives.response_s.max()) if answered.all() else float("inf")
    collisions = int(drives.collisions.sum())
    return [name, "corridor blocked",
            f"answer after {np.median(drives.response_s):.1f} / {slowest:.1f} s, "
            f"{int(drives.reached.sum())} of {len(drives.reached)} reached, "
            f"{collisions} collisions",
            report.verdict(f"{name}: blocked corridor answered after {slowest:.1f} s",
                           slowest <= RESPONSE_S and collisions == 0)]


def scenario_rows(arguments: argparse.Namespace, report: Report) -> list[list[str]]:
    rows = []
    for pattern, row in (("low_obstacles", low_row), ("blocked_corridor", blocked_row)):
        for name in arguments.world:
            if folders := folders_of(arguments, name, pattern):
                rows.append(row(name, read_drives(folders), report))
    return rows


def make_report(arguments: argparse.Namespace) -> Report:
    report = Report()
    report.text(machine(1) + f" {arguments.processes} drives at once, "
                f"{100 * arguments.point_share:.0f} % of the LiDAR's columns.")
    worlds = {name: read_drives(folders) for name in arguments.world
              if (folders := folders_of(arguments, name, "random_*"))}
    report.text("### Random goals")
    report.table(["world", "reached", "98 %", "collisions", "none", "hit by people while standing",
                  "driven / optimal", f"<= {LENGTH_RATIO}", "recoveries",
                  "worst error of place [cm]"],
                 [drive_row(name, drives, report) for name, drives in worlds.items()])
    report.text("### Times")
    report.table(["world", "plan: median / max [ms]", "< 100", "control: median / max [ms]",
                  "above 100 ms [%]", "<= 1 %", "map update: median / 95 % [ms]", "< 50",
                  "octree [10^6 nodes]", "second half / first half", f"<= {OCTREE_GROWTH}"],
                 [time_row(name, drives, report) for name, drives in worlds.items()])
    report.text("### Surprises")
    report.table(["world", "what", "outcome", "reached"], scenario_rows(arguments, report))
    for name, drives in worlds.items():
        report.lines += [f"- {name}: {reason}" for reason in drives.reasons]
    report.text(f"{report.checked - len(report.missed)} of {report.checked} limits reached.")
    for missed in report.missed:
        report.lines.append(f"- missed: {missed}")
    return report


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--world", action="append", default=[], metavar="NAME")
    parser.add_argument("--point-share", type=float, required=True)
    parser.add_argument("--processes", type=int, required=True)
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    show("\n".join(make_report(arguments).lines), arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
