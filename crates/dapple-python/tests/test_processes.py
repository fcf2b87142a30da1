"""Other processes and threads: pickles, forks, spawns, and the interpreter let go."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import threading
import time

import numpy as np
import pytest

import dapple_textures as dp
from test_fields import FIELDS


def _digest(field):
    return field.render(300, extent=5).tobytes()


@pytest.mark.parametrize("name", FIELDS)
def test_fields_are_pickled_as_their_description(name):
    field = FIELDS[name]
    copy = pickle.loads(pickle.dumps(field))
    assert copy == field and type(copy) is type(field) and hash(copy) == hash(field)
    assert copy.__dask_tokenize__() == field.__dask_tokenize__()
    assert _digest(copy) == _digest(field)
    assert field != FIELDS["number"] + 1


def test_deep_fields_are_pickled_or_refused():
    """What is made can be sent; what is too deep is refused where it is made, without a crash."""
    chains = [
        lambda field: field + 1,
        lambda field: 1 - field,
        abs,
        lambda field: field.rotate(0.1),
        lambda field: dp.worley().warp(dp.constant(0.0), field, 0.1),
        lambda field: dp.worley().mix(0.5, field),
        lambda field: field.fbm(1),
    ]
    points = dp.poisson_disk(dp.Domain(1), distance=0.2)
    leaves = [
        dp.worley(scatter={"poisson": {"density": 3}}, octaves={"count": 2}),
        dp.noise(dp.Domain(1), spacing=0.3, seed=1),
        dp.pups(points, np.ones(len(points)), net={"orientations": "random"}),
        dp.Recipe.builtin("flagstone").plan().field(),
    ]
    for chain in chains:
        for field in leaves:
            with pytest.raises(dp.DappleError) as caught:
                for _ in range(4000):
                    last, field = field, chain(field)
            assert caught.value.kind == "depth" and "60 times" in str(caught.value)
            copy = pickle.loads(pickle.dumps(last))
            assert copy == last and copy.__dask_tokenize__() == last.__dask_tokenize__()
    field = dp.worley()
    with pytest.raises(dp.DappleError) as caught:
        for _ in range(50):
            field = field + field
    assert caught.value.kind == "too_large"


def test_a_description_that_is_too_deep_is_refused():
    from dapple_textures._native import _field_from_description

    for depth, kind in [(61, "depth"), (120, "depth"), (4000, "description")]:
        with pytest.raises(dp.DappleError) as caught:
            _field_from_description('{"absolute":' * depth + '{"constant":1.0}' + "}" * depth)
        assert caught.value.kind == kind


def test_recipes_and_plans_are_pickled():
    recipe = dp.Recipe.builtin("rock")
    assert pickle.loads(pickle.dumps(recipe)) == recipe
    image = np.random.default_rng(1).random((16, 16), np.float32)
    recipe = dp.Recipe({"dapple": 1, "nodes": {"a": {"image": {"file": "a.png"}}}, "material": {"height": "a"}})
    plan = recipe.plan(images={"a.png": image}, time=0.25)
    copy = pickle.loads(pickle.dumps(plan))
    assert copy == plan and copy.time == 0.25
    assert np.array_equal(copy.bake(32)["height"], plan.bake(32)["height"])
    assert recipe.plan(images={"a.png": image.T}) != plan


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_renders_with_threads_of_its_own():
    field = FIELDS["cracks"]
    dp.set_threads(4)
    try:
        expected = _digest(field)
        context = multiprocessing.get_context("fork")
        with context.Pool(2) as pool:
            results = [pool.apply_async(_digest, (field,)) for _ in range(4)]
            # A child that waits for threads that it does not have would never answer.
            assert all(result.get(timeout=60) == expected for result in results)
        assert _digest(field) == expected
    finally:
        dp.set_threads(0)


def test_a_spawned_process_has_the_same_bits():
    context = multiprocessing.get_context("spawn")
    with context.Pool(1) as pool:
        assert pool.apply_async(_digest, (FIELDS["warped"],)).get(timeout=120) == _digest(FIELDS["warped"])


def test_the_interpreter_runs_while_a_field_is_drawn():
    turns = 0
    drawn = threading.Event()

    def count():
        nonlocal turns
        while not drawn.is_set():
            turns += 1
            time.sleep(0.0005)

    counter = threading.Thread(target=count)
    counter.start()
    try:
        started = time.perf_counter()
        while time.perf_counter() - started < 0.5:
            before = turns
            dp.worley(seed=7, value="edge_distance").render(1500, extent=400)
            assert turns > before, "no other thread ran while a picture was drawn"
    finally:
        drawn.set()
        counter.join()


def test_many_python_threads_draw_at_once():
    field, expected = FIELDS["f1"], _digest(FIELDS["f1"])
    results = []
    threads = [threading.Thread(target=lambda: results.append(_digest(field))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [expected] * 8


def test_the_number_of_threads_comes_from_the_environment(tmp_path):
    import subprocess
    import sys

    program = "import dapple_textures as dp; print(dp.threads())"

    def run(value):
        environment = {**os.environ, "DAPPLE_THREADS": value}
        return subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)

    assert run("3").stdout == "3\n"
    refused = run("many")
    assert refused.returncode == 1 and "DAPPLE_THREADS is `many`" in refused.stderr


def test_models_are_pickled_with_all_that_they_write(tmp_path):
    roof = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    maps = dp.Recipe.builtin("rock").plan().bake(16, ["albedo", "normal", "orm"])
    for example in (maps, maps["albedo"], maps["orm"][..., 1]):
        model = dp.synthesize_on(roof, example, atlas={"texels": 64}, sites=300, matching={"levels": 1})
        copy = pickle.loads(pickle.dumps(model))
        for name in ("vertices", "faces", "uv", "normals", "texture"):
            assert np.array_equal(getattr(copy, name), getattr(model, name)), name
        assert copy.maps.keys() == model.maps.keys() and copy.double_sided == model.double_sided
        assert repr(copy) == repr(model)
        for ending in ("glb", "ply"):
            for thing, path in [(model, tmp_path / f"a.{ending}"), (copy, tmp_path / f"b.{ending}")]:
                thing.export(path)
            assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


def test_corner_tiles_are_pickled():
    sources = [dp.worley(seed=seed, period=4).render(32) for seed in (1, 2)]
    tiles = dp.CornerTiles(sources, width=0.25, period=(2, 3))
    copy = pickle.loads(pickle.dumps(tiles))
    assert np.array_equal(copy.render((100, 90), seed=3), tiles.render((100, 90), seed=3))
