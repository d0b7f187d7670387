#!/usr/bin/python3
"""Prints the table of scripts/bench_relocalization.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from relocalization_figures import Trials, read_run, read_trials
from table_report import Report, machine, show

OFFSETS = (1, 5, 10, 15)
SUCCESS_PERCENT = {1: 100, 5: 99, 10: 95, 15: 80}
METHODS = (("search", "levels 10, 5, 3, 1 m and search"), ("ndt", "levels 10, 5, 3, 1 m"),
           ("single3", "single level 3 m"), ("without10", "without 10 m"),
           ("without1", "without 1 m"), ("pcl", "NDT of PCL, 1 m"))
RMSE_M = 0.02              # of the successes, on simulated data
LEVELS_MS = 50.0
FIRST_POSE_MS = 3000.0
CHANGED_PERCENT = 95
DRIVE_M = 0.03
DRIVE_DEG = 0.15
GROWTH_M = 0.005
BACK_S = 5.0
EVENT_S = 40.0             # of the faults in the recordings
BLACKOUT_S = 10.0


def guess_row(folder: Path, name: str, method: str, label: str, simulated: bool,
              report: Report) -> list[str] | None:
    if not (folder / f"{method}_1.csv").exists():
        return None
    trials = {offset: read_trials(folder / f"{method}_{offset}.csv") for offset in OFFSETS}
    cells = []
    for offset in OFFSETS:
        percent = trials[offset].percent()
        cells.append(f"{percent:.0f}")
        if method == "search":
            report.verdict(f"{name}: {percent:.0f} % at {offset} m",
                           percent >= SUCCESS_PERCENT[offset])
    rmse = trials[1].rmse_m()
    milliseconds = float(np.median(trials[1].ms))
    if method == "search" and simulated:
        report.verdict(f"{name}: RMSE {100 * rmse:.2f} cm", rmse < RMSE_M)
    if method == "ndt" and simulated:
        report.verdict(f"{name}: levels in {milliseconds:.0f} ms", milliseconds < LEVELS_MS)
    return [name, label, *cells, f"{100 * rmse:.2f}", f"{milliseconds:.0f}"]


def peer_row(folder: Path, name: str, peer: str) -> list[str]:
    trials = {offset: read_trials(folder / f"{name}_{offset}.csv") for offset in OFFSETS}
    return [name, peer, *(f"{trials[offset].percent():.0f}" for offset in OFFSETS),
            f"{100 * trials[1].rmse_m():.2f}", f"{np.median(trials[1].ms):.0f}"]


def guess_rows(arguments: argparse.Namespace, name: str, simulated: bool,
               report: Report) -> list[list[str]]:
    rows = [guess_row(arguments.results / name, name, method, label, simulated, report)
            for method, label in METHODS]
    peers = [(peer, Path(folder)) for peer, folder in arguments.peer
             if (Path(folder) / f"{name}_1.csv").exists()]
    return [row for row in rows if row is not None] + [peer_row(folder, name, peer)
                                                       for peer, folder in peers]


def anywhere_row(arguments: argparse.Namespace, name: str, report: Report) -> list[str]:
    folder = arguments.results / name
    trials = read_trials(folder / "anywhere.csv")
    found = int(np.count_nonzero(trials.successes()))
    verdict = report.verdict(f"{name}: {found} of {len(trials.ms)} without a guess",
                             found == len(trials.ms))
    wrong = int(np.count_nonzero((trials.localized > 0) & ~trials.successes()))
    elsewhere = [read_trials(path) for path in sorted(folder.glob("elsewhere_*.csv"))]
    asked = sum(len(one.ms) for one in elsewhere)
    accepted = int(sum(np.count_nonzero(one.localized > 0) for one in elsewhere))
    slowest = float(trials.ms.max())
    refusals = part = "-"
    if asked:
        astray = read_trials(folder / "part.csv")
        in_part = int(np.count_nonzero((astray.localized > 0) & ~astray.successes()))
        part = f"{in_part} of {len(astray.ms)}"
        report.verdict(f"{name}: {in_part} wrong in the map of a part", in_part == 0)
        report.verdict(f"{name}: {accepted} false acceptances", accepted == 0)
        report.verdict(f"{name}: slowest answer {slowest:.0f} ms", slowest < FIRST_POSE_MS)
        refused_ms = np.concatenate([one.ms for one in elsewhere])
        refusals = f"{np.median(refused_ms):.0f} / {refused_ms.max():.0f}"
    return [name, f"{found} of {len(trials.ms)}", verdict, str(wrong),
            f"{100 * trials.rmse_m():.2f}", f"{np.median(trials.ms):.0f} / {slowest:.0f}",
            f"{accepted} of {asked}" if asked else "-", part, refusals]


def changed_row(arguments: argparse.Namespace, name: str, report: Report) -> list[str]:
    trials: Trials = read_trials(arguments.results / name / "changed.csv")
    percent = trials.percent()
    return [name, f"{percent:.0f}", f"{100 * trials.rmse_m():.2f}",
            report.verdict(f"{name}: {percent:.0f} % in a changed map",
                           percent >= CHANGED_PERCENT)]


def drive_row(arguments: argparse.Namespace, name: str, report: Report) -> list[str]:
    run = read_run(arguments.results / name / "drive", arguments.data / name)
    metres, degrees = float(run.error_m.mean()), float(run.error_deg.mean())
    near = report.verdict(f"{name}: mean error {100 * metres:.1f} cm, {degrees:.2f} deg",
                          metres < DRIVE_M and degrees < DRIVE_DEG)
    steady = report.verdict(f"{name}: growth {100 * run.growth_m():.1f} cm",
                            run.growth_m() < GROWTH_M)
    cells = [name, f"{100 * metres:.2f}", f"{100 * run.error_m.max():.1f}", f"{degrees:.3f}", near,
             f"{100 * run.growth_m():+.2f}", steady, f"{run.track_ms:.0f}"]
    for variant, event_s in (("blackout", EVENT_S + BLACKOUT_S), ("kidnapped", EVENT_S)):
        run = read_run(arguments.results / name / variant, arguments.data / name)
        lost = run.says_lost(EVENT_S, BLACKOUT_S + 1.0)
        back_s = run.back_after_s(event_s)
        cells += ["yes" if lost else "no", f"{back_s:.1f}",
                  report.verdict(f"{name}, {variant}: back after {back_s:.1f} s",
                                 lost and back_s < BACK_S)]
    return cells


def refurnished_row(arguments: argparse.Namespace, name: str) -> list[str]:
    run = read_run(arguments.results / name / "refurnished", arguments.data / name)
    return [name, f"{100 * run.localized_share:.1f}", f"{run.first_pose_s:.1f}",
            f"{100 * run.error_m.mean():.2f}", f"{100 * run.error_m.max():.1f}",
            f"{run.error_deg.mean():.3f}"]


def make_report(arguments: argparse.Namespace) -> Report:
    report = Report()
    report.text(machine(2).replace("2 thread(s) a scan.", "all used."))
    report.text("### With a guess (paper, Table 6)")
    rows = [row for name in arguments.world for row in guess_rows(arguments, name, True, report)]
    rows += [row for name in arguments.real for row in guess_rows(arguments, name, False, report)]
    report.table(["map", "method", "1 m 1 deg [%]", "5 m 5 deg", "10 m 10 deg", "15 m 15 deg",
                  "RMSE at 1 m [cm]", "median [ms]"], rows)
    report.text("### Without a guess")
    report.table(["map", "found", "all", "wrong", "RMSE [cm]", "median / slowest [ms]",
                  "accepted from elsewhere", "wrong in the map of a part", "refused in: median / slowest [ms]"],
                 [anywhere_row(arguments, name, report)
                  for name in arguments.world + arguments.real])
    if arguments.world:
        report.text("### In a map that has changed by 20 %, guess off by 1 m and 1 deg")
        report.table(["map", "found [%]", "RMSE [cm]", f">= {CHANGED_PERCENT}"],
                     [changed_row(arguments, name, report) for name in arguments.world])
        report.text("### While driving")
        report.table(["map", "mean [cm]", "max [cm]", "mean [deg]", "< 3 cm, 0.15 deg",
                      "growth [cm]", "none", "comparison [ms]", "lost in blackout",
                      "back after [s]", "< 5 s", "lost when kidnapped", "back after [s]", "< 5 s"],
                     [drive_row(arguments, name, report) for name in arguments.world])
        report.text("### While driving, with everything that stands around placed anew")
        report.table(["map", "localised [% of scans]", "first place after [s]", "mean [cm]",
                      "max [cm]", "mean [deg]"],
                     [refurnished_row(arguments, name) for name in arguments.world])
    report.text(f"{report.checked - len(report.missed)} of {report.checked} limits reached.")
    for missed in report.missed:
        report.lines.append(f"- missed: {missed}")
    return report


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--world", action="append", default=[], metavar="NAME")
    parser.add_argument("--real", action="append", default=[], metavar="NAME")
    parser.add_argument("--peer", nargs=2, action="append", default=[], metavar=("NAME", "DIR"))
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    show("\n".join(make_report(arguments).lines), arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
