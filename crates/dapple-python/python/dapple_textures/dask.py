"""Recipes and fields on Dask: lazy arrays of any size, and bakes to Zarr stores that survive the loss of workers."""

from __future__ import annotations

import math
import operator
import queue
import uuid
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass, field
from itertools import islice
from typing import Any, SupportsIndex

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
    samples: _sources.Samples = "centers",
) -> da.Array:
    """Returns a lazy array of any size: a map of a recipe, or the values of a field.

    Parameters
    ----------
    what : Recipe, Plan, Field or ColorField
        A recipe or a plan, or a field.
    shape : int or sequence of int
        (rows, columns); (frames, rows, columns) of a recipe is a loop in time, and (depth, rows, columns) of a field of
        three axes a volume. A number is both rows and columns.
    plane : str or None, default None
        The map of a recipe, "height" by default. Normals, colors and ORM have a last axis of 3 channels.
    chunks : object, default 2048
        The shape of a chunk; a number is both rows and columns, with 1 along further axes. Other values of Dask also
        work, such as "auto", -1 for a whole axis, and a dictionary of axes by number.
    extent : float, sequence of float or None, default None
        As in `Field.render`, for fields only.
    origin : float, sequence of float or None, default None
        As in `Field.render`, for fields only.
    samples : {"centers", "corners"}, default "centers"
        The positions of the samples, as in `Plan.bake` and `Field.render`: with "corners" the last row and column are
        copies of the first ones where the tile repeats. It does not change the times of a loop.

    Returns
    -------
    da.Array
        The array, which computes nothing until it is asked for values.

    Raises
    ------
    DappleError
        If `chunks` names an axis that the array lacks, a plane is unknown, or the shape does not fit the source.
    """
    source = _sources.source(what, extent=extent, origin=origin, samples=samples)
    plane = plane or ("value" if isinstance(source, _sources.FieldSource) else "height")
    shape = _sources.sides(shape)
    source.check(shape)
    channels = source.channels(plane)
    last = (channels,) if channels > 1 else ()
    if isinstance(chunks, Mapping):
        chunks = _chunks_by_axis(chunks, len(shape))
    elif isinstance(chunks, str):
        chunks = (chunks,) * len(shape)
    elif not isinstance(chunks, Sequence):
        chunks = jobs.shard_sides(chunks, shape)
    sides = da.core.normalize_chunks((*chunks, *last), shape=(*shape, *last), dtype=np.float32)
    return da.map_blocks(
        _workers.block,
        # Share one object among all chunks, so that it is sent to a worker only once.
        delayed(source, name=f"dapple-source-{_sources.digest(source.to_data())}", pure=True),
        shape=shape,
        plane=plane,
        version=__version__,
        chunks=sides,
        dtype=np.float32,
        meta=np.empty((0,) * len(sides), np.float32),
        name=f"dapple-{_sources.digest([source.to_data(), plane, shape, sides])}",
    )


def _chunks_by_axis(chunks: Mapping[Any, Any], n_axes: int) -> tuple[Any, ...]:
    """Returns the chunks along all axes; along axes that are not named, a whole axis is one chunk, as in Dask."""
    for axis in chunks:
        if not isinstance(axis, SupportsIndex) or not -n_axes <= operator.index(axis) < n_axes:
            message = f"the chunks name the axis {axis!r}, but the axes are the numbers from 0 to {n_axes - 1}"
            raise refusal("chunks", message)
    by_axis = {operator.index(axis) % n_axes: sides for axis, sides in chunks.items()}
    return tuple(by_axis.get(axis, -1) for axis in range(n_axes))


@dataclass(frozen=True)
class Report:
    """The result of baking a job."""

    #: The job, whose arrays are now complete.
    job: jobs.Job
    #: The number of shards that were baked; the others existed before.
    baked: int
    #: The number of tasks that were lost when their workers died, and baked again.
    restarted: int
    #: The hashes of the baked shards, except shards that a worker wrote just before it died.
    records: list[jobs.Record] = field(repr=False)


def bake_job(job: jobs.Job, *, resume: bool = True, client: Client | None = None) -> Report:
    """Bakes the shards of a job that are missing, on all workers of a cluster.

    A worker writes a shard and returns its hash. If a worker dies, only its unfinished shards are lost, and another worker
    bakes them again. After the loss of the whole cluster, the same call continues where it stopped.

    Parameters
    ----------
    job : Job
        A job of `jobs.create`, in a store that all workers see.
    resume : bool, default True
        Whether the job may have shards already; if not, it is refused.
    client : Client or None, default None
        The client of the cluster, by default the current one. Workers may come and go.

    Returns
    -------
    Report
        What was baked.

    Raises
    ------
    DappleError
        If the store is in the memory of this process, or the job has shards and `resume` is False.
    """
    client = client or get_client()
    jobs.check_shared(job.store)
    missing = job.missing()
    if not resume and len(missing) < len(job):
        raise refusal("store", f"{job.store} holds shards of this job already", "pass `resume=True`")
    run, baked = _Run(client, job), len(missing)
    while missing:
        run.bake(missing)
        left = job.missing()
        if len(left) == len(missing):
            message = f"{len(left)} shards were baked and are not there, the first of them {left[0]}"
            raise refusal("store", message, "give a place that all workers see")
        missing = left
    return Report(job, baked, run.restarted + run.lost(), run.records)


class _Run:
    """One run of a job on a cluster, with the tasks that are under way."""

    def __init__(self, client: Client, job: jobs.Job) -> None:
        self.client, self.job = client, job
        self.records: list[jobs.Record] = []
        self.restarted = 0
        # Workers open the job once for each call: at the next call the same place may hold another job.
        self._call = uuid.uuid4().hex
        self._prefix = f"dapple-bake-{self._call}-"
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
        key = f"{self._prefix}{uuid.uuid4().hex}"
        future = self.client.submit(_workers.bake_shards, self.job.store, self._call, indices, key=key)
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
                # The result was lost with its worker, but the shards are in the store, and `missing` finds them.
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
        # A lost worker is an event of the scheduler, which counts its tasks.
        self.restarted += error is None
        self._submit(indices, attempt + 1)

    def lost(self) -> int:
        """Returns the number of tasks whose workers died, as the scheduler has noted: it begins most of them again itself."""
        try:
            events = self.client.get_events("all")
        except OSError:
            return 0
        dead = (event for _, event in events if event.get("action") == "remove-worker" and not event.get("expected"))
        return sum(str(key).startswith(self._prefix) for event in dead for key in event["processing-tasks"])

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
