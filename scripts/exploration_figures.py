"""Figures of exploration: runs in dungeon maps, and drives in worlds, judged by the truth."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

RESAMPLES = 4000
CURVE_POINTS = 400


@dataclass
class Runs:
    """One planner on a set of maps; arrays hold a value a map."""

    maps: list[str]
    travel: np.ndarray
    done: np.ndarray
    decision_ms: np.ndarray
    loops_broken: int

    def all_done(self) -> bool:
        return bool(self.done.all())


def read_runs(folder: Path) -> Runs | None:
    """Nothing where there are no results, or no finished ones."""
    if not (folder / "arguments.txt").exists():
        return None
    with (folder / "runs.csv").open() as file:
        rows = list(csv.DictReader(file))
    column = lambda name: np.array([float(row[name]) for row in rows])
    summary = json.loads((folder / "run.json").read_text())["planners"][0]
    return Runs([row["map"] for row in rows], column("travel"), column("done") > 0,
                column("decision_ms"), summary["loops_broken"])


def pooled(sets: list[Runs]) -> Runs:
    join = lambda name: np.concatenate([getattr(runs, name) for runs in sets])
    return Runs([name for runs in sets for name in runs.maps], join("travel"), join("done"),
                join("decision_ms"), sum(runs.loops_broken for runs in sets))


@dataclass
class Share:
    """Of another planner's travel, with the interval that holds it with 95 %."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.3f} ({self.low:.3f} to {self.high:.3f})"


def share_of(runs: Runs, other: Runs) -> Share:
    """Paired: maps are drawn anew (bootstrap), each with the travels of both."""
    if runs.maps != other.maps:
        raise SystemExit("exploration_table: there are results of other maps: run with --fresh")
    count = len(runs.maps)
    drawn = np.random.default_rng(1).integers(0, count, (RESAMPLES, count))
    shares = runs.travel[drawn].sum(axis=1) / other.travel[drawn].sum(axis=1)
    low, high = np.percentile(shares, [2.5, 97.5])
    return Share(float(runs.travel.sum() / other.travel.sum()), float(low), float(high))


@dataclass
class Drive:
    """One exploration of a world."""

    start: int
    summary: dict
    time_s: np.ndarray     # of the coverage, as the next two
    driven_m: np.ndarray
    percent: np.ndarray    # explored, of the ground that the robot can get to

    def known(self, percent: int) -> dict | None:
        """When so much was known: time_s and travelled_m."""
        return self.summary[f"known_{percent}"] or None


def read_drive(folder: Path, start: int) -> Drive | None:
    """Nothing where there are no results, or no finished ones."""
    if not (folder / "arguments.txt").exists():
        return None
    with (folder / "coverage.csv").open() as file:
        rows = list(csv.DictReader(file))
    column = lambda name: np.array([float(row[name]) for row in rows])
    return Drive(start, json.loads((folder / "run.json").read_text()), column("time_s"),
                 column("travelled_m"), 100.0 * column("share"))


def mean_curve(drives: list[Drive], name: str) -> tuple[np.ndarray, np.ndarray]:
    """Mean share explored [%] over `name`, to where the last drive ended; what a drive knew in the
    end, it goes on knowing."""
    end = max(float(getattr(drive, name)[-1]) for drive in drives)
    x = np.linspace(0.0, end, CURVE_POINTS)
    return x, np.mean([np.interp(x, getattr(drive, name), drive.percent) for drive in drives],
                      axis=0)


def write_curves(path: Path, curves: list[tuple[str, str, np.ndarray, np.ndarray]]) -> None:
    """Panel, curve, x and y of each, as hv_plot_curves reads them."""
    lines = ["panel,curve,x,y"]
    for panel, name, xs, ys in curves:
        lines += [f"{panel},{name},{x:.2f},{y:.3f}" for x, y in zip(xs, ys)]
    path.write_text("\n".join(lines) + "\n")
