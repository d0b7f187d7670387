#!/usr/bin/python3
"""Prints the table of scripts/soak.sh, and draws the memory of the nodes over time."""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

from table_report import Report, machine, show

WARM_UP_SHARE = 0.25  # of a phase
GROWTH_MB_PER_H = 2.0


def read_memory(path: Path) -> dict[str, dict[str, np.ndarray]]:
    """Phase -> node -> rows of hours and MB."""
    rows = defaultdict(lambda: defaultdict(list))
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            rows[row["phase"]][row["node"]].append((float(row["time_s"]) / 3600, float(row["mb"])))
    return {phase: {node: np.array(values) for node, values in nodes.items()}
            for phase, nodes in rows.items()}


def memory_row(phase: str, node: str, values: np.ndarray, report: Report) -> list[str]:
    warm = values[values[:, 0] >= WARM_UP_SHARE * values[-1, 0]]
    if len(warm) < 3:
        return [phase, node, "", "", "", "too short"]
    slope = float(np.polyfit(warm[:, 0], warm[:, 1], 1)[0])
    verdict = report.verdict(f"{phase}, {node}: grows by {slope:.1f} MB/h",
                             slope <= GROWTH_MB_PER_H)
    return [phase, node, f"{warm[0, 1]:.0f}", f"{warm[-1, 1]:.0f}", f"{slope:+.1f}", verdict]


def draw(memory: dict[str, dict[str, np.ndarray]], results: Path, program: Path) -> None:
    curves = results / "memory_curves.csv"
    with curves.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["panel", "curve", "x", "y"])
        for phase, nodes in memory.items():
            for node, values in nodes.items():
                writer.writerows([phase, node, f"{x:.4f}", f"{y:.2f}"] for x, y in values)
    subprocess.run([str(program), "--curves", str(curves), "--title", "Memory of the nodes",
                    "--x-label", "simulated time [h]", "--y-label", "[MB]", "--out",
                    str(results / "memory.png")], check=True, stdout=subprocess.DEVNULL)


def make_report(arguments: argparse.Namespace) -> Report:
    phases = json.loads((arguments.results / "soak.json").read_text())
    memory = read_memory(arguments.results / "memory.csv")
    draw(memory, arguments.results, arguments.plot)
    report = Report()
    report.text(f"{machine(1)} Memory by the operating system, after the first "
                f"{100 * WARM_UP_SHARE:.0f} % of each phase.")
    report.table(["phase", "simulated [h]", "goals reached", "refused", "ended well"],
                 [[phase["name"], f"{phase['hours']:.2f}", str(phase["goals"]),
                   str(len(phase["refused"])),
                   report.verdict(f"{phase['name']}: {phase['failure']}", not phase["failure"])]
                  for phase in phases])
    report.table(["phase", "node", "warm [MB]", "in the end [MB]", "growth [MB/h]",
                  f"at most {GROWTH_MB_PER_H:.0f}"],
                 [memory_row(phase, node, values, report)
                  for phase, nodes in memory.items() for node, values in sorted(nodes.items())])
    report.text(f"{report.checked - len(report.missed)} of {report.checked} limits reached.")
    report.lines += [f"- missed: {missed}" for missed in report.missed]
    return report


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--plot", type=Path, required=True, help="hv_plot_curves")
    parser.add_argument("--markdown", type=Path)
    arguments = parser.parse_args()
    show("\n".join(make_report(arguments).lines), arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
