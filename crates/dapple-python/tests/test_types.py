"""The stubs say what the native module has, and the package is typed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy")

import dapple_textures  # noqa: E402
from dapple_textures import _native  # noqa: E402

#: Empty where the package is installed: there the checkers find it by themselves.
SOURCES = "" if "site-packages" in dapple_textures.__file__ else Path(dapple_textures.__file__).parents[1]


def run(*arguments, cwd):
    environment = {**os.environ, "MYPYPATH": str(SOURCES)}
    return subprocess.run(
        [sys.executable, "-m", *map(str, arguments)], capture_output=True, text=True, cwd=cwd, env=environment
    )


def test_stubs_are_those_of_the_native_module(tmp_path):
    # PyO3 lists the names of a module; nobody imports the list.
    (tmp_path / "allowed").write_text("dapple_textures._native.__all__\n")
    done = run("mypy.stubtest", "dapple_textures._native", "--allowlist", tmp_path / "allowed", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_package_exports_what_the_native_module_has():
    names = {name for name in vars(_native) if not name.startswith("_")}
    assert names - set(dapple_textures.__all__) == set()


def test_the_package_is_typed():
    sources = Path(__file__).parents[1]
    done = run("mypy", "--config-file", "pyproject.toml", "python/dapple_textures", cwd=sources)
    assert done.returncode == 0, done.stdout + done.stderr
