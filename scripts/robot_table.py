#!/usr/bin/python3
"""Prints the table of scripts/bench_robot.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import json
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

from table_report import Report, machine, show

ODOMETRY_P99_MS = 30.0
STAGES = ("exploration", "drive")


def read_stories(folder: Path) -> list[dict]:
    paths = sorted(folder.glob("*/story.json"), key=lambda path: int(path.parent.name))
    return [json.loads(path.read_text()) for path in paths]


def spread(values: list[float], digits: int = 0) -> str:
    """Median and largest."""
    if not values:
        return ""
    return f"{np.median(values):.{digits}f} / {max(values):.{digits}f}"


def story_row(name: str, stories: list[dict], report: Report) -> list[str]:
    told = [story for story in stories if not story["failure"]]
    collisions = sum(story[stage]["collisions"] for story in stories for stage in STAGES)
    explorations = [story["exploration"] for story in stories]
    return [name, f"{len(told)} of {len(stories)}",
            report.verdict(f"{name}: {len(told)} of {len(stories)} stories",
                           len(told) == len(stories)),
            str(collisions), spread([story["explored_m2"] for story in stories]),
            spread([stage["travelled_m"] for stage in explorations]),
            spread([stage["seconds"] for stage in explorations]),
            spread([story["found_after_s"] for story in told], 1),
            spread([100 * story["found_error_m"] for story in told]),
            spread([story["drive"]["travelled_m"] for story in told]),
            spread([100 * story["goal_error_m"] for story in told])]


def load_rows(stories: dict[str, list[dict]]) -> list[list[str]]:
    """Of each node: cores and memory, over all stories of all buildings."""
    cores, memory = defaultdict(list), defaultdict(list)
    for story in (story for told in stories.values() for story in told):
        for stage in STAGES:
            for node, load in story[stage]["load"].items():
                cores[stage, node].append(load["cores"])
                memory[stage, node].append(load["mb"])
    return [[stage, node, spread(cores[stage, node], 2), spread(memory[stage, node])]
            for stage, node in sorted(cores)]


def latency_rows(name: str, stories: list[dict], report: Report) -> list[list[str]]:
    rows = []
    for stage in STAGES:
        for what in ("scan_to_pose", "obstacles_to_velocity"):
            latencies = [story[stage]["latency_ms"].get(what, {}) for story in stories]
            latencies = [latency for latency in latencies if "p99" in latency]
            if not latencies:
                continue
            p99 = max(latency["p99"] for latency in latencies)
            verdict = ""
            if what == "scan_to_pose":
                verdict = report.verdict(f"{name}, {stage}: pose after {p99:.0f} ms at the 99th "
                                         "percentile", p99 < ODOMETRY_P99_MS)
            rows.append([name, stage, what.replace("_", " "),
                         *(spread([latency[key] for latency in latencies], 1)
                           for key in ("median", "p99", "max")), verdict])
    return rows


def make_report(arguments: argparse.Namespace) -> Report:
    report = Report()
    report.text(f"{machine(1)} All nodes of the robot and its simulation, "
                f"{100 * arguments.point_share:.0f} % of the LiDAR's columns, {arguments.rate:g} "
                "simulated seconds per second. Median / largest of the stories.")
    stories = {name: told for name in arguments.building
               if (told := read_stories(arguments.results / name))}
    report.text("### Stories")
    report.table(["building", "told to the end", "all", "collisions", "explored [m^2]",
                  "explored on [m]", "explored in [s]", "found after [s]", "found within [cm]",
                  "driven [m]", "goal missed by [cm]"],
                 [story_row(name, told, report) for name, told in stories.items()])
    report.text("### Load")
    report.table(["stage", "node", "cores", "memory [MB]"], load_rows(stories))
    report.text("### Latency")
    report.table(["building", "stage", "from - to", "median [ms]", "99th percentile [ms]",
                  "longest [ms]", f"99th percentile < {ODOMETRY_P99_MS:.0f} ms"],
                 [row for name, told in stories.items()
                  for row in latency_rows(name, told, report)])
    for name, told in stories.items():
        report.lines += [f"- {name}: {story['failure']}" for story in told if story["failure"]]
    report.text(f"{report.checked - len(report.missed)} of {report.checked} limits reached.")
    report.lines += [f"- missed: {missed}" for missed in report.missed]
    return report


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--building", action="append", default=[], metavar="NAME")
    parser.add_argument("--point-share", type=float, required=True)
    parser.add_argument("--rate", type=float, required=True)
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    show("\n".join(make_report(arguments).lines), arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
