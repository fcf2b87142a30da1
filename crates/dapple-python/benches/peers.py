"""Compares the noise of dapple-textures with other packages, and prints the Markdown table of docs/peers.md.

    python benches/peers.py [--write]

All packages run on one thread, in alternating rounds. The result is the median CPU time of a round, which other programs
hardly influence. Functions that take arrays get arrays allocated beforehand; others are called in a loop, on fewer pixels.
Packages that are not installed are left out. `--write` writes the results to README.md, docs/index.md and docs/peers.md.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.metadata
import importlib.util
import re
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np

import dapple_textures as dp

SIDE = 1024
#: Pixels of a cell, along an axis.
CELL = 64
#: The side of the image for packages that are called once per pixel.
SMALL = 64


@dataclass
class Entry:
    """A call of a package, and the number of pixels that it computes."""

    package: str
    call: Callable[[], Any]
    pixels: int


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--write", action="store_true", help="update the documents")
    arguments = parser.parse_args()
    dp.set_threads(1)
    packages = ["dapple-textures", *filter(installed, ["pyfastnoiselite", "vnoise", "noise", "opensimplex"])]
    ratios = {}
    table = [
        f"| one thread, 1024², 64 pixels per cell, ns/pixel | {' | '.join(packages)} | relative to pyfastnoiselite |",
        "|---|" + "---:|" * (len(packages) + 1),
    ]
    print("\n".join(table))
    for kind, entries in kinds().items():
        entries = [entry for entry in entries if entry.package in packages]
        times = measure(entries, arguments.rounds)
        cells = [shown(times.get(package)) for package in packages]
        peer = times.get("pyfastnoiselite")
        if peer:
            ratios[kind] = peer / times["dapple-textures"]
        ratio = f"{shown(ratios[kind])} ×" if peer else ""
        table.append(f"| {kind} | {' | '.join(cells)} | {ratio} |")
        print(table[-1], flush=True)
    versions = [f"{package} {version(package)}" for package in packages]
    line = (
        f"Nanoseconds of CPU time for each pixel, median of {arguments.rounds} rounds that alternate, on one thread, "
        f"{date.today()}: {', '.join(versions)}; NumPy {np.__version__}, Python {sys.version.split()[0]}."
    )
    print(f"\n{line}")
    if arguments.write:
        write("\n".join(table), line, ratios)


def write(table: str, line: str, ratios: dict[str, float]) -> None:
    """Puts the figures of one run into all documents that have them."""
    base = Path(__file__).parents[1]
    images = ["cells, F1", "cells, F2 − F1", "gradient noise", "gradient noise, 6 octaves"]
    cells, both, noise, octaves = (shown(ratios[kind]) for kind in images)
    others = [1 / ratio for kind, ratio in ratios.items() if "scattered" in kind or "warped" in kind]
    fast = (
        f"- **Fast**: on one thread, images of cells are {both} to {cells} times as fast as with `pyfastnoiselite`, of "
        f"gradient noise {noise} times, of six octaves of it {octaves} times. At scattered positions and warped, it takes "
        f"{shown(min(others), 1)} to {shown(max(others), 1)} times the time of that package ([comparison](PAGE))."
    )
    for name, page in [("README.md", "docs/peers.md"), ("docs/index.md", "peers.md")]:
        replace(base / name, r"^- \*\*Fast\*\*.*$", fast.replace("PAGE", page))
    replace(base / "docs/peers.md", r"^\| one thread, (?:.*\n\|)*.*$", table)
    start = r"^Nanoseconds of CPU time for each pixel[^:]*:.*?\d\."
    replace(base / "docs/peers.md", start + r"(?: The last three rows.*? pixels\.)?(?= |$)", line)


def replace(path: Path, pattern: str, text: str) -> None:
    """Replaces the only match of a pattern in a file."""
    new, count = re.subn(pattern, lambda _: text, path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert count == 1, (path, count)
    path.write_text(new, encoding="utf-8")


def kinds() -> dict[str, list[Entry]]:
    """The entries of each row of the table."""
    # One point in each cell, as the peer has them.
    scatter = {"jittered": {"jitter": 1.0}}
    return {
        "cells, F1": [ours(dp.worley(scatter=scatter)), fast("Cellular", "Distance")],
        "cells, F2 − F1": [
            ours(dp.worley(scatter=scatter, value="f2_minus_f1")),
            fast("Cellular", "Distance2Sub"),
        ],
        "cells, F2 − F1, at scattered positions": [
            ours(dp.worley(scatter=scatter, value="f2_minus_f1"), scattered=True),
            fast("Cellular", "Distance2Sub", scattered=True),
        ],
        "gradient noise": [ours(dp.gradient_noise()), fast("Perlin"), *grids(1), loops(1)],
        "gradient noise, 6 octaves": [
            ours(dp.gradient_noise(octaves=6)),
            fast("Perlin", octaves=6),
            *grids(6),
            loops(6),
        ],
        "gradient noise, at scattered positions": [
            ours(dp.gradient_noise(), scattered=True),
            fast("Perlin", scattered=True),
        ],
        "gradient noise, 6 octaves, at scattered positions": [
            ours(dp.gradient_noise(octaves=6), scattered=True),
            fast("Perlin", octaves=6, scattered=True),
        ],
        "gradient noise, 6 octaves, warped by two noises": [ours(warped()), fast_warped()],
        "gradient noise in 3-D": [ours(dp.gradient_noise(dims=3).slice(0.4)), fast("Perlin", axes=3)],
        "different kinds: partition of unity; simplex": [
            ours(partition()),
            fast("OpenSimplex2"),
            *simplex(),
        ],
    }


def warped() -> dp.Field:
    """Six octaves at positions that two noises of one octave displace."""
    x, y = dp.gradient_noise(seed=1), dp.gradient_noise(seed=2)
    return dp.gradient_noise(octaves=6).warp(x, y, 1.0)


def fast_warped() -> Entry:
    """The same of pyfastnoiselite, in three calls."""
    if not installed("pyfastnoiselite"):
        return Entry("pyfastnoiselite", lambda: None, 1)
    module = importlib.import_module("pyfastnoiselite.pyfastnoiselite")

    def noise(seed: int, octaves: int) -> Any:
        made = module.FastNoiseLite(seed=seed)
        made.frequency = 1.0
        made.noise_type = module.NoiseType.NoiseType_Perlin
        if octaves > 1:
            made.fractal_type = module.FractalType.FractalType_FBm
            made.fractal_octaves = octaves
        return made

    y, x = (np.mgrid[:SIDE, :SIDE].astype(np.float32) + 0.5) / CELL
    places = np.stack([x.ravel(), y.ravel()])
    of, *by = noise(0, 6), noise(1, 1), noise(2, 1)

    def draw() -> Any:
        return of.gen_from_coords(places + np.stack([shift.gen_from_coords(places) for shift in by]))

    return Entry("pyfastnoiselite", draw, SIDE * SIDE)


def partition() -> dp.Field:
    """Values at points that are a cell apart, as the peers' are."""
    side = SIDE / CELL
    return dp.noise(dp.Domain(side), spacing=1.0)


def positions() -> np.ndarray[Any, np.dtype[np.float64]]:
    """Returns random positions, one per pixel of an image, in no order."""
    return np.random.default_rng(1).uniform(0, SIDE / CELL, (SIDE * SIDE, 2))


def ours(field: dp.Field, scattered: bool = False) -> Entry:
    size = (SIDE, SIDE)
    if scattered:
        places = positions()
        return Entry("dapple-textures", lambda: field.sample(places), SIDE * SIDE)
    return Entry("dapple-textures", lambda: field.render(size, extent=SIDE / CELL), SIDE * SIDE)


def fast(noise: str, value: str | None = None, octaves: int = 1, axes: int = 2, scattered: bool = False) -> Entry:
    """pyfastnoiselite, all positions in one call."""
    if not installed("pyfastnoiselite"):
        return Entry("pyfastnoiselite", lambda: None, 1)
    module = importlib.import_module("pyfastnoiselite.pyfastnoiselite")
    noises = module.FastNoiseLite(seed=7)
    noises.frequency = 1.0
    noises.noise_type = getattr(module.NoiseType, f"NoiseType_{noise}")
    if value:
        noises.cellular_return_type = getattr(module.CellularReturnType, f"CellularReturnType_{value}")
        noises.cellular_distance_function = module.CellularDistanceFunction.CellularDistanceFunction_Euclidean
    if octaves > 1:
        noises.fractal_type = module.FractalType.FractalType_FBm
        noises.fractal_octaves = octaves
    y, x = (np.mgrid[:SIDE, :SIDE].astype(np.float32) + 0.5) / CELL
    places = np.stack([x.ravel(), y.ravel(), np.full(SIDE * SIDE, 0.4, np.float32)][:axes])
    if scattered:
        places = np.ascontiguousarray(positions().T, np.float32)
    return Entry("pyfastnoiselite", lambda: noises.gen_from_coords(places), SIDE * SIDE)


def grids(octaves: int) -> list[Entry]:
    """vnoise, a grid in one call."""
    if not installed("vnoise"):
        return []
    noises = importlib.import_module("vnoise").Noise(7)
    axis = (np.arange(SIDE) + 0.5) / CELL
    return [Entry("vnoise", lambda: noises.noise2(axis, axis, octaves=octaves), SIDE * SIDE)]


def loops(octaves: int) -> Entry:
    """noise, pixel by pixel."""
    if not installed("noise"):
        return Entry("noise", lambda: None, 1)
    pnoise2 = importlib.import_module("noise").pnoise2
    axis = ((np.arange(SMALL) + 0.5) / CELL).tolist()
    return Entry("noise", lambda: [[pnoise2(x, y, octaves) for x in axis] for y in axis], SMALL * SMALL)


def simplex() -> list[Entry]:
    """opensimplex, a grid in one call."""
    if not installed("opensimplex"):
        return []
    noises = importlib.import_module("opensimplex").OpenSimplex(7)
    axis = (np.arange(SMALL) + 0.5) / CELL
    return [Entry("opensimplex", lambda: noises.noise2array(axis, axis), SMALL * SMALL)]


def measure(entries: list[Entry], rounds: int) -> dict[str, float]:
    """Nanoseconds of CPU time for each pixel, by package."""
    times: dict[str, list[float]] = {entry.package: [] for entry in entries}
    for entry in entries:
        entry.call()
    for _ in range(rounds):
        for entry in entries:
            before = time.process_time_ns()
            entry.call()
            times[entry.package].append((time.process_time_ns() - before) / entry.pixels)
    return {package: statistics.median(rounds) for package, rounds in times.items()}


def shown(number: float | None, digits: int = 2) -> str:
    if number is None:
        return "–"
    return f"{number:.{digits}f}" if number < 10 else f"{number:,.0f}"


def installed(package: str) -> bool:
    return importlib.util.find_spec(package) is not None


def version(package: str) -> str:
    return dp.__version__ if package == "dapple-textures" else importlib.metadata.version(package)


if __name__ == "__main__":
    main()
