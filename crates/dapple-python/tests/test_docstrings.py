"""The examples of the docstrings of the native half run."""

import doctest

import pytest

import dapple_textures as dp

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
NAMES = [name for name in dp.__all__ if ">>>" in (getattr(dp, name).__doc__ or "")]


@pytest.mark.parametrize("name", NAMES)
def test_examples_of(name):
    finder = doctest.DocTestParser()
    test = finder.get_doctest(getattr(dp, name).__doc__, {}, name, None, None)
    results = doctest.DocTestRunner(optionflags=FLAGS).run(test)
    assert results.failed == 0
