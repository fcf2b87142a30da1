"""Every public name has a docstring, whose examples are true."""

from __future__ import annotations

import ast
import builtins
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


def _sections(text):
    """The sections of a docstring in the form of numpydoc, each as a list of (names, type, description)."""
    parts = re.split(r"^(Parameters|Returns|Raises|Warns|Examples)\n-+\n", text, flags=re.M)
    sections = dict(zip(parts[1::2], parts[2::2]))
    sections.pop("Examples", None)
    parsed = {}
    for section, body in sections.items():
        entries = []
        for line in body.strip("\n").split("\n"):
            if line and not line.startswith(" "):
                names, _, kind = line.partition(" : ")
                entries.append((names if section == "Parameters" else "", kind if section == "Parameters" else line, []))
            elif line.strip():
                entries[-1][2].append(line.strip())
        parsed[section] = entries
    return parsed


CALLS = {name: thing for name, thing in THINGS.items() if callable(thing) and name not in ("DappleError", "DappleWarning") and not hasattr(thing, "_fields")}


@pytest.mark.parametrize("name", CALLS)
def test_a_docstring_is_numpydoc(name):
    """Every parameter has an entry with its type, its default and a description; results and exceptions are named."""
    thing = CALLS[name]
    try:
        signature = inspect.signature(thing)
    except ValueError:
        # A class that other functions make has no signature.
        return
    text = inspect.getdoc(thing)
    # Sentences that fit every function say nothing of this one.
    assert not re.search(r"as described above|^ +The result\.$|If an argument is refused", text, re.M)
    sections = _sections(text)
    wanted = [part for part in signature.parameters.values() if part.name not in ("self", "args", "kwargs")]
    stars = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    entries = sections.get("Parameters", [])
    assert [entry[0] for entry in entries] == [stars.get(part.kind, "") + part.name for part in wanted]
    for (_, kind, text), part in zip(entries, wanted):
        form, _, default = kind.partition(", default ")
        has_default = part.default is not inspect.Parameter.empty
        assert form and not form.endswith(".") and text, part.name
        if default:
            assert ast.literal_eval(default) == part.default, part.name
        else:
            assert form.endswith(", optional") == has_default, part.name
    if not inspect.isclass(thing) and name.split(".")[-1] not in NOTHING:
        [(_, kind, text)] = sections["Returns"]
        assert kind and text
    for kind in [kind for _, kind, _ in sections.get("Warns", [])]:
        assert issubclass(vars(dp)[kind], Warning)
    if "Raises" in sections:
        known = vars(builtins) | {"DappleError": dp.DappleError}
        assert all(issubclass(known[kind], Exception) and text for _, kind, text in sections["Raises"])
    elif wanted and not inspect.isclass(thing):
        raise AssertionError("there is no section Raises")


#: Functions that return None.
NOTHING = {"set_threads", "write_image", "check_local", "export"}


def _choices(function, parameter):
    """The words in quotes in the entry of a parameter."""
    entry = re.search(rf"^{parameter} : [^\n]*\n(.*?)(?=^\S|\Z)", inspect.getdoc(function), re.M | re.S)[1]
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
    (dp.Net, "weight"): lambda **net: dp.noise(dp.Domain(1), spacing=0.3, net=net),
}


@pytest.mark.parametrize(("function", "parameter"), CHOICES, ids=lambda part: getattr(part, "__name__", part))
def test_every_word_that_a_docstring_offers_is_accepted(function, parameter):
    words = _choices(function, parameter)
    assert len(words) > 1
    for word in words:
        CHOICES[function, parameter](**{parameter: word})
