"""The whole package in one go, as a reader of the first page would try it."""

from __future__ import annotations

import numpy as np
import pytest

import dapple_textures as dp


def test_the_whole_package(tmp_path):
    trimesh = pytest.importorskip("trimesh")

    # Fields.
    cells = dp.worley(seed=7, value="f2_minus_f1", period=(8, 8)).normalized()
    a = cells.render((512, 512), extent=(8, 8))
    part = cells.render((512, 512), extent=(8, 8), window=np.s_[100:150, 33:94])
    assert np.array_equal(part, a[100:150, 33:94])
    assert cells.render((512, 512), out=a, extent=(8, 8)) is a
    assert cells.sample(np.array([[0.5, 1.25]])).shape == (1,)
    assert dp.worley(seed=7, dims=3).render((16, 64, 64), extent=(4, 4, 1)).shape == (16, 64, 64)
    near = dp.worley(seed=7).features([[0.5, 1.25]], count=2)
    assert near.distance.shape == (1, 2) and near.vector.shape == (1, 2, 2) and near.id.dtype == np.uint64
    wave = dp.wavelet_noise(seed=1, period=8, weights=[1.0, 0.5]).frequency(8.0)
    assert wave.period == [1.0, 1.0]

    # Points and graphs.
    domain = dp.Domain(size=(1, 1), wrap=True)
    points = dp.poisson_disk(domain, distance=0.05, seed=3)
    edges = dp.delaunay(points).edges()
    # On a torus, Euler says that there are three edges for each point.
    assert edges.shape == (3 * len(points), 2)

    # Partitions of unity.
    land = dp.pups(points, values=np.random.default_rng(1).random(len(points)))
    assert land.period == [1.0, 1.0]
    coat = dp.space_giraffe(domain, spacing=0.28, seed=6)
    assert set(np.unique(coat.render(64))) <= {0.0, 1.0}

    # Pictures.
    dp.write_image(tmp_path / "photo.png", dp.ramp(land.render(96), "terrain"))
    photo = dp.read_image(tmp_path / "photo.png")
    tile, report = dp.make_tile(photo, method="soft_cut"), dp.seam_report(photo)
    assert tile.ndim == 3 and report.passes
    more = dp.synthesize(photo, (48, 64), seed=1)
    assert more.shape == (48, 64, 3)
    normal = dp.normal_map(a, relief=0.3, extent=(8, 8))
    assert normal.shape == (512, 512, 3)

    # Meshes.
    model = dp.synthesize_on(trimesh.creation.icosphere(2), exemplar=photo, atlas={"texels": 512}, sites=600, seed=1)
    model.export(tmp_path / "ball.glb")
    mesh = model.to_trimesh()
    assert mesh.visual.uv.shape[1] == 2
    assert len(trimesh.load(tmp_path / "ball.glb", force="mesh").faces) == len(model.faces)

    # Recipes.
    recipe = dp.Recipe({
        "dapple": 1,
        "seed": 7,
        "extent": [8, 8],
        "nodes": {
            "joint": {"worley": {"value": "f2_minus_f1"}},
            "stones": {"levels": {"input": "joint", "from": [0.04, 0.4]}},
        },
        "material": {"height": "stones", "relief": 0.3},
    })
    plan = recipe.plan(time=0.0)
    maps = plan.bake(128, ["height", "normal", "orm"])
    assert [values.shape for values in maps.values()] == [(128, 128), (128, 128, 3), (128, 128, 3)]
    assert plan.is_local and plan.map_info["normal"] == (3, "non-color", "normal")


def test_larger_than_a_machine(tmp_path):
    pytest.importorskip("zarr")
    pytest.importorskip("distributed")
    from dapple_textures import jobs
    from dapple_textures.dask import bake

    recipe = dp.Recipe.builtin("rock")
    lazy = bake(recipe, (200_000, 200_000), "height", chunks=2048)
    assert lazy[:10, :10].compute(scheduler="sync").shape == (10, 10)
    job = jobs.create(recipe, (200_000, 200_000), ["height", "normal"], str(tmp_path / "rock.zarr"), shard=2048)
    assert len(job) == 98 * 98
    assert job.openjd(parts=64)["specificationVersion"] == "jobtemplate-2023-09"
    clip = bake(recipe, (240, 2048, 2048), "albedo", chunks=1024)
    assert clip.chunksize == (1, 1024, 1024, 3)
