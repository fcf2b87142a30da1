"""Code that runs in the workers of a Dask cluster, without `dask.array`, which takes half of a worker's memory."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from distributed import get_worker

from ._native import __version__, set_threads
from ._types import refusal

if TYPE_CHECKING:
    from . import _sources, jobs

#: The job that this worker opened last, and the call that it belongs to.
_open: tuple[str, jobs.Job] | None = None

#: The process whose number of threads has been set.
_prepared: int | None = None


def block(
    source: _sources.Source, *, shape: tuple[int, ...], plane: str, version: str, block_info: dict[Any, Any]
) -> _sources.Image:
    """Renders a chunk of a lazy array."""
    _prepare()
    if version != __version__:
        message = f"the array was made by version {version}, but this worker has {__version__}"
        raise refusal("version", message, "use one version on all machines")
    location = block_info[None]["array-location"]
    window = tuple(slice(first, end) for first, end in location[: len(shape)])
    return source.render(shape, [plane], window)[plane]


def bake_shards(store: Any, call: str, indices: list[int]) -> list[jobs.Record]:
    """Bakes shards of the job in a store; shards that exist already take no time."""
    from .jobs import Job

    global _open
    _prepare()
    if _open is None or _open[0] != call:
        _open = call, Job(store)
    _, job = _open
    return [job.bake(index) for index in indices]


def _prepare() -> None:
    """Sets the threads of the package to the threads of the worker, unless `DAPPLE_THREADS` sets them.

    It does so only if the process belongs to the worker alone. The tasks of a machine together then use as many threads as
    its workers have.
    """
    global _prepared
    if _prepared == os.getpid():
        return
    _prepared = os.getpid()
    try:
        worker = get_worker()
    except ValueError:
        return
    if worker.nanny is not None and "DAPPLE_THREADS" not in os.environ:
        set_threads(worker.state.nthreads)
