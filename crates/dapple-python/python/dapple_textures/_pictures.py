"""Results of picture functions that are more than an array."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt


class SeamReport(NamedTuple):
    """Measurements of how well an image repeats, and a verdict. ``print`` shows it as a table."""

    #: Whether the image has no fault.
    passes: bool
    #: Pairs of a channel (empty if the image has only one) and a description of its fault.
    faults: list[tuple[str, str]]
    #: A score to rank tiles of one source: lower is better.
    badness: float
    #: All measurements, channel by channel.
    channels: list[dict[str, Any]]
    #: The report as text, with tables.
    text: str

    def __str__(self) -> str:
        return self.text


class Bands(NamedTuple):
    """The bands of an image; ``wavelet_synthesize`` adds them up again."""

    #: The detail lost each time the image is halved, finest first.
    details: list[npt.NDArray[np.float32]]
    #: The halved image that remains.
    coarse: npt.NDArray[np.float32]
