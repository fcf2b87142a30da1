"""A Dask cluster whose workers are killed."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import dapple_textures as dp

pytest.importorskip("distributed")
pytest.importorskip("zarr")

from dask import config  # noqa: E402
from distributed import Client, Future, LocalCluster, WorkerPlugin  # noqa: E402

from dapple_textures import jobs  # noqa: E402
from dapple_textures.dask import bake, bake_job  # noqa: E402

RECIPE = dp.Recipe.builtin("rock")
SHAPE = (1000, 1200)
PLANES = ["height", "normal"]

# Without these, a worker that was killed is missed for a minute.
config.set({"distributed.comm.timeouts.connect": "10s"})


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


def test_samples_on_corners_are_those_of_a_plan(tmp_path):
    corners = RECIPE.plan().bake((65, 33), PLANES, samples="corners")
    lazy = bake(RECIPE, (65, 33), "normal", chunks=20, samples="corners")
    assert np.array_equal(lazy.compute(), corners["normal"])
    with cluster(1) as workers, Client(workers):
        report = bake_job(jobs.create(RECIPE, (65, 33), PLANES, tmp_path / "a.zarr", shard=20, samples="corners"))
    assert_whole(report.job, corners)


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
    by_axis = bake(cells, (16, 32, 32), chunks={0: 8, -1: 16}, extent=4.0)
    assert by_axis.chunksize == (8, 32, 16) and np.array_equal(by_axis.compute(scheduler="sync"), volume)
    for chunks in ({3: 8}, {"x": 8}):
        with pytest.raises(dp.DappleError, match="from 0 to 2"):
            bake(cells, (16, 32, 32), chunks=chunks)
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
        report = bake_job(jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=100), client=client)
        killer.join()
        assert report.baked == 120 and report.restarted >= 2
        assert_whole(report.job, whole)
        again = bake_job(jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=100), client=client)
        assert again.baked == 0
        with pytest.raises(dp.DappleError, match="already"):
            bake_job(jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=100), client=client, resume=False)


def test_one_job_in_two_places(tmp_path):
    with cluster(1) as workers, Client(workers) as client:
        for place in ("a.zarr", "b.zarr"):
            report = bake_job(jobs.create(dp.constant(0.5), 64, "value", str(tmp_path / place), shard=32), client=client)
            assert (report.job.array("value")[:] == 0.5).all()
            assert [record.index for record in sorted(report.records, key=lambda record: record.index)] == [0, 1, 2, 3]
        # What is in a place may be another layout the next time.
        shutil.rmtree(tmp_path / "a.zarr")
        report = bake_job(jobs.create(dp.constant(0.5), 64, "value", str(tmp_path / "a.zarr"), shard={"shape": 32, "chunk": 16}), client=client)
        assert (report.job.array("value")[:] == 0.5).all()


def test_a_cluster_that_is_restarted_goes_on(tmp_path):
    with cluster(2) as workers, Client(workers) as client:

        def restart():
            while not list((tmp_path / "a.zarr/height/c").glob("*/*")):
                time.sleep(0.01)
            client.restart()

        restarter = threading.Thread(target=restart)
        restarter.start()
        report = bake_job(jobs.create(RECIPE, (600, 600), "height", str(tmp_path / "a.zarr"), shard=16), client=client)
        restarter.join()
        assert report.restarted > 0 and jobs.Job(report.job.store).missing() == []


def test_a_result_may_be_lost_while_it_is_fetched(tmp_path, monkeypatch):
    fetch, fetched = Future.result, []

    def restart_first(future, **kwargs):
        if not fetched:
            client.restart()
        fetched.append(future)
        return fetch(future, **kwargs)

    monkeypatch.setattr(Future, "result", restart_first)
    with cluster(2) as workers, Client(workers) as client:
        report = bake_job(jobs.create(RECIPE, (300, 300), "height", str(tmp_path / "a.zarr"), shard=100), client=client)
        assert fetched[0].status == "cancelled"
        assert jobs.Job(report.job.store).missing() == [] and len(report.records) < 9


def test_workers_may_come_late_and_the_client_need_not_be_the_default(tmp_path):
    with cluster(0) as workers, Client(workers, set_as_default=False) as client:
        grow = threading.Timer(0.5, lambda: workers.scale(2))
        grow.start()
        report = bake_job(jobs.create(RECIPE, (300, 300), "height", str(tmp_path / "a.zarr"), shard=100), client=client)
        assert report.baked == 9


def test_a_scheduler_that_is_gone_is_an_error(tmp_path):
    command = [sys.executable, "-m", "dask", "scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(tmp_path / "scheduler")]
    scheduler = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    try:
        with config.set({"distributed.comm.timeouts.connect": "2s"}):
            client = Client(scheduler_file=str(tmp_path / "scheduler"), timeout=8)
            # Nobody works: it waits for workers until there is no scheduler.
            threading.Timer(1, scheduler.kill).start()
            with pytest.raises(dp.DappleError) as caught:
                bake_job(jobs.create(RECIPE, 64, "height", str(tmp_path / "a.zarr")), client=client)
            assert caught.value.kind == "cluster"
            client.close(timeout=1)
    finally:
        scheduler.kill()


def test_a_lost_worker_that_the_scheduler_gives_up_is_tried_again(tmp_path, whole):
    deaths = tmp_path / "deaths"
    deaths.mkdir()
    (deaths / "one").touch()
    with config.set({"distributed.scheduler.allowed-failures": 0}), cluster(2) as workers, Client(workers) as client:
        client.register_plugin(DieInside(str(deaths)))
        report = bake_job(jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=400), client=client)
        assert report.restarted > 0
        assert_whole(report.job, whole)


def test_tasks_have_the_threads_of_their_worker(tmp_path):
    with config.set({"distributed.nanny.pre-spawn-environ.DAPPLE_THREADS": None}):
        with LocalCluster(n_workers=1, threads_per_worker=2, dashboard_address=None) as workers, Client(workers) as client:
            bake(RECIPE, (64, 64), chunks=32).compute()
            assert list(client.run(dp.threads).values()) == [2]
        with cluster(1) as workers, Client(workers) as client:
            bake_job(jobs.create(RECIPE, 64, "height", str(tmp_path / "a.zarr")), client=client)
            assert list(client.run(dp.threads).values()) == [1]
    before = dp.threads()
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as workers, Client(workers):
        bake_job(jobs.create(RECIPE, 64, "height", str(tmp_path / "b.zarr")))
    assert dp.threads() == before


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
        report = bake_job(jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=200), client=client)
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
        report = bake_job(jobs.create(RECIPE, SHAPE, PLANES, place, shard=100), client=client)
    assert report.baked == len(missing)
    assert_whole(report.job, whole)


def test_the_current_client_is_taken_and_errors_come_through(tmp_path):
    with cluster(1) as workers, Client(workers):
        report = bake_job(jobs.create(dp.worley(), (100, 100), "value", str(tmp_path / "a.zarr"), shard=64, extent=9.0))
        assert np.array_equal(report.job.array("value")[:], dp.worley().render(100, extent=9))
        with pytest.raises(dp.DappleError, match="hieght"):
            bake_job(jobs.create(RECIPE, 100, ["hieght"], str(tmp_path / "b.zarr")))
