"""Do bodies that have nothing to do with each other leave each other alone, and are those found that have?"""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.motion.contact_islands import island_of, label_islands, sort_by_island
from watchsim.simulation.simulate import simulate

_label, _sort = callable_kernel(label_islands), callable_kernel(sort_by_island)
_island_of = callable_kernel(island_of)
R = 0.01  # m


def disc(name: str, x: float, height: float = 0.0) -> Body:
    circle = Loop((Arc(0.0, 0.0, R, 0.0, 2.0 * math.pi),))
    return Body(name, "free", (x, R + height), mass=0.01, inertia=4e-7, loops=(circle,))


def on_ground(*discs: Body, touching: tuple[tuple[str, str], ...] = ()) -> Scene:
    """Discs on one line, with contacts among those in `touching`."""
    ground = Body("ground", "fixed", loops=(Loop((Line(5.0, 0.0, -5.0, 0.0),), closed=False),))
    pairs = [(one.name, "ground") for one in discs] + list(touching)
    contacts = tuple(Contact((Side(a), Side(b)), 0.2, 0.7) for a, b in pairs)
    return Scene("discs", (*discs, ground), gravity=(0.0, -9.81), contacts=contacts)


def islands(compiled: Compiled, ids: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Labels by coordinate, the contacts in order, the end of each one's island."""
    label, listed, upto = np.zeros(len(compiled.q), np.int64), ids.copy(), np.zeros(len(ids), np.int64)
    _label(compiled.model, listed, len(ids), label)
    _sort(compiled.model, label, len(ids), listed, upto)
    return label, listed, upto


def test_islands_are_the_connected_sets() -> None:
    """Against a search over the graph of coordinates, for any choice of closed contacts."""
    names = [f"d{i}" for i in range(7)]
    touching = tuple((names[i], names[j]) for i in range(7) for j in range(i))
    compiled = compile_scene(on_ground(*(disc(name, 0.03 * i) for i, name in enumerate(names)), touching=touching))
    model, rng = compiled.model, np.random.default_rng(5)
    body = [compiled.model.primitives[k].body for k in range(len(model.primitives))]
    for _ in range(200):
        ids = np.sort(rng.choice(len(model.contacts), rng.integers(0, 12), replace=False)).astype(np.int64)
        label, listed, upto = islands(compiled, ids)
        groups = [{3 * i, 3 * i + 1, 3 * i + 2} for i in range(7)]
        for k in ids:
            firsts = [model.bodies[body[side]].first for side in (model.contacts[k].a, model.contacts[k].b)]
            joined = [g for g in groups if any(first in g for first in firsts if first >= 0)]
            groups = [g for g in groups if g not in joined] + [set.union(*joined)]
        assert sorted(min(g) for g in groups) == sorted(set(label))
        assert all(label[i] == min(g) for g in groups for i in g)
        assert sorted(listed) == sorted(ids)
        where = [int(_island_of(model, label, k)) for k in listed]
        assert where == sorted(where)
        assert [int(end) for end in upto] == [max(j for j, other in enumerate(where) if other == one) + 1 for one in where]


def test_impacts_elsewhere_do_not_push_what_rolls() -> None:
    """A disc rolls on undisturbed, without any event of its own, while another one bounces beside it."""
    rolling = dataclasses.replace(disc("rolling", 0.0), velocity=(0.3, 0.0, -0.3 / R))
    run = simulate(on_ground(rolling, disc("bouncing", 1.0, height=0.02)), 0.5)
    assert run.counts["impacts"] > 5
    own = [k for k, pair in enumerate(run.pairs) if "rolling" in (pair.body_a, pair.body_b)]
    assert not np.isin(run.events["contact"][run.events["t"] > 0.0], own).any()
    assert np.abs(run.u[:, run.slices["rolling"]] / [0.3, 1.0, 0.3 / R] - [1.0, 0.0, -1.0]).max() < 2e-15
