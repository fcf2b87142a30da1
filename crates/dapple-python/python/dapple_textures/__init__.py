"""Procedural textures as NumPy arrays.

Arrays are float32 in C order with the shape (rows, columns[, channels]); colors are linear. Positions, extents and
origins are written x first; y points down. A texture *is* its seed: the same seed gives the same bits on every machine,
with any number of threads, and a window is, bit for bit, the crop of the whole.
"""

from __future__ import annotations

from ._native import (
    DappleError,
    Field,
    Worley,
    __version__,
    constant,
    gradient_noise,
    set_threads,
    threads,
    wavelet_noise,
    worley,
)
from ._types import Features

__all__ = [
    "DappleError",
    "Features",
    "Field",
    "Worley",
    "__version__",
    "constant",
    "gradient_noise",
    "set_threads",
    "threads",
    "wavelet_noise",
    "worley",
]
