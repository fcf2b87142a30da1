"""Sources that can be baked in parts: recipes and fields, as data from which any process can rebuild them."""

from __future__ import annotations

import hashlib
import json
import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, Protocol, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from ._native import (
    ColorField,
    DappleError,
    Field,
    Plan,
    Recipe,
    _field_from_description,
    _map_info,
    _plan_from_parts,
)
from ._types import refusal

Image = npt.NDArray[np.float32]

#: The number of prepared recipes and fields that a process keeps, for the frames it works on. Each holds its images.
_READY = 4


#: The positions of the samples of an array.
Samples: TypeAlias = Literal["centers", "corners"]

#: Images as names, shapes and bytes, so that they are hashable.
Packed = tuple[tuple[str, tuple[int, ...], bytes], ...]


#: The name of a coordinate, and the function of the numbers of pixels.
Coordinate = tuple[str, Callable[[npt.NDArray[Any]], npt.NDArray[np.float64]]]


class Source(Protocol):
    """A source of planes of numbers for the pixels of an array of any size."""

    def channels(self, plane: str) -> int:
        """Returns the number of channels of a plane."""

    def render(
        self, shape: tuple[int, ...], planes: Sequence[str], window: tuple[slice, ...]
    ) -> dict[str, Image]:
        """Renders a window of an array of this shape, for each plane."""

    def check(self, shape: tuple[int, ...]) -> None:
        """Raises an error if the source cannot fill an array of this shape."""

    def to_data(self) -> dict[str, Any]:
        """Returns the source as data for JSON, with images replaced by their SHA-256."""

    def images_by_hash(self) -> dict[str, Image]:
        """Returns the images of the source, by their SHA-256."""

    def attributes(self, plane: str) -> dict[str, Any]:
        """Returns attributes of an array that describe the source of a plane, such as the recipe and its seed."""

    def coordinates(self, shape: tuple[int, ...]) -> list[Coordinate]:
        """Returns, for each axis of an array, what its coordinates are, and how they follow from the numbers of pixels."""


@dataclass(frozen=True)
class RecipeSource:
    """The maps of a recipe. Arrays with a third axis in front hold the frames of a loop in time."""

    recipe: str
    images: Packed
    time: float
    samples: Samples = "centers"

    @classmethod
    def of(cls, plan: Plan, samples: Samples) -> RecipeSource:
        plan.check_local()
        _, (recipe, images, time) = plan.__reduce__()
        return cls(recipe, _packed(images), time, samples)

    def channels(self, plane: str) -> int:
        info = _map_info()
        if plane not in info:
            raise _unknown("map", plane, info)
        return int(info[plane].channels)

    def plan(self, time: float) -> Plan:
        """Returns the plan at a time, from 0 to 1 in the loop."""
        return _plan(self, time)

    def render(
        self, shape: tuple[int, ...], planes: Sequence[str], window: tuple[slice, ...]
    ) -> dict[str, Image]:
        *frames, rows, columns = window
        size = (shape[-2], shape[-1])

        def bake(time: float) -> dict[str, Image]:
            return self.plan(time).bake(size, list(planes), window=(rows, columns), samples=self.samples)

        if not frames:
            return bake(self.time)
        pictures = [
            bake((self.time + frame / shape[0]) % 1.0) for frame in range(frames[0].start, frames[0].stop)
        ]
        return {plane: np.stack([picture[plane] for picture in pictures]) for plane in planes}

    def check(self, shape: tuple[int, ...]) -> None:
        if len(shape) not in (2, 3):
            message = f"the shape is {shape}, but a recipe has (rows, columns) or (frames, rows, columns)"
            raise refusal("shape", message)
        _check_corners(shape[-2:], self.samples)

    def to_data(self) -> dict[str, Any]:
        images = [{"name": name, "hash": hashed} for (name, _, _), hashed in zip(self.images, self._hashes())]
        return {
            "recipe": json.loads(self.recipe),
            "images": images,
            "time": self.time,
            **_samples_data(self.samples),
        }

    def images_by_hash(self) -> dict[str, Image]:
        arrays = (np.frombuffer(data, np.float32).reshape(shape) for _, shape, data in self.images)
        return dict(zip(self._hashes(), arrays))

    def attributes(self, plane: str) -> dict[str, Any]:
        recipe = Recipe.from_json(self.recipe)
        # Values of maps have no unit. Heights times the relief are in units of the plane.
        made = {"recipe": recipe.name, "seed": recipe.seed, "time": self.time, "units": "1"}
        if plane == "height":
            made["relief"] = recipe.to_dict()["material"].get("relief", 0.1)
        return made

    def coordinates(self, shape: tuple[int, ...]) -> list[Coordinate]:
        width, height = Recipe.from_json(self.recipe).extent
        plane = [
            _coordinate("y", 0.0, height, shape[-2], self.samples),
            _coordinate("x", 0.0, width, shape[-1], self.samples),
        ]
        if len(shape) == 2:
            return plane
        return [("elapsed part of the loop", lambda frame: (self.time + frame / shape[0]) % 1.0), *plane]

    def _hashes(self) -> list[str]:
        return [digest([list(shape), hashlib.sha256(data).hexdigest()]) for _, shape, data in self.images]


@dataclass(frozen=True)
class FieldSource:
    """A field, of numbers or of colors, over a rectangle or a box."""

    description: str
    extent: tuple[float, ...]
    origin: tuple[float, ...]
    samples: Samples = "centers"

    def channels(self, plane: str) -> int:
        if plane != "value":
            raise _unknown("plane of a field", plane, ["value"])
        field = _field(self.description)
        return field.channels if isinstance(field, ColorField) else 1

    def render(
        self, shape: tuple[int, ...], planes: Sequence[str], window: tuple[slice, ...]
    ) -> dict[str, Image]:
        field = _field(self.description)
        values = field.render(
            shape, extent=self.extent, origin=self.origin, window=window, samples=self.samples
        )
        if values.shape[len(shape) :] == (1,):
            # A map of one channel has no axis for channels.
            values = values[..., 0]
        return {plane: values for plane in planes}

    def check(self, shape: tuple[int, ...]) -> None:
        if len(shape) != len(self.extent):
            raise refusal("shape", f"the shape is {shape}, but the field has {len(self.extent)} axes")
        _check_corners(shape, self.samples)

    def to_data(self) -> dict[str, Any]:
        return {
            "field": self.description,
            "extent": list(self.extent),
            "origin": list(self.origin),
            **_samples_data(self.samples),
        }

    def images_by_hash(self) -> dict[str, Image]:
        return {}

    def attributes(self, plane: str) -> dict[str, Any]:
        return {"field": self.description, "units": "1"}

    def coordinates(self, shape: tuple[int, ...]) -> list[Coordinate]:
        axes = zip("xyzw", self.origin, self.extent, reversed(shape))
        return [_coordinate(*axis, self.samples) for axis in axes][::-1]


def source(
    what: Recipe | Plan | Field | ColorField,
    *,
    extent: float | Sequence[float] | None = None,
    origin: float | Sequence[float] | None = None,
    samples: Samples = "centers",
) -> RecipeSource | FieldSource:
    """Returns the source of a recipe, a plan or a field, which can be baked in parts.

    `extent` and `origin` are for fields only. They and `samples` have the same meaning as in `Field.render`. A recipe with a node that needs
    the whole tile is refused, with a hint at the way out.
    """
    if samples not in get_args(Samples):
        raise _unknown("samples", samples, get_args(Samples))
    if isinstance(what, Recipe):
        what = what.plan()
    if isinstance(what, Plan):
        if extent is not None or origin is not None:
            raise refusal("conflict", "a recipe has an extent of its own: leave `extent` and `origin` out")
        return RecipeSource.of(what, samples)
    if not isinstance(what, Field | ColorField):
        raise TypeError(f"a Recipe, a Plan or a Field is needed, not {type(what).__name__}")
    if extent is None:
        extent = what._default_extent()
    _, (description,) = what.__reduce__()
    axes = what.ndim
    extents = _numbers("extent", extent, axes)
    return FieldSource(description, extents, _numbers("origin", 0.0 if origin is None else origin, axes), samples)


def from_data(data: dict[str, Any], images: dict[str, Image]) -> RecipeSource | FieldSource:
    """Rebuilds a source from its data and its images, given by their SHA-256."""
    samples: Samples = data.get("samples", "centers")
    if "field" in data:
        return FieldSource(data["field"], tuple(data["extent"]), tuple(data["origin"]), samples)
    named = {image["name"]: images[image["hash"]] for image in data["images"]}
    return RecipeSource(json.dumps(data["recipe"]), _packed(named), data["time"], samples)


def _coordinate(name: str, origin: float, extent: float, side: int, samples: Samples) -> Coordinate:
    """Returns the coordinates of the samples along an axis, in units of the plane."""
    what = f"{name} in units of the plane"
    if samples == "corners":
        return what, lambda corner: origin + corner * (extent / (side - 1))
    return what, lambda pixel: origin + (pixel + 0.5) * (extent / side)


def _check_corners(shape: tuple[int, ...], samples: Samples) -> None:
    """Raises an error for samples on corners along a side that has a single one."""
    if samples == "corners" and min(shape) < 2:
        raise refusal("range", f"the shape is {shape}, but corners need at least 2 samples along each side")


def _samples_data(samples: Samples) -> dict[str, str]:
    """Returns the samples as data. The default is left out, so that the data for centers don't change."""
    return {} if samples == "centers" else {"samples": samples}


def _packed(images: dict[str, Image]) -> Packed:
    return tuple((name, image.shape, image.tobytes()) for name, image in sorted(images.items()))


def sides(value: Any) -> tuple[int, ...]:
    """Returns sizes in pixels, from one number for both rows and columns or one number for each axis."""
    try:
        return (operator.index(value),) * 2
    except TypeError:
        return tuple(operator.index(side) for side in value)


def digest(data: object) -> str:
    """Returns the SHA-256 of data, written as JSON."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def sha256(values: npt.NDArray[Any]) -> str:
    """Returns the SHA-256 of the bytes of an array in C order, little-endian."""
    values = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    return hashlib.sha256(values.data).hexdigest()


def _numbers(what: str, value: float | Sequence[float], axes: int) -> tuple[float, ...]:
    numbers = np.ravel(np.asarray(value, dtype=np.float64)).tolist()
    numbers = numbers * axes if len(numbers) == 1 else numbers
    if len(numbers) != axes or not np.isfinite(numbers).all() or (what == "extent" and 0 in numbers):
        message = f"the {what} is {value}, but {axes} finite numbers are needed, x first, and none of an extent is 0"
        raise refusal("extent", message)
    return tuple(numbers)


def _unknown(what: str, name: str, known: Sequence[str] | dict[str, Any]) -> DappleError:
    return refusal("name", f"the {what} is `{name}`, but it must be one of {', '.join(known)}")


@lru_cache(maxsize=_READY)
def _plan(source: RecipeSource, time: float) -> Plan:
    images = {
        name: np.frombuffer(data, np.float32).reshape(shape) for name, shape, data in source.images
    }
    plan = _plan_from_parts(source.recipe, images, time)
    plan.check_local()
    return plan


@lru_cache(maxsize=_READY)
def _field(description: str) -> Field | ColorField:
    field = _field_from_description(description)
    assert isinstance(field, Field | ColorField)
    return field
