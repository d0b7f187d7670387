#!/usr/bin/python3
"""Trains the exploration policy in variants of one configuration, on the same measurements, and
prints how far each drives on the maps for validation. Trainings that are there are kept, those
that were broken off go on."""

from __future__ import annotations

import argparse
import csv
import math
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import yaml

from table_report import Report, show

ROOT = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Variant:
    """What differs from the configuration, by the names of its sections."""

    group: str
    name: str
    changes: dict


def network(name: str, **changes: int) -> Variant:
    paper = {"width": 32, "feed_forward": 64, "encoder_layers": 6, "pyramid_levels": 2,
             "memory": 32}
    return Variant("network", name, {"sac": {"actor": {**paper, **changes}}})


def learning(name: str, **changes: dict) -> Variant:
    return Variant("sac", name, changes)


REWARD = {"coverage": 5.0, "frontier": 1.0, "distribution": 0.5, "path": 1.0, "completion": 20.0}

VARIANTS = [
    Variant("network", "as configured", {}),
    network("six layers, pyramid, LSTM"),
    network("four layers, pyramid, LSTM", encoder_layers=4),
    network("two layers, pyramid, LSTM", encoder_layers=2),
    network("six layers, pyramid", memory=0),
    network("six layers, LSTM", pyramid_levels=0),
    *(learning(f"gamma {gamma}", sac={"discount": gamma}) for gamma in (0.95, 0.97, 0.98, 0.99)),
    *(learning(f"alpha {alpha}", sac={"temperature": alpha, "tune_temperature": False})
      for alpha in (0.05, 0.1, 0.2)),
    learning("all rewards", reward=REWARD),
    *(learning(f"without {term}", reward={**REWARD, term: 0.0}) for term in REWARD),
]


def merged(base: dict, changes: dict) -> dict:
    result = dict(base)
    for key, value in changes.items():
        nested = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = merged(result[key], value) if nested else value
    return result


def config_of(variant: Variant, base: dict, cycles: int) -> dict:
    rounds = {"improvement": {"rounds": 1}}
    fine_tune = {"fine_tune": {"cycles": cycles if variant.group == "sac" else 0}}
    return merged(merged(merged(base, rounds), fine_tune), variant.changes)


def train(variant: Variant, arguments: argparse.Namespace) -> Path:
    """The folder of its training."""
    base = yaml.safe_load(arguments.config.read_text()) or {}
    folder = arguments.out / variant.name.replace(",", "").replace(" ", "_")
    folder.mkdir(parents=True, exist_ok=True)
    text = yaml.safe_dump(config_of(variant, base, arguments.cycles), sort_keys=False)
    config = folder / "variant.yaml"
    begun = config.exists() and config.read_text() == text and (folder / "state.bin").exists()
    if begun and (folder / "config.yaml").exists():
        return folder
    (folder / "config.yaml").unlink(missing_ok=True)  # which the end of a training writes
    config.write_text(text)
    print(f"ablate_exploration: {variant.name}", file=sys.stderr)
    program = arguments.build / "devel/lib/hv_replay/hv_explore_train"
    subprocess.run([program, "--maps", arguments.maps, "--config", config, "--out", folder,
                    "--threads", str(arguments.threads),
                    *(["--resume"] if begun else ["--labels", arguments.labels])],
                   check=True, stdout=subprocess.DEVNULL)
    return folder


def row_of(variant: Variant, folder: Path) -> list[str]:
    with (folder / "curve.csv").open() as file:
        points = list(csv.DictReader(file))
    shares = [share for point in points if not math.isnan(share := float(point["share"]))]
    gains = [gain for point in points if not math.isnan(gain := float(point["gain"]))]
    return [variant.group, variant.name, points[-1]["states"], f"{gains[-1]:.2f}",
            f"{shares[0]:.4f}", f"{min(shares):.4f}", f"{shares[-1]:.4f}"]


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--maps", type=Path, required=True, help="as of hv_explore_train")
    parser.add_argument("--labels", type=Path, required=True,
                        help="folder of a training with the configuration: what it has measured in "
                             "its first round serves all variants")
    parser.add_argument("--config", type=Path, default=ROOT / "config/training/exploration.yaml")
    parser.add_argument("--build", type=Path,
                        default=Path(os.environ.get("HV_BUILD_DIR", ROOT / "build")))
    parser.add_argument("--out", type=Path, help="default: bench/exploration_ablation in the build")
    parser.add_argument("--only", action="append", default=[], metavar="NAME",
                        help="this variant or group alone; may be repeated")
    parser.add_argument("--cycles", type=int, default=100, help="of SAC, for the group sac")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--markdown", type=Path, help="also write the table to this file")
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    arguments.out = arguments.out or arguments.build / "bench/exploration_ablation"
    wanted = [variant for variant in VARIANTS if not arguments.only
              or variant.name in arguments.only or variant.group in arguments.only]
    if not wanted:
        sys.exit("ablate_exploration: there is no such variant: "
                 + "; ".join(variant.name for variant in VARIANTS))
    rows = [row_of(variant, train(variant, arguments)) for variant in wanted]
    report = Report()
    report.table(["group", "variant", "states", "gain a decision [px]",
                  "measured only: of `utility`", "best", "last"], rows)
    show("\n".join(report.lines), arguments.markdown)
    return 0


if __name__ == "__main__":
    sys.exit(main())
