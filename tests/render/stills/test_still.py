"""Does the picture of the start show what can touch in colour, and only that?"""

from __future__ import annotations

from pathlib import Path

import imageio.v3 as imageio
import numpy as np
from matplotlib.colors import to_rgb

import watchsim as ws
from watchsim.mechanism.check import modelled_pairs
from watchsim.mechanism.compile import compile_scene
from watchsim.model import LINE
from watchsim.render import still as module
from watchsim.render.parts import pose_matrix
from watchsim.render.stage import Stage

LEVER = Path(__file__).resolve().parents[3] / "profiles" / "bench_lever" / "scene.toml"


def test_reachable_edges_wear_colour_and_others_do_not(tmp_path):
    scene = ws.load(LEVER)
    compiled = compile_scene(scene)
    pairs = modelled_pairs(compiled, [body.name for body in scene.bodies])
    module.still(scene, tmp_path / "start.png", compiled, pairs)
    picture = imageio.imread(tmp_path / "start.png").astype(float) / 255.0
    view = Stage(module.at_rest(scene, compiled), module.SIZE, (0.0, 1.0)).view
    rows = {"never": [], "reachable": [], "candidate": []}
    for number, body in enumerate(scene.bodies):
        matrix = view.matrix(view.centre) @ pose_matrix(np.array([*body.position, body.angle]))
        for i, primitive in enumerate(compiled.model.primitives):
            if primitive.body != number or primitive.kind != LINE or primitive.length < 0.2e-3:
                continue
            middle = (primitive.x + 0.5 * primitive.length * primitive.tx, primitive.y + 0.5 * primitive.length * primitive.ty)
            x, y, _ = matrix @ (*middle, 1.0)
            kind = "candidate" if i in pairs.candidates else "reachable" if i in pairs.reachable else "never"
            rows[kind].append(picture[module.SIZE[1] - 1 - round(y), round(x)])
    wanted = {"reachable": module.REACHABLE, "candidate": module.CANDIDATE}
    for kind, colour in wanted.items():
        off = np.abs(np.array(rows[kind]) - to_rgb(colour)).max(axis=1)
        # Bodies that touch cover each other's edges here and there.
        assert len(off) > 3 and np.mean(off < 0.35) > 0.9, kind
    for colour in wanted.values():
        assert np.abs(np.array(rows["never"]) - to_rgb(colour)).max(axis=1).min() > 0.3
