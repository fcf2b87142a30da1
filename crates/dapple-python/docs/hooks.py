"""Runs the code of a page, for the site and for the tests.

The ```python blocks of a page run in order, in one namespace and one temporary folder. So do comments that begin with `python`,
which are not shown, and shell blocks marked `.run`. The images and models of a page are files that its code writes.
`<!-- output -->` is replaced by the output of the preceding block, and so is `<!-- output as markdown -->`. The image `a.png` of
the page `b.md` is available to other pages of the folder as `b-a.png`.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import subprocess
import sys
import tempfile
import types
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

#: Optional packages: the code of a page stops at the import of one that is missing.
OPTIONAL = {"bpy", "torch"}

_BLOCK = re.compile(r"^(?:```(?P<kind>python|\{\.sh \.run\})|<!-- python) *\n(?P<code>.*?)^(?:```|-->) *$", re.M | re.S)
_OUTPUT = re.compile(r"^<!-- output(?P<markdown> as markdown)? -->$", re.M)
_FILE = re.compile(r"\]\(([\w.-]+\.(?:png|gif|glb|webp))\)")


@dataclass
class Run:
    """The results of running the code of a page."""

    #: The folder in which the code ran.
    folder: Path
    #: The output of each block.
    printed: list[str] = field(default_factory=list)
    #: The missing package at which the code stopped.
    missing: str | None = None


def files_of(text: str) -> set[str]:
    """Returns the files that a page shows."""
    return set(_FILE.findall(text))


def run(page: Path, folder: Path) -> Run:
    """Runs the code of a page in a folder."""
    result = Run(folder)
    module = types.ModuleType("page_" + re.sub(r"\W", "_", page.stem))
    sys.modules[module.__name__] = module
    text = page.read_text(encoding="utf-8")
    here = os.getcwd()
    os.chdir(folder)
    # Pages may import the modules in the folder of this file.
    sys.path.insert(0, str(Path(__file__).parent))
    try:
        for block in _BLOCK.finditer(text):
            try:
                result.printed.append(_run_block(block, text, page, module.__dict__))
            except ModuleNotFoundError as error:
                if error.name not in OPTIONAL:
                    raise
                result.missing = error.name
                break
    finally:
        sys.path.pop(0)
        os.chdir(here)
        del sys.modules[module.__name__]
    return result


def _run_block(block: re.Match[str], text: str, page: Path, names: dict[str, Any]) -> str:
    if (block["kind"] or "").startswith("{"):
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", block["code"]], env=_environment(), text=True, capture_output=True
        )
        if done.returncode:
            raise RuntimeError(f"{page.name}: {block['code']}\n{done.stdout}{done.stderr}")
        return done.stdout
    # Line numbers in tracebacks match the page.
    line = text.count("\n", 0, block.start("code"))
    code = compile("\n" * line + block["code"], str(page), "exec")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(code, names)
    return printed.getvalue()


def _environment() -> dict[str, str]:
    """Returns the environment for commands: they find the programs of this Python, with the package that it has loaded."""
    import dapple_textures

    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    return os.environ | {"PATH": path, "PYTHONPATH": str(Path(dapple_textures.__file__).parents[1])}


def with_output(text: str, printed: list[str]) -> str:
    """Returns the text of a page with the output of its code added."""
    blocks = list(_BLOCK.finditer(text))

    def output(match: re.Match[str]) -> str:
        before = sum(block.end() < match.start() for block in blocks)
        if before > len(printed):
            return ""
        lines = printed[before - 1].rstrip()
        return lines if match["markdown"] else f"```{{.text .output}}\n{lines}\n```"

    return _OUTPUT.sub(output, text)


# The hooks of mkdocs.

_RUNS: dict[str, Run] = {}
_FOLDERS: list[tempfile.TemporaryDirectory[str]] = []


def on_files(files: Any, config: Any) -> Any:
    """Runs all pages, and adds the files that they wrote to the site."""
    from mkdocs.structure.files import File

    for page in list(files.documentation_pages()):
        _FOLDERS.append(tempfile.TemporaryDirectory())
        source = Path(page.abs_src_path)
        result = _RUNS[page.src_uri] = run(source, Path(_FOLDERS[-1].name))
        for name in sorted(files_of(source.read_text(encoding="utf-8"))):
            if (result.folder / name).is_file():
                place = str(Path(page.src_uri).with_name(f"{source.stem}-{name}"))
                files.append(File.generated(config, place, abs_src_path=str(result.folder / name)))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Adds the output of the code of a page, and renames its files to their names on the site."""
    result = _RUNS.get(page.file.src_uri)
    if result is None:
        return markdown
    for name in files_of(markdown):
        # Files of other pages have their names already.
        if not (result.folder / name).is_file():
            continue
        shown = rf"(?<=\]\(){re.escape(name)}(?=\))"
        markdown = re.sub(shown, f"{Path(page.file.src_uri).stem}-{name}", markdown)
    return with_output(markdown, result.printed)


def on_post_build(config: Any) -> None:
    """Removes the folders in which pages ran."""
    while _FOLDERS:
        _FOLDERS.pop().cleanup()
