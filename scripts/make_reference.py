"""Writes docs/reference: what the names of `watchsim` take and return, from their docstrings.

python scripts/make_reference.py
"""

import dataclasses
import enum
import importlib
import inspect
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import watchsim
from watchsim import units
from watchsim.scene import keys

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = Path(watchsim.__file__).resolve().parent  # installed or not
FOLDER = ROOT / "docs" / "reference"
WIDEST = 100  # of a signature in one line
ITEM = re.compile(r"([\w.]+(?:, [\w.]+)*) {2,}(.+)")  # a line of a docstring's list: names, two spaces or more, what they are
NOTE = "Made from the docstrings by `python scripts/make_reference.py`; not edited by hand."

# Page: title, then names of `watchsim` and, below what returns them, of records that they return ("module:name").
PAGES = {
    "scenes": ("Scenes", ["load", "Scene", "SceneError", "profiles_dir", "watchsim.scene.scene:Expectation"]),
    "bodies": (
        "Bodies, forces and contacts of a scene",
        [
            "watchsim.scene.scene:Body",
            *(f"watchsim.scene.forces:{name}" for name in ("Spring", "Torque", "Damping", "Contact", "Side")),
            "watchsim.scene.scene:Prescribed",
            "watchsim.scene.scene:Recording",
        ],
    ),
    "designs": ("Designs", ["watchsim.designs:names", "watchsim.designs:Maker", "watchsim.designs:Drawn"]),
    "drawings": ("Drawings and outlines", ["read", "Drawing", "watchsim.drawing.findings:Finding", "Profile"]),
    "contact": ("Distances and contact kinematics", ["distance", "watchsim.mechanism.distance:Distance", "gap", "kinematics"]),
    "simulation": ("Simulation", ["simulate", "Trajectory", "EventKind", "Stop"]),
    "results": ("Results folders", ["write_results", "read_results"]),
    "analysis": (
        "Beats, forces, verdicts",
        [
            *("summary", "beats", "watchsim.analysis.timing:Beats", "forces", "watchsim.analysis.forces:Forces", "verdict"),
            *("watchsim.analysis.verdict_kinds:Verdict", "wear", "watchsim.analysis.wear:Wear"),
            *("watchsim.analysis.wear:WornPlace",),
        ],
    ),
    "studies": (
        "Limit cycles, sweeps, sensitivities, positions, tolerances, better scenes, fits",
        [
            *("steady", "Cycle", "compare", "watchsim.studies.compare:Comparison", "sweep", "watchsim.studies.sweep:Sweep"),
            *("sensitivity", "watchsim.studies.sensitivity:Sensitivity", "positions", "watchsim.studies.positions:Positions"),
            *("shock", "watchsim.studies.shock:Blow", "shock_map", "watchsim.studies.shock:ShockMap", "tolerance"),
            *("ToleranceStudy", "merge", "improve", "watchsim.studies.goals:Better", "fit", "watchsim.studies.fit:Fit"),
        ],
    ),
    "pictures": (
        "Plots, movies, sound and pages",
        [
            *("plot_kinematics", "plot_phases", "plot_timeline", "plot_torque", "plot_phase_portrait", "plot_forces"),
            "plot_sound",
            *("plot_energy", "plot_timing", "plot_tape", "plot_sweep", "plot_comparison", "plot_sensitivity", "plot_tolerance"),
            *("plot_front", "plot_fit", "plot_positions", "plot_shock_map", "plot_wear"),
            *("movie", "frame", "card", "show", "sound", "report", "listen", "watchsim.analysis.listen:Heard"),
        ],
    ),
    "verification": ("Verification", ["verify"]),
}


def pages() -> dict[str, str]:
    """File name -> text of every page."""
    made = {f"{page}.md": page_text(title, names) for page, (title, names) in PAGES.items()}
    return {"README.md": contents(), **made, "keys.md": keys_page()}


def keys_page() -> str:
    """Every key that a scene file may hold, from the table by which scenes are read."""
    note = "Made from `watchsim/scene/keys.py` by `python scripts/make_reference.py`; not edited by hand."
    parts = [f"# Keys of a scene file\n\n{note} [The scene file](../guide/scene-file.md) explains them with examples.\n"]
    for name, section in keys.SECTIONS.items():
        headings = {keys.NAMED_TABLES: f"[{name}.NAME]", keys.TABLES_LISTED: f"[[{name}]]"}
        parts += [f"\n## {headings.get(section.form, f'[{name}]')}\n", *key_rows(section, name)]
    return "".join(parts)


def key_rows(table: keys.Key, path: str) -> Iterator[str]:
    """The table of the keys within one, then those of the tables in them."""
    if table.doc:
        yield f"\n{table.doc[0].upper()}{table.doc[1:]}.\n"
    if table.inner:
        yield "\n| key | what | value | range | default |\n|---|---|---|---|---|\n"
    for name, key in table.inner.items():
        notes = [f"; {' or '.join(key.motions)} only" if key.motions else "", "; required" if key.required else ""]
        yield (f"| `{name}` | {key.doc}{''.join(notes)} | {value_of(key)} | {range_of(key)} | {default_of(key)} |\n")
    for name, key in table.inner.items():
        if key.inner:
            yield f"\n### {path}: {name}\n"
            yield from key_rows(key, f"{path}: {name}")


def value_of(key: keys.Key) -> str:
    if key.choices:
        return ", ".join(f'`"{choice}"`' for choice in key.choices)
    kinds = " or ".join(one.name for one in (key.dimension, key.linear) if one is not None)
    holder = {keys.PAIR: "two of: ", keys.POINTS: "list of points: "}.get(key.form, "")
    return f"{holder}{kinds}" if kinds else key.form


def range_of(key: keys.Key) -> str:
    """The limits, but for what is too small to compute with, in the unit of messages."""
    found = []
    for limit in key.limits:
        if limit.message == keys.TOO_SMALL or key.dimension is None:
            continue
        for end, words in ((limit.low, ("from", "above")), (limit.high, ("to", "below"))):
            is_open = limit.open == ("low" if end == limit.low else "high")
            found += [f"{words[is_open]} {in_unit(end, key)}"] if math.isfinite(end) else []
        found += ["not 0"] if limit.apart else []
    return " ".join(dict.fromkeys(found))


def default_of(key: keys.Key) -> str:
    if key.absent or key.default == 0.0 or key.dimension is None:
        return key.absent
    return in_unit(key.default, key)


def in_unit(value: float, key: keys.Key) -> str:
    assert key.dimension is not None
    return (
        "0"
        if value == 0.0 or not math.isfinite(value)
        else units.show(value, key.dimension.usual[1] if key.dimension.si else "")
    )


def contents() -> str:
    """The first page: every name with the first sentence said of it."""
    parts = [f"# Reference\n\nWhat Python users call, after `import watchsim as ws`. {NOTE}\n"]
    for page, (title, names) in PAGES.items():
        parts += [f"\n## [{title}]({page}.md)\n\n| name | what it is |\n|---|---|\n"]
        for name in names:
            shown, thing = found(name)
            parts.append(f"| [`{shown}`]({page}.md#{anchor(shown)}) | {first_sentence(thing)} |\n")
    parts.append("\n## [Keys of a scene file](keys.md)\n\n## [Glossary](../guide/glossary.md)\n")
    return "".join(parts)


def page_text(title: str, names: list[str]) -> str:
    return f"# {title}\n\n{NOTE}\n" + "".join(section(*found(name)) for name in names)


def found(name: str) -> tuple[str, Any]:
    """How the name is shown, and what it stands for."""
    module, _, record = name.rpartition(":")
    if not module:
        return f"ws.{name}", getattr(importlib.import_module("watchsim"), name)
    shown = f"ws.designs.{record}" if module == "watchsim.designs" and record.islower() else record
    return shown, getattr(importlib.import_module(module), record)


def section(shown: str, thing: Any) -> str:
    """One name with all that belongs to it."""
    home = Path(inspect.getsourcefile(thing) or "").resolve().relative_to(PACKAGE.parent).as_posix()
    parts = [f"\n## {shown}\n\n`{home}`\n\n"]
    if not inspect.isclass(thing):
        return "".join([*parts, signature(shown, thing), markdown(inspect.getdoc(thing) or "")])
    parts.append(markdown(inspect.getdoc(thing) or ""))
    if issubclass(thing, enum.Enum):
        parts += ["\n| name | value | meaning |\n|---|---|---|\n", *member_rows(thing)]
    elif dataclasses.is_dataclass(thing):
        shown_fields = [one for one in dataclasses.fields(thing) if not one.name.startswith("_")]
        parts += ["\n| field | type | default |\n|---|---|---|\n", *map(field_row, shown_fields)]
    elif issubclass(thing, tuple):
        kinds = inspect.get_annotations(thing).items()
        parts += ["\n| field | type |\n|---|---|\n", *(f"| `{name}` | `{in_cell(kind)}` |\n" for name, kind in kinds)]
    for name, member in members(thing):
        if isinstance(member, property):
            parts.append(f"\n### {shown.removeprefix('ws.')}.{name}\n\n{markdown(inspect.getdoc(member) or '')}")
        else:
            call = signature(f"{shown.removeprefix('ws.')}.{name}", member)
            parts.append(f"\n### {shown.removeprefix('ws.')}.{name}()\n\n{call}{markdown(inspect.getdoc(member) or '')}")
    return "".join(parts)


def members(thing: type) -> Iterator[tuple[str, Any]]:
    """Public properties and methods that the class itself has, in the order of the file."""
    for name, member in vars(thing).items():
        if name.startswith("_"):
            continue
        if isinstance(member, (staticmethod, classmethod)):
            yield name, member.__func__
        elif isinstance(member, property) or inspect.isfunction(member):
            yield name, member
        elif hasattr(member, "func") and hasattr(member, "attrname"):  # cached_property
            yield name, property(member.func)


def field_row(one: dataclasses.Field[Any]) -> str:
    default = "" if one.default is dataclasses.MISSING else f"`{in_cell(repr(one.default))}`"
    if one.default_factory is not dataclasses.MISSING:
        default = "empty"
    return f"| `{one.name}` | `{in_cell(one.type)}` | {default} |\n"


def member_rows(thing: type[enum.Enum]) -> Iterator[str]:
    """The members, each with its sentence, or with the comment that stands behind it in the file."""
    source = inspect.getsource(thing)
    for one in thing:
        comment = re.search(rf"^ +{one.name} = \S+  # (.+)$", source, re.MULTILINE)
        meaning = getattr(one, "sentence", None) or (comment[1] if comment else "")
        yield f"| `{one.name}` | {one.value} | {in_cell(meaning)} |\n"


def in_cell(text: object) -> str:
    return str(text).replace("|", "\\|")


def signature(shown: str, thing: Any) -> str:
    """The call as Python code, one argument a line where it is long."""
    call = inspect.signature(thing)
    words: list[str] = []
    named_only = False
    for name, one in call.parameters.items():
        if name in {"self", "cls"}:
            continue
        if one.kind is one.KEYWORD_ONLY and not named_only:
            words.append("*")
            named_only = True
        star = "*" if one.kind is one.VAR_POSITIONAL else ""
        kind = "" if one.annotation is one.empty else f": {one.annotation}"
        default = "" if one.default is one.empty else f" = {one.default!r}"
        words.append(f"{star}{name}{kind}{default}")
    back = "" if call.return_annotation is call.empty else f" -> {call.return_annotation}"
    line = f"{shown}({', '.join(words)}){back}"
    if len(line) > WIDEST:
        line = f"{shown}(\n" + "".join(f"    {word},\n" for word in words) + f"){back}"
    return f"```python\n{line}\n```\n\n"


def markdown(docstring: str) -> str:
    """Paragraphs as they are; of lines `name  what it is`, whose further lines are indented, a list."""
    lines = []
    in_list = False
    for line in docstring.replace("<", "&lt;").splitlines():
        head = ITEM.match(line)
        in_list = bool(head) or (in_list and line.startswith(" "))
        if head:
            lines.append(f"- {', '.join(f'`{name}`' for name in head[1].split(', '))}: {head[2]}")
        else:
            lines.append(f"  {line.strip()}" if in_list else line)
    return "\n".join(lines) + "\n"


def first_sentence(thing: Any) -> str:
    said = (inspect.getdoc(thing) or "").split("\n\n")[0].replace("\n", " ")
    return re.split(r"(?<=[.])\s|[;:]\s", said)[0].rstrip(".").replace("|", "\\|")


def anchor(shown: str) -> str:
    return re.sub(r"[^\w-]", "", shown.lower())


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    made = pages()
    for old in FOLDER.glob("*.md"):
        if old.name not in made:
            old.unlink()
    for name, text in made.items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    print(f"{len(made)} pages in {FOLDER}")


if __name__ == "__main__":
    from usage import arguments

    arguments(__doc__)
    main()
