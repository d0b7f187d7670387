#!/usr/bin/python3
"""Prints the table of scripts/bench_loop.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

import odometry_figures as figures
from loop_figures import (Loops, Truth, best_threshold, detect_times, judge, read_detections,
                          submap_stamps)
from table_report import Report, machine, show

DRIFTED_M = 0.10           # odometry error from which loops must halve it
HALVED = 0.5
UNHARMED = 1.05
STRAIGHTENED_M = {5.0: 0.10, 10.0: 0.30}  # by the distance of the places of a loop
RECALL = 0.9
LOOP_ERROR_M = 0.05
LOOP_ERROR_DEG = 0.5
DETECT_MS = 20.0


def read_loops(folder: Path, truth: Truth, distance_m: float) -> Loops:
    loops = read_detections(folder / "loops.csv", accepted_only=True)
    return judge(loops, truth, submap_stamps(folder), distance_m)


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


def detect_ms(folder: Path) -> float:
    return json.loads((folder / "run.json").read_text())["loops"]["detect_ms"]["median"]


def loop_row(arguments: argparse.Namespace, name: str, distance_m: float, variant: str,
             report: Report) -> list[str]:
    folder = arguments.results / name / variant
    loops = read_loops(folder, Truth(arguments.data / name / "truth.tum"), distance_m)
    detect = detect_ms(folder)
    recall = loops.found / max(1, loops.revisits)
    precise = report.verdict(f"{name}, {variant}: {loops.false} false loops", loops.false == 0)
    complete = report.verdict(f"{name}, {variant}: recall {recall:.2f}", recall >= RECALL)
    if loops.true == 0:
        return [name, variant, str(loops.reported), str(loops.false), precise, f"{recall:.2f}",
                complete, "-", "-", f"{detect:.1f}"]
    metres, degrees = np.median(loops.error_m), np.median(loops.error_deg)
    worst = f"{100 * metres:.1f} / {100 * loops.error_m.max():.1f}"
    turned = f"{degrees:.2f} / {loops.error_deg.max():.2f}"
    report.verdict(f"{name}, {variant}: error of a loop {worst} cm, {turned} deg",
                   metres < LOOP_ERROR_M and degrees < LOOP_ERROR_DEG)
    report.verdict(f"{name}, {variant}: extraction and query {detect:.1f} ms", detect < DETECT_MS)
    return [name, variant, str(loops.reported), str(loops.false), precise, f"{recall:.2f}",
            complete, worst, turned, f"{detect:.1f}"]


def place_row(name: str, program: str, threshold: str, loops: Loops, detect_ms: float) -> list[str]:
    right = f"{loops.true / loops.reported:.2f}" if loops.reported else "-"
    error = f"{100 * np.median(loops.error_m):.1f}" if loops.true else "-"
    return [name, program, threshold, str(loops.reported), f"{loops.precision():.2f}",
            f"{loops.recall():.2f}", f"{loops.f1():.2f}", right, error, f"{detect_ms:.0f}"]


def peer_rows(arguments: argparse.Namespace, name: str, distance_m: float, program: str,
              results: Path) -> list[list[str]]:
    """One program by its own defaults and at the threshold with the best F1."""
    if not results.exists():
        return []
    truth = Truth(arguments.data / name / "truth.tum")
    submaps = submap_stamps(arguments.results / name / "as_is")
    every = read_detections(results, accepted_only=False)
    best = best_threshold(every, truth, submaps, distance_m)
    choices = [("its default", read_detections(results, accepted_only=True)),
               (f"{best:.2f}, best F1", every.above(best))]
    milliseconds = float(np.median(detect_times(results)))
    return [place_row(name, program, label, judge(loops, truth, submaps, distance_m), milliseconds)
            for label, loops in choices]


def place_rows(arguments: argparse.Namespace, name: str, distance_m: float) -> list[list[str]]:
    folder = arguments.results / name / "as_is"
    loops = read_loops(folder, Truth(arguments.data / name / "truth.tum"), distance_m)
    rows = [place_row(name, "HV-LIOM", "its default", loops, detect_ms(folder))]
    for program, peer_folder in arguments.peer:
        rows += peer_rows(arguments, name, distance_m, program, Path(peer_folder) / f"{name}.csv")
    return rows


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
    if arguments.peer:
        report.text("### Places beside other programs")
        report.table(["sequence", "program", "threshold", "reported", "precision", "recall", "F1",
                      "pose right", "its error [cm]", "detection, median [ms]"],
                     [row for sequence in sequences for row in place_rows(arguments, *sequence)])
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
    parser.add_argument("--peer", nargs=2, action="append", default=[],
                        metavar=("NAME", "DIR"))
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
