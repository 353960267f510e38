"""How is a mechanism written as a scene file?

In SI units with all digits, so that it reads back to the same motion. What is neither a polygon nor a circle becomes a DXF
drawing beside the scene.
"""

from pathlib import Path
from typing import Any

from watchsim.drawing.write import dxf_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.scene import Body, Scene
from watchsim.scene.toml import toml_text


def write_scene(scene: Scene, path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    mapping: dict[str, Any] = {"scene": {"title": scene.title, "schema": 1}}
    if any(scene.gravity):
        mapping["scene"]["gravity"] = _pair(scene.gravity, "m/s²")
    mapping["bodies"] = {body.name: _body(body, path) for body in scene.bodies}
    motions = {body.name: body.motion for body in scene.bodies}
    mapping["springs"] = [
        {
            "body": s.body,
            "stiffness": _text(s.stiffness, "N·m/rad" if motions[s.body] == "pivot" else "N/m"),
            "rest": _text(s.rest, "rad" if motions[s.body] == "pivot" else "m"),
        }
        for s in scene.springs
    ]
    mapping["torques"] = [
        {"body": t.body, "value": _text(t.value, "N·m" if motions[t.body] == "pivot" else "N")} for t in scene.torques
    ]
    mapping["damping"] = [_damping(d, motions[d.body]) for d in scene.damping]
    mapping["contacts"] = [
        {"between": [str(side) for side in c.sides], "friction": c.friction, "restitution": c.restitution}
        for c in scene.contacts
    ]
    mapping["run"] = {"duration": _text(scene.duration, "s")}
    path.write_text(toml_text({key: value for key, value in mapping.items() if value}), encoding="utf-8")
    return path


def _text(value: float, unit: str) -> str:
    return f"{float(value)!r} {unit}"


def _pair(values: tuple[float, float], unit: str) -> list[str]:
    return [_text(value, unit) for value in values]


def _damping(damping: Any, motion: str) -> dict[str, str]:
    unit = {"viscous": "N·m·s/rad", "coulomb": "N·m"} if motion == "pivot" else {"viscous": "N·s/m", "coulomb": "N"}
    kinds = {name: _text(getattr(damping, name), unit[name]) for name in unit if getattr(damping, name)}
    return {"body": damping.body, **kinds}


def _body(body: Body, path: Path) -> dict[str, Any]:
    entry = {"motion": body.motion, **_outline(body, path), "position": _pair(body.position, "m")}
    entry["angle"] = _text(body.angle, "rad")
    if body.motion == "free":
        entry["pivot"] = ["0 m", "0 m"]
        entry["velocity"], entry["spin"] = _pair((body.velocity[0], body.velocity[1]), "m/s"), _text(body.velocity[2], "rad/s")
    elif body.motion == "slide":
        entry["axis"], entry["velocity"] = list(body.axis), _text(body.velocity[0], "m/s")
    elif body.motion == "pivot":
        entry["velocity"] = _text(body.velocity[0], "rad/s")
    if body.mass:
        entry["mass"] = _text(body.mass, "kg")
    if body.inertia:
        entry["inertia"] = _text(body.inertia, "kg·m²")
    return entry


def _outline(body: Body, path: Path) -> dict[str, Any]:
    (loop,) = body.loops
    first = loop.edges[0]
    if all(isinstance(edge, Line) for edge in loop.edges):
        return {"polygon": [_pair(edge.start, "m") for edge in loop.edges]}
    if len(loop.edges) == 1 and isinstance(first, Arc) and first.is_circle and first.x == first.y == 0.0:
        return {"circle": _text(first.radius, "m")}
    drawing = path.with_name(f"{path.stem}-{body.name}.dxf")
    drawing.write_text(dxf_text([Loop(loop.edges, "OUTLINE")]), encoding="utf-8")
    return {"drawing": drawing.name, "pivot": ["0 m", "0 m"]}
