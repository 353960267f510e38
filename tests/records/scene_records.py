"""What do `watchsim check`, the reader of scenes and the model say of the library and of scenes with many keys?"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from records.drawing_records import outline
from records.many_keys import SCENES, write
from records.run_records import PROFILES as RUNNING
from records.wording import said

from watchsim.escapement.function_report import statics, text
from watchsim.escapement.measure import measure
from watchsim.mechanism.check import check_report, check_text, modelled_pairs
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.results.folder import travelling
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import Scene

PROFILES = (*RUNNING, "carriage", "ratchet", "recoil_anchor", "snail", "winding_click")
WRONG = ("-2 s", 0)  # what every value of a scene is replaced by
OUTLINES = ("loops", "decoration")


def records() -> dict[str, Callable[[Path], str]]:
    """By name: what is said, of scenes written into a folder."""
    found: dict[str, Callable[[Path], str]] = {}
    for name in PROFILES:
        found[name] = partial(of_profile, name)
    for name in SCENES:
        found[f"keys: {name}"] = partial(of_keys, name)
        found[f"locked: {name}"] = partial(locked, name)
        for wrong in WRONG if name != "design" else ():
            found[f"{name} with {wrong!r}"] = partial(with_wrong_values, name, wrong)
    return found


def of_profile(name: str, _: Path) -> str:
    """What `check` says in words, the geometry of function in full, and the sums of the model's columns."""
    scene = load(profiles_dir() / name)
    compiled = compile_scene(scene)
    function = measure(scene, compiled)
    report = check_report(scene, modelled_pairs(compiled, [body.name for body in scene.bodies]).counts)
    words = check_text(report, scene, text(function))
    return "\n".join([words, *said(statics(function), "statics"), *_model_lines(compiled)]) + "\n"


def of_keys(name: str, folder: Path) -> str:
    """The scene field by field, what `check` says, and the sums of the model's columns."""
    scene = load(write(name, folder))
    compiled = compile_scene(scene)
    report = check_report(scene, modelled_pairs(compiled, [body.name for body in scene.bodies]).counts)
    lines = [*_scene_lines(scene), check_text(report, scene), *said(report), *_model_lines(compiled)]
    return "\n".join(lines) + "\n"


def locked(name: str, folder: Path) -> str:
    """The scene as it is copied into results, without digests and versions."""
    whole = travelling(load(write(name, folder)))["scene.lock.toml"]
    return str(whole).partition("[lock")[0].rstrip() + "\n"


def _scene_lines(scene: Scene) -> Iterator[str]:
    for field in fields(scene):
        if field.compare and field.name != "bodies":
            yield from said(getattr(scene, field.name), field.name)
    for body in scene.bodies:
        for field in fields(body):
            value = getattr(body, field.name)
            if field.name in OUTLINES:
                yield from (f"{body.name}.{field.name}: {outline(loop)}" for loop in value)
            elif field.name == "solids":
                for number, solid in enumerate(value):
                    plain = {one.name: getattr(solid, one.name) for one in fields(solid)}
                    loops = [outline(loop) for loop in plain.pop("loops", ())]
                    yield from said({**plain, "loops": loops}, f"{body.name}.solids.{number}")
            else:
                yield from said(value, f"{body.name}.{field.name}")


def _model_lines(compiled: Any) -> Iterator[str]:
    """Of each column of the model that is not zero: how many, the sum, the sum of sizes, and a sum that knows the order."""
    yield from said([compiled.size, compiled.fastest, *compiled.q.tolist(), *compiled.u.tolist()], "compiled")
    yield from said(compiled.against, "against")
    yield from said(compiled.geared, "geared")
    for name, table in compiled.model._asdict().items():
        yield from _column_lines(np.asarray(table), name)


def _column_lines(table: np.ndarray, name: str) -> Iterator[str]:
    if table.dtype.names:
        for column in table.dtype.names:
            yield from _column_lines(table[column], f"{name}.{column}")
    elif np.issubdtype(table.dtype, np.number) and np.any(table):
        values = table.ravel().astype(float)
        ordered = float(values @ np.linspace(1.0, 2.0, len(values)))
        yield f"{name} {table.shape}: [{values.sum():.8g}, {np.abs(values).sum():.8g}, {ordered:.8g}]"


def with_wrong_values(name: str, wrong: object, folder: Path) -> str:
    """One line for each value of the file: what is said when it is replaced."""
    scene = load(write(name, folder))
    return "".join(f"{key}: {_refusal(scene, key, wrong)}\n" for key in _keys(scene.source))


def _keys(source: Any, path: str = "") -> Iterator[str]:
    """Dotted paths of all values."""
    items = source.items() if isinstance(source, Mapping) else enumerate(source)
    for key, value in items:
        whole = f"{path}.{key}".lstrip(".")
        if isinstance(value, (Mapping, list)):
            yield from _keys(value, whole)
        else:
            yield whole


def _refusal(scene: Scene, key: str, wrong: object) -> str:
    try:
        scene.set(key, wrong)
    except SceneError as error:
        return " | ".join(f"{fault.key}{fault.shown} {fault.message}" for fault in error.faults)
    return "accepted"
