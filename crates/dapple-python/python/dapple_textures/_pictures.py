"""What calls with pictures give that is more than an array."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt


class SeamReport(NamedTuple):
    """How well an image repeats, in numbers and as a verdict. ``print`` shows it as a table."""

    #: Whether there is no fault.
    passes: bool
    #: The channel (empty where there is one only), and what is wrong with it.
    faults: list[tuple[str, str]]
    #: Ranks tiles of one source: lower is better.
    badness: float
    #: All measurements, channel by channel.
    channels: list[dict[str, Any]]
    #: The tables.
    text: str

    def __str__(self) -> str:
        return self.text


class Bands(NamedTuple):
    """The bands of an image, which ``wavelet_synthesize`` adds up again."""

    #: What is lost each time the image is halved, finest first.
    details: list[npt.NDArray[np.float32]]
    #: What is left.
    coarse: npt.NDArray[np.float32]
