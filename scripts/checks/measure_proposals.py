"""Of ten assembled mechanisms: how many proposals of `watchsim new DRAWING` load, and how many run after at most three edits?

Eight are the mechanisms of the profiles, drawn as one file each (tests/proposal/assemblies.py); two were drawn by others and
are looked for in the folder given. A mechanism runs where its wheel goes on, tooth by tooth where something swings, and the
verdict is neither that it stops nor that it works wrongly. Prints the table of docs/reports/proposals.md.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]
SECONDS = 3.0
WRONG = ("stops", "trips", "overbanks", "backwards")
OTHERS = ("pin_lever/siconos_pin_lever_assembly.dxf", "svg/openMEMSdesign__Schrittschaltwerke.svg")


@dataclass(frozen=True)
class Edits:
    """What a designer would change: contacts to be left out, as words of both sides, and values by key."""

    without: tuple[tuple[str, str], ...] = ()
    values: tuple[tuple[str, object], ...] = ()

    def __len__(self) -> int:
        return len(self.without) + len(self.values)


EDITS = {
    "coaxial": Edits(without=(("FORK", "IMPULSE_STONE"),)),
    # As drawn a tooth's back meets the entry stone (negative drop): the wheel is moved 0.03 mm away from the lever.
    "siconos_pin_lever_assembly": Edits(values=(("bodies.escape_wheel.position", ["4.677715 mm", "-10.668966 mm"]),)),
}


def measured(path: Path, folder: Path) -> str:
    """A row of the table."""
    from watchsim.analysis.summary import summary
    from watchsim.proposal.propose import NothingToPropose, propose
    from watchsim.scene.file.load import load
    from watchsim.simulation.simulate import simulate

    edits = EDITS.get(path.stem, Edits())
    try:
        found = propose([path])
    except NothingToPropose as error:
        return f"| {path.stem} | no | | | {str(error).splitlines()[0]} |"
    text = found.files["scene.toml"].decode()
    for first, second in edits.without:
        parts = text.split("[[contacts]]")
        text = "[[contacts]]".join(p for p in parts if not (first in p.split("\n")[1] and second in p.split("\n")[1]))
    for name, data in {**found.files, "scene.toml": text.encode()}.items():
        (folder / name).write_bytes(data)
    scene = load(folder)
    for key, value in edits.values:
        scene = scene.set(key, value)
    bodies = ", ".join(role.name for role in found.roles)
    if not scene.contacts:
        return f"| {path.stem} | yes | {bodies} | {len(edits)} | no: nothing is found that meets |"
    run = simulate(scene, SECONDS)
    numbers = summary(run)
    wheel = next(role for role in found.roles if role.task == "wheel")
    turned = run.q[-1, run.slices[wheel.name].start] - run.q[0, run.slices[wheel.name].start]
    teeth = abs(turned) * wheel.teeth / (2.0 * math.pi)
    works = teeth > 1.0 and numbers["verdict"] not in WRONG and not run.counts["lcp_failures"]
    amplitude = numbers["amplitude_deg"]
    told = f"{teeth:.1f} teeth in {SECONDS:g} s" + (f", amplitude {amplitude:.0f}°" if amplitude else "")
    return f"| {path.stem} | yes | {bodies} | {len(edits)} | {'yes' if works else 'no'}: {told} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drawings", type=Path, help="folder with drawings of others")
    args = parser.parse_args()
    from proposal.assemblies import NAMES, assembly, scene_of

    print("| Assembly | Loads | Bodies found | Edits | Runs |\n|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as place:
        paths = [assembly(scene_of(name), Path(place) / f"{name}.dxf") for name in NAMES]
        paths += [args.drawings / name for name in OTHERS] if args.drawings else []
        for number, path in enumerate(paths):
            folder = Path(place) / f"{number}"
            folder.mkdir()
            print(measured(path, folder), flush=True)


if __name__ == "__main__":
    main()
