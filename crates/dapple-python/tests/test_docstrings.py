"""Every public name has a docstring, whose examples are true."""

from __future__ import annotations

import doctest
import inspect
import re
from functools import partial

import pytest

import dapple_textures as dp


def public():
    for name in dp.__all__:
        thing = getattr(dp, name)
        if name.startswith("__"):
            continue
        yield name, thing
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (callable(value) or inspect.isdatadescriptor(value) or isinstance(value, staticmethod)):
                    yield f"{name}.{member}", getattr(thing, member)


THINGS = dict(public())


@pytest.mark.parametrize("name", THINGS)
def test_docstring(name):
    text = inspect.getdoc(THINGS[name])
    assert text and len(text) > 15, f"{name} has no docstring"
    flags = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    test = doctest.DocTestParser().get_doctest(text, {}, name, None, 0)
    output: list[str] = []
    runner = doctest.DocTestRunner(optionflags=flags)
    runner.run(test, out=output.append)
    assert runner.failures == 0, "".join(output)


def _choices(function, parameter):
    """The words in quotes in the entry of a parameter."""
    entry = re.search(rf"^{parameter}(?:, \w+)* : (.*?)(?=^\S|\Z)", inspect.getdoc(function), re.M | re.S)[1]
    # A word inside of braces is the name of an option, which needs a value.
    return re.findall(r'"([a-z0-9_]+)"', re.sub(r"\{.*?\}", "", entry, flags=re.S))


SLOPE = [[0.0, 0.25], [0.5, 0.75]]
CHOICES = {
    (dp.worley, "value"): dp.worley,
    (dp.worley, "metric"): dp.worley,
    (dp.gradient_noise, "shape"): partial(dp.gradient_noise, octaves=2),
    (dp.normal_map, "wrap"): partial(dp.normal_map, SLOPE),
    (dp.normal_map, "y"): partial(dp.normal_map, SLOPE),
    (dp.ramp, "space"): partial(dp.ramp, SLOPE),
    (dp.ramp, "interpolation"): partial(dp.ramp, SLOPE),
    (dp.ramp, "outside"): partial(dp.ramp, SLOPE),
    (dp.blend, "mixing"): partial(dp.blend, [SLOPE, SLOPE]),
    (dp.blend_map, "wrap"): partial(dp.blend_map, SLOPE),
    (dp.wavelet_halve, "borders"): partial(dp.wavelet_halve, SLOPE),
    (dp.poisson_disk, "rule"): partial(dp.poisson_disk, dp.Domain(1), distance=0.3),
    (dp.noise, "weight"): partial(dp.noise, dp.Domain(1), spacing=0.3),
}


@pytest.mark.parametrize(("function", "parameter"), CHOICES, ids=lambda part: getattr(part, "__name__", part))
def test_every_word_that_a_docstring_offers_is_accepted(function, parameter):
    words = _choices(function, parameter)
    assert len(words) > 1
    for word in words:
        CHOICES[function, parameter](**{parameter: word})
