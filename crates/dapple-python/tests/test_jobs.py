"""Shards in a store: whole or not there, and baked once."""

from __future__ import annotations

import json
import os
import pickle
import shutil
import subprocess
import sys

import numpy as np
import pytest

import dapple_textures as dp

pytest.importorskip("zarr")

from dapple_textures import jobs  # noqa: E402

RECIPE = dp.Recipe.builtin("flagstone")
SHAPE = (200, 300)
PLANES = ["height", "normal", "metallic"]


@pytest.fixture(scope="module")
def whole():
    return RECIPE.plan().bake(SHAPE, PLANES)


def assert_whole(job, whole):
    assert job.missing() == []
    for plane in job.planes:
        assert np.array_equal(job.array(plane)[:], whole[plane]), plane


@pytest.mark.parametrize("chunk", [None, 32])
def test_shards_in_any_order_make_the_whole(tmp_path, whole, chunk):
    job = jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=dp.Shard(shape=64, chunk=chunk))
    assert len(job) == 20 and job.missing() == list(range(20))
    assert job.array("normal").shape == (200, 300, 3)
    for index in np.random.default_rng(1).permutation(20):
        record = job.bake(int(index))
        assert list(record.hashes) == PLANES
    assert_whole(job, whole)
    assert list(job.bake_all([3, 19])) == [jobs.Record(3, {}), jobs.Record(19, {})]


def test_a_job_is_resumed_where_a_plane_is_missing(tmp_path, whole):
    place = str(tmp_path / "a.zarr")
    job = jobs.create(RECIPE, SHAPE, PLANES, place, shard=100)
    first = list(job.bake_all())
    # As if a machine died between the planes of a shard: a metallic of 0 is a shard like others.
    os.remove(tmp_path / "a.zarr/metallic/c/1/1")
    shutil.rmtree(tmp_path / "a.zarr/normal/c/0")
    (tmp_path / "a.zarr/height/c/0/2.partial").write_bytes(b"half of a shard")
    again = jobs.create(RECIPE, SHAPE, PLANES, place, shard=100)
    assert again.missing() == [0, 1, 2, 4]
    records = {record.index: record.hashes for record in again.bake_all()}
    assert {index: list(hashes) for index, hashes in records.items()} == {
        0: ["normal"], 1: ["normal"], 2: ["normal"], 4: ["metallic"]
    }
    for index, hashes in records.items():
        assert hashes.items() <= first[index].hashes.items()
    assert_whole(again, whole)


def test_another_job_in_the_same_place_is_refused(tmp_path):
    place = str(tmp_path / "a.zarr")
    job = jobs.create(RECIPE, SHAPE, PLANES, place, shard=64)
    for arguments, options in [
        ((RECIPE.with_seed(1), SHAPE, PLANES), {"shard": 64}),
        ((RECIPE, (200, 301), PLANES), {"shard": 64}),
        ((RECIPE, SHAPE, ["height"]), {"shard": 64}),
        ((RECIPE, SHAPE, PLANES), {"shard": 65}),
    ]:
        with pytest.raises(dp.DappleError) as caught:
            jobs.create(*arguments, place, **options)
        assert caught.value.kind == "store"
    assert jobs.Job(place).hash == job.hash
    with pytest.raises(dp.DappleError, match="holds no job"):
        import zarr

        zarr.open_group(str(tmp_path / "b.zarr"), mode="a")
        jobs.Job(str(tmp_path / "b.zarr"))


def test_another_version_is_refused(tmp_path):
    place = tmp_path / "a.zarr"
    jobs.create(RECIPE, SHAPE, PLANES, str(place))
    text = (place / "zarr.json").read_text()
    (place / "zarr.json").write_text(text.replace(f'"version": "{dp.__version__}"', '"version": "0.0.1"'))
    with pytest.raises(dp.DappleError) as caught:
        jobs.Job(str(place))
    assert caught.value.kind == "version" and "0.0.1" in str(caught.value)


def test_a_recipe_that_sees_the_whole_tile_is_refused_before_anything_is_written(tmp_path):
    with pytest.raises(dp.DappleError) as caught:
        jobs.create(dp.Recipe.builtin("stone-and-grass"), 100, "height", str(tmp_path / "a.zarr"))
    assert caught.value.kind == "global" and "image" in caught.value.hint
    assert not list(tmp_path.iterdir())


def test_loops_in_time_and_volumes(tmp_path):
    moving = dp.Recipe({"dapple": 1, "extent": [4, 4], "nodes": {"a": {"worley": {"motion": {"cells": 1}}}}, "material": {"height": "a"}})
    job = jobs.create(moving, (5, 40, 60), "height", str(tmp_path / "loop.zarr"), shard=32)
    assert job.shard == (1, 32, 32) and len(job) == 20
    assert len(list(job.bake_all())) == 20
    for frame in range(5):
        assert np.array_equal(job.array("height")[frame], moving.plan(time=frame / 5).bake((40, 60))["height"])
    cells = dp.worley(seed=7, dims=3)
    job = jobs.create(cells, (20, 30, 40), "value", str(tmp_path / "cells.zarr"), shard=(8, 16, 16), extent=(4, 3, 2), origin=1)
    list(job.bake_all())
    assert np.array_equal(job.array("value")[:], cells.render((20, 30, 40), extent=(4, 3, 2), origin=(1, 1, 1)))
    assert job.array("value").metadata.dimension_names == ("z", "y", "x")


def test_a_job_holds_the_images_of_its_recipe(tmp_path):
    image = np.random.default_rng(1).random((16, 24), np.float32)
    recipe = dp.Recipe({"dapple": 1, "nodes": {"a": {"image": {"file": "a.png"}}}, "material": {"height": "a"}})
    plan = recipe.plan(images={"a.png": image})
    job = pickle.loads(pickle.dumps(jobs.create(plan, 64, "height", str(tmp_path / "a.zarr"), shard=32)))
    list(job.bake_all())
    assert np.array_equal(job.array("height")[:], plan.bake(64)["height"])


def test_parts_share_all_shards(tmp_path):
    job = jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=64)
    parts = [index for number in range(3) for index in job.part(number, 3)]
    assert sorted(parts) == list(range(20))
    for number, count in [(3, 3), (-1, 3), (0, 0)]:
        with pytest.raises(dp.DappleError):
            job.part(number, count)
    for index in (-1, 20):
        with pytest.raises(dp.DappleError, match="from 0 to 19"):
            job.bake(index)


@pytest.mark.parametrize(
    ("options", "kind"),
    [
        ({"shard": 0}, "shape"),
        ({"shard": (1, 2, 3)}, "count"),
        ({"shard": {"shape": 64, "chunk": 48}}, "shape"),
        ({"shard": {"shap": 64}}, "options"),
        ({"extent": 2.0}, "conflict"),
        ({"origin": 2.0}, "conflict"),
        ({"shape": (1, 2, 3, 4)}, "shape"),
        ({"what": dp.worley(dims=3), "planes": "value"}, "shape"),
        ({"what": dp.worley(), "planes": "value", "extent": (1, 2, 3)}, "extent"),
        ({"what": dp.worley(), "planes": "value", "extent": float("nan")}, "extent"),
        ({"planes": ["hieght"]}, "name"),
        ({"planes": []}, "planes"),
        ({"planes": ["height", "height"]}, "planes"),
    ],
)
def test_a_job_is_refused_before_anything_is_written(tmp_path, options, kind):
    options = dict(options)
    what, shape, planes = options.pop("what", RECIPE), options.pop("shape", SHAPE), options.pop("planes", PLANES)
    with pytest.raises(dp.DappleError) as caught:
        jobs.create(what, shape, planes, str(tmp_path / "a.zarr"), **options)
    assert caught.value.kind == kind
    assert not list(tmp_path.iterdir())


def test_stores_that_other_processes_do_not_see_stay_in_this_one(tmp_path, whole):
    import zarr

    job = jobs.create(RECIPE, SHAPE, PLANES, zarr.storage.MemoryStore(), shard=64)
    assert len(list(job.bake_all())) == 20
    assert_whole(job, whole)
    for give in (pickle.dumps, jobs.Job.openjd):
        with pytest.raises(dp.DappleError) as caught:
            give(job)
        assert caught.value.kind == "store"
    with pytest.raises(dp.DappleError, match="as a whole"):
        jobs.create(RECIPE, SHAPE, PLANES, zarr.storage.ZipStore(tmp_path / "a.zip", mode="w"))


def test_numpy_numbers_and_relative_paths(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    job = jobs.create(RECIPE, np.int64(64), "height", "a.zarr", shard=np.int64(32))
    assert job.store == str(tmp_path / "a.zarr") and job.shape == (64, 64) and len(job) == 4


def test_a_creation_that_was_killed_is_finished(tmp_path, monkeypatch):
    import zarr

    place, made = str(tmp_path / "a.zarr"), zarr.Group.create_array

    def dying(group, name, **options):
        if name == "normal":
            raise KeyboardInterrupt
        return made(group, name, **options)

    with monkeypatch.context() as context:
        context.setattr(zarr.Group, "create_array", dying)
        with pytest.raises(KeyboardInterrupt):
            jobs.create(RECIPE, SHAPE, PLANES, place, shard=64)
    assert len(jobs.create(RECIPE, SHAPE, PLANES, place, shard=64).missing()) == 20
    with pytest.raises(dp.DappleError, match="another job"):
        jobs.create(RECIPE, SHAPE, PLANES, place, shard={"shape": 64, "chunk": 32})


def test_many_processes_create_one_job(tmp_path):
    (tmp_path / "stones.toml").write_text(RECIPE.to_toml())
    command = [sys.executable, "-m", "dapple_textures.jobs", "create", tmp_path / "a.zarr", tmp_path / "stones.toml"]
    command = [*map(str, command), "--size", "100", "--maps", "height,normal", "--shard", "32"]
    processes = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(6)]
    assert [(process.wait(), process.stderr.read()) for process in processes] == [(0, "")] * 6


def test_the_store_writes_whole_files():
    from zarr.storage import _local

    # Older versions write in place: what a killed worker leaves would count as a shard.
    assert hasattr(_local, "_atomic_write")


def run(*arguments):
    command = [sys.executable, "-m", "dapple_textures.jobs", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


def test_the_command_bakes_in_parts(tmp_path, whole):
    (tmp_path / "stones.toml").write_text(RECIPE.to_toml())
    place = tmp_path / "a.zarr"
    made = run("create", place, tmp_path / "stones.toml", "--size", "300x200", "--maps", ",".join(PLANES), "--shard", 64)
    assert made.returncode == 0, made.stderr
    assert "20 of 20 shards are missing" in made.stdout
    processes = [run("bake", place, "--part", f"{part}/2") for part in range(2)]
    assert [process.returncode for process in processes] == [0, 0]
    assert sum(process.stdout.count("baked") for process in processes) == 20
    assert "0 of 20 shards are missing" in run("status", place).stdout
    assert_whole(jobs.Job(str(place)), whole)
    assert run("bake", place, "--part", "0/2").stdout.count("was there") == 10
    for arguments in (["bake", place, "--part", "2/2"], ["status", tmp_path / "none"], ["create", place, "rokc", "--size", 9]):
        refused = run(*arguments)
        assert refused.returncode == 2 and refused.stderr.startswith("error: "), refused.stderr


def test_openjd_runs_the_shards(tmp_path, whole):
    openjd = shutil.which("openjd", path=os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", "")]))
    if openjd is None:
        pytest.skip("openjd-cli is not installed")
    job = jobs.create(RECIPE, SHAPE, PLANES, str(tmp_path / "a.zarr"), shard=100)
    template = tmp_path / "job.template.json"
    template.write_text(json.dumps(job.openjd(parts=4, python=sys.executable)))
    for arguments in (["check", template], ["run", template]):
        done = subprocess.run([openjd, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    assert_whole(job, whole)


def test_stores_have_coordinates_and_attributes(tmp_path):
    xarray = pytest.importorskip("xarray")
    recipe = dp.Recipe.builtin("rock").with_seed(2**64 - 1)
    jobs.create(recipe, (6, 8), ["height", "normal"], tmp_path / "a.zarr", shard=4)
    for record in jobs.Job(tmp_path / "a.zarr").bake_all():
        assert record.hashes
    data = xarray.open_zarr(tmp_path / "a.zarr", consolidated=True)
    assert data.height.dims == ("y", "x") and data.normal.dims == ("y", "x", "channel")
    width, height = recipe.extent
    assert np.array_equal(data.x, (np.arange(8) + 0.5) * (width / 8))
    assert np.array_equal(data.y, (np.arange(6) + 0.5) * (height / 6))
    attributes = data.height.attrs
    assert attributes["recipe"] == recipe.name and attributes["seed"] == 2**64 - 1
    assert attributes["version"] == dp.__version__ and attributes["units"] == "1"
    # It is opened again as it is.
    assert jobs.create(recipe, (6, 8), ["height", "normal"], tmp_path / "a.zarr", shard=4).missing() == []
    jobs.create(dp.worley(dims=3), (2, 4, 8), "value", tmp_path / "b.zarr", shard=8, extent=(8, 4, 2), origin=(1, 2, 3))
    field = xarray.open_zarr(tmp_path / "b.zarr")
    assert field.x[0] == 1.5 and field.y[0] == 2.5 and field.z[0] == 3.5
    jobs.create(recipe, (4, 2, 2), "height", tmp_path / "c.zarr", shard=2)
    assert np.array_equal(xarray.open_zarr(tmp_path / "c.zarr").t, [0, 0.25, 0.5, 0.75])


def test_samples_on_corners_have_the_bits_of_a_bake(tmp_path):
    whole = RECIPE.plan().bake((65, 33), PLANES, samples="corners")
    job = jobs.create(RECIPE, (65, 33), PLANES, tmp_path / "a.zarr", shard=16, samples="corners")
    assert all(record.hashes for record in job.bake_all())
    assert_whole(jobs.Job(tmp_path / "a.zarr"), whole)
    loop = jobs.create(RECIPE, (2, 65, 33), "height", tmp_path / "b.zarr", shard=40, samples="corners")
    assert all(record.hashes for record in loop.bake_all())
    assert np.array_equal(loop.array("height")[0], whole["height"])
    field = dp.gradient_noise(seed=1, dims=3, period=4)
    volume = jobs.create(field, (5, 9, 7), "value", tmp_path / "c.zarr", shard=4, samples="corners")
    assert all(record.hashes for record in volume.bake_all())
    assert np.array_equal(volume.array("value")[:], field.render((5, 9, 7), samples="corners"))


def test_samples_belong_to_the_job(tmp_path):
    xarray = pytest.importorskip("xarray")
    place = tmp_path / "a.zarr"
    jobs.create(RECIPE, (5, 9), "height", place, shard=4, samples="corners")
    width, height = RECIPE.extent
    data = xarray.open_zarr(place)
    assert np.array_equal(data.x, np.arange(9) * (width / 8)) and np.array_equal(data.y, np.arange(5) * (height / 4))
    with pytest.raises(dp.DappleError, match="holds another job"):
        jobs.create(RECIPE, (5, 9), "height", place, shard=4)
    # The description of centers lacks the samples, as it did before there was a choice.
    centers = jobs.create(RECIPE, (5, 9), "height", tmp_path / "b.zarr", shard=4, samples="centers")
    assert "samples" not in centers.source.to_data()
    for what in (RECIPE, dp.worley()):
        with pytest.raises(dp.DappleError, match="at least 2 samples") as caught:
            jobs.create(what, (1, 9), "height", tmp_path / "c.zarr", samples="corners")
        assert caught.value.kind == "range"
        with pytest.raises(dp.DappleError, match="centers, corners"):
            jobs.create(what, (5, 9), "height", tmp_path / "c.zarr", samples="corner")
    assert not (tmp_path / "c.zarr").exists()


def test_the_command_bakes_on_corners(tmp_path):
    place = tmp_path / "a.zarr"
    made = run("create", place, "flagstone", "--size", "33x65", "--samples", "corners", "--shard", 64)
    assert made.returncode == 0, made.stderr
    assert run("bake", place).returncode == 0
    whole = RECIPE.plan().bake((65, 33), samples="corners")
    assert np.array_equal(jobs.Job(place).array("height")[:], whole["height"])
