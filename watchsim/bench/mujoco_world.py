"""How does a scene run in MuJoCo?

Soft contacts at fixed steps: there is no restitution, but a damped spring in each contact, whose damping ratio is set so
that half an oscillation of it returns the wanted share of the speed. Polygons become prisms, circles spheres in their
middle plane.
"""

from __future__ import annotations

import math
from typing import Any
from xml.sax.saxutils import quoteattr

from watchsim.bench.engines import Circle, Drive, Setup, Surface, bodies, drives, surfaces
from watchsim.scene.scene import Body, Scene

_RIM = 0.95  # of the reach: where the mass of a pivoted body is put; what is left of its inertia stays about that point


class MujocoWorld:
    """Model and data, and where each body's coordinates are."""

    def __init__(self, mujoco: Any, model: Any, scene: Scene, units: float) -> None:
        self.mujoco, self.model, self.data = mujoco, model, mujoco.MjData(model)
        self.scene, self.units = scene, units
        self.start: dict[str, int] = {}
        for body in scene.bodies:
            if body.motion == "fixed":
                continue
            self.start[body.name] = model.joint(f"{body.name}.{'angle' if body.motion == 'pivot' else 'x'}").qposadr[0]
        for body in scene.bodies:
            if body.motion == "pivot":
                self.data.qpos[self.start[body.name]] = body.angle
                self.data.qvel[self.start[body.name]] = body.velocity[0] if body.velocity else 0.0

    def advance(self, steps: int) -> None:
        self.mujoco.mj_step(self.model, self.data, nstep=steps)

    def place(self, body: str) -> tuple[float, float, float]:
        part, i = self.scene.body(body), self.start[body]
        if part.motion == "pivot":
            return (*part.position, float(self.data.qpos[i]))
        x, y, angle = (float(value) for value in self.data.qpos[i : i + 3])
        return part.position[0] + x / self.units, part.position[1] + y / self.units, part.angle + angle


def build(scene: Scene, step: float, setup: Setup) -> MujocoWorld:
    """The scene with lengths in 1/`setup.units` metres and masses so that the lightest body's inertia is 1."""
    import mujoco

    units = setup.units
    mass = 1.0 / (min(body.inertia for body in bodies(scene) if body.motion != "fixed") * units**2)
    found = surfaces(scene, setup.deviation)
    size = max(abs(c) for s in found for c in _corner(s)) * units
    acting = {drive.body: drive for drive in drives(scene)}
    meshes = "".join(_mesh(k, s, units, size) for k, s in enumerate(found) if not isinstance(s.piece, Circle))
    trees = "".join(_body(body, found, acting.get(body.name), units, mass) for body in scene.bodies)
    text = f"""<mujoco>
<compiler angle="radian" boundmass="0" boundinertia="0" inertiafromgeom="false"/>
<option timestep="{step!r}" gravity="{scene.gravity[0] * units!r} {scene.gravity[1] * units!r} 0" cone="pyramidal" impratio="1">
<flag refsafe="disable"/></option>
<asset>{meshes}</asset><worldbody>{trees}</worldbody><contact>{_pairs(found, step, setup.ring)}</contact></mujoco>"""
    mujoco.set_mju_user_warning(_silent)  # it would write a file into the current folder
    model = mujoco.MjModel.from_xml_string(text)
    world = MujocoWorld(mujoco, model, scene, units)
    for name, drive in acting.items():
        world.data.qfrc_applied[world.start[name]] = drive.torque * mass * units**2
    return world


def _silent(_message: str) -> None:
    """An instability shows in the numbers."""


def _corner(surface: Surface) -> tuple[float, ...]:
    if isinstance(surface.piece, Circle):
        return (*surface.piece.centre, surface.piece.radius)
    return tuple(c for point in surface.piece for c in point)


def _reach(body: Body, found: list[Surface], units: float) -> float:
    """Distance of the farthest corner from the body's origin, in length units."""
    own = [surface.piece for surface in found if surface.body == body.name]
    far = [math.hypot(*p.centre) + p.radius if isinstance(p, Circle) else max(math.hypot(*c) for c in p) for p in own]
    return units * max(far, default=1.0)


def _mesh(number: int, surface: Surface, units: float, size: float) -> str:
    """A prism about the middle plane; no two bodies' prisms are equally high, lest faces meet above one another."""
    assert not isinstance(surface.piece, Circle)
    half = 0.05 * size * (1.0 + 0.3 * (surface.own & 0x55555555 != 0))
    points = " ".join(f"{x * units!r} {y * units!r} {z!r}" for z in (-half, half) for x, y in surface.piece)
    return f'<mesh name="mesh{number}" vertex="{points}"/>'


def _geom(number: int, surface: Surface, units: float) -> str:
    common = f'name="geom{number}" contype="0" conaffinity="0" mass="0"'
    if isinstance(surface.piece, Circle):
        x, y = surface.piece.centre
        return f'<geom {common} type="sphere" size="{surface.piece.radius * units!r}" pos="{x * units!r} {y * units!r} 0"/>'
    return f'<geom {common} type="mesh" mesh="mesh{number}"/>'


def _body(body: Body, found: list[Surface], drive: Drive | None, units: float, mass: float) -> str:
    geoms = "".join(_geom(k, surface, units) for k, surface in enumerate(found) if surface.body == body.name)
    turned = f'euler="0 0 {body.angle!r}"' if body.motion != "pivot" else ""
    place = (
        f'pos="{body.position[0] * units!r} {body.position[1] * units!r} 0" {turned} gravcomp="{int(body.motion == "pivot")}"'
    )
    head = f"<body name={quoteattr(body.name)} {place}>"
    if body.motion == "fixed":
        return f"{head}{geoms}</body>"
    name, inertia = body.name, body.inertia * mass * units**2
    weight, arm, own = mass * body.mass, 0.0, inertia
    if body.motion == "pivot":
        # Contacts are made as stiff as the engine thinks the body's centre of mass is hard to move. One that lies in the pivot
        # cannot be moved at all, and contacts go wild. So the inertia is that of a mass at the body's reach.
        reach = _reach(body, found, units)
        weight, arm, own = inertia / reach**2, _RIM * reach, inertia * (1.0 - _RIM**2)
    inertial = f'<inertial pos="{arm!r} 0 0" mass="{weight!r}" diaginertia="{own!r} {own!r} {own!r}"/>'
    scale = mass * units**2
    spring = ""
    if drive:
        spring = f'stiffness="{drive.stiffness * scale!r}" springref="{drive.rest!r}" damping="{drive.viscous * scale!r}"'
    joints = f'<joint name={quoteattr(name + ".angle")} type="hinge" axis="0 0 1" {spring}/>'
    if body.motion == "free":
        slides = (
            f'<joint name={quoteattr(f"{name}.{k}")} type="slide" axis="{axis}"/>'
            for k, axis in (("x", "1 0 0"), ("y", "0 1 0"))
        )
        joints = "".join(slides) + joints
    return f"{head}{joints}{inertial}{geoms}</body>"


def _pairs(found: list[Surface], step: float, ring: float) -> str:
    """Every pair of surfaces that may touch, with its spring."""
    return "".join(
        f'<pair geom1="geom{i}" geom2="geom{j}" condim="3" friction="{a.friction!r} {a.friction!r} 0 0 0" '
        f'solref="{_solref(a.restitution, step, ring)}"/>'
        for i, a in enumerate(found)
        for j, b in enumerate(found)
        if i < j and a.own & b.meets
    )


def _solref(restitution: float, step: float, ring: float) -> str:
    """Time constant and damping ratio of a contact that lasts `ring` steps."""
    if restitution == 0.0:
        return f"{2.0 * step!r} 1"
    log = math.log(restitution)
    ratio = -log / math.hypot(math.pi, log)
    return f"{ring * step * math.sqrt(1.0 - ratio**2) / (math.pi * ratio)!r} {ratio!r}"
