#!/usr/bin/python3
"""Prints the table of scripts/bench_odometry.sh from the results that lie in its folders."""

from __future__ import annotations

import argparse
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import odometry_figures as figures
from odometry_figures import Run, TunnelRun
from table_report import Report, machine, show

CELLS = {0.25: "leaf025", 0.5: "leaf050"}
TUNNEL = "tunnel_straight_robot"

# Limits; a ratio is to the peer's figure.
ERROR_RATIO = 0.8
SMALL_ERROR_M = 0.005
TIME_RATIO = 0.5
SLOWEST_SCAN_MS = 100.0
MEMORY_GROWTH_PERCENT = 2.0
PATH_ERROR_PERCENT = 1.0
TUNNEL_COVERED = 0.99
TUNNEL_DEGENERATE = 0.9
TUNNEL_ALONG_SHARE = 0.05
TUNNEL_ACROSS_M = 0.2


@dataclass
class Sequence:
    """All runs on one sequence: ours and each peer's, by cell size."""

    name: str
    ours: dict[float, Run]
    peers: dict[str, dict[float, Run]]


def pair(runs: dict[float, Run], figure: str, scale: float, digits: int) -> str:
    """One figure at both cell sizes: "a / b"."""
    return " / ".join(f"{scale * getattr(runs[cell], figure):.{digits}f}" if cell in runs else "-"
                      for cell in CELLS)


def best(runs: dict[float, Run], figure: str) -> float:
    return min((getattr(run, figure) for run in runs.values()), default=float("nan"))


def error_cells(sequence: Sequence, figure: str, label: str, cell: float,
                report: Report) -> tuple[list[str], bool]:
    """Our error at both cell sizes, each peer's, and the ratio to its better run."""
    cells = [pair(sequence.ours, figure, 100.0, 2)]
    good = True
    for name, runs in sequence.peers.items():
        cells.append(pair(runs, figure, 100.0, 2))
        if not runs or cell not in sequence.ours:
            cells.append("-")
            continue
        ours = getattr(sequence.ours[cell], figure)
        ratio = ours / best(runs, figure)
        reached = ratio <= ERROR_RATIO or ours < SMALL_ERROR_M
        report.verdict(f"{sequence.name}: {label} {ratio:.2f} x {name}", reached)
        cells.append(f"{ratio:.2f}" if reached else f"**{ratio:.2f}**")
        good = good and reached
    return cells, good


def time_cells(sequence: Sequence, figure: str, label: str,
               report: Report) -> tuple[list[str], bool]:
    """Our time at both cell sizes, each peer's, and the ratios at equal cells."""
    cells = [pair(sequence.ours, figure, 1.0, 1)]
    good = True
    for name, runs in sequence.peers.items():
        cells.append(pair(runs, figure, 1.0, 1))
        ratios = []
        for cell in CELLS:
            if cell not in runs or cell not in sequence.ours:
                ratios.append("-")
                continue
            ratio = getattr(sequence.ours[cell], figure) / getattr(runs[cell], figure)
            reached = ratio <= TIME_RATIO
            report.verdict(f"{sequence.name}: {label} at {cell} m {ratio:.2f} x {name}", reached)
            ratios.append(f"{ratio:.2f}" if reached else f"**{ratio:.2f}**")
            good = good and reached
        cells.append(" / ".join(ratios))
    return cells, good


def sequence_row(sequence: Sequence, cell: float, report: Report) -> list[str]:
    path = next((run.path_m for run in sequence.ours.values()), float("nan"))
    row = [sequence.name, f"{path:.0f}"]
    good = bool(sequence.ours)
    parts = [error_cells(sequence, "ape_m", "APE", cell, report),
             error_cells(sequence, "vertical_m", "vertical error", cell, report),
             time_cells(sequence, "median_ms", "median time", report),
             time_cells(sequence, "p99_ms", "p99 time", report)]
    for cells, reached in parts:
        row += cells
        good = good and reached
    slowest = max((run.max_ms for run in sequence.ours.values()), default=float("nan"))
    fast = slowest <= SLOWEST_SCAN_MS
    report.verdict(f"{sequence.name}: slowest scan {slowest:.0f} ms", fast)
    row.append(pair(sequence.ours, "max_ms", 1.0, 1))
    row.append("yes" if good and fast else "**no**")
    return row


def sequence_table(sequences: list[Sequence], cell: float, report: Report) -> None:
    header = ["sequence", "path [m]"]
    for title in ("APE RMSE [cm]", "vertical RMSE [cm]", "median [ms]", "p99 [ms]"):
        header.append(title)
        for peer in sequences[0].peers:
            header += [peer, "ratio"]
    header += ["max [ms]", "within limits"]
    report.table(header, [sequence_row(sequence, cell, report) for sequence in sequences])
    report.text(f"Pairs are at cells (leaves) of {' / '.join(f'{c:.2f}' for c in CELLS)} m. "
                f"Error ratios: ours at {cell:.2f} m, the default, to the peer's better run; at "
                f"most {ERROR_RATIO}, or below {1000 * SMALL_ERROR_M:.0f} mm. Time ratios at equal "
                f"cells: at most {TIME_RATIO}. No scan above {SLOWEST_SCAN_MS:.0f} ms.")


def tunnel_rows(run: TunnelRun) -> list[list[str]]:
    rows = []
    for second in range(0, int(run.seconds[-1]) + 1, 10):
        i = int(np.argmin(np.abs(run.seconds - second)))
        rows.append([f"{second}", f"{run.station_m[i]:.1f}",
                     "featureless" if run.inside()[i] else "",
                     f"{run.along_m[i]:+.3f}", f"{3.0 * run.sigma_m[i]:.3f}",
                     f"{run.across_m[i]:.3f}", "yes" if run.degenerate[i] else ""])
    return rows


def tunnel_section(run: TunnelRun, cell: float, report: Report) -> None:
    report.text(f"### Straight tunnel, cells of {cell:.2f} m")
    report.table(["time [s]", "station [m]", "section", "error along [m]", "3 sigma along [m]",
                  "error across [m]", "degenerate"], tunnel_rows(run))
    inside = run.inside()
    error = np.abs(run.along_m[inside])
    degenerate = float(np.mean(run.degenerate[inside]))
    covered = float(np.mean(error <= 3.0 * run.sigma_m[inside]))
    length = figures.FEATURELESS_M[1] - figures.FEATURELESS_M[0]
    bounded = (bool(np.all(np.isfinite(run.along_m))) and run.across_m.max() < TUNNEL_ACROSS_M and
               np.abs(run.along_m).max() < TUNNEL_ALONG_SHARE * length)
    rows = [
        ["scans in the featureless section that report a degenerate direction",
         f"{int(run.degenerate[inside].sum())} of {int(inside.sum())}",
         f">= {100 * TUNNEL_DEGENERATE:.0f} %",
         report.verdict(f"tunnel {cell}: {100 * degenerate:.0f} % of the scans degenerate",
                        degenerate >= TUNNEL_DEGENERATE)],
        ["of those scans, error along within 3 sigma", f"{100 * covered:.1f} %",
         f">= {100 * TUNNEL_COVERED:.0f} %",
         report.verdict(f"tunnel {cell}: {100 * covered:.0f} % within 3 sigma",
                        covered >= TUNNEL_COVERED)],
        ["largest error along / across (no divergence)",
         f"{np.abs(run.along_m).max():.2f} / {run.across_m.max():.2f} m",
         f"< {TUNNEL_ALONG_SHARE * length:.1f} / {TUNNEL_ACROSS_M:.1f} m",
         report.verdict(f"tunnel {cell}: diverged", bool(bounded))]]
    report.table(["straight tunnel", "measured", "limit", "reached"], rows)


def memory_section(sequence: str, run: figures.MemoryRun, report: Report) -> None:
    growth = run.growth_percent()
    report.text("### Memory once the table is full")
    report.table(
        ["sequence", "voxels", "full after", "then [MB]", "largest later [MB]", "growth", "limit",
         "APE RMSE [cm]", "reached"],
        [[sequence, str(run.capacity),
          f"{100.0 * run.full_at_scan / run.scans:.0f} % of the run", f"{run.full_mb:.1f}",
          f"{run.largest_mb:.1f}", f"{growth:.2f} %", f"{MEMORY_GROWTH_PERCENT:.0f} %",
          f"{100 * run.ape_m:.2f}",
          report.verdict(f"memory grows by {growth:.1f} %",
                         growth < MEMORY_GROWTH_PERCENT and
                         run.full_at_scan <= run.scans / 5)]])


def kitti_section(errors: list[figures.PathError], report: Report) -> None:
    report.text("### KITTI without IMU")
    rows = [[error.reference, f"{error.path_m:.2f}", f"{error.end_percent:.2f} %",
             f"{error.step_percent:.2f} %", f"{PATH_ERROR_PERCENT:.0f} %",
             report.verdict(f"KITTI against {error.reference}: {error.end_percent:.2f} %",
                            error.end_percent < PATH_ERROR_PERCENT)] for error in errors]
    report.table(["reference", "path [m]", "error at the end", "mean error of a step", "limit",
                  "reached"], rows)


def load(name: str, arguments: argparse.Namespace) -> Sequence:
    truth = arguments.data / name / "truth.tum"

    def runs(folder: Path) -> dict[float, Run]:
        found = {cell: figures.read_run(folder / name / leaf, truth, arguments.ape)
                 for cell, leaf in CELLS.items()}
        return {cell: run for cell, run in found.items() if run is not None}

    peers = {peer: runs(Path(folder)) for peer, folder in arguments.peer}
    return Sequence(name, runs(arguments.results / "hv_lio"), peers)


def tunnel_sections(arguments: argparse.Namespace, report: Report) -> None:
    for cell, leaf in CELLS.items():
        folder = arguments.results / "hv_lio" / TUNNEL / leaf
        run = figures.read_tunnel(folder, arguments.data / TUNNEL / "truth.tum")
        if run is not None:
            tunnel_section(run, cell, report)


def make_report(arguments: argparse.Namespace) -> Report:
    report = Report()
    report.text(machine(arguments.threads))
    sequence_table([load(name, arguments) for name in arguments.sequence], arguments.default_cell,
                   report)
    if TUNNEL in arguments.sequence:
        tunnel_sections(arguments, report)
    if arguments.memory is not None:
        memory = figures.read_memory(arguments.results / "memory",
                                     arguments.data / arguments.memory / "truth.tum",
                                     arguments.ape)
        if memory is not None:
            memory_section(arguments.memory, memory, report)
    if arguments.kitti is not None:
        kitti_section(figures.read_kitti(arguments.results / "kitti", arguments.kitti), report)
    report.text(f"{report.checked - len(report.missed)} of {report.checked} limits reached.")
    for missed in report.missed:
        report.lines.append(f"- missed: {missed}")
    return report


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--ape", type=Path, required=True, help="the program hv_ape")
    parser.add_argument("--sequence", action="append", required=True)
    parser.add_argument("--peer", nargs=2, action="append", default=[], metavar=("NAME", "DIR"))
    parser.add_argument("--default-cell", type=float, required=True)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--memory", metavar="SEQUENCE", help="that of the run with a small table")
    parser.add_argument("--kitti", type=Path)
    parser.add_argument("--markdown", type=Path)
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    try:
        text = "\n".join(make_report(arguments).lines).rstrip() + "\n"
    except (OSError, ValueError, KeyError, subprocess.CalledProcessError) as error:
        print(f"odometry_table: {error}", file=sys.stderr)
        return 1
    show(text, arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
