"""Recipes and fields on Dask: lazy arrays of any size, and Zarr stores that survive their workers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import dask.array as da
import numpy as np
from dask.delayed import delayed
from distributed import Client, KilledWorker, as_completed, get_client

from . import _sources, _workers, jobs
from ._native import ColorField, Field, Plan, Recipe
from ._types import refusal

#: Tasks that are in the hands of the scheduler for each thread of the workers: enough that none waits, and few enough
#: that a job of any length takes little memory there.
_AHEAD = 4

#: The pixels of a task, at least: what takes longer than to hand it over.
_TASK = 1 << 20

#: How often a task is begun again after its workers died.
_ATTEMPTS = 10


def bake(
    what: Recipe | Plan | Field | ColorField,
    shape: int | Sequence[int],
    plane: str | None = None,
    *,
    chunks: int | Sequence[int] = 2048,
    extent: float | Sequence[float] | None = None,
    origin: float | Sequence[float] = 0.0,
) -> da.Array:
    """A lazy array of any size: a map of a recipe, or the values of a field.

    Parameters
    ----------
    what : a recipe or a plan, or a field.
    shape : (rows, columns); (frames, rows, columns) of a recipe is a loop in time, and (depth, rows, columns) of a field
        of three axes a volume. A number is both rows and columns.
    plane : the map of a recipe, "height" by default. Normals, colors and ORM have a last axis of 3 channels.
    chunks : the shape of a chunk; a number is both rows and columns, and 1 along further axes.
    extent, origin : those of `Field.render`, for fields alone.
    """
    source = _sources.source(what, extent=extent, origin=origin)
    plane = plane or ("value" if isinstance(source, _sources.FieldSource) else "height")
    shape = (shape, shape) if isinstance(shape, int) else tuple(int(side) for side in shape)
    chunk = jobs._sides(chunks, shape)
    channels = source.channels(plane)
    last = (channels,) if channels > 1 else ()
    sides = da.core.normalize_chunks((*chunk, *last), shape=(*shape, *last), dtype=np.float32)
    return da.map_blocks(
        _workers.block,
        # One object for all chunks, so that it is sent to a worker once.
        delayed(source, name=f"dapple-source-{_sources.digest(source.to_data())}", pure=True),
        shape=shape,
        plane=plane,
        chunks=sides,
        dtype=np.float32,
        meta=np.empty((0,) * len(sides), np.float32),
        name=f"dapple-{_sources.digest([source.to_data(), plane, shape, sides])}",
    )


@dataclass(frozen=True)
class Report:
    """What became of a job."""

    #: The job, whose arrays are whole now.
    job: jobs.Job
    #: The shards that were baked; the others were there before.
    baked: int
    #: How often a task was begun again after its workers died.
    restarted: int


def bake_to_zarr(
    what: Recipe | Plan | Field | ColorField,
    shape: int | Sequence[int],
    planes: str | Sequence[str],
    store: Any,
    *,
    shard: int | Sequence[int] = 2048,
    resume: bool = True,
    client: Client | None = None,
    **options: Any,
) -> Report:
    """Bakes into a Zarr store on all workers of a cluster, however large the arrays are.

    A worker writes a shard and gives back its hash, so nothing is lost with a worker but the shard that it was at, which
    another one begins again. After the whole cluster died, the same call goes on where it ended. The arguments are those
    of `jobs.create`; with `resume=False` a job that was begun before is refused. `client` is the current client by
    default.
    """
    client = client or get_client()
    job = jobs.create(what, shape, planes, store, shard=shard, **options)
    missing = job.missing()
    if not resume and len(missing) < len(job):
        raise refusal("store", f"{store} holds shards of this job already", "pass `resume=True`")
    client.register_plugin(_workers.OneThreadEach(), name="dapple-threads")
    restarted = sum(_run(client, job, missing))
    if lost := job.missing():
        message = f"{len(lost)} shards are not there although they were baked, the first of them {lost[0]}"
        raise refusal("store", message, "look at what else writes to the store, and call again")
    return Report(job, len(missing), restarted)


def _run(client: Client, job: jobs.Job, missing: list[int]) -> Iterator[int]:
    """Bakes shards on the workers, and tells of each task how often it was begun again."""
    threads = max(1, sum(client.nthreads().values()))
    tasks = iter(_tasks(job, missing, threads))
    running = as_completed()
    begun: dict[Any, tuple[list[int], int]] = {}

    def submit(indices: list[int], attempt: int = 0) -> None:
        future = client.submit(_workers.bake_shards, job.store, job.hash, indices, pure=False)
        begun[future.key] = indices, attempt
        running.add(future)

    for indices in islice(tasks, threads * _AHEAD):
        submit(indices)
    for future in running:
        indices, attempt = begun.pop(future.key)
        if future.status == "error":
            error = future.exception()
            if not isinstance(error, KilledWorker) or attempt >= _ATTEMPTS:
                raise error
            submit(indices, attempt + 1)
            continue
        future.release()
        yield attempt
        for indices in islice(tasks, 1):
            submit(indices)


def _tasks(job: jobs.Job, missing: list[int], threads: int) -> Iterator[list[int]]:
    """The shards that are baked by one task each: several where they are small, since a task costs some milliseconds."""
    together = max(1, _TASK // math.prod(job.shard))
    together = min(together, max(1, len(missing) // (threads * _AHEAD)))
    remaining = iter(missing)
    while indices := list(islice(remaining, together)):
        yield indices
