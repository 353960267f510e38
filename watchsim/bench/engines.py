"""How does a scene run in other engines: pymunk, Box2D, MuJoCo?

Only what they all can do: bodies that turn, are free or fixed, one set of contact parameters for each outline, constant
torques, linear springs and dampers. Anything else is refused rather than left out in silence.
"""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version as version_of_package
from typing import Any, Protocol
from xml.sax.saxutils import quoteattr

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.scene.forces import CONSTANT
from watchsim.scene.scene import Body, Scene

MODULES = {"pymunk": "pymunk", "box2d": "Box2D", "mujoco": "mujoco"}


@dataclass(frozen=True, slots=True)
class Setup:
    """How an engine is set up for a scene: its best known way.

    units       length units per metre: engines have lengths of their own built in
    deviation   m, of chords from arcs
    iterations  of the contact solver: velocities, positions
    slop        m of penetration that is not corrected, where the engine lets one choose
    ring        duration of a contact in steps, where contacts are springs
    """

    units: float
    deviation: float = 1e-7
    iterations: tuple[int, int] = (20, 10)
    slop: float = 1e-9
    ring: float = 3.2


class World(Protocol):
    """A scene in another engine, at its start."""

    def advance(self, steps: int) -> None:
        """Take that many steps."""

    def place(self, body: str) -> tuple[float, float, float]:
        """x, y (m) and angle (rad, not wrapped) of a body that moves."""


def is_installed(method: str) -> bool:
    """True if the engine can be imported."""
    return importlib.util.find_spec(MODULES[method]) is not None


def version_of(method: str) -> str:
    """The engine's version, as its package says."""
    return version_of_package(MODULES[method])


def build(method: str, scene: Scene, step: float, setup: Setup) -> World:
    """The scene in the engine `method`, to be advanced in steps of `step` seconds."""
    worlds: dict[str, Callable[[Scene, float, Setup], World]] = {
        "pymunk": PymunkWorld,
        "box2d": Box2DWorld,
        "mujoco": MujocoWorld,
    }
    return worlds[method](scene, step, setup)


# Engines for games know convex polygons and circles only. Arcs are first replaced by chords that stray by at most a given
# deviation; the polygon is cut into triangles by clipping ears, and triangles are joined again while they stay convex
# (Hertel and Mehlhorn 1983).

Polygon = tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Circle:
    """A full disc, metres."""

    centre: Point
    radius: float


Piece = Circle | Polygon


def convex_pieces(loop: Loop, deviation: float, corners: int = 8) -> list[Piece]:
    """Convex pieces (counter-clockwise, at most `corners` corners, metres) that fill a closed outer outline.

    An open chain of one line is the edge of a half-plane: a box as deep as a twentieth of its length lies behind it.
    ValueError for a hole or another open chain.
    """
    if loop.hole:
        raise ValueError(f'the hole on layer "{loop.layer}" cannot be filled with convex pieces')
    if not loop.closed:
        return [_half_plane(loop)]
    arcs = [edge for edge in loop.edges if isinstance(edge, Arc)]
    if len(arcs) == len(loop.edges) and len({(arc.x, arc.y, arc.radius) for arc in arcs}) == 1:
        return [Circle((arcs[0].x, arcs[0].y), arcs[0].radius)]
    points = [point for edge in loop.edges for point in _chords(edge, deviation)]
    return list(_joined(points, _ears(points), corners))


def _half_plane(loop: Loop) -> Polygon:
    if len(loop.edges) != 1 or not isinstance(loop.edges[0], Line):
        raise ValueError(f'the open chain on layer "{loop.layer}" bounds no material that convex pieces could fill')
    line = loop.edges[0]
    depth = 0.05 * line.length
    dx, dy = line.tangent(0.0)
    behind = [(x - depth * dy, y + depth * dx) for x, y in (line.end, line.start)]
    return (line.start, line.end, *behind)


def _chords(edge: Edge, deviation: float) -> list[Point]:
    """Start points of the chords that replace an edge."""
    if isinstance(edge, Line):
        return [edge.start]
    widest = 2.0 * math.acos(max(0.0, 1.0 - deviation / edge.radius))
    count = max(1, math.ceil(abs(edge.sweep) / widest))
    return [edge.point(k / count) for k in range(count)]


def _turn(a: Point, b: Point, c: Point) -> float:
    """Twice the area of a, b, c; positive counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _ears(points: list[Point]) -> list[list[int]]:
    """Triangles (indices) that fill the counter-clockwise polygon."""
    left, triangles = list(range(len(points))), []
    while len(left) > 3:
        ear = next((k for k in range(len(left)) if _is_ear(points, left, k)), None)
        if ear is None:
            raise ValueError("the outline crosses itself: it cannot be cut into triangles")
        a, b, c = left[ear - 1], left[ear], left[(ear + 1) % len(left)]
        if _turn(points[a], points[b], points[c]) > 0.0:
            triangles.append([a, b, c])
        del left[ear]
    return [*triangles, left]


def _is_ear(points: list[Point], left: list[int], k: int) -> bool:
    """True if the corner left[k] can be cut off, no other corner lying in its triangle."""
    a, b, c = (points[left[(k + j) % len(left)]] for j in (-1, 0, 1))
    if _turn(a, b, c) < 0.0:
        return False
    return not any(
        _turn(a, b, p) >= 0.0 and _turn(b, c, p) >= 0.0 and _turn(c, a, p) >= 0.0
        for p in (points[i] for i in left)
        if p not in (a, b, c)
    )


def _joined(points: list[Point], triangles: list[list[int]], corners: int) -> list[Polygon]:
    """Join pieces over shared edges while the result is convex and has few enough corners."""
    pieces = list(triangles)
    while (pair := _joinable(points, pieces, corners)) is not None:
        first, second, whole = pair
        pieces = [piece for k, piece in enumerate(pieces) if k not in (first, second)] + [whole]
    return [tuple(points[i] for i in piece) for piece in pieces]


def _joinable(points: list[Point], pieces: list[list[int]], corners: int) -> tuple[int, int, list[int]] | None:
    sides = {(piece[k - 1], piece[k]): number for number, piece in enumerate(pieces) for k in range(len(piece))}
    for (a, b), first in sides.items():
        second = sides.get((b, a))
        if second is None or second <= first:
            continue
        one, other = pieces[first], pieces[second]
        i, j = one.index(b), other.index(a)
        whole = [*one[i:], *one[:i], *(other[j:] + other[:j])[1:-1]]
        if len(whole) <= corners and _is_convex([points[k] for k in whole]):
            return first, second, whole
    return None


def _is_convex(points: list[Point]) -> bool:
    return all(_turn(points[k - 2], points[k - 1], points[k]) > 0.0 for k in range(len(points)))


@dataclass(frozen=True, slots=True)
class Surface:
    """One convex piece of a body's outline, in its frame, m. Two meet where one's `own` bit is in the other's `meets`."""

    body: str
    piece: Piece
    own: int
    meets: int
    friction: float
    restitution: float


@dataclass(frozen=True, slots=True)
class Drive:
    """torque - stiffness (q - rest) - viscous u on a pivoted body, SI."""

    body: str
    torque: float = 0.0
    stiffness: float = 0.0
    rest: float = 0.0
    viscous: float = 0.0


def bodies(scene: Scene) -> tuple[Body, ...]:
    """The bodies; ValueError where one moves in a way other engines do not know here."""
    for body in scene.bodies:
        if body.motion not in ("pivot", "free", "fixed"):
            raise ValueError(f'body "{body.name}" can {body.motion}: not compared with other engines')
    return scene.bodies


def drives(scene: Scene) -> list[Drive]:
    """The forces on every pivoted body that has any; ValueError for forces other engines do not know here."""
    if any(torque.over != "constant" for torque in scene.torques):
        raise ValueError("a tabled torque: not compared with other engines")
    if any(damping.quadratic or damping.coulomb for damping in scene.damping):
        raise ValueError("damping other than viscous: not compared with other engines")
    if any(contact.slip != CONSTANT for contact in scene.contacts):
        raise ValueError("friction that depends on speed: not compared with other engines")
    found = []
    for body in scene.bodies:
        springs = [spring for spring in scene.springs if spring.body == body.name]
        if len(springs) > 1:
            raise ValueError(f'several springs on "{body.name}": not compared with other engines')
        drive = Drive(
            body.name,
            sum(torque.value for torque in scene.torques if torque.body == body.name),
            springs[0].stiffness if springs else 0.0,
            springs[0].rest if springs else 0.0,
            sum(damping.viscous for damping in scene.damping if damping.body == body.name),
        )
        if drive != Drive(body.name):
            found.append(drive)
    return found


def surfaces(scene: Scene, deviation: float) -> list[Surface]:
    """The convex pieces of all outlines that can touch; arcs become chords that stray by at most `deviation` metres."""
    found = []
    for body in scene.bodies:
        for loop in body.loops:
            own, meets, laws = 0, 0, set()
            for number, contact in enumerate(scene.contacts):
                for k, side in enumerate(contact.sides):
                    if side.body == body.name and side.layer in (None, loop.layer):
                        own |= 1 << (2 * number + k)
                        meets |= 1 << (2 * number + 1 - k)
                        laws.add((contact.friction, contact.restitution))
            if not own or loop.hole:
                continue
            if len(laws) > 1:
                raise ValueError(f'"{body.name}.{loop.layer}" has different contact laws: not compared with other engines')
            friction, restitution = laws.pop()
            pieces = convex_pieces(loop, deviation)
            found += [Surface(body.name, piece, own, meets, friction, restitution) for piece in pieces]
    return found


def lightest_inertia(scene: Scene) -> float:
    """Of the bodies that move, kg·m²: the unit of mass is chosen by it."""
    return min(body.inertia for body in bodies(scene) if body.motion != "fixed")


def scaled(piece: Piece, units: float) -> Piece:
    """A piece in length units."""
    if isinstance(piece, Circle):
        return Circle((piece.centre[0] * units, piece.centre[1] * units), piece.radius * units)
    return tuple((x * units, y * units) for x, y in piece)


HEAVY = 1e12  # kg: a pivoted body of this mass stays on its pivot without a joint; only its inertia matters
FIRST_SIDES = 0x55555555  # the bits of the first sides of contacts


class _Impulses:
    """Parts by the name of their body, and what drives them, for engines that forget forces after every step."""

    def __init__(self, scene: Scene, units: float, mass: float, parts: dict[str, Any]) -> None:
        if any(scene.gravity) and any(body.motion == "pivot" for body in scene.bodies):
            raise ValueError("gravity on a pivoted body: not compared with pymunk and Box2D")
        self.units, self.parts, scale = units, parts, mass * units**2
        acting = [(parts[d.body], d.torque * scale, d.stiffness * scale, d.rest, d.viscous * scale) for d in drives(scene)]
        self.constant = [(part, torque) for part, torque, k, _, c in acting if k == c == 0.0]
        self.sprung = [entry for entry in acting if entry[2] or entry[4]]

    def place(self, body: str) -> tuple[float, float, float]:
        part = self.parts[body]
        return part.position[0] / self.units, part.position[1] / self.units, part.angle


class PymunkWorld(_Impulses):
    """Chipmunk: sequential impulses in double precision at fixed steps; lengths in units, masses in kilograms.

    Friction and elasticity of a contact are the products of both shapes' values, so one side carries the value and the other 1.
    """

    def __init__(self, scene: Scene, step: float, setup: Setup) -> None:
        import pymunk

        units = setup.units
        self.step, self.space = step, pymunk.Space()
        self.space.gravity = (scene.gravity[0] * units, scene.gravity[1] * units)
        self.space.iterations = setup.iterations[0]
        self.space.collision_slop = setup.slop * units
        parts = {}
        for body in bodies(scene):
            if body.motion == "fixed":
                part = pymunk.Body(body_type=pymunk.Body.STATIC)
            else:
                part = pymunk.Body(body.mass if body.motion == "free" else HEAVY, body.inertia * units**2)
            part.position, part.angle = (body.position[0] * units, body.position[1] * units), body.angle
            parts[body.name] = part
            self.space.add(part)
            if body.motion == "pivot":
                part.angular_velocity = body.velocity[0] if body.velocity else 0.0
        super().__init__(scene, units, 1.0, parts)
        for surface in surfaces(scene, setup.deviation):
            piece, part = scaled(surface.piece, units), parts[surface.body]
            shape: Any = (
                pymunk.Circle(part, piece.radius, piece.centre) if isinstance(piece, Circle) else pymunk.Poly(part, list(piece))
            )
            carries = surface.own & FIRST_SIDES != 0
            shape.friction, shape.elasticity = (surface.friction, surface.restitution) if carries else (1.0, 1.0)
            shape.filter = pymunk.ShapeFilter(categories=surface.own, mask=surface.meets)
            self.space.add(shape)

    def advance(self, steps: int) -> None:
        space, step = self.space, self.step
        for _ in range(steps):
            for body, torque in self.constant:
                body.torque = torque
            for body, torque, k, rest, c in self.sprung:
                # A step moves the bodies first and lets forces act then: with the spring's torque of before, that would be
                # Euler's explicit method, which feeds the oscillation (at 20 µs 1 % of its energy in a second).
                w = body.angular_velocity
                body.torque = torque - k * (body.angle + step * w - rest) - c * w
            space.step(step)


class Box2DWorld(_Impulses):
    """Sequential impulses in single precision at fixed steps, with a skin of two length units per thousand built in: the length
    unit decides. Masses are such that the lightest body's inertia is 1.

    A contact takes the larger restitution of both shapes and the geometric mean of their friction.
    """

    def __init__(self, scene: Scene, step: float, setup: Setup) -> None:
        import Box2D

        units = setup.units
        self.step, self.iterations = step, setup.iterations
        mass = 1.0 / (lightest_inertia(scene) * units**2)
        self.world = Box2D.b2World(gravity=(scene.gravity[0] * units, scene.gravity[1] * units), doSleep=False)
        parts = {}
        for body in bodies(scene):
            make = self.world.CreateStaticBody if body.motion == "fixed" else self.world.CreateDynamicBody
            part = make(position=(body.position[0] * units, body.position[1] * units), angle=body.angle, allowSleep=False)
            # Else only what stands still is met at its own instant: a tooth's corner would sink into a stone by a whole step.
            part.bullet = body.motion != "fixed"
            parts[body.name] = part
            if body.motion == "pivot":
                part.angularVelocity = body.velocity[0] if body.velocity else 0.0
        super().__init__(scene, units, mass, parts)
        for surface in surfaces(scene, setup.deviation):
            piece = scaled(surface.piece, units)
            parts[surface.body].CreateFixture(
                shape=Box2D.b2CircleShape(pos=piece.centre, radius=piece.radius)
                if isinstance(piece, Circle)
                else Box2D.b2PolygonShape(vertices=list(piece)),
                density=0.0,
                friction=surface.friction,
                restitution=surface.restitution,
                categoryBits=surface.own,
                maskBits=surface.meets,
            )
        for body in bodies(scene):
            if body.motion != "fixed":
                own, inertia = HEAVY if body.motion == "pivot" else body.mass, body.inertia * mass * units**2
                parts[body.name].massData = Box2D.b2MassData(mass=own * mass, center=(0.0, 0.0), I=inertia)

    def advance(self, steps: int) -> None:
        step, (velocity, position), advance = self.step, self.iterations, self.world.Step
        constant = [(body.ApplyTorque, torque) for body, torque in self.constant]
        sprung = [(body, body.ApplyTorque, *rest) for body, *rest in self.sprung]
        for _ in range(steps):
            for push, torque in constant:
                push(torque, True)
            for body, push, torque, k, rest, c in sprung:
                push(torque - k * (body.angle - rest) - c * body.angularVelocity, True)
            advance(step, velocity, position)


RIM = 0.95  # of the reach: where the mass of a pivoted body is put; what is left of its inertia stays about that point


class MujocoWorld:
    """Soft contacts at fixed steps: there is no restitution, but a damped spring in each contact, whose damping ratio is set so
    that half an oscillation of it returns the wanted share of the speed.

    Polygons become prisms, circles spheres in their middle plane; masses are such that the lightest body's inertia is 1.
    """

    def __init__(self, scene: Scene, step: float, setup: Setup) -> None:
        import mujoco

        units = setup.units
        mass = 1.0 / (lightest_inertia(scene) * units**2)
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
        # An instability shows in the numbers; a warning would write a file into the current folder.
        mujoco.set_mju_user_warning(lambda _: None)
        self.mujoco, self.scene, self.units = mujoco, scene, units
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        self.start: dict[str, int] = {}  # of each body's coordinates
        for body in scene.bodies:
            if body.motion != "fixed":
                joint = f"{body.name}.{'angle' if body.motion == 'pivot' else 'x'}"
                self.start[body.name] = self.model.joint(joint).qposadr[0]
            if body.motion == "pivot":
                self.data.qpos[self.start[body.name]] = body.angle
                self.data.qvel[self.start[body.name]] = body.velocity[0] if body.velocity else 0.0
        for name, drive in acting.items():
            self.data.qfrc_applied[self.start[name]] = drive.torque * mass * units**2

    def advance(self, steps: int) -> None:
        self.mujoco.mj_step(self.model, self.data, nstep=steps)

    def place(self, body: str) -> tuple[float, float, float]:
        part, i = self.scene.body(body), self.start[body]
        if part.motion == "pivot":
            return (*part.position, float(self.data.qpos[i]))
        x, y, angle = (float(value) for value in self.data.qpos[i : i + 3])
        return part.position[0] + x / self.units, part.position[1] + y / self.units, part.angle + angle


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
    half = 0.05 * size * (1.0 + 0.3 * (surface.own & FIRST_SIDES != 0))
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
        weight, arm, own = inertia / reach**2, RIM * reach, inertia * (1.0 - RIM**2)
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
