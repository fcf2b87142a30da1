"""The code of the README, of the pages of the site and of the examples runs, and writes the pictures that it names."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

import dapple_textures as dp

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"

if not DOCS.is_dir():
    pytest.skip("the pages are in the repository", allow_module_level=True)


def load(name):
    spec = importlib.util.spec_from_file_location(name, DOCS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


hooks = load("hooks")

PAGES = sorted(DOCS.rglob("*.md")) + [ROOT / "README.md"]


#: What pages need; where it is missing, the page is skipped.
NEEDS = {
    "augmentation": ["skimage", "scipy"],
    "blender": ["bpy", "trimesh"],
    "farm": ["distributed", "zarr", "openjd"],
    "loops": ["PIL"],
    "meshes": ["trimesh", "skimage", "PIL"],
    "photographs": ["skimage"],
    "points": ["scipy", "skimage", "PIL"],
    "synthesis": ["skimage"],
    "terrain": ["xarray", "skimage", "dask"],
}


def files_beside(page):
    """The pictures of the pages in the same folder, as they are named there."""
    return {
        f"{other.stem}-{name}"
        for other in page.parent.glob("*.md")
        if other != page
        for name in hooks.files_of(other.read_text(encoding="utf-8"))
    }


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_code_of_a_page_runs_and_writes_what_it_shows(page, tmp_path):
    if page.parent.name == "cookbook":
        for package in NEEDS.get(page.stem, []):
            pytest.importorskip(package)
        if page.stem in ("augmentation", "farm") and not hasattr(os, "fork"):
            pytest.skip("the page forks, or has scripts of bash")
    result = hooks.run(page, tmp_path)
    shown = hooks.files_of(page.read_text(encoding="utf-8")) - files_beside(page)
    assert {name for name in shown if (tmp_path / name).is_file()} == shown
    if result.missing:
        pytest.skip(f"the rest of the page needs {result.missing}")


def test_code_that_fails_is_said_with_its_line(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A page\n\n```python\na = 1\n```\n\n```python\nprint(a)\n1 / 0\n```\n")
    with pytest.raises(ZeroDivisionError) as caught:
        hooks.run(page, tmp_path)
    assert caught.traceback[-1].lineno + 1 == 9 and str(caught.traceback[-1].path) == str(page)
    assert hooks.with_output("```python\nprint(1)\n```\n<!-- output -->\n", ["1\n"]).endswith("{.text .output}\n1\n```\n")


def test_the_page_of_the_api_has_all_names():
    text = load("reference").markdown()
    names = [name for name in dp.__all__ if not name.startswith("_")]
    assert [name for name in names if f"### `{name}`\n" not in text] == []
    assert "`.render(size, *, extent=None" in text
    textures = text.split("## Textures of control points\n")[1].split("\n## ")[0]
    others = [name for name in names if f"### `{name}`\n" in textures and getattr(dp, name).__module__ != "dapple_textures._textures"]
    assert others == [], "names without a group"


def test_the_example_bakes_files(tmp_path):
    paths = os.environ | {"PYTHONPATH": str(Path(dp.__file__).parents[1])}
    command = [sys.executable, str(ROOT / "examples/material.py"), "ice", str(tmp_path / "out"), "64"]
    done = subprocess.run(command, env=paths, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    files = [Path(line) for line in done.stdout.split()]
    assert len(files) == 7
    assert all(dp.read_image(file).shape[:2] == (64, 64) for file in files)
