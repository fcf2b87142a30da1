"""Every public name has a docstring, whose examples are true."""

from __future__ import annotations

import doctest
import inspect

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
