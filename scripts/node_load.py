"""Processor time and memory of the project's nodes, by the operating system."""

from __future__ import annotations

import os
import time
from pathlib import Path

TICKS = os.sysconf("SC_CLK_TCK")
PAGE_MB = os.sysconf("SC_PAGE_SIZE") / 2**20


def nodes() -> dict[int, str]:
    """Names of the programs hv_*_node that run now, by their number."""
    found = {}
    for folder in Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            name = Path(os.fsdecode((folder / "cmdline").read_bytes().split(b"\0")[0])).name
        except OSError:
            continue  # has ended meanwhile
        if name.startswith("hv_") and name.endswith("_node"):
            found[int(folder.name)] = name
    return found


def cpu_s(process: int) -> float:
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def memory_mb(process: int) -> float:
    return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * PAGE_MB


class NodeLoad:
    """From its construction on, of the nodes that ran then and still do."""

    def __init__(self) -> None:
        self._begun = time.monotonic()
        self._before = {process: (name, cpu_s(process)) for process, name in nodes().items()}

    def wall_s(self) -> float:
        return time.monotonic() - self._begun

    def measure(self) -> dict[str, dict[str, float]]:
        """For each node: share of one core, and memory [MB]."""
        wall_s = self.wall_s()
        running = nodes()
        return {name: {"cores": (cpu_s(process) - before) / wall_s, "mb": memory_mb(process)}
                for process, (name, before) in self._before.items() if process in running}
