"""Figures of navigation: drives to goals, judged by the truth, and the times that they took."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

PERIOD_MS = 100.0  # of control


@dataclass
class Drives:
    """Arrays hold a value a goal, times one each time."""

    reached: np.ndarray
    collisions: np.ndarray
    hit_by_people: np.ndarray
    driven_m: np.ndarray
    optimal_m: np.ndarray
    response_s: np.ndarray    # of scenarios; -1: none
    recoveries: np.ndarray
    octree_nodes: np.ndarray
    octree_growth: float      # most nodes in the second half of a run over those in the first
    worst_place_m: np.ndarray
    reasons: list[str]        # of failures
    plan_ms: np.ndarray
    control_ms: np.ndarray
    update_ms: np.ndarray     # of the obstacle map by scans

    def length_ratio(self) -> float:
        """Driven over optimal, of the goals that were reached."""
        good = self.reached > 0
        return float(self.driven_m[good].sum() / max(self.optimal_m[good].sum(), 1e-9))

    def late_percent(self) -> float:
        return 100.0 * float(np.mean(self.control_ms > PERIOD_MS)) if self.control_ms.size else 0.0


def read_rows(paths: list[Path]) -> list[dict[str, str]]:
    rows = []
    for path in paths:
        with path.open() as file:
            rows += list(csv.DictReader(file))
    return rows


def growth(folder: Path) -> float:
    nodes = [float(row["octree_nodes"]) for row in read_rows([folder / "trials.csv"])]
    half = len(nodes) // 2
    return max(nodes[half:]) / max(nodes[:half]) if half > 0 else 1.0


def read_drives(folders: list[Path]) -> Drives:
    trials = read_rows([folder / "trials.csv" for folder in folders])
    cycles = read_rows([folder / "cycles.csv" for folder in folders])
    of_trials = lambda name: np.array([float(row[name]) for row in trials])
    of_cycles = lambda name: np.array([float(row[name]) for row in cycles])
    above_zero = lambda values: values[values > 0.0]
    return Drives(of_trials("reached"), of_trials("collisions"), of_trials("hit_by_people"),
                  of_trials("driven_m"), of_trials("optimal_m"), of_trials("response_s"),
                  of_trials("recoveries"), of_trials("octree_nodes"),
                  max(growth(folder) for folder in folders), of_trials("worst_place_m"),
                  [row["reason"] for row in trials if row["reached"] == "0"],
                  above_zero(of_cycles("plan_ms")), of_cycles("control_ms"),
                  above_zero(of_cycles("update_ms")))
