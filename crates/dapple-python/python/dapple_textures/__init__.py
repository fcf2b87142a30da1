"""Procedural textures as NumPy arrays.

Arrays are float32 in C order with the shape (rows, columns[, channels]); colors are linear. Positions, extents and
origins are written x first; y points down. A texture *is* its seed: the same seed gives the same bits on every machine,
with any number of threads, and a window is, bit for bit, the crop of the whole.
"""

from __future__ import annotations

from ._native import (
    DappleError,
    Field,
    Plan,
    Recipe,
    ShardList,
    Worley,
    __version__,
    constant,
    gradient_noise,
    map_names,
    set_threads,
    shards,
    threads,
    wavelet_noise,
    worley,
)
from ._types import Features, MapInfo

__all__ = [
    "DappleError",
    "Features",
    "Field",
    "MapInfo",
    "Plan",
    "Recipe",
    "ShardList",
    "Worley",
    "__version__",
    "constant",
    "gradient_noise",
    "map_names",
    "set_threads",
    "shards",
    "threads",
    "wavelet_noise",
    "worley",
]
