#!/usr/bin/python3
"""Prints the table of scripts/bench_recordings.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from odometry_figures import ape, read_columns
from table_report import Report, machine, show

HEADER = ["recording", "path [m]", "program", "max [m]", "mean [m]", "median [m]", "RMSE [m]",
          "std [m]", "rotation RMSE [deg]", "median [ms]", "p99 [ms]"]


def times_of(folder: Path) -> list[str]:
    """Median and 99th percentile of the time a scan."""
    if not (folder / "timing.csv").is_file():
        return ["", ""]
    total = read_columns(folder / "timing.csv")["total_ms"]
    return [f"{np.median(total):.1f}", f"{np.percentile(total, 99):.1f}"]


def row(name: str, truth: Path, program: str, trajectory: Path,
        arguments: argparse.Namespace) -> list[str]:
    error = ape(arguments.ape, truth, trajectory)
    metres = error["ape_m"]
    return [name, f"{error['path_length_m']:.0f}", program,
            *(f"{metres[key]:.3f}" for key in ("max", "mean", "median", "rmse", "std")),
            f"{error['rotation_deg']['rmse']:.2f}", *times_of(trajectory.parent)]


def rows_of(name: str, truth: Path, arguments: argparse.Namespace) -> list[list[str]]:
    """Odometry, the same after loop closing, and the other programs; what is missing is left out."""
    trajectories = [("odometry", arguments.results / name / "odometry.tum"),
                    ("after loops", arguments.results / name / "trajectory.tum")]
    trajectories += [(peer, Path(folder) / name / "trajectory.tum")
                     for peer, folder in arguments.peer]
    return [row(name, truth, program, path, arguments) for program, path in trajectories
            if path.is_file() and truth.is_file()]


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--recording", nargs=2, action="append", default=[],
                        metavar=("NAME", "TRUTH"))
    parser.add_argument("--peer", nargs=2, action="append", default=[], metavar=("NAME", "DIR"))
    parser.add_argument("--ape", type=Path, required=True, help="the program hv_ape")
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    report = Report()
    report.text(machine(1))
    report.text("Errors of the position against the truth after SE(3) alignment.")
    rows = [row for name, truth in arguments.recording
            for row in rows_of(name, Path(truth), arguments)]
    if not rows:
        print("recordings_table: no results yet", file=sys.stderr)
        return 1
    report.table(HEADER, rows)
    show("\n".join(report.lines), arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
