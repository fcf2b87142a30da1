"""Bakes pictures that are too large for one machine, shard by shard, into a Zarr store.

A window has the same bits as a crop of the whole. So any number of processes on any number of machines can bake the
shards of one store in any order. They may also crash: a shard is written completely or not at all, and a shard that
exists is not baked again. The store holds the recipe, so a worker only needs the path of the store:

    python -m dapple_textures.jobs create rock.zarr rock.toml --size 200000 --maps height,normal --shard 2048
    python -m dapple_textures.jobs bake rock.zarr --part $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT
    python -m dapple_textures.jobs status rock.zarr

This needs `zarr` 3 and no other scheduler; `dapple_textures.dask` does the same on a Dask cluster.
"""

from __future__ import annotations

import argparse
import json
import math
import operator
import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

import numpy as np
import zarr
from zarr.core.sync import sync
from zarr.errors import ContainsArrayError, ContainsGroupError
from zarr.storage import LocalStore, MemoryStore, StorePath, ZipStore

from . import _sources
from ._native import ColorField, Field, Plan, Recipe, __version__
from ._options import Shard, read
from ._recipes import read_recipe, read_recipe_images
from ._types import refusal

#: The attribute of the store that holds the job.
_ATTRIBUTE = "dapple_textures"

#: The longest side with coordinates: 128 MiB of them.
_LONGEST = 1 << 24

#: The group in the store that holds the images of the recipe.
_IMAGES = "images"


@dataclass(frozen=True)
class Record:
    """The result of baking a shard."""

    #: The number of the shard, from 0.
    index: int
    #: The SHA-256 of the numbers of each baked plane; planes that existed already are left out.
    hashes: dict[str, str]


class Job:
    """The shards of an array of any size in a Zarr store. `create` makes a job, and `Job(store)` opens it again.

    `len(job)` is the number of shards. A job can be pickled.
    """

    def __init__(self, store: Any) -> None:
        """Opens the job in a store: a path, the address of an object store, or a Zarr store."""
        #: The place of the store; paths are absolute, so that they are valid in any working directory.
        self.store = place_of(store)
        group = zarr.open_group(self.store, mode="r+")
        data = group.attrs.get(_ATTRIBUTE)
        if not isinstance(data, dict):
            raise refusal("store", f"{store} holds no job: make one with `create`")
        if data["version"] != __version__:
            message = f"the job was made by version {data['version']}, but this is {__version__}"
            raise refusal("version", message, "use one version on all machines")
        self._group = group
        self._arrays: dict[str, zarr.Array[Any]] = {}
        #: The SHA-256 of the description of the job.
        self.hash = _sources.digest(data)
        #: The recipe or field to bake.
        self.source = _sources.from_data(data["source"], _read_images(group, data["source"]))
        #: The names of the planes to bake.
        self.planes: tuple[str, ...] = tuple(data["planes"])
        #: The shape of the whole array, without channels.
        self.shape: tuple[int, ...] = tuple(data["shape"])
        #: The shape of a shard, without channels.
        self.shard: tuple[int, ...] = tuple(data["shard"])
        #: The number of shards along each axis.
        self.grid: tuple[int, ...] = _grid(self.shape, self.shard)

    def __reduce__(self) -> tuple[type[Job], tuple[Any]]:
        check_shared(self.store)
        return Job, (self.store,)

    def __len__(self) -> int:
        return math.prod(self.grid)

    def window(self, index: int) -> tuple[slice, ...]:
        """Returns the window of a shard in the whole array."""
        return _window(self.shape, self.shard, self._place(index))

    def array(self, plane: str) -> zarr.Array[Any]:
        """Returns a plane as a Zarr array; values that are not baked yet are NaN."""
        if plane not in self._arrays:
            array = self._group[plane]
            assert isinstance(array, zarr.Array)
            # Chunks of zeros (such as a metallic of 0) are written as well, since a missing chunk means "not baked".
            self._arrays[plane] = array.with_config({"write_empty_chunks": True})
        return self._arrays[plane]

    def missing(self) -> list[int]:
        """Returns the numbers of the shards that lack a plane, in ascending order."""
        missing: set[int] = set()
        for plane in self.planes:
            missing |= self._missing(plane)
        return sorted(missing)

    def bake(self, index: int) -> Record:
        """Bakes and writes the missing planes of a shard."""
        place = self._place(index)
        planes = [plane for plane in self.planes if not self._is_there(plane, place)]
        if not planes:
            return Record(index, {})
        window = _window(self.shape, self.shard, place)
        made = self.source.render(self.shape, planes, window)
        hashes = {}
        for plane, values in made.items():
            self.array(plane)[window] = values
            hashes[plane] = _sources.sha256(values)
        return Record(index, hashes)

    def bake_all(self, indices: Iterable[int] | None = None) -> Iterator[Record]:
        """Bakes shards one after the other, by default all missing ones."""
        for index in self.missing() if indices is None else indices:
            yield self.bake(index)

    def part(self, number: int, count: int) -> range:
        """Returns the shards of part `number` (from 0) if `count` workers share all shards evenly."""
        if not 0 <= number < count:
            raise refusal("range", f"the part is {number}, but it must be from 0 to {count - 1}")
        return range(number, len(self), count)

    def openjd(self, *, parts: int | None = None, python: str = "python") -> dict[str, Any]:
        """Returns an Open Job Description template (2023-09) whose tasks bake the shards.

        It is for farms such as Deadline Cloud. `parts` is the number of tasks: by default one for each shard, but at most
        1024, which is a common limit of farms. The template holds the absolute path or the address of the store.
        """
        check_shared(self.store)
        parts = min(len(self), 1024) if parts is None else parts
        if not 1 <= parts <= len(self):
            raise refusal("range", f"the number of parts is {parts}, but it must be from 1 to {len(self)}")
        return {
            "specificationVersion": "jobtemplate-2023-09",
            "name": "dapple-textures",
            "parameterDefinitions": [
                {"name": "Store", "type": "STRING", "default": str(self.store)},
                {"name": "Python", "type": "STRING", "default": python},
            ],
            "steps": [
                {
                    "name": "Bake",
                    "parameterSpace": {
                        "taskParameterDefinitions": [
                            {"name": "Part", "type": "INT", "range": f"0-{parts - 1}"}
                        ]
                    },
                    "script": {
                        "actions": {
                            "onRun": {
                                "command": "{{Param.Python}}",
                                "args": [
                                    "-m",
                                    "dapple_textures.jobs",
                                    "bake",
                                    "{{Param.Store}}",
                                    "--part",
                                    f"{{{{Task.Param.Part}}}}/{parts}",
                                ],
                            }
                        }
                    },
                }
            ],
        }

    def __repr__(self) -> str:
        return f"<Job of {len(self)} shards of {self.shard} in {self.store!r}: {', '.join(self.planes)}>"

    def _place(self, index: int) -> tuple[int, ...]:
        if not 0 <= index < len(self):
            raise refusal("range", f"the shard is {index}, but it must be from 0 to {len(self) - 1}")
        return tuple(int(part) for part in np.unravel_index(index, self.grid))

    def _key(self, plane: str, place: tuple[int, ...]) -> tuple[StorePath, str]:
        array = self.array(plane)
        channels = (0,) * (array.ndim - len(place))
        return array.store_path, array.metadata.encode_chunk_key((*place, *channels))

    def _is_there(self, plane: str, place: tuple[int, ...]) -> bool:
        path, key = self._key(plane, place)
        return bool(sync((path / key).exists()))

    def _missing(self, plane: str) -> set[int]:
        array = self.array(plane)
        path = array.store_path
        prefix = f"{path.path}/" if path.path else ""

        async def keys() -> set[str]:
            return {key.removeprefix(prefix) async for key in path.store.list_prefix(prefix)}

        there, encode = sync(keys()), array.metadata.encode_chunk_key
        channels = (0,) * (array.ndim - len(self.grid))
        places = enumerate(np.ndindex(*self.grid))
        return {index for index, place in places if encode((*place, *channels)) not in there}


def create(
    what: Recipe | Plan | Field | ColorField,
    shape: int | Sequence[int],
    planes: str | Sequence[str],
    store: Any,
    *,
    shard: int | Sequence[int] | Shard | Mapping[str, Any] = 2048,
    extent: float | Sequence[float] | None = None,
    origin: float | Sequence[float] | None = None,
    samples: _sources.Samples = "centers",
) -> Job:
    """Makes the arrays of a job in a store, or opens the job if the store already holds the same one.

    Parameters
    ----------
    what : Recipe, Plan, Field or ColorField
        A recipe or plan, whose maps are baked, or a field, whose plane is "value".
    shape : int or sequence of int
        (rows, columns); (frames, rows, columns) of a recipe is a loop in time, and (depth, rows, columns) of a field of
        three axes a volume. A number is both rows and columns.
    planes : str or sequence of str
        The names of the maps.
    store : object
        A path, the address of an object store (with fsspec), or a Zarr store.
    shard : int, sequence of int, Shard or dict, default 2048
        The shape of the part that a worker writes as one file or object; a number is both rows and columns, with 1
        along further axes. A `Shard` also has chunks and compressors.
    extent : float, sequence of float or None, default None
        As in `Field.render`, for fields only.
    origin : float, sequence of float or None, default None
        As in `Field.render`, for fields only.
    samples : {"centers", "corners"}, default "centers"
        The positions of the samples, as in `Plan.bake` and `Field.render`: with "corners" the last row and column are
        copies of the first ones where the tile repeats. It does not change the times of a loop.

    Returns
    -------
    Job
        The job. Its shards can be baked by any number of processes.

    Raises
    ------
    DappleError
        If there is no plane or one twice, a side is below 1, a chunk does not divide a shard, or the store holds
        something else.
    """
    source = _sources.source(what, extent=extent, origin=origin, samples=samples)
    planes = (planes,) if isinstance(planes, str) else tuple(planes)
    shape = _sources.sides(shape)
    source.check(shape)
    if not planes or len(set(planes)) < len(planes):
        raise refusal("planes", "at least one plane is needed, and each once")
    channels = {plane: source.channels(plane) for plane in planes}
    layout = read(Shard, "shard", shard) if isinstance(shard, (Shard, Mapping)) else Shard(shape=shard)
    shard = shard_sides(layout.shape, shape)
    chunk = shard if layout.chunk is None else shard_sides(layout.chunk, shape)
    if any(side < 1 for side in (*shape, *shard, *chunk)) or any(s % c for s, c in zip(shard, chunk)):
        message = f"the shape is {shape}, a shard {shard} and a chunk {chunk}, but sides must be at least 1, and a chunk divides a shard"
        raise refusal("shape", message)
    data = {
        "version": __version__,
        "source": source.to_data(),
        "planes": list(planes),
        "shape": list(shape),
        "shard": list(shard),
        "layout": {"chunk": list(chunk), "compressors": repr(layout.compressors)},
    }
    store = place_of(store)
    # Convert the data to the form in which JSON is read.
    data = json.loads(json.dumps(data))
    group = _group(store, data)
    before = group.attrs.get(_ATTRIBUTE)
    if before is None:
        raise refusal("store", f"{store} holds something else", "choose another place, or remove what is there")
    if before != data:
        message = f"{store} holds another job"
        raise refusal("store", message, "choose another place, or remove what is there")
    for hashed, image in source.images_by_hash().items():
        if f"{_IMAGES}/{hashed}" not in group:
            group.create_array(f"{_IMAGES}/{hashed}", data=image, overwrite=True)
    for plane in planes:
        last = (channels[plane],) if channels[plane] > 1 else ()
        if plane in group:
            continue
        try:
            group.create_array(
                plane,
                shape=(*shape, *last),
                shards=(*shard, *last) if chunk != shard else None,
                chunks=(*chunk, *last),
                dtype=np.float32,
                fill_value=np.nan,
                compressors=layout.compressors,
                dimension_names=(*_axes(len(shape), source), *(["channel"] if last else [])),
                attributes={**source.attributes(plane), "version": __version__},
            )
        except ContainsArrayError:
            pass
    _describe(group, source, shape)
    return Job(store)


def _describe(group: zarr.Group, source: _sources.RecipeSource | _sources.FieldSource, shape: tuple[int, ...]) -> None:
    """Adds coordinates of the samples to a group, and gathers its metadata in one file.

    xarray reads both. Sides that are longer than 2**24 have no coordinates.
    """
    if group.metadata.consolidated_metadata is not None:
        return
    for axis, side, (name, coordinates) in zip(_axes(len(shape), source), shape, source.coordinates(shape)):
        if side > _LONGEST:
            continue
        values = coordinates(np.arange(side))
        try:
            array = group.create_array(
                axis,
                shape=(len(values),),
                chunks=(len(values),),
                dtype=np.float64,
                dimension_names=(axis,),
                attributes={"long_name": name, "units": "1"},
            )
        except ContainsArrayError:
            found = group[axis]
            assert isinstance(found, zarr.Array)
            array = found
        array[:] = values
    with warnings.catch_warnings():
        # Ignore Zarr's warning that other programs may not support consolidated metadata: they read the other metadata.
        warnings.simplefilter("ignore")
        zarr.consolidate_metadata(group.store, path=group.path)


def _group(store: Any, data: dict[str, Any]) -> zarr.Group:
    """Opens the group of a store, or makes it with the description of a job if it does not exist.

    Another process may make it at the same moment. The group and the description are one file, so both write the same.
    """
    try:
        return zarr.open_group(store, mode="r+")
    except FileNotFoundError:
        pass
    try:
        return zarr.create_group(store, attributes={_ATTRIBUTE: data}, zarr_format=3)
    except ContainsGroupError:
        return zarr.open_group(store, mode="r+")


def place_of(store: Any) -> Any:
    """Returns the store in a form that is valid in any folder; paths become absolute."""
    if isinstance(store, LocalStore):
        store = store.root
    if isinstance(store, os.PathLike) or (isinstance(store, str) and "://" not in store):
        return os.path.abspath(os.fspath(store))
    if isinstance(store, ZipStore):
        raise refusal("store", "a job needs a store that writes a file or an object as a whole, which ZipStore does not")
    return store


def check_shared(store: Any) -> None:
    """Raises an error for a store in the memory of this process, which other processes cannot reach."""
    if isinstance(store, (dict, MemoryStore)) or str(store).startswith("memory://"):
        message = "the store lies in the memory of this process, and others do not see it"
        raise refusal("store", message, "give a path, or the address of an object store")


def _read_images(group: zarr.Group, source: dict[str, Any]) -> dict[str, _sources.Image]:
    """Reads the images of a job, by their SHA-256."""
    images = {}
    for image in source.get("images", ()):
        name = f"{_IMAGES}/{image['hash']}"
        if name not in group:
            raise refusal("store", f"the image `{image['name']}` is not there yet", "call `create` again")
        array = group[name]
        assert isinstance(array, zarr.Array)
        images[image["hash"]] = np.asarray(array[...], np.float32)
    return images


def _axes(count: int, source: object) -> tuple[str, ...]:
    first = "t" if isinstance(source, _sources.RecipeSource) else "z"
    return ("w", first, "y", "x")[4 - count :] if count != 3 else (first, "y", "x")


def shard_sides(side: Any, shape: Sequence[int]) -> tuple[int, ...]:
    """Returns the sides of a part of an array; a number is both rows and columns, with 1 along further axes."""
    sides = _sources.sides(side)
    try:
        operator.index(side)
        sides = (1,) * (len(shape) - 2) + sides
    except TypeError:
        pass
    if len(sides) != len(shape):
        raise refusal("count", f"a shard has {len(sides)} sides, but {len(shape)} are needed")
    return sides


def _grid(shape: Sequence[int], shard: Sequence[int]) -> tuple[int, ...]:
    return tuple(-(-side // part) for side, part in zip(shape, shard))


def _window(
    shape: Sequence[int], shard: Sequence[int], place: Sequence[int]
) -> tuple[slice, ...]:
    return tuple(
        slice(at * part, min((at + 1) * part, side)) for side, part, at in zip(shape, shard, place)
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command `python -m dapple_textures.jobs`."""
    parser = argparse.ArgumentParser(prog="python -m dapple_textures.jobs", description=__doc__.split("\n\n")[0])
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("create", help="make the arrays of a job")
    make.add_argument("store")
    make.add_argument("recipe", help="a file in TOML or JSON, or the name of a built-in recipe")
    make.add_argument("--size", required=True, help="size of the whole as COLUMNSxROWS, or one number for both")
    make.add_argument("--maps", default="height", help="names of maps, separated by commas (height)")
    make.add_argument("--frames", type=int, help="number of pictures of a loop in time")
    make.add_argument(
        "--samples",
        choices=get_args(_sources.Samples),
        default="centers",
        help="positions of the samples: centers of pixels, or corners of a grid that reaches the sides of the tile",
    )
    make.add_argument("--shard", type=int, default=2048)
    make.add_argument("--chunk", type=int)
    bake = commands.add_parser("bake", help="bake shards that are missing")
    bake.add_argument("store")
    bake.add_argument("--part", help="K/N bakes part K (from 0) of N equal parts; by default all shards")
    status = commands.add_parser("status", help="print how many shards are missing")
    status.add_argument("store")
    options = parser.parse_args(arguments)
    try:
        return _run(options)
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def _run(options: argparse.Namespace) -> int:
    job = _create(options) if options.command == "create" else Job(options.store)
    if options.command == "bake":
        indices: Iterable[int] = job.missing()
        if options.part:
            number, _, count = options.part.partition("/")
            indices = job.part(int(number), int(count))
        for record in job.bake_all(indices):
            state = "baked" if record.hashes else "was there"
            print(f"shard {record.index}: {state}", flush=True)
        return 0
    missing = job.missing()
    print(job)
    print(f"{len(missing)} of {len(job)} shards are missing")
    return 0


def _create(options: argparse.Namespace) -> Job:
    columns, _, rows = options.size.partition("x")
    size = (int(rows or columns), int(columns))
    shape = size if options.frames is None else (options.frames, *size)
    recipe = read_recipe(options.recipe)
    plan = recipe.plan(images=read_recipe_images(recipe, Path(options.recipe).parent))
    return create(
        plan,
        shape,
        options.maps.split(","),
        options.store,
        shard=Shard(shape=options.shard, chunk=options.chunk),
        samples=options.samples,
    )


if __name__ == "__main__":
    sys.exit(main())
