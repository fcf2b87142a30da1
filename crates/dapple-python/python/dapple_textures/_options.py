"""Option objects: parameters that travel together and are shared by functions. A dict with the same keys works, too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, fields
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeAlias, TypeVar

from ._types import refusal

if TYPE_CHECKING:
    import numpy.typing as npt

_Options = TypeVar("_Options")
#: An image or a dict of maps.
_Maps_co = TypeVar("_Maps_co", covariant=True)

#: The falloff of the weight of a control point.
Weight: TypeAlias = Literal["cubic", "quintic"] | Mapping[str, object]


def read(kind: type[_Options], name: str, given: _Options | Mapping[str, Any] | None) -> _Options:
    """Returns the option object given for the parameter `name`: itself, a dict of its fields, or None for the default."""
    if kind is Directions and isinstance(given, tuple):
        given = {"field": given}
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
    """Returns the error for a key that is not a field, with the nearest field."""
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


def exemplar(given: Any) -> Exemplar[Any]:
    """Returns an exemplar; maps are one with the defaults."""
    return given if isinstance(given, Exemplar) else Exemplar(given)


@dataclass(frozen=True)
class Exemplar(Generic[_Maps_co]):
    """An example texture with its options; functions also take the maps alone.

    Parameters
    ----------
    maps : array_like or dict of array_like
        The image or the maps, as for the function that takes the exemplar.
    edges : {"cut", "wrap"}, default "cut"
        How the edges of the example are treated: "cut", or "wrap" if the example repeats.
    mask : array_like or None, default None
        (rows, columns) of the example, at least 0.5 where it may be used; nothing is copied from elsewhere.
    mesh : mesh or None, default None
        For `synthesize_on`: the mesh that the maps are the texture of, with `.uv` (m, 3, 2), v down, such as a
        `MeshFile` or a `Model`. Its texture is lifted onto the other mesh. In this case, colors are compared, and the
        "auto" of `coherence` is 2.
    sites : int or None, default None
        The number of points on `mesh`, by default as many as on the other mesh: more points make its features larger.
    directions : tuple of array_like or None, default None
        (positions, vectors) on `mesh`, each (n, 3), like `Directions.field`; its texture points down by default.

    Examples
    --------
    >>> import numpy as np, dapple_textures as dp
    >>> checker = dp.Exemplar(np.kron([[0, 1], [1, 0]], np.ones((8, 8))), edges="wrap")
    >>> dp.synthesize(checker, (24, 20), matching={"levels": 2}).shape
    (24, 20)
    """

    maps: _Maps_co
    _: KW_ONLY
    edges: Literal["cut", "wrap"] = "cut"
    mask: npt.ArrayLike | None = None
    mesh: Any = None
    sites: int | None = None
    directions: tuple[npt.ArrayLike, npt.ArrayLike] | None = None


@dataclass(frozen=True, kw_only=True)
class Matching:
    """How neighborhoods of an example and of a texture are compared. A field that a function cannot use is refused.

    Parameters
    ----------
    levels : int or None, default None
        1 to 16 levels, each with half the resolution of the next finer one: more levels capture larger features. By
        default 3, or as many as fit the example if the method is "endless".
    coherence : float, {"auto"} or None, default None
        The tolerance for worse matches that continue the adjacent pixels: "auto" or a number of at least 0; higher
        values copy larger pieces.
    evenness : float or None, default None
        How evenly the pixels of the example are used, 0 to 1000; 1 by default. It has no effect with guides.
    paper : bool, default False
        Whether to match as in the paper, where the smallest difference wins.
    guides : sequence of tuple of (array_like, float), default ()
        A list of (of_example, of_texture, weight): parts of the example are placed where both have similar values.
        `of_example` is a scalar image of the same size as the example, `of_texture` one of the size of the texture. On
        a mesh, `of_texture` is a number for each vertex, (n,), or an image that is sampled at `mesh.uv` and repeats.
        With weight 1 a guide counts as much as one channel; with weight 3 a guide of zeros and ones is followed nearly
        everywhere.
    method : {"endless", "sweep"} or None, default None
        For `synthesize`: "endless", a window of an infinite texture, which is fast and preserves large or regular
        features; or "sweep", pixel by pixel. By default "endless", unless `coherence`, `evenness`, `paper` or `guides`
        are given or the length of a side that wraps is not the required multiple.
    space : {"appearance", "colors"} or None, default None
        What is compared on meshes: "appearance" by default, or "colors" as in the paper.
    axes : {"followed", "carried"} or None, default None
        How neighborhoods continue over a surface: "followed" by the directions, or "carried" along it.

    Examples
    --------
    >>> import numpy as np, dapple_textures as dp
    >>> checker = np.kron([[0, 1], [1, 0]], np.ones((8, 8)))
    >>> dp.synthesize(checker, 24, matching=dp.Matching(levels=2, coherence=2.0)).shape
    (24, 24)
    """

    levels: int | None = None
    coherence: float | Literal["auto"] | None = None
    evenness: float | None = None
    paper: bool = False
    guides: Sequence[tuple[npt.ArrayLike, npt.ArrayLike, float]] = ()
    method: Literal["endless", "sweep"] | None = None
    space: Literal["appearance", "colors"] | None = None
    axes: Literal["followed", "carried"] | None = None


@dataclass(frozen=True, kw_only=True)
class Directions:
    """How a texture lies on a mesh: its directions and sizes.

    Parameters
    ----------
    field : tuple of array_like or None, default None
        (positions, vectors), each (n, 3): the direction in which the example's downward axis points at each position.
        Directions are interpolated in between.
    down : sequence of float or None, default None
        The downward direction for connected pieces of the surface that contain no position of the field; by default
        (0, -1, 0), or (0, 0, -1) for objects of Blender.
    symmetry : {1, 2, 4}, default 1
        The rotational symmetry of the example: 2 if it looks the same upside down, such as bricks, and 4 if it looks
        the same after a quarter turn, such as a checkerboard. Higher symmetry gives the texture fewer tears.
    scales : array_like or None, default None
        The size of an example pixel, in multiples of the point spacing, from 1/8 to 8; by default 1. Pass a number
        for each vertex, (n,), or an image that is sampled at `mesh.uv` and repeats, (rows, columns). Or pass two
        bounds, between which sizes follow the directions: features grow where the directions diverge and shrink where
        they converge, so that they continue without breaks.
    """

    field: tuple[npt.ArrayLike, npt.ArrayLike] | None = None
    down: Sequence[float] | None = None
    symmetry: Literal[1, 2, 4] = 1
    scales: npt.ArrayLike | None = None


@dataclass(frozen=True, kw_only=True)
class Atlas:
    """The layout of a mesh in a square texture.

    Parameters
    ----------
    texels : int, default 1024
        The side of the texture in pixels, at most 16384.
    kind : {"charts", "area", "uniform", "uv"}, default "charts"
        How faces are laid out: "charts" (large pieces), "area" (triangles sized by their areas), "uniform" (triangles
        of one size), or "uv" (`mesh.uv`, (m, 3, 2), v down).
    padding : int or None, default None
        The width, in pixels, by which each piece of the texture extends past its border.
    crease : float, default 30.0
        The crease angle in degrees: an edge with a larger angle is shaded as a crease.
    """

    texels: int = 1024
    kind: Literal["charts", "area", "uniform", "uv"] = "charts"
    padding: int | None = None
    crease: float = 30.0


@dataclass(frozen=True, kw_only=True)
class Shard:
    """How the arrays of a Zarr store are split into files or objects.

    Parameters
    ----------
    shape : int or sequence of int, default 2048
        The shape of the part that a worker writes as one file or object; a number is both rows and columns, with 1
        along further axes.
    chunk : int, sequence of int or None, default None
        The shape of the part that a reader loads at once; by default the whole shard. It must divide the shard.
    compressors : object, default "auto"
        Compressors of Zarr; by default Zarr's own choice.
    """

    shape: int | Sequence[int] = 2048
    chunk: int | Sequence[int] | None = None
    compressors: Any = "auto"
