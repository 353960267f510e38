"""How does docs/guide/gallery.md come about, and the moving picture of the README?

    python scripts/pictures/make_gallery.py

Runs the commands that the page shows, as anyone can, in a folder of its own; pictures go to docs/images/gallery. Takes half a
minute.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "guide" / "gallery.md"
IMAGES = ROOT / "docs" / "images" / "gallery"
LARGEST = 2_000_000  # bytes of one picture

SWISS = 'watchsim run profiles/swiss_lever --duration "1.2 s" -o swiss'
BEAT = '--window "0.69 s:0.94 s"'


@dataclass(frozen=True)
class Exhibit:
    """A picture: its file, what it shows, and the command that makes it; `also` is run before."""

    picture: str
    title: str
    words: str
    command: str
    also: str = ""


EXHIBITS = (
    Exhibit(
        "swiss_lever.gif",
        "An oscillation of a Swiss lever",
        "At adaptive speed: unlocking, impulse and drop get most of the frames, and the speed stands at the upper right. "
        "Arrows are the forces on the lever from the wheel, and on the roller's pin from the fork.",
        f"watchsim movie swiss {BEAT} --speed adaptive --length 5s --fps 16 --size 720x406 --phases --forces "
        '--inset "entry stone" --inset lever.FORK -o swiss_lever.gif',
        SWISS,
    ),
    Exhibit(
        "tall.gif",
        "The same, for a telephone",
        "A tall picture has its insets above, and its strip of angle and velocity below; here on dark ground.",
        f"watchsim movie swiss {BEAT} --speed adaptive --length 4s --fps 12 --size 450x800 --dark --phases --strip "
        '--inset "entry stone" --inset "exit stone" -o tall.gif',
    ),
    Exhibit(
        "start.png",
        "The scene before it runs",
        "Edges that can ever touch another body are in colour.",
        "watchsim check profiles/swiss_lever --png start.png",
    ),
    Exhibit(
        "start_function.png",
        "Geometry of function",
        "Lock, draw, lift, drop and the freedoms of the safety action, measured on the drawing; the same command makes it.",
        "",
    ),
    Exhibit(
        "beat.png",
        "Angles and velocities",
        "Of all bodies over one oscillation.",
        f"watchsim plot swiss {BEAT} -o beat.png",
    ),
    Exhibit(
        "phases.png",
        "The phases of a beat",
        "From unlocking to the banking.",
        "watchsim plot swiss --phases -o phases.png",
    ),
    Exhibit(
        "timeline.png",
        "The mechanism amid each phase",
        "With the forces on the lever. More [plots](plots.md).",
        "watchsim plot swiss --kind timeline -o timeline.png",
    ),
    Exhibit(
        "torque.png",
        "Torque on the balance",
        "What unlocking takes and the impulse gives is the area under the curve.",
        "watchsim plot swiss --kind torque -o torque.png",
    ),
    Exhibit(
        "cylinder.gif",
        "Before the lever: the cylinder",
        "A tooth rests on the cylinder outside and inside by turns; in between it lifts its lips.",
        'watchsim movie cylinder --window "1.3 s:1.7 s" --speed adaptive --length 4s --fps 12 --size 400x640 --dark '
        "--phases --forces -o cylinder.gif",
        'watchsim run profiles/cylinder --duration "2 s" -o cylinder',
    ),
    Exhibit(
        "duplex.png",
        "A duplex amid each phase",
        "The wheel goes on in every other half swing: out of the notch, onto the pallet, and to rest on the roller.",
        "watchsim plot duplex --kind timeline -o duplex.png",
        'watchsim run profiles/duplex --duration "2 s" -o duplex',
    ),
    Exhibit(
        "pin_wheel.gif",
        "A tower clock",
        "The pin wheel with its pendulum of two seconds, at 4/3 of the true speed, and the pallets enlarged.",
        'watchsim movie tower --window "4 s:8 s" --speed 4/3 --fps 12 --size 320x640 --phases '
        "--inset pendulum.PALLETS -o pin_wheel.gif",
        'watchsim run profiles/pin_wheel --duration "8 s" -o tower',
    ),
    Exhibit(
        "incline.gif",
        "Not only watches",
        "A disc rolls, slides and sticks on an incline: one of the benchmarks with a closed form.",
        "watchsim movie incline --size 640x360 --fps 20 --forces --contacts -o incline.gif",
        "watchsim run profiles/incline -o incline",
    ),
)


def main() -> None:
    IMAGES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "profiles").symlink_to(ROOT / "profiles", target_is_directory=True)
        for one in EXHIBITS:
            for command in filter(None, (one.also, one.command)):
                run(command, place)
            made = place / one.picture
            if made.stat().st_size > LARGEST:
                raise SystemExit(f"{one.picture}: {made.stat().st_size / 1e6:.1f} MB are too many; make it smaller or shorter")
            shutil.copyfile(made, IMAGES / one.picture)
    PAGE.write_text(page(EXHIBITS), encoding="utf-8")


def run(command: str, folder: Path) -> None:
    """One command line of the page, with the watchsim of this folder tree."""
    words = shlex.split(command)
    found = os.environ.get("PYTHONPATH")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(ROOT), found)) if found else str(ROOT)}
    if subprocess.run([sys.executable, "-m", *words], cwd=folder, env=environment, check=False).returncode != 0:
        raise SystemExit(f"failed: {command}")


def page(exhibits: Sequence[Exhibit]) -> str:
    """The page in Markdown."""
    parts = ["# Gallery\n\nEvery picture with the commands that make it. `scripts/pictures/make_gallery.py` makes this page.\n"]
    for one in exhibits:
        parts.append(f"## {one.title}\n\n{one.words}\n")
        if commands := "\n".join(filter(None, (one.also, one.command))):
            parts.append(f"```\n{commands}\n```\n")
        parts.append(f"![{one.title}](../images/gallery/{one.picture})\n")
    return "\n".join(parts)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    arguments(__doc__)
    main()
