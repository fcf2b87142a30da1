"""Recipes and fields on Dask: lazy arrays of any size, and bakes to Zarr stores that survive the loss of workers."""

from __future__ import annotations

import math
import queue
import uuid
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
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

#: The number of tasks submitted to the scheduler per thread of the workers, and its minimum: enough that no worker waits,
#: and few enough that a job of any length takes little memory there.
_AHEAD, _LEAST = 4, 64

#: The least number of pixels of a task, so that its work takes longer than its submission.
_TASK = 1 << 20

#: How often a task is restarted after its worker died.
_ATTEMPTS = 10

#: The seconds without a finished task after which the scheduler and new workers are checked.
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
    """Returns a lazy array of any size: a map of a recipe, or the values of a field.

    Parameters
    ----------
    what : a recipe or a plan, or a field.
    shape : (rows, columns); (frames, rows, columns) of a recipe is a loop in time, and (depth, rows, columns) of a field
        of three axes a volume. A number is both rows and columns.
    plane : the map of a recipe, "height" by default. Normals, colors and ORM have a last axis of 3 channels.
    chunks : the shape of a chunk; a number is both rows and columns, with 1 along further axes. Other values of Dask also
        work, such as "auto", and -1 for a whole axis.
    extent, origin : as in `Field.render`, for fields only.
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
        # All chunks share one object, so that it is sent to a worker only once.
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
    """The result of baking a job."""

    #: The job, whose arrays are now complete.
    job: jobs.Job
    #: The number of shards that were baked; the others existed before.
    baked: int
    #: How often a task was restarted after its worker died.
    restarted: int
    #: The hashes of the baked shards, except shards that a worker wrote just before it died.
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
    """Bakes arrays of any size into a Zarr store, on all workers of a cluster.

    A worker writes a shard and returns its hash. If a worker dies, only its unfinished shards are lost, and another worker
    bakes them again. After the loss of the whole cluster, the same call continues where it stopped. The other arguments
    are those of `jobs.create`; with `resume=False` a job that has shards already is refused. `client` is the current
    client by default, and workers may come and go.
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
    """One run of a job on a cluster, with the tasks that are under way."""

    def __init__(self, client: Client, job: jobs.Job) -> None:
        self.client, self.job = client, job
        self.records: list[jobs.Record] = []
        self.restarted = 0
        # Workers open the job once for each call: at the next call the same place may hold another job.
        self._call = uuid.uuid4().hex
        self._begun: dict[Any, tuple[Future[Any], list[int], int]] = {}
        self._done: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()

    def bake(self, missing: list[int]) -> None:
        """Bakes shards on all current workers, and on workers that join later."""
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
        """Submits tasks until the workers have enough."""
        threads = self._threads()
        for indices in islice(tasks, max(0, max(_LEAST, threads * _AHEAD) - len(self._begun))):
            self._submit(indices, 0)

    def _threads(self) -> int:
        """The number of threads of all workers; 0 while the scheduler does not answer, which `_look` finds out about."""
        if self.client.status != "running":
            return 0
        try:
            return sum(self.client.nthreads().values())
        except OSError:
            return 0

    def _submit(self, indices: list[int], attempt: int) -> None:
        future = self.client.submit(_workers.bake_shards, self.job.store, self._call, indices, pure=False)
        self._begun[future.key] = future, indices, attempt
        future.add_done_callback(self._done.put)

    def _end(self, done: Future[Any]) -> None:
        """Takes the result of a task, or restarts the task if it was lost with its worker."""
        if done.key not in self._begun:
            return
        _, indices, attempt = self._begun.pop(done.key)
        if done.status == "finished":
            try:
                records = done.result(timeout=_PATIENCE * 10)
            except (CancelledError, TimeoutError):
                # The result was lost with its worker, but the shards are in the store and will be found.
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
        """Raises an error if the scheduler is gone."""
        if self.client.status not in ("running", "connecting"):
            raise refusal("cluster", "the scheduler is gone", "call again: finished shards stay")


def _tasks(job: jobs.Job, missing: list[int]) -> Iterator[list[int]]:
    """Groups shards into tasks: several small shards per task, since each task has an overhead of some milliseconds."""
    together = max(1, _TASK // math.prod(job.shard))
    together = min(together, max(1, len(missing) // _LEAST))
    remaining = iter(missing)
    while indices := list(islice(remaining, together)):
        yield indices
