"""At which height does each layer of a mechanism lie?

A scene is flat. For pictures and files in three dimensions its layers are stacked as a watchmaker would: what is declared to
touch lies at one height, and so do layers of one body that lie side by side; what covers each other without touching lies one
above the other. The largest come lowest.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

from watchsim.drawing.material import layer_roles
from watchsim.geometry.loops import Loop
from watchsim.geometry.solids import reach
from watchsim.scene.scene import Body, Scene
from watchsim.scene.solids import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid
from watchsim.scene.trains import at_start

if TYPE_CHECKING:
    from watchsim.geometry.solids import Region


AIR = 0.1  # of a layer's thickness, between two heights
DEVIATION = 1e-6  # m of a chord from its arc, where only overlaps are looked for
BESIDE = 20e-6  # m between layers that lie side by side: there is glue between stones and lever
TOUCHING = 1e-3  # of the smaller of two layers: sharing no more than this, they stand side by side


@dataclass(frozen=True)
class Slab:
    """One layer of a body as a solid: outlines in the body's frame (m), `thickness` and the height of its `middle` (m).

    `solid` is what the scene says of it, None where only the outlines are known and the thickness is a default.
    """

    body: str
    layer: str
    loops: tuple[Loop, ...]
    thickness: float
    middle: float = 0.0
    solid: Solid | None = None


def slabs(scene: Scene, thickness: float) -> tuple[Slab, ...]:
    """All layers of all bodies that have a volume, each at its height; `thickness` (m) where the scene gives none."""
    flat = [slab for body in scene.bodies for slab in _of_body(body, thickness)]
    standing = [slab for slab in flat if slab.solid is None or slab.solid.kind != UPRIGHT]
    heights = _heights(scene, standing)
    placed = {id(slab): replace(slab, middle=height) for slab, height in zip(standing, heights, strict=True)}
    return tuple(placed.get(id(slab)) or _on_its_pivot(slab, flat, placed) for slab in flat)


def _of_body(body: Body, thickness: float) -> Iterable[Slab]:
    for solid in body.solids:
        layer = solid.layer or (body.layers[0] if solid.kind == PLATE and len(body.layers) == 1 else solid.kind)
        yield Slab(body.name, layer, _seen(solid), _height(solid), solid=solid)
    described = {solid.layer for solid in body.solids}
    whole = any(solid.kind == PLATE and not solid.layer for solid in body.solids)
    for layer in body.layers:
        loops = tuple(loop for loop in body.loops if loop.layer == layer and loop.closed)
        if loops and layer not in described and not whole:
            yield Slab(body.name, layer, loops, thickness)
    roles = layer_roles(loop for loop in (*body.loops, *body.decoration) if loop.closed)
    apart = [loop for loop in body.decoration if loop.closed and loop.layer not in described and loop.layer not in body.layers]
    for layer in dict.fromkeys(loop.layer for loop in apart if roles[loop.layer] == "material" and not loop.hole):
        yield Slab(body.name, layer, tuple(loop for loop in apart if loop.layer == layer), thickness)


def _seen(solid: Solid) -> tuple[Loop, ...]:
    """Its outlines from above."""
    if solid.kind == UPRIGHT:
        return solid.loops
    if solid.spiral is not None:
        return (solid.spiral.outline(solid.width).moved(0.0, solid.pivot),)
    both = [loop.reflected(*solid.axis) for loop in solid.loops] if solid.kind == LYING else []
    return tuple(solid.copies([*solid.loops, *both]))


def _height(solid: Solid) -> float:
    if solid.kind == LYING:
        return 2.0 * reach(solid.loops, *solid.axis)
    return solid.thickness


def _on_its_pivot(slab: Slab, flat: Sequence[Slab], placed: dict[int, Slab]) -> Slab:
    """A staff goes through the middle of all else on its body."""
    others = [placed[id(other)].middle for other in flat if other.body == slab.body and id(other) in placed]
    return replace(slab, middle=0.5 * (min(others) + max(others)) if others else 0.0)


def _heights(scene: Scene, flat: Sequence[Slab]) -> list[float]:
    """The middle of each slab, by the number of the level it finds free."""
    from watchsim.geometry.solids import region  # shapely is slow to load, and `check` has no need of it

    regions, start = [], at_start(scene)
    for slab in flat:
        body = start.body(slab.body)
        regions.append(region((loop.moved(body.angle, body.position) for loop in slab.loops), DEVIATION))
    groups = _joined(_groups(scene, flat), flat, regions)
    levels: list[list[int]] = []
    level_of: dict[int, int] = {}
    for group in sorted(groups, key=lambda members: -max(regions[i].area for i in members)):
        free = (k for k, level in enumerate(levels) if not _any_covers(group, level, regions))
        k = next(free, len(levels))
        if k == len(levels):
            levels.append([])
        levels[k] += group
        level_of.update(dict.fromkeys(group, k))
    middles, bottom = [], 0.0
    for level in levels:
        tallest = max(flat[i].thickness for i in level)
        middles.append(bottom + 0.5 * tallest)
        bottom += (1.0 + AIR) * tallest
    return [middles[level_of[i]] for i in range(len(flat))]


def _joined(groups: list[list[int]], flat: Sequence[Slab], regions: Sequence[Region]) -> list[list[int]]:
    """The groups, those made one that hold layers of one body side by side, unless that would bring two layers to one place."""
    for i, j in combinations(range(len(flat)), 2):
        first, second = (next(group for group in groups if k in group) for k in (i, j))
        if first is second or flat[i].body != flat[j].body or regions[i].distance(regions[j]) > BESIDE:
            continue
        if not _any_covers(first, second, regions):
            groups = [group for group in groups if group is not first and group is not second] + [first + second]
    return groups


def _any_covers(group: Sequence[int], others: Sequence[int], regions: Sequence[Region]) -> bool:
    return any(_cover(regions[i], regions[j]) for i in group for j in others)


def _cover(a: Region, b: Region) -> bool:
    """Does one lie above the other by more than a touch?"""
    return bool(a.intersection(b).area > TOUCHING * min(a.area, b.area))


def _groups(scene: Scene, flat: Sequence[Slab]) -> list[list[int]]:
    """Slabs that lie at one height because contacts join them."""
    group = list(range(len(flat)))
    for contact in scene.contacts:
        joined = [
            i
            for i, slab in enumerate(flat)
            if any(
                slab.body == side.body and side.layer in (None, slab.layer) and _can_touch(scene, slab)
                for side in contact.sides
            )
        ]
        first = {group[i] for i in joined}
        group = [min(first) if number in first else number for number in group]
    return [[i for i, number in enumerate(group) if number == kept] for kept in dict.fromkeys(group)]


def _can_touch(scene: Scene, slab: Slab) -> bool:
    plate = slab.solid is None or slab.solid.kind not in (HAIRSPRING, LYING)
    return plate and slab.layer in scene.body(slab.body).layers
