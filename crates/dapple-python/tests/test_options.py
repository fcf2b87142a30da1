"""Functions have few parameters: what travels together is an option object, for which a dict works, too."""

from __future__ import annotations

import dataclasses
import inspect
import pickle

import numpy as np
import pytest

import dapple_textures as dp

#: More parameters than this are no longer read.
MOST = 8


def callables():
    """All public functions, classes and methods, with the names of their parameters."""
    things = {f"dp.{name}": getattr(dp, name) for name in dp.__all__}
    for module in ("blender", "dask", "jobs"):
        module = pytest.importorskip(f"dapple_textures.{module}")
        own = {name: thing for name, thing in vars(module).items() if getattr(thing, "__module__", "") == module.__name__}
        things |= {f"{module.__name__}.{name}": thing for name, thing in own.items() if not name.startswith("_")}
    for name, thing in list(things.items()):
        if inspect.isclass(thing):
            things |= {f"{name}.{key}": getattr(thing, key) for key in vars(thing) if not key.startswith("_")}
    for name, thing in things.items():
        # Tuples with names are results, which functions of the package make.
        if callable(thing) and not hasattr(thing, "_fields"):
            try:
                parameters = inspect.signature(thing).parameters
            except ValueError:
                continue
            yield name, [parameter for parameter in parameters if parameter != "self"]


def test_no_function_has_more_than_eight_parameters() -> None:
    found = dict(callables())
    assert len(found) > 150
    assert {name: parameters for name, parameters in found.items() if len(parameters) > MOST} == {}


OPTIONS = [thing for name in dp.__all__ if dataclasses.is_dataclass(thing := getattr(dp, name))]


@pytest.mark.parametrize("options", OPTIONS)
def test_an_option_object_describes_its_fields_is_frozen_and_comes_back_from_a_pickle(options) -> None:
    assert options.__dataclass_params__.frozen
    made = options(*[np.eye(2) for field in dataclasses.fields(options) if field.default is dataclasses.MISSING])
    again = pickle.loads(pickle.dumps(made))
    assert type(again) is options and repr(again) == repr(made)


def test_a_wrong_key_of_an_option_object_is_refused_with_the_nearest_one() -> None:
    with pytest.raises(dp.DappleError, match="net: `axis_scal` is not one of `axis_scale`, `weight`, .*; did you mean `axis_scale`") as error:
        dp.noise(net={"axis_scal": 2.0})
    assert error.value.kind == "options" and error.value.hint == "axis_scale"
    with pytest.raises(dp.DappleError, match="net: `x` is not one of `axis_scale`.*`fade`$") as error:
        dp.Partition([[0, 0], [1, 0], [0, 1]], net={"x": 2.0})
    assert error.value.hint is None
    with pytest.raises(TypeError, match="`net` must be Net or a dict of its fields, not float"):
        dp.pups([[0, 0], [1, 0], [0, 1]], [1, 2, 3], net=2.0)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="Net.strength"):
        dp.pups([[0, 0], [1, 0], [0, 1]], [1, 2, 3], net={"strength": "much"})
