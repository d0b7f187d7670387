"""Figures of odometry runs: errors, times, memory, and how honest the reported covariance is."""

from __future__ import annotations

import csv
import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# Between these stations of the straight tunnel, x of the truth [m], fewer than 1 in 2000 returns come
# from anything but its smooth lining, which begins at 30 m and ends at 200 m.
FEATURELESS_M = (60.0, 170.0)


@dataclass
class Run:
    """One program on one sequence at one cell size."""

    ape_m: float
    vertical_m: float
    path_m: float
    median_ms: float
    p99_ms: float
    max_ms: float


@dataclass
class TunnelRun:
    """A run through the straight tunnel; arrays hold a value for each scan."""

    station_m: np.ndarray
    seconds: np.ndarray
    along_m: np.ndarray
    across_m: np.ndarray
    sigma_m: np.ndarray
    degenerate: np.ndarray

    def inside(self) -> np.ndarray:
        return (self.station_m > FEATURELESS_M[0]) & (self.station_m < FEATURELESS_M[1])


@dataclass
class MemoryRun:
    """Resident memory from the moment the table is full."""

    capacity: int
    scans: int
    full_at_scan: int
    full_mb: float
    largest_mb: float
    ape_m: float

    def growth_percent(self) -> float:
        return 100.0 * (self.largest_mb / self.full_mb - 1.0)


@dataclass
class PathError:
    """Error of a short path against one reference, in percent of the reference's length."""

    reference: str
    path_m: float
    end_percent: float
    step_percent: float


def read_columns(path: Path) -> dict[str, np.ndarray]:
    """The columns of a CSV file with a header line."""
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    values = np.array([[float(word) for word in row] for row in rows[1:]], ndmin=2)
    return {name.strip(): values[:, i] for i, name in enumerate(rows[0])}


def ape(program: Path, reference: Path, estimate: Path) -> dict:
    """What hv_ape says about a trajectory after SE(3) alignment."""
    command = [str(program), "--json", "--reference", str(reference), "--estimate", str(estimate)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def read_run(folder: Path, truth: Path, ape_program: Path) -> Run | None:
    """The figures of one run; None when the folder does not hold one."""
    trajectory, timing = folder / "trajectory.tum", folder / "timing.csv"
    if not (trajectory.is_file() and timing.is_file() and truth.is_file()):
        return None
    error = ape(ape_program, truth, trajectory)
    total = read_columns(timing)["total_ms"]
    return Run(error["ape_m"]["rmse"], error["vertical_m"]["rmse"], error["path_length_m"],
               float(np.median(total)), float(np.percentile(total, 99)), float(total.max()))


def rotations(quaternions: np.ndarray) -> np.ndarray:
    """Rotation matrices of quaternions x y z w, one a row."""
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
            2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
            2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]
    return np.stack(rows, axis=1).reshape(-1, 3, 3)


def read_tum(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Stamps [s] and 4 x 4 poses of a TUM file."""
    table = np.loadtxt(path, ndmin=2)
    poses = np.tile(np.eye(4), (len(table), 1, 1))
    poses[:, :3, :3] = rotations(table[:, 4:8])
    poses[:, :3, 3] = table[:, 1:4]
    return table[:, 0], poses


def position_covariances(columns: dict[str, np.ndarray]) -> np.ndarray:
    """3 x 3 covariances of the position; terms that a file leaves out are zero."""
    zero = np.zeros_like(columns["xx"])
    xy, xz, yz = (columns.get(name, zero) for name in ("xy", "xz", "yz"))
    rows = [columns["xx"], xy, xz, xy, columns["yy"], yz, xz, yz, columns["zz"]]
    return np.stack(rows, axis=1).reshape(-1, 3, 3)


def read_tunnel(folder: Path, truth: Path) -> TunnelRun | None:
    """Error along and across the tunnel, aligned at the first pose, with the reported deviation."""
    if not ((folder / "covariance.csv").is_file() and truth.is_file()):
        return None
    columns = read_columns(folder / "covariance.csv")
    stamps, poses = read_tum(folder / "trajectory.tum")
    true_stamps, true_poses = read_tum(truth)
    stamps, rows, at = np.intersect1d(stamps, columns["stamp"], return_indices=True)
    poses = poses[rows]
    true_position = np.stack([np.interp(stamps, true_stamps, true_poses[:, i, 3])
                              for i in range(3)], axis=1)
    first = int(np.argmin(np.abs(true_stamps - stamps[0])))
    T_true_odom = true_poses[first] @ np.linalg.inv(poses[0])
    error = poses[:, :3, 3] @ T_true_odom[:3, :3].T + T_true_odom[:3, 3] - true_position
    axis = T_true_odom[:3, :3].T @ np.array([1.0, 0.0, 0.0])
    variance = np.einsum("i,nij,j->n", axis, position_covariances(columns)[at], axis)
    return TunnelRun(true_position[:, 0], stamps - stamps[0], error[:, 0],
                     np.linalg.norm(error[:, 1:], axis=1), np.sqrt(variance),
                     columns["degenerate_translation"][at] > 0)


def read_memory(folder: Path, truth: Path, ape_program: Path) -> MemoryRun | None:
    """Resident memory of a run with a small table; None when it never became full."""
    if not (folder / "timing.csv").is_file():
        return None
    columns = read_columns(folder / "timing.csv")
    voxels, memory = columns["voxels"], columns["rss_mb"]
    full = int(np.argmax(voxels))
    error = ape(ape_program, truth, folder / "trajectory.tum")
    return MemoryRun(int(voxels[full]), len(voxels), full, float(memory[full]),
                     float(memory[full:].max()), error["ape_m"]["rmse"])


def read_matrix_poses(path: Path) -> np.ndarray:
    """Poses of a file with the twelve numbers of a 3 x 4 matrix a line."""
    table = np.loadtxt(path, ndmin=2)
    poses = np.tile(np.eye(4), (len(table), 1, 1))
    poses[:, :3, :] = table.reshape(-1, 3, 4)
    return poses


def kitti_lidar_poses(poses: Path, calibration: Path) -> np.ndarray:
    """Poses of the LiDAR from poses of cam0 and the line "Tr:" of calib.txt."""
    for line in calibration.read_text().splitlines():
        if line.startswith("Tr:"):
            T_cam0_lidar = np.eye(4)
            T_cam0_lidar[:3] = np.array(line.split()[1:], dtype=float).reshape(3, 4)
            return read_matrix_poses(poses) @ T_cam0_lidar
    raise ValueError(f"{calibration}: no line 'Tr:'")


def path_error(name: str, reference: np.ndarray, estimate: np.ndarray) -> PathError:
    """Error of the last pose and mean error of the steps, relative to the first pose."""
    inverse = np.linalg.inv
    steps = inverse(reference[:-1]) @ reference[1:]
    lengths = np.linalg.norm(steps[:, :3, 3], axis=1)
    estimated_steps = inverse(estimate[:-1]) @ estimate[1:]
    step_errors = np.linalg.norm((inverse(steps) @ estimated_steps)[:, :3, 3], axis=1)
    whole = inverse(reference[0]) @ reference[-1]
    end = inverse(whole) @ inverse(estimate[0]) @ estimate[-1]
    path = float(lengths.sum())
    return PathError(name, path, 100.0 * float(np.linalg.norm(end[:3, 3])) / path,
                     100.0 * float(step_errors.sum()) / path)


def read_kitti(folder: Path, sequence: Path) -> list[PathError]:
    """Errors of a run without IMU against every poses*.txt of the sequence."""
    if not (folder / "trajectory.tum").is_file():
        return []
    _, estimate = read_tum(folder / "trajectory.tum")
    errors = []
    for poses in sorted(sequence.glob("poses*.txt")):
        reference = kitti_lidar_poses(poses, sequence / "calib.txt")
        count = min(len(reference), len(estimate))
        errors.append(path_error(poses.name, reference[:count], estimate[:count]))
    return errors
