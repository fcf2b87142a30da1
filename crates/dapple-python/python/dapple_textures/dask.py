"""Recipes and fields on Dask: lazy arrays of any size, and Zarr stores that survive their workers."""

from __future__ import annotations

import math
import queue
import uuid
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

import dask.array as da
import numpy as np
from dask.delayed import delayed
from distributed import Client, Future, KilledWorker, get_client

from . import _sources, _workers, jobs
from ._native import ColorField, Field, Plan, Recipe, __version__
from ._types import refusal

#: Tasks that are in the hands of the scheduler for each thread of the workers, and at least: enough that none waits, and
#: few enough that a job of any length takes little memory there.
_AHEAD, _LEAST = 4, 64

#: The pixels of a task, at least: what takes longer than to hand it over.
_TASK = 1 << 20

#: How often a task is begun again after its workers died.
_ATTEMPTS = 10

#: After how many seconds without a finished task it is looked whether the scheduler and new workers are there.
_PATIENCE = 1.0


def bake(
    what: Recipe | Plan | Field | ColorField,
    shape: int | Sequence[int],
    plane: str | None = None,
    *,
    chunks: Any = 2048,
    extent: float | Sequence[float] | None = None,
    origin: float | Sequence[float] | None = None,
) -> da.Array:
    """A lazy array of any size: a map of a recipe, or the values of a field.

    Parameters
    ----------
    what : a recipe or a plan, or a field.
    shape : (rows, columns); (frames, rows, columns) of a recipe is a loop in time, and (depth, rows, columns) of a field
        of three axes a volume. A number is both rows and columns.
    plane : the map of a recipe, "height" by default. Normals, colors and ORM have a last axis of 3 channels.
    chunks : the shape of a chunk; a number is both rows and columns, and 1 along further axes. Also what Dask takes, such
        as "auto" and -1 for a whole axis.
    extent, origin : those of `Field.render`, for fields alone.
    """
    source = _sources.source(what, extent=extent, origin=origin)
    plane = plane or ("value" if isinstance(source, _sources.FieldSource) else "height")
    shape = _sources.sides(shape)
    source.check(shape)
    channels = source.channels(plane)
    last = (channels,) if channels > 1 else ()
    if isinstance(chunks, str):
        chunks = (chunks,) * len(shape)
    elif not isinstance(chunks, Sequence):
        chunks = jobs.shard_sides(chunks, shape)
    sides = da.core.normalize_chunks((*chunks, *last), shape=(*shape, *last), dtype=np.float32)
    return da.map_blocks(
        _workers.block,
        # One object for all chunks, so that it is sent to a worker once.
        delayed(source, name=f"dapple-source-{_sources.digest(source.to_data())}", pure=True),
        shape=shape,
        plane=plane,
        version=__version__,
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
    #: The hashes of shards; those that a worker wrote just before it died are not among them.
    records: list[jobs.Record] = field(repr=False)


def bake_to_zarr(
    what: Recipe | Plan | Field | ColorField,
    shape: int | Sequence[int],
    planes: str | Sequence[str],
    store: Any,
    *,
    shard: int | Sequence[int] = 2048,
    chunk: int | Sequence[int] | None = None,
    compressors: Any = "auto",
    extent: float | Sequence[float] | None = None,
    origin: float | Sequence[float] | None = None,
    resume: bool = True,
    client: Client | None = None,
) -> Report:
    """Bakes into a Zarr store on all workers of a cluster, however large the arrays are.

    A worker writes a shard and gives back its hash, so nothing is lost with a worker but the shards that it was at, which
    another one begins again. After the whole cluster died, the same call goes on where it ended. The arguments are those
    of `jobs.create`; with `resume=False` a job of which shards are there is refused. `client` is the current client by
    default, and workers may come and go.
    """
    client = client or get_client()
    jobs.check_shared(store)
    job = jobs.create(
        what, shape, planes, store, shard=shard, chunk=chunk, compressors=compressors, extent=extent, origin=origin
    )
    missing = job.missing()
    if not resume and len(missing) < len(job):
        raise refusal("store", f"{store} holds shards of this job already", "pass `resume=True`")
    run, baked = _Run(client, job), len(missing)
    while missing:
        run.bake(missing)
        left = job.missing()
        if len(left) == len(missing):
            message = f"{len(left)} shards were baked and are not there, the first of them {left[0]}"
            raise refusal("store", message, "give a place that all workers see")
        missing = left
    return Report(job, baked, run.restarted, run.records)


class _Run:
    """The shards of a job on their way through a cluster."""

    def __init__(self, client: Client, job: jobs.Job) -> None:
        self.client, self.job = client, job
        self.records: list[jobs.Record] = []
        self.restarted = 0
        # Workers open the job once for each call: what is in its place may be another one the next time.
        self._call = uuid.uuid4().hex
        self._begun: dict[Any, tuple[Future[Any], list[int], int]] = {}
        self._done: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()

    def bake(self, missing: list[int]) -> None:
        """Bakes shards on all workers that there are, or come."""
        tasks = _tasks(self.job, missing)
        try:
            self._fill(tasks)
            while self._begun:
                try:
                    done = self._done.get(timeout=_PATIENCE)
                except queue.Empty:
                    self._look()
                else:
                    self._end(done)
                self._fill(tasks)
        finally:
            self.client.cancel([future for future, _, _ in self._begun.values()])
            self._begun.clear()

    def _fill(self, tasks: Iterator[list[int]]) -> None:
        """Hands over as many tasks as workers are to have."""
        threads = sum(self.client.nthreads().values()) if self.client.status == "running" else 0
        for indices in islice(tasks, max(0, max(_LEAST, threads * _AHEAD) - len(self._begun))):
            self._submit(indices, 0)

    def _submit(self, indices: list[int], attempt: int) -> None:
        future = self.client.submit(_workers.bake_shards, self.job.store, self._call, indices, pure=False)
        self._begun[future.key] = future, indices, attempt
        future.add_done_callback(self._done.put)

    def _end(self, done: Future[Any]) -> None:
        """Takes what a task gave, or begins it again where it was lost with its worker."""
        if done.key not in self._begun:
            return
        _, indices, attempt = self._begun.pop(done.key)
        if done.status == "finished":
            try:
                records = done.result(timeout=_PATIENCE * 10)
            except TimeoutError:
                # The result went with its worker, but the shards did not: they are found.
                records = []
            self.records += [record for record in records if record.hashes]
            return
        error = done.exception() if done.status == "error" else None
        if error is not None and not isinstance(error, KilledWorker):
            raise error
        self._look()
        if attempt >= _ATTEMPTS:
            message = f"the shards {indices[0]} to {indices[-1]} were begun {attempt + 1} times and lost with their workers"
            raise refusal("cluster", message, "look at the memory of the workers; finished shards stay")
        self.restarted += 1
        self._submit(indices, attempt + 1)

    def _look(self) -> None:
        """Refuses to wait for a scheduler that is gone."""
        if self.client.status not in ("running", "connecting"):
            raise refusal("cluster", "the scheduler is gone", "call again: finished shards stay")


def _tasks(job: jobs.Job, missing: list[int]) -> Iterator[list[int]]:
    """The shards that are baked by one task each: several where they are small, since a task costs some milliseconds."""
    together = max(1, _TASK // math.prod(job.shard))
    together = min(together, max(1, len(missing) // _LEAST))
    remaining = iter(missing)
    while indices := list(islice(remaining, together)):
        yield indices
