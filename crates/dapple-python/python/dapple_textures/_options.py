"""Option objects: parameters that travel together and are shared by functions. A dict with the same keys works, too."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypeVar

from ._types import refusal

if TYPE_CHECKING:
    import numpy.typing as npt

_Options = TypeVar("_Options")

#: The falloff of the weight of a control point.
Weight: TypeAlias = Literal["cubic", "quintic"] | Mapping[str, object]


def read(kind: type[_Options], name: str, given: _Options | Mapping[str, Any] | None) -> _Options:
    """Returns the option object given for the parameter `name`: itself, a dict of its fields, or None for the default."""
    if given is None or isinstance(given, Mapping):
        known = [field.name for field in fields(kind)]  # type: ignore[arg-type]
        for key in given or {}:
            if key not in known:
                raise _unknown(name, str(key), known)
        return kind(**given or {})
    if not isinstance(given, kind):
        raise TypeError(f"`{name}` must be {kind.__name__} or a dict of its fields, not {type(given).__name__}")
    return given


def _unknown(name: str, key: str, known: list[str]) -> Exception:
    """Returns the error for a key that is no field, with the nearest field."""
    near = get_close_matches(key, known, 1)
    message = f"{name}: `{key}` is not one of {', '.join(f'`{field}`' for field in known)}"
    error = refusal("options", message + "".join(f"; did you mean `{field}`?" for field in near))
    error.hint = near[0] if near else None
    return error


@dataclass(frozen=True, kw_only=True)
class Net:
    """The weights of control points, for `pups`, `Partition` and the textures of control points.

    Parameters
    ----------
    axis_scale : float, default 1.0
        The length of axes as a multiple of the length of their edges, above 0.5 and at most 16. Up to 1, the field
        interpolates the values at the control points; above 1, it is smoother.
    weight : {"cubic", "quintic"} or dict, default "cubic"
        The falloff of the weight: "cubic", "quintic", or {"oscillating": {"dips": 3, "depth": 0.5}} with 1 to 16 dips
        and a depth of 0 to 0.99.
    orientations : {"none", "random"}, dict, array_like or None, default None
        The directions in which weights lean: None, "random", {"same": [x, y, z]}, {"away_from": [x, y]} or {"angle":
        radians}; for `pups` and `Partition` also an array (n, 2) or (n, 3) of vectors.
    strength : float, default 0.5
        How strongly orientations shift weights, from 0 to below 1.
    fade : float, default 0.0
        The ratio of border length to edge length below which an axis fades, from 0 (never) to 1. The border is the side
        of the point's cell that crosses the axis. With 0.25, the field changes smoothly when points move.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> smooth = dp.noise(dp.Domain(1), net=dp.Net(axis_scale=2.0, weight="quintic"))
    >>> smooth == dp.noise(dp.Domain(1), net={"axis_scale": 2.0, "weight": "quintic"})
    True
    """

    axis_scale: float = 1.0
    weight: Weight = "cubic"
    orientations: Literal["none", "random"] | Mapping[str, object] | npt.ArrayLike | None = None
    strength: float = 0.5
    fade: float = 0.0
