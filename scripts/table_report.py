"""Markdown tables with limits reached and missed, coloured on a terminal."""

from __future__ import annotations

import os
import platform
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Report:
    """Markdown under way, and how many limits were checked and missed."""

    lines: list[str] = field(default_factory=list)
    checked: int = 0
    missed: list[str] = field(default_factory=list)

    def verdict(self, what: str, reached: bool) -> str:
        self.checked += 1
        if reached:
            return "yes"
        self.missed.append(what)
        return "**no**"

    def table(self, header: list[str], rows: list[list[str]]) -> None:
        widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
        for row in [header, ["-" * width for width in widths], *rows]:
            cells = [text.ljust(width) for text, width in zip(row, widths)]
            self.lines.append("| " + " | ".join(cells) + " |")
        self.lines.append("")

    def text(self, line: str) -> None:
        self.lines += [line, ""]


def machine(threads: int) -> str:
    name = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            name = line.split(":", 1)[1].strip()
            break
    return f"{name}, {os.cpu_count()} cores; {threads} thread(s) a scan."


def coloured(text: str) -> str:
    """Markdown for a terminal: misses red, passes green, titles bold."""
    text = re.sub(r"\*\*([^*|]+)\*\*", "\033[31m\\1    \033[0m", text)
    text = re.sub(r"\| yes( *)\|", "| \033[32myes\033[0m\\1|", text)
    return re.sub(r"(?m)^#+ (.*)$", "\033[1m\\1\033[0m", text)


def show(text: str, markdown: Path | None) -> None:
    """Writes a report to standard output, and to a file when one is named."""
    if markdown is not None:
        markdown.write_text(text)
    on_terminal = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    sys.stdout.write(coloured(text) if on_terminal else text)
