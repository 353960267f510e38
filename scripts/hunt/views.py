"""How else can the same mechanism be described?

Turned in the plane, mirrored, each outline drawn at another angle in its own frame; and how does its motion look from there?
Start velocities, forces and places changed by a small share give the perturbed twins.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hunt.parts import apart
from watchsim.geometry.primitives import Point
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import Stop
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]


@dataclass(frozen=True)
class View:
    """First mirrored in the x axis, then turned by `tilt` (rad); the outline of a body drawn turned by `drawn[name]`."""

    tilt: float = 0.0
    mirrored: bool = False
    drawn: Mapping[str, float] = field(default_factory=dict)

    def of(self, scene: Scene) -> Scene:
        """The scene as described from here."""
        motions = {body.name: body.motion for body in scene.bodies}
        sign = -1.0 if self.mirrored else 1.0
        signs = {name: sign if motion == "pivot" else 1.0 for name, motion in motions.items()}
        return replace(
            scene,
            bodies=tuple(self._body(body) for body in scene.bodies),
            gravity=self._vector(scene.gravity),
            torques=tuple(replace(t, value=signs[t.body] * t.value) for t in scene.torques),
            springs=tuple(
                replace(s, rest=signs[s.body] * s.rest + (self._offset(s.body) if motions[s.body] == "pivot" else 0.0))
                for s in scene.springs
            ),
        )

    def back(self, scene: Scene, slices: Mapping[str, slice], q: Array) -> Array:
        """Rows of coordinates of the turned scene as those of the scene itself."""
        out, sign = np.array(q), -1.0 if self.mirrored else 1.0
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        for body in scene.bodies:
            if body.motion == "pivot":
                column = slices[body.name].start
                out[:, column] = sign * (q[:, column] - self._offset(body.name))
            elif body.motion == "free":
                i = slices[body.name].start
                out[:, i] = c * q[:, i] + s * q[:, i + 1]
                out[:, i + 1] = sign * (c * q[:, i + 1] - s * q[:, i])
                out[:, i + 2] = sign * (q[:, i + 2] - self._offset(body.name))
        return out

    def _offset(self, name: str) -> float:
        return self.tilt - self.drawn.get(name, 0.0)

    def _vector(self, v: Point) -> Point:
        x, y = v[0], -v[1] if self.mirrored else v[1]
        return _turned((x, y), self.tilt)

    def _body(self, body: Body) -> Body:
        angle = self.drawn.get(body.name, 0.0)
        sign = -1.0 if self.mirrored else 1.0
        loops = tuple(loop.reflected((0.0, 0.0), (1.0, 0.0)) if self.mirrored else loop for loop in body.loops)
        velocity = body.velocity
        if body.motion == "pivot":
            velocity = (sign * velocity[0],)
        elif body.motion == "free":
            velocity = (*self._vector((velocity[0], velocity[1])), sign * velocity[2])
        centre = body.centre_of_mass
        return replace(
            body,
            position=self._vector(body.position),
            angle=sign * body.angle + self._offset(body.name),
            velocity=velocity,
            axis=self._vector(body.axis),
            centre_of_mass=_turned((centre[0], sign * centre[1]), angle),
            loops=tuple(loop.moved(angle, (0.0, 0.0)) if angle else loop for loop in loops),
        )


def views(scene: Scene, seed: int, count: int) -> list[View]:
    """Turned anyhow; every other one mirrored."""
    rng = np.random.default_rng(seed)
    return [
        View(
            float(rng.uniform(0.0, 2.0 * math.pi)),
            bool(k % 2),
            {body.name: float(rng.uniform(0.0, 2.0 * math.pi)) for body in scene.bodies},
        )
        for k in range(count)
    ]


def perturbed(scene: Scene, share: float, seed: int, lean: float = 1.0) -> Scene:
    """Velocities, forces, masses, laws and places changed by up to that share of themselves or of the scene's own.

    Places are stretched from a point of the plane, or with `lean` -1 drawn towards it, and outlines are turned, the other way
    with the other `lean`, where that leaves them apart: of two faces that meet flat either end may be first, and a gap that
    hardly closes may or may not. Seeds 2 n and 2 n + 1 turn outlines by the same angles. What touches is stretched.
    """
    rng = np.random.default_rng(seed)

    def near(value: float, scale: float = 0.0) -> float:
        return value + share * float(rng.uniform(-1.0, 1.0)) * max(abs(value), scale)

    size = max(math.dist(a.position, b.position) for a in scene.bodies for b in scene.bodies)
    centre = (size * rng.uniform(-1.0, 1.0), size * rng.uniform(-1.0, 1.0))
    stretch = share * float(rng.uniform(0.0, 1.0)) * float(rng.random() < 0.7)
    speeds = _typical_speeds(scene)
    bodies = []
    for body in scene.bodies:
        velocity = tuple(near(v, speeds[body.motion if i < 2 else "pivot"]) for i, v in enumerate(body.velocity))
        bodies.append(replace(body, velocity=velocity, inertia=near(body.inertia), mass=near(body.mass)))
    gravity = _turned(scene.gravity, share * float(rng.uniform(-1.0, 1.0)))
    changed = replace(
        scene,
        bodies=tuple(bodies),
        gravity=gravity,
        torques=tuple(replace(t, value=near(t.value)) for t in scene.torques),
        springs=tuple(replace(s, stiffness=near(s.stiffness)) for s in scene.springs),
        contacts=tuple(
            replace(c, friction=near(c.friction), restitution=min(near(c.restitution), 1.0)) for c in scene.contacts
        ),
    )
    angles = share * lean * np.random.default_rng(seed // 2).uniform(0.1, 1.0, len(bodies))
    twins = [_stretched(changed, centre, 1.0 + sign * stretch) for sign in (lean, 1.0)]
    for twin in twins:
        skewed = replace(twin, bodies=tuple(_skewed(body, float(by)) for body, by in zip(twin.bodies, angles, strict=True)))
        if apart(skewed):
            return skewed
    return twins[1]


def _stretched(scene: Scene, centre: Point, factor: float) -> Scene:
    """All places that far from a point of the plane."""
    mx, my = centre
    places = [(mx + factor * (b.position[0] - mx), my + factor * (b.position[1] - my)) for b in scene.bodies]
    return replace(scene, bodies=tuple(replace(b, position=p) for b, p in zip(scene.bodies, places, strict=True)))


def _skewed(body: Body, angle: float) -> Body:
    """Its outline turned about a corner of its own: faces that land flat land on one end or the other."""
    if body.motion in ("fixed", "slide"):
        return body
    x, y = body.loops[0].edges[0].start
    c, s = _turned((x, y), angle)
    return replace(body, loops=tuple(loop.moved(angle, (x - c, y - s)) for loop in body.loops))


def _typical_speeds(scene: Scene) -> dict[str, float]:
    """The largest start velocity of each kind of motion: what a body at rest is nudged by is a share of it."""
    found: dict[str, float] = {"fixed": 0.0}
    for motion in ("pivot", "slide", "free"):
        values = [abs(v) for body in scene.bodies if body.motion == motion for v in body.velocity[:2]]
        found[motion] = max(values, default=0.0) or (1.0 if motion == "pivot" else 0.01)
    return found


def _turned(v: Point, angle: float) -> Point:
    c, s = math.cos(angle), math.sin(angle)
    return c * v[0] - s * v[1], s * v[0] + c * v[1]


# How much of a disagreement do two runs make on the way, and how much has only grown from rounding?
#
# Unstable motion multiplies: a cam that chatters under an arm turns the rounding of one impact into 10⁻³ of the size. Twins,
# which differ from the start, do not show that where the motion has forgotten its start before. So a run is restarted at each
# of its samples: what a piece does otherwise is made there, and grows no further. It is taken for a difference of rates, which
# goes on to the end. Where both runs are what the other description makes piece by piece, they obey the same laws, and what
# parts them is growth. What has gone wrong in one whole run alone, as a contact lost, shows in the piece where it happens.

if TYPE_CHECKING:
    from hunt.judge import Judge

LONG = 2  # samples a piece: a rate that comes out otherwise in the first shows in the second


def made(judge: "Judge", run: Trajectory, tolerance: float, view: View | None = None) -> Array:
    """(samples,): how far, as shares of the size, pieces at that tolerance and seen from there lead away from a run."""
    found = np.zeros(len(judge.times))
    starts, step = np.concatenate([[0.0], judge.times[:-1]]), judge.times[0]
    for k, start in enumerate(starts):
        own = _piece(judge, run, tolerance, view, start, judge.times[k : k + LONG])
        found[k:] += own * np.maximum(judge.times[k:] - start, step) / step
    return found


def _piece(judge: "Judge", run: Trajectory, tolerance: float, view: View | None, start: float, times: Array) -> float:
    """How far a piece leads away from the run that it begins on; infinite where it comes to no end."""
    row = max(int(np.searchsorted(run.t, start, side="right")) - 1, 0)  # the end of a step, where gaps are closed
    scene, begun = resumed(run, row, float(times[-1]))
    try:
        piece = judge.run(scene if view is None else view.of(scene), tolerance)
    except SceneError:
        return np.inf
    if piece.stop != Stop.DURATION:
        return np.inf
    q, _ = run.sample(times)
    away = judge.motion(piece, view, times - run.t[row]) + (begun - q) * judge.weights
    return float(np.abs(away).max())


def resumed(run: Trajectory, row: int, until: float) -> tuple[Scene, Array]:
    """The scene of a run from one of its rows on, and what its coordinates there are to be raised by to be those of the run.

    A sliding body starts again at zero, where its guide stands.
    """
    scene, q, u = run.scene, run.q[row], run.u[row]
    bodies, springs, begun = [], list(scene.springs), np.zeros(len(q))
    for body in scene.bodies:
        own = run.slices.get(body.name, slice(0))
        bodies.append(_standing(body, q[own], u[own]))
        if body.motion == "slide":
            begun[own] = q[own]
            springs = [replace(s, rest=s.rest - float(q[own][0])) if s.body == body.name else s for s in springs]
    return replace(scene, bodies=tuple(bodies), springs=tuple(springs), duration=until - float(run.t[row])), begun


def _standing(body: Body, q: Array, u: Array) -> Body:
    """A body moved to where its coordinates are `q`, with the velocities `u`."""
    velocity = tuple(float(value) for value in u)
    if body.motion == "pivot":
        return replace(body, angle=float(q[0]), velocity=velocity)
    if body.motion == "slide":
        (x, y), (ax, ay), way = body.position, body.axis, float(q[0])
        return replace(body, position=(x + way * ax, y + way * ay), velocity=velocity)
    if body.motion == "free":
        return replace(body, position=(float(q[0]), float(q[1])), angle=float(q[2]), velocity=velocity)
    return body
