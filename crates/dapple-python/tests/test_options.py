"""Option objects, for which a dict works, too."""

from __future__ import annotations

import dataclasses
import pickle

import numpy as np
import pytest

import dapple_textures as dp

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
