"""Places in a saved map."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import yaml

CLEARANCE_M = 0.6
FAR_M = 4.0


class FreePlaces:
    """Where a robot can stand in a saved map, by its grid: at least one place."""

    def __init__(self, folder: Path) -> None:
        """Raises ValueError where there is none."""
        with (folder / "grid.yaml").open() as file:
            header = yaml.safe_load(file)
        with (folder / header["image"]).open("rb") as file:
            file.readline()  # P5
            width, height = (int(word) for word in self._line(file).split())
            self._line(file)
            pixels = np.frombuffer(file.read(), dtype=np.uint8).reshape(height, width)
        free = pixels[::-1] > 250
        cell_m = header["resolution"]
        reach = math.ceil(CLEARANCE_M / cell_m)
        rows, columns = np.nonzero(self._eroded(free, reach))
        self._places = np.stack([header["origin"][0] + (columns + 0.5) * cell_m,
                                 header["origin"][1] + (rows + 0.5) * cell_m], axis=1)
        if len(self._places) == 0:
            raise ValueError(f"{folder}: nowhere a robot could stand")

    @staticmethod
    def _line(file) -> bytes:
        line = file.readline()
        return line if not line.startswith(b"#") else FreePlaces._line(file)

    @staticmethod
    def _eroded(free: np.ndarray, reach: int) -> np.ndarray:
        """Cells whose square of `reach` cells to each side is free."""
        padded = np.pad(~free, reach, constant_values=True).astype(np.int32).cumsum(0).cumsum(1)
        padded = np.pad(padded, ((1, 0), (1, 0)))
        size = 2 * reach + 1
        taken = (padded[size:, size:] - padded[:-size, size:] - padded[size:, :-size]
                 + padded[:-size, :-size])
        return taken == 0

    def far_from(self, place: tuple[float, float],
                 random: np.random.Generator) -> tuple[float, float]:
        """One of them, x and y in the map [m]; far away if there is such a place."""
        far = self._places[np.linalg.norm(self._places - place, axis=1) > FAR_M]
        choice = far if len(far) > 0 else self._places
        x, y = choice[random.integers(len(choice))]
        return float(x), float(y)
