"""How far does `watchsim new DRAWING` come? Every profile is drawn as a whole in one file, proposed and run as proposed.

Writes the table of docs/reports/proposals.md (default), or of `--page FILE`; takes some minutes.
"""

import argparse
import math
import re
import sys
import tempfile
from pathlib import Path

import numpy as np

from watchsim.proposal.propose import NothingToPropose, Proposal
from watchsim.proposal.roles import Role, plain
from watchsim.proposal.trial import tried
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from proposal.assemblies import assembly, scene_of  # noqa: E402  beside the tests that use it, too

PAGE = ROOT / "docs" / "reports" / "proposals.md"
MECHANISMS = (
    *("swiss_lever", "bench_lever", "set_a", "set_b", "pin_pallet", "coaxial", "detent", "duplex", "cylinder", "verge"),
    *("graham", "recoil_anchor", "pin_wheel", "grasshopper", "geneva", "geneva_stop", "involute_pair", "cycloidal_pair"),
    *("ratchet", "winding_click", "jumper", "cam", "snail"),
)
SECONDS = 3.0
HEAD = "| Assembly | Bodies, of its own | Doubts | What came of it in 3 s, as proposed | Without names of parts |"


def row(name: str, folder: Path) -> str:
    real = scene_of(name)
    found = proposed(real, folder / f"{name}.dxf", "body")
    bare = proposed(real, folder / f"{name}_bare.dxf", "own")
    if isinstance(found, str):
        return f"| {name} | none of {len(real.bodies)} | | {found} | {'' if isinstance(bare, str) else _bodies(real, bare, 'own')} |"
    out = folder / name
    out.mkdir()
    for file, data in found.files.items():
        (out / file).write_bytes(data)
    said = bare if isinstance(bare, str) else _bodies(real, bare, "own")
    scene = load(out)
    return f"| {name} | {_bodies(real, found, 'body')} | {len(found.doubts)} | {_motion(scene, found)} | {said} |"


def proposed(real: Scene, path: Path, layers: str) -> Proposal | str:
    try:
        return tried([assembly(real, path, layers)])
    except NothingToPropose as error:
        return str(error).splitlines()[0]


def _bodies(real: Scene, found: Proposal, layers: str) -> str:
    """How many bodies hold the very layers that they have in the mechanism's own scene."""
    own = [
        {f"{body.name}_{loop.layer}" if layers == "body" else loop.layer for loop in (*body.loops, *body.decoration)}
        for body in real.bodies
    ]
    there = [{plain(layer)[0] for layer in role.part.layers} for role in found.roles]
    right = sum(one in there for one in own)
    return f"all {len(own)}" if right == len(own) == len(there) else f"{right} of {len(own)}"


def _motion(scene: Scene, found: Proposal) -> str:
    run = simulate(scene, SECONDS)
    said = [_moved(scene, run, role) for role in found.roles if role.moves and role.task != "driver"]
    return ", ".join(said) or "nothing is driven by another part"


def _moved(scene: Scene, run: Trajectory, role: Role) -> str:
    way = run.q[:, run.slices[role.name].start]
    if role.task == "oscillator":
        return f"{role.name} swings by {math.degrees(0.5 * float(np.ptp(way[run.t > SECONDS - 1.0]))):.0f}°"
    if role.task == "wheel" and role.teeth:
        return f"{role.name} by {abs(float(way[-1] - way[0])) * role.teeth / math.tau:.1f} teeth"
    most = float(np.ptp(way))
    moved = f"{1e3 * most:.2f} mm" if scene.body(role.name).motion == "slide" else f"{math.degrees(most):.1f}°"
    return f"{role.name} over {moved}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--page", type=Path, default=PAGE, help="default %(default)s")
    page = parser.parse_args().page
    with tempfile.TemporaryDirectory() as folder:
        rows = []
        for name in MECHANISMS:
            rows.append(row(name, Path(folder)))
            print(rows[-1], flush=True)
    table = "\n".join([HEAD, re.sub(r"[^|]+", "---", HEAD), *rows])
    text = PAGE.read_text(encoding="utf-8")
    page.write_text(re.sub(r"(?ms)^\|.*?\n(?!\|)", table + "\n", text, count=1), encoding="utf-8")


if __name__ == "__main__":
    main()
