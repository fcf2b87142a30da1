"""What runs in the workers of a Dask cluster. It does not need `dask.array`, which takes half of a worker's memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from distributed import Worker, WorkerPlugin

from ._native import set_threads
from ._types import refusal

if TYPE_CHECKING:
    from . import _sources, jobs

#: The job that a worker has opened last.
_open: jobs.Job | None = None


def block(
    source: _sources.Source, *, shape: tuple[int, ...], plane: str, block_info: dict[Any, Any]
) -> _sources.Image:
    """A chunk of a lazy array."""
    location = block_info[None]["array-location"]
    window = tuple(slice(first, end) for first, end in location[: len(shape)])
    return source.render(shape, [plane], window)[plane]


def bake_shards(store: Any, digest: str, indices: list[int]) -> list[jobs.Record]:
    """Bakes shards of the job with this hash; those that are there already take no time."""
    from .jobs import Job

    global _open
    # One job may be baked into several stores.
    if _open is None or _open.hash != digest or _open.store != store:
        _open = Job(store)
        if _open.hash != digest:
            raise refusal("store", f"{store} holds another job than the scheduler was given")
    job = _open
    return [job.bake(index) for index in indices]


class OneThreadEach(WorkerPlugin):
    """Gives each task of a worker one thread, so that tasks and threads together are as many as the worker has."""

    def setup(self, worker: Worker) -> None:
        """Sets the threads of the package to those of the worker."""
        set_threads(worker.state.nthreads)
