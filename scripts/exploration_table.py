#!/usr/bin/python3
"""Prints the table of scripts/bench_exploration.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

import numpy as np

from exploration_figures import (Drive, Runs, mean_curve, pooled, read_drive, read_runs, share_of,
                                 write_curves)
from table_report import Report, machine, show

OF_UTILITY = 0.94
OF_ORACLE = 1.20
DONE_WITHOUT_GUARD = 0.95
EXPLORED_PERCENT = 98.0
LATE_PERCENT = 95  # explored, from which on the rest takes long
WITHOUT_GUARD = "sac_without_guard"


def read_dungeons(arguments: argparse.Namespace) -> dict[str, dict[str, Runs]]:
    """By set and result; those of all sets together under `all`."""
    results = [*arguments.planner, WITHOUT_GUARD, "oracle"]
    sets = {}
    for name in arguments.dungeons:
        folder = arguments.results / "dungeons" / name
        sets[name] = {result: runs for result in results if (runs := read_runs(folder / result))}
    if len(sets) > 1:
        sets["all"] = {result: pooled([runs[result] for runs in sets.values()])
                       for result in results if all(result in runs for runs in sets.values())}
    return sets


def dungeon_row(name: str, result: str, sets: dict[str, Runs], report: Report) -> list[str]:
    runs = sets[result]
    done = int(runs.done.sum())
    guarded = result != WITHOUT_GUARD
    of_utility = "utility" in sets and result != "utility"
    return [name, result.replace("_", " "), f"{done} of {len(runs.maps)}",
            report.verdict(f"{name}: {result} finished {done} of {len(runs.maps)} maps",
                           runs.all_done()) if guarded else "-",
            f"{runs.travel.mean():.0f}",
            str(share_of(runs, sets["utility"])) if of_utility else "-",
            f"{runs.decision_ms.mean():.2f}", str(runs.loops_broken) if guarded else "-"]


def policy_rows(sets: dict[str, dict[str, Runs]], report: Report) -> list[list[str]]:
    """What the learned policy has to come up to."""
    first, together = next(iter(sets.items())), list(sets.items())[-1]
    rows = []
    for (name, runs), other, limit in ((together, "utility", OF_UTILITY),
                                       (first, "oracle", OF_ORACLE)):
        if "sac" in runs and other in runs:
            share = share_of(runs["sac"], runs[other])
            rows.append([f"travel, of that of `{other}`", name, str(share), f"<= {limit:.2f}",
                         report.verdict(f"{name}: sac drives {share.value:.3f} of {other}",
                                        share.value <= limit)])
    name, runs = together
    if WITHOUT_GUARD in runs:
        done = float(runs[WITHOUT_GUARD].done.mean())
        rows.append(["finished without loop guard [%]", name, f"{100 * done:.1f}",
                     f">= {100 * DONE_WITHOUT_GUARD:.0f}",
                     report.verdict(f"{name}: {100 * done:.1f} % finished without loop guard",
                                    done >= DONE_WITHOUT_GUARD)])
    return rows


def report_dungeons(arguments: argparse.Namespace, report: Report) -> None:
    sets = read_dungeons(arguments)
    report.text("### Dungeons")
    report.table(["maps", "planner", "finished", "all", "travel [px]",
                  "of `utility`, 95 % interval", "decision [ms]", "loops broken"],
                 [dungeon_row(name, result, runs, report)
                  for name, runs in sets.items() for result in runs])
    if rows := policy_rows(sets, report):
        report.text("### The learned policy")
        report.table(["what", "maps", "measured", "limit", "reached"], rows)


def read_worlds(arguments: argparse.Namespace,
                report: Report) -> dict[str, dict[str, list[Drive]]]:
    """By world and planner. A drive that is missing is a limit missed."""
    worlds: dict[str, dict[str, list[Drive]]] = {}
    for name in arguments.world:
        for planner in arguments.planner:
            folder = arguments.results / "worlds" / name
            for start in range(1, arguments.starts + 1):
                if drive := read_drive(folder / f"{planner}_{start}", start):
                    worlds.setdefault(name, {}).setdefault(planner, []).append(drive)
                else:
                    report.verdict(f"{name}: {planner}, start {start} has no result", False)
    return worlds


def mean_of(drives: list[Drive], key: str) -> float:
    return float(np.mean([drive.summary[key] for drive in drives]))


def late_known(drives: list[Drive], key: str) -> str:
    points = [drive.known(LATE_PERCENT) for drive in drives]
    return "-" if None in points else f"{np.mean([point[key] for point in points]):.0f}"


def of_utility(drives: list[Drive], planners: dict[str, list[Drive]]) -> str:
    """Of the distance of `utility`, from the same starts, where all have come to the end."""
    others = planners.get("utility", [])
    if drives is others or [drive.start for drive in drives] != [drive.start for drive in others]:
        return "-"
    if any(100.0 * drive.summary["share"] < EXPLORED_PERCENT for drive in [*drives, *others]):
        return "-"
    return f"{mean_of(drives, 'travelled_m') / mean_of(others, 'travelled_m'):.2f}"


def world_row(name: str, planner: str, planners: dict[str, list[Drive]],
              report: Report) -> list[str]:
    drives = planners[planner]
    least = min(100.0 * drive.summary["share"] for drive in drives)
    collisions = sum(drive.summary["collisions"] for drive in drives)
    what = f"{name}, {planner}"
    return [name, planner, str(len(drives)), f"{100 * mean_of(drives, 'share'):.1f} / {least:.1f}",
            report.verdict(f"{what}: {least:.1f} % explored", least >= EXPLORED_PERCENT),
            f"{mean_of(drives, 'travelled_m'):.0f}", of_utility(drives, planners),
            f"{mean_of(drives, 'time_s'):.0f}",
            f"{late_known(drives, 'travelled_m')} / {late_known(drives, 'time_s')}",
            str(collisions),
            report.verdict(f"{what}: {collisions} collisions", collisions == 0),
            str(sum(drive.summary["hit_by_people"] for drive in drives))]


def plot(arguments: argparse.Namespace, worlds: dict[str, dict[str, list[Drive]]]) -> None:
    """The paper's Fig. 13: a picture over metres and one over seconds, a panel a world."""
    for name, label, stem in (("driven_m", "driven [m]", "explored_over_metres"),
                              ("time_s", "time [s]", "explored_over_time")):
        curves = arguments.results / f"{stem}.csv"
        write_curves(curves, [(world, planner, *mean_curve(drives, name))
                              for world, planners in worlds.items()
                              for planner, drives in planners.items()])
        subprocess.run([arguments.plot, "--curves", curves, "--x-label", label, "--y-label", "[%]",
                        "--title", "Explored, of the ground that can be reached",
                        "--out", curves.with_suffix(".png")], check=True)


def report_worlds(arguments: argparse.Namespace, report: Report) -> None:
    worlds = read_worlds(arguments, report)
    report.text("### In the closed loop")
    report.table(["world", "planner", "starts", "explored: mean / least [%]", "98 %", "driven [m]",
                  "of `utility`", "time [s]", f"{LATE_PERCENT} % after [m] / [s]", "collisions",
                  "none", "hit by people while standing"],
                 [world_row(name, planner, planners, report)
                  for name, planners in worlds.items() for planner in planners])
    failed = [f"- {name}, {planner}, start {drive.start}: {drive.summary['reason']}"
              for name, planners in worlds.items() for planner, drives in planners.items()
              for drive in drives if not drive.summary["success"]]
    report.lines += [*failed, ""] if failed else []
    if worlds:
        plot(arguments, worlds)


def make_report(arguments: argparse.Namespace) -> Report:
    report = Report()
    if arguments.dungeons:
        report_dungeons(arguments, report)
    if arguments.world:
        report.text(machine(1) + f" {arguments.processes} runs at once, at most "
                    f"{arguments.time_limit:.0f} s, {100 * arguments.point_share:.0f} % of the "
                    "LiDAR's columns.")
        report_worlds(arguments, report)
    report.text(f"{report.checked - len(report.missed)} of {report.checked} limits reached.")
    for missed in report.missed:
        report.lines.append(f"- missed: {missed}")
    return report


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--plot", type=Path, required=True, help="hv_plot_curves")
    parser.add_argument("--dungeons", action="append", default=[], metavar="NAME")
    parser.add_argument("--world", action="append", default=[], metavar="NAME")
    parser.add_argument("--planner", action="append", default=[], metavar="NAME")
    parser.add_argument("--starts", type=int, required=True)
    parser.add_argument("--time-limit", type=float, required=True)
    parser.add_argument("--point-share", type=float, required=True)
    parser.add_argument("--processes", type=int, required=True)
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    show("\n".join(make_report(arguments).lines) + "\n", arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
