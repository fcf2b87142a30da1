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
