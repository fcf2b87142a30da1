"""Makes Markdown from the docstrings of the package, for the API page."""

from __future__ import annotations

import inspect
import re
from typing import Any

import dapple_textures as dp

#: The groups of names, in order. Names in no group are textures of control points.
GROUPS = {
    "Fields": ["worley", "Worley", "gradient_noise", "wavelet_noise", "constant", "Field", "ColorField", "Features"],
    "Points and graphs": ["Domain", "Points", "poisson_disk", "extend_poisson_disk", "nested_poisson_disk", "jittered_grid", "white_noise", "spectrum", "Spectrum", "EmptyCircle", "delaunay", "gabriel", "yao", "k_nearest", "Graph", "Axes"],
    "Partitions of unity": ["pups", "Partition", "Net", "Weights", "angle_orientations", "biased_labels", "grouped_labels", "outward_orientations", "random_labels", "random_orientations", "random_values", "reference_labels"],
    "Textures of control points": [],
    "Materials": ["Recipe", "read_recipe", "read_recipe_images", "Plan", "MapInfo", "Shader", "map_names", "shards", "ShardList", "Shard"],
    "Pictures": ["read_image", "write_image", "write_maps", "decode_image", "encode_image", "ramp", "palettes", "linear_from_srgb", "srgb_from_linear", "normal_map", "ambient_occlusion", "curvature"],
    "Tiles": ["make_tile", "even_out", "rectify", "resize", "estimate_material", "seam_report", "SeamReport", "repeat", "disturb", "lay_tiles", "match_borders", "CornerTiles", "blend", "blend_map", "rank_equalize"],
    "Bands of frequencies": ["wavelet_tile", "wavelet_analyze", "wavelet_synthesize", "wavelet_halve", "wavelet_double", "Bands"],
    "Synthesis and meshes": ["synthesize", "repair", "synthesize_along", "synthesize_on", "repair_on", "Exemplar", "Matching", "Directions", "Atlas", "Model", "read_model", "MeshFile", "mesh_report"],
    "Threads and errors": ["threads", "set_threads", "DappleError", "DappleWarning"],
}


def markdown() -> str:
    """Returns all groups, then the modules for arrays too large for one machine."""
    named = {name for names in GROUPS.values() for name in names}
    rest = [name for name in dp.__all__ if name not in named and not name.startswith("_")]
    parts = []
    for group, names in (GROUPS | {"Textures of control points": rest}).items():
        parts += [f"## {group}", *(entry(name, getattr(dp, name)) for name in names if hasattr(dp, name))]
    for module in ("dask", "jobs", "blender"):
        parts += _module(module)
    return "\n\n".join(parts)


def _module(name: str) -> list[str]:
    try:
        module = __import__(f"dapple_textures.{name}", fromlist=["*"])
    except ModuleNotFoundError:
        return []
    parts = [f"## dapple_textures.{name}", text(module.__doc__ or "")]
    for key, value in vars(module).items():
        if getattr(value, "__module__", None) == module.__name__ and not key.startswith("_") and value.__doc__:
            parts.append(entry(key, value))
    return parts


def entry(name: str, what: Any, level: int = 3) -> str:
    """Describes an object, with its signature and the members of a class."""
    parts = [f"{'#' * level} `{name}`", signature(name, what), text(inspect.getdoc(what) or "")]
    if inspect.isclass(what) and not issubclass(what, Exception):
        members = [(key, value) for key, value in vars(what).items() if not key.startswith("_")]
        if hasattr(what, "_fields"):
            members = []
            parts.append("\n".join(f"- `{key}`" for key in what._fields))
        parts += [_member(key, value) for key, value in members if getattr(value, "__doc__", None)]
    return "\n\n".join(part for part in parts if part)


def _member(name: str, what: Any) -> str:
    what = getattr(what, "__func__", what)
    call = _parameters(what)
    body = text(inspect.getdoc(what) or "").replace("\n", "\n    ")
    return f"`.{name}{call}`\n:   {body}"


def signature(name: str, what: Any) -> str:
    """Returns a code block with the call, over several lines if it is long."""
    call = _parameters(what)
    # Python knows no parameters of an object that cannot be called.
    if not call or (inspect.isclass(what) and call == "()"):
        return ""
    if len(name + call) > 88:
        call = "(\n    " + ",\n    ".join(_split(call[1:-1])) + ",\n)"
    return f"```python\n{name}{call}\n```"


def _parameters(what: Any) -> str:
    if inspect.isclass(what) and (hasattr(what, "_fields") or issubclass(what, Exception)):
        return ""
    try:
        found = inspect.signature(what)
    except (TypeError, ValueError):
        return ""
    parameters = [
        parameter.replace(annotation=parameter.empty) for parameter in found.parameters.values() if parameter.name != "self"
    ]
    parameters = [
        parameter.replace(kind=parameter.POSITIONAL_OR_KEYWORD) if parameter.kind == parameter.POSITIONAL_ONLY else parameter
        for parameter in parameters
    ]
    return str(inspect.Signature(parameters))


def _split(parameters: str) -> list[str]:
    """Splits parameters at commas outside of brackets."""
    parts, depth, start = [], 0, 0
    for place, letter in enumerate(parameters):
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            parts.append(parameters[start:place].strip())
            start = place + 1
    return [*parts, parameters[start:].strip()]


def text(docstring: str) -> str:
    """Returns a docstring in NumPy's form as Markdown."""
    docstring = docstring.replace("``", "`")
    parts = re.split(r"^(Parameters|Returns|Raises|Examples)\n-+\n", docstring, flags=re.M)
    found = [_indented_code(parts[0].strip())]
    for title, body in zip(parts[1::2], parts[2::2]):
        if title == "Examples":
            found.append(f"```pycon\n{body.strip()}\n```")
        elif title == "Parameters":
            found.append(_definitions(body.strip("\n")))
        else:
            found.append(_results(title, body.strip("\n")))
    return "\n\n".join(found)


def _entries(body: str) -> list[tuple[str, str]]:
    """Returns the first line of each entry of a section, and its description, which is indented."""
    entries = re.split(r"^(?=\S)", body, flags=re.M)
    parts = (entry.partition("\n") for entry in entries if entry.strip())
    return [(head.strip(), rest.rstrip()) for head, _, rest in parts]


def _definitions(body: str) -> str:
    found = []
    for head, what in _entries(body):
        name, _, kind = head.partition(" : ")
        found.append(f"`{name}` `{kind}`\n:   {what.lstrip()}".rstrip())
    return "\n\n".join(found)


def _results(title: str, body: str) -> str:
    found = [f"`{kind}`: {' '.join(what.split())}" for kind, what in _entries(body)]
    return f"**{title}** " + " ".join(found)


def _indented_code(body: str) -> str:
    return re.sub(r"((?:^    \S.*\n?)+)", lambda code: "```sh\n" + inspect.cleandoc(code[0]) + "\n```\n", body, flags=re.M)
