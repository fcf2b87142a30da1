"""A Dask cluster whose workers are killed."""

from __future__ import annotations

import os
import random
import signal
import threading
import time

import numpy as np
import pytest

import dapple_textures as dp

pytest.importorskip("distributed")
pytest.importorskip("zarr")

from dask import config  # noqa: E402
from distributed import Client, LocalCluster, WorkerPlugin  # noqa: E402

from dapple_textures import jobs  # noqa: E402
from dapple_textures.dask import bake, bake_to_zarr  # noqa: E402

RECIPE = dp.Recipe.builtin("rock")
SHAPE = (1000, 1200)
PLANES = ["height", "normal"]

# Without these, a worker that was killed is missed for a minute.
config.set({"distributed.comm.timeouts.connect": "10s", "distributed.nanny.pre-spawn-environ.DAPPLE_THREADS": "1"})


@pytest.fixture(scope="module")
def whole():
    return RECIPE.plan().bake(SHAPE, PLANES)


def cluster(workers=3):
    return LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None)


def assert_whole(job, whole):
    assert jobs.Job(job.store).missing() == []
    for plane in PLANES:
        assert np.array_equal(job.array(plane)[:], whole[plane]), plane


def pids(client):
    return list(client.run(os.getpid).values())


@pytest.mark.parametrize("chunks", [256, (333, 1200)])
def test_lazy_arrays_are_the_whole(whole, chunks):
    with cluster(2) as workers, Client(workers):
        lazy = bake(RECIPE, SHAPE, "normal", chunks=chunks)
        assert lazy.shape == (1000, 1200, 3) and lazy.dtype == np.float32
        assert np.array_equal(lazy.compute(), whole["normal"])
        assert np.array_equal(lazy[900:, :10].compute(), whole["normal"][900:, :10])


def test_lazy_arrays_need_no_cluster(whole):
    lazy = bake(RECIPE, (200_000, 200_000), "height", chunks=2048)
    assert lazy.shape == (200_000, 200_000)
    corner = RECIPE.plan().bake((200_000, 200_000), window=np.s_[4000:4100, 100_000:100_050])["height"]
    assert np.array_equal(lazy[4000:4100, 100_000:100_050].compute(scheduler="sync"), corner)
    clip = bake(RECIPE, (4, 64, 64), "albedo", chunks=32)
    assert clip.shape == (4, 64, 64, 3) and clip.chunksize == (1, 32, 32, 3)
    cells = dp.worley(dims=3)
    volume = bake(cells, (16, 32, 32), chunks=(8, 16, 16), extent=4.0).compute(scheduler="sync")
    assert np.array_equal(volume, cells.render((16, 32, 32), extent=4))
    assert bake(cells, (16, 32, 32)).name == bake(cells, (16, 32, 32)).name != bake(cells, (16, 32, 33)).name
    with pytest.raises(dp.DappleError) as caught:
        bake(dp.Recipe.builtin("stone-and-grass"), 1000)
    assert caught.value.kind == "global"


def test_two_of_three_workers_are_killed(tmp_path, whole):
    with cluster(3) as workers, Client(workers) as client:
        victims = pids(client)[:2]

        def kill(report_at):
            store = tmp_path / "a.zarr/height/c"
            for victim, enough in zip(victims, report_at):
                while sum(1 for path in store.rglob("*") if path.is_file()) < enough:
                    time.sleep(0.01)
                os.kill(victim, signal.SIGKILL)

        killer = threading.Thread(target=kill, args=([20, 50],))
        killer.start()
        report = bake_to_zarr(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=100, client=client)
        killer.join()
        assert report.baked == 120
        assert_whole(report.job, whole)
        again = bake_to_zarr(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=100, client=client)
        assert again.baked == 0
        with pytest.raises(dp.DappleError, match="already"):
            bake_to_zarr(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=100, client=client, resume=False)


def test_one_job_in_two_places(tmp_path):
    with cluster(1) as workers, Client(workers) as client:
        for place in ("a.zarr", "b.zarr"):
            report = bake_to_zarr(dp.constant(0.5), 64, "value", str(tmp_path / place), shard=32, client=client)
            assert (report.job.array("value")[:] == 0.5).all()


class DieInside(WorkerPlugin):
    """Ends the process in the middle of a shard, as often as there are files to take away."""

    def __init__(self, folder):
        self.folder = folder

    def setup(self, worker):
        from dapple_textures import _sources

        render, folder = _sources.RecipeSource.render, self.folder

        def dying(source, shape, planes, window):
            made = render(source, shape, planes, window)
            for token in os.listdir(folder):
                try:
                    os.remove(os.path.join(folder, token))
                except FileNotFoundError:
                    continue
                os._exit(1)
            return made

        _sources.RecipeSource.render = dying


def test_workers_that_die_inside_of_a_shard(tmp_path, whole):
    deaths = tmp_path / "deaths"
    deaths.mkdir()
    for number in range(5):
        (deaths / str(number)).touch()
    with cluster(2) as workers, Client(workers) as client:
        client.register_plugin(DieInside(str(deaths)))
        report = bake_to_zarr(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=200, client=client)
        assert not os.listdir(deaths)
        assert_whole(report.job, whole)


def test_a_whole_cluster_is_killed_and_the_job_resumed(tmp_path, whole):
    place = str(tmp_path / "a.zarr")
    workers = cluster(2)
    client = Client(workers)
    job = jobs.create(RECIPE, SHAPE, PLANES, place, shard=100)
    futures = client.map(job.bake, range(60), pure=False)
    futures[random.Random(1).randrange(10, 50)].result()
    for pid in pids(client):
        os.kill(pid, signal.SIGKILL)
    client.close()
    workers.close()
    missing = jobs.Job(place).missing()
    assert 60 <= len(missing) < 120
    with cluster(2) as workers, Client(workers) as client:
        report = bake_to_zarr(RECIPE, SHAPE, PLANES, place, shard=100, client=client)
    assert report.baked == len(missing)
    assert_whole(report.job, whole)


def test_the_current_client_is_taken_and_errors_come_through(tmp_path):
    with cluster(1) as workers, Client(workers):
        report = bake_to_zarr(dp.worley(), (100, 100), "value", str(tmp_path / "a.zarr"), shard=64, extent=9.0)
        assert np.array_equal(report.job.array("value")[:], dp.worley().render(100, extent=9))
        with pytest.raises(dp.DappleError, match="hieght"):
            bake_to_zarr(RECIPE, 100, ["hieght"], str(tmp_path / "b.zarr"))
