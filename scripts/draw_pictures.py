"""The pictures of the pages, and the pages that hold little else.

    python scripts/draw_pictures.py all            every picture
    python scripts/draw_pictures.py graham.png     one, by its path in docs/images, or those of a group

Groups: theory; mechanisms and movies (docs/guide/mechanisms.md); pages (single pictures of other pages); gallery and plots, from
the commands that docs/guide/gallery.md and plots.md show; live (in a browser); tolerances (256 watches each, some minutes). Beside the pictures
stand their words (docs/images/words.json), which tests compare with those of today. Pictures of measurements are drawn by the
scripts that measure (`MEASURED`).
"""

import contextlib
import io
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import imageio.v3 as imageio
import numpy as np
from draw_theory import PICTURES as THEORY
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

import watchsim as ws
from watchsim.cli import main as watchsim

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"
WORDS = IMAGES / "words.json"

Make = Callable[[Path], None]  # writes a picture to a path

SIZE = (960, 540)
MECHANISMS = {  # profile: picture: simulated (s), instant (s), bodies to show close (None: all); movie: simulated, window, speed, options
    "geneva": (1.0, 0.2, None, "1.5 s", "0 s:1.5 s", "1/2", ""),
    "geneva_stop": (4.0, 4.0, None, "4 s", "0 s:4 s", "1", ""),
    "graham": (2.0, 1.76, None, "5 s", "4 s:5 s", "1/4", ""),
    "recoil_anchor": (2.0, 1.76, None, "5 s", "4 s:5 s", "1/4", ""),
    "detent": (2.5, 2.1275, None, "2.6 s", "2 s:2.5 s", "adaptive", "--length 4s"),
    "pin_pallet": (2.2, 2.101, None, "2.6 s", "2 s:2.4 s", "adaptive", "--length 4s --zoom wheel,lever"),
    "pin_wheel": (4.0, 3.52, None, "6 s", "4 s:6 s", "1/2", ""),
    "cylinder": (2.2, 2.1, None, "2.6 s", "2 s:2.4 s", "adaptive", "--length 4s"),
    "duplex": (2.2, 2.1055, None, "2.6 s", "2 s:2.4 s", "adaptive", "--length 4s"),
    "involute_pair": (0.2, 0.2, None, "0.4 s", "0.1 s:0.4 s", "1/12", "--zoom pinion"),
    "cycloidal_pair": (0.2, 0.2, ["pinion"], "0.4 s", "0.1 s:0.4 s", "1/12", "--zoom pinion"),
    "jumper": (0.6, 0.49, None, "1 s", "0 s:1 s", "1/4", ""),
    "cam": (0.2, 0.1, None, "0.3 s", "0 s:0.3 s", "1/10", ""),
    "ratchet": (0.2, 0.15, None, "0.5 s", "0 s:0.5 s", "1/8", ""),
    "verge": (4.5, 4.42, None, "9 s", "5 s:9 s", "1", ""),
    "winding_click": (0.5, 0.2, None, "0.5 s", "0 s:0.5 s", "1/8", ""),
    "snail": (3.4, 3.3, None, "7.3 s", "4.95 s:7.25 s", "1/2", ""),
    "grasshopper": (1.5, 1.35, None, "5 s", "4 s:5 s", "1/4", ""),
    "remontoir": (1.0, 0.942, None, "1 s", "0.93 s:0.96 s", "1/120", ""),
    "tourbillon": (5.1, 5.0, None, "5.1 s", "4 s:5 s", "1/4", ""),
    "governor": (1.1, 1.0, None, "1.2 s", "0 s:1.2 s", "1/4", ""),
}


def mechanism(name: str, path: Path) -> None:
    duration, instant, close, *_ = MECHANISMS[name]
    run = ws.simulate(ws.load(ws.profiles_dir() / name), duration=duration)
    imageio.imwrite(path, ws.frame(run, instant, size=SIZE, zoom=close))


LOOK = "--size 480x320 --fps 12"


def film(name: str, path: Path) -> None:
    *_, duration, window, speed, options = MECHANISMS[name]
    with tempfile.TemporaryDirectory() as folder:
        run = f"{folder}/{name}"
        called(f'watchsim run profiles/{name} --duration "{duration}" --no-plots -o {run}')
        called(f'watchsim movie {run} --window "{window}" --speed {speed} {LOOK} {options} -o {path}')


def called(command: str) -> None:
    """One command line of a page, in this process."""
    _, *words = shlex.split(command)
    with contextlib.redirect_stdout(io.StringIO()) as said:
        status = watchsim(words)
    if status != 0:
        raise SystemExit(f"failed: {command}\n{said.getvalue()}")


GALLERY_PAGE = ROOT / "docs" / "guide" / "gallery.md"
LARGEST = 2_000_000  # bytes of one picture
SWISS = 'watchsim run profiles/swiss_lever --duration "1.2 s" -o swiss'
START = "watchsim check profiles/swiss_lever --png start.png"
BEAT = '--window "0.69 s:0.94 s"'


@dataclass(frozen=True)
class Exhibit:
    """A picture: its file, what it shows, and the command that makes it; `also` is run before, once."""

    picture: str
    title: str
    words: str
    command: str
    also: str = SWISS


EXHIBITS = (
    Exhibit(
        "swiss_lever.gif",
        "An oscillation of a Swiss lever",
        "At adaptive speed: unlocking, impulse and drop get most of the frames, and the speed stands at the upper right. "
        "Arrows are the forces on the lever from the wheel, and on the roller's pin from the fork.",
        f"watchsim movie swiss {BEAT} --speed adaptive --length 5s --fps 16 --size 720x406 --phases --forces "
        '--inset "entry stone" --inset lever.FORK -o swiss_lever.gif',
    ),
    Exhibit(
        "tall.gif",
        "The same, for a phone",
        "A tall picture has its insets above, and its strip of angle and velocity below; here with a dark background.",
        f"watchsim movie swiss {BEAT} --speed adaptive --length 4s --fps 12 --size 450x800 --dark --phases --strip "
        '--inset "entry stone" --inset "exit stone" -o tall.gif',
    ),
    Exhibit(
        "start.png",
        "The scene before it runs",
        "Edges that can ever touch another body are in colour.",
        START,
        "",
    ),
    Exhibit(
        "start_function.png",
        "Geometry of function",
        "Lock, draw, lift, drop and the freedoms of the safety action, measured on the drawing; the same command makes it.",
        START,
        "",
    ),
    Exhibit(
        "beat.png", "Angles and velocities", "Of all bodies over one oscillation.", f"watchsim plot swiss {BEAT} -o beat.png"
    ),
    Exhibit(
        "phases.png", "The phases of a beat", "From unlocking to the banking.", "watchsim plot swiss --phases -o phases.png"
    ),
    Exhibit(
        "timeline.png",
        "The mechanism during each phase",
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
        "A duplex during each phase",
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


class Shop:
    """A folder where the commands of a group are run, each once; the profiles are found from anywhere."""

    def __init__(self, first: str = "") -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.first, self.done = first, set[str]()

    def exhibit(self, one: Exhibit, path: Path) -> None:
        here = Path.cwd()
        os.chdir(self.folder.name)
        try:
            for command in (self.first, one.also, one.command):
                if command and command not in self.done:
                    called(command)
                    self.done.add(command)
            shutil.copyfile(Path(one.picture).name, path)
        finally:
            os.chdir(here)


def gallery_page() -> str:
    parts = ["# Gallery\n\nEvery picture with the commands that make it. `scripts/draw_pictures.py gallery` makes this page.\n"]
    shown = set[str]()
    for one in EXHIBITS:
        parts.append(f"## {one.title}\n\n{one.words}\n")
        commands = [command for command in (one.also, one.command) if command and command not in shown]
        shown.update(commands)
        if commands:
            parts.append("```\n" + "\n".join(commands) + "\n```\n")
        parts.append(f"![{one.title}](../images/gallery/{one.picture})\n")
    return "\n".join(parts)


PLOTS_PAGE = ROOT / "docs" / "guide" / "plots.md"
RUN = 'watchsim run profiles/swiss_lever --duration "20 s" -o swiss --no-plots'


PLOTTED = """\
kinematics | --window "19.55 s:19.85 s" | Kinematics | Angle and velocity of every body (`--bodies`, `--quantities angle,velocity,acceleration`) over the run or a `--window`. Where the window shows a few beats, their phases are shaded and named. Impacts are jumps. However many rows a run has, every spike is drawn: of each column of dots the curve keeps the first, last, least and largest value.
phases | --kind phases | The phases of a beat | The last oscillation, with its two beats enlarged. `--phases` prints the tables of motion and energy, too.
timeline | --kind timeline | The mechanism during each phase | The parts around the lever in the middle of every phase, with the contact forces on the lever as arrows of one scale; numbers show when.
torque | --kind torque | Torque on the balance | The moment of all contact forces on the balance over its angle, positive with its swing: below zero the balance unlocks, above it is driven. An area is the work of the forces; on it stands what the phase gives in all, with the impacts, the number of `phases.csv`. The table has both parts. They are worked out twice: from contact forces and jumps here, from the energy balance of each phase there. Where nothing keeps time, as under a calendar's driven finger, the torque that keeps each driven body in its motion, with its work between impacts.
forces | --kind forces | Forces | Normal and friction forces between the bodies of each pair, summed over their contacts, and the loads of the bearings. Impacts have impulses, not forces, and are not shown.
wear | --kind wear | Wear | Archard's index, load times sliding distance, for each millimetre of the true outline and extrapolated to a year, of the places that wear most; of the teeth, the most worn one. A corner has no length: it is a ring, with its sum below. The sums are those of `ws.wear(run)`; the page of a run shows the picture of its last beats.
portrait | --kind phase-portrait | Phase portrait | Velocity over angle of one oscillation, phases in colour.
energy | --kind energy | Energy | What was put in over the whole run, and where it went; below, each phase of the last two beats. The black line is the work of the drive; where bars reach beyond it stores gave the rest, to the left of zero.
sound | --kind sound | Sound | What a microphone would hear of the last two beats, each noise named by what met what. 1 is the loudest; the tones of the case are typical, not computed.
timing | --kind timing | Amplitude, rate and beat error | Of every half swing of whatever swings, heard or not.
tape | --kind tape | Paper of a timegrapher | As an instrument that hears the first noise of each beat would write it.
"""  # name, options, title, words
PLOTS = tuple(
    Exhibit(f"{name}.png", title, words, f"watchsim plot swiss {how} -o {name}.png", "")
    for name, how, title, words in (line.split(" | ") for line in PLOTTED.splitlines())
)
HEAD = f"""# Plots

`watchsim plot RUN --kind NAME` draws what is shown here, several kinds with commas, `--kind all` every one that the run has. Files are PNG,
SVG or PDF (`--format svg,pdf`, or the ending of `-o`). In Python each is a function that returns a matplotlib figure:
`ws.plot_kinematics`, `plot_phases`, `plot_timeline`, `plot_torque`, `plot_forces`, `plot_phase_portrait`, `plot_energy`, `plot_sound`, `plot_timing`, `plot_tape`, `plot_wear`; of studies
`plot_sweep` and `plot_sensitivity` ([studies](studies.md)). A notebook shows a figure that stands on the last line of a cell.
`ax=` puts a plot in the place of some axes of a figure of yours (`plt.subplots(1, 2, figsize=(14, 6))`), laid out as for its `width`; what is returned is
then that part of your figure.

A figure is as wide as it will be printed: 170 mm for a page, `--width "85 mm"` (`width=85`) for a column, letters of 6 pt or more in both. Colours can
be distinguished with every kind of colour vision, and no colour stands alone: names, dashes, marks or hatching go with it. `--dark` (`watchsim.render.palette.dark`) gives any of them dark ground. The same style draws all pictures
of these pages (`watchsim.render.style`). `scripts/draw_pictures.py plots` makes this page from

```
{RUN}
```
"""


def plots_page() -> str:
    parts = [HEAD]
    for one in PLOTS:
        words = f"## {one.title}\n\n{one.words}\n\n```\n{one.command}\n```\n"
        parts.append(f"{words}\n![{one.title}](../images/plots/{one.picture})\n")
    return "\n".join(parts)


# Single pictures of other pages, by commands.
COAXIAL = 'watchsim run profiles/coaxial --duration "180.2 s" --no-plots -o coaxial'
SINGLE = tuple(  # by command, and what is run before
    Exhibit(picture, "", "", f"{command} {picture}", also)
    for picture, command, also in (
        (
            "swiss_lever_beat.png",
            'watchsim plot beats --window "0.62 s:1.02 s" -o',
            'watchsim run profiles/swiss_lever --duration "1.2 s" --no-plots -o beats',
        ),
        (
            "tape_eccentric.png",
            "watchsim plot eccentric --kind tape -o",
            'watchsim run profiles/swiss_lever --duration "60 s" --no-plots --set \'bodies.wheel.adjust.TEETH.shift=["-5 µm","0 µm"]\' -o eccentric',
        ),
        ("card.png", "watchsim card shared -o", 'watchsim run profiles/swiss_lever --duration "20 s" --no-plots -o shared'),
        ("coaxial_function.png", "watchsim check profiles/coaxial --sheet", ""),
        ("coaxial_turn.png", "watchsim check profiles/coaxial --turn --png", ""),
        ("coaxial_phases.png", "watchsim plot coaxial --kind phases -o", COAXIAL),
    )
)
TOLERANCE_DPI = 160


def tolerances(name: str, path: Path) -> None:
    """A study of docs/guide/tolerances.md: 256 watches; what results/ holds is gone on with."""
    scene = ROOT / "docs" / "guide" / "tolerances" / f"{name}.toml"
    study = ws.tolerance(scene, 256, workers=2, folder=ROOT / "results" / f"tolerances_{name}", resume=True)
    ws.plot_tolerance(study).savefig(path, dpi=TOLERANCE_DPI)


def positions(path: Path) -> None:
    """The dials of docs/guide/positions.md."""
    found = ws.positions(ROOT / "docs" / "guide" / "positions" / "swiss_lever.toml", workers=2)
    ws.plot_positions(found).savefig(path, dpi=TOLERANCE_DPI)


def shock(path: Path) -> None:
    """The map of docs/guide/shock.md."""
    scene = ws.load(ROOT / "profiles" / "swiss_lever")
    scene = scene.set("bodies.lever.mass", "8 mg").set("bodies.lever.centre_of_mass", ["0 mm", "0.3 mm"])
    ws.plot_shock_map(ws.shock_map(scene)).savefig(path, dpi=TOLERANCE_DPI)


DESIGNED = '[design]\nof = "swiss_lever"\nlock = "1.5°"\n\n[run]\nduration = "60 s"\n'
OPEN_MS = 60_000.0  # ms; a busy machine


def live(path: Path) -> None:
    """The page of docs/guide/live.md after a save with a deeper lock, its exit stone close by."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as started:
        scene = Path(folder) / "scene.toml"
        scene.write_text(DESIGNED, encoding="utf-8")
        words = [sys.executable, "-m", "watchsim", "live", str(scene), "--no-browser"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as server:
            assert server.stdout
            browser = started.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1360, "height": 880})
            page.goto(server.stdout.readline().strip())
            for shown, text in ((1, DESIGNED), (2, DESIGNED.replace("1.5°", "2.4°"))):
                scene.write_text(text, encoding="utf-8")
                page.locator("#sheet > section.words").wait_for(timeout=OPEN_MS)
                while page.evaluate("watchsim.live().shown") < shown:
                    page.wait_for_timeout(50)
                if shown == 1:
                    at = next(one["at"] for one in page.evaluate("watchsim.names()") if one["text"] == "exit stone")
                    stage = page.evaluate("document.getElementById('stage').getBoundingClientRect().toJSON()")
                    page.mouse.move(at[0] + stage["x"], at[1] + stage["y"])
                    page.mouse.wheel(0, -900)
            page.wait_for_timeout(3000)
            page.screenshot(path=path)
            browser.close()
            server.terminate()


def exhibits(shown: Iterable[Exhibit], folder: str, first: str = "") -> dict[str, Make]:
    shop = Shop(first)
    return {f"{folder}{one.picture}": partial(shop.exhibit, one) for one in shown}


def groups() -> dict[str, dict[str, Make]]:
    """Group -> picture, by its path in docs/images -> what writes it to a path."""
    return {
        "theory": dict(THEORY),
        "mechanisms": {f"{name}.png": partial(mechanism, name) for name in MECHANISMS},
        "movies": {f"movies/{name}.gif": partial(film, name) for name in MECHANISMS},
        "pages": exhibits(SINGLE, ""),
        "gallery": exhibits(EXHIBITS, "gallery/"),
        "plots": exhibits(PLOTS, "plots/", RUN),
        "positions": {"positions.png": positions},
        "shock": {"shock.png": shock},
        "live": {"live.png": live},
        "tolerances": {f"tolerances_{name}.png": partial(tolerances, name) for name in ("coaxial", "swiss_lever")},
    }


# Pictures of measurements: the script that measures and draws.
MEASURED = {
    "complexity.png": "scripts/reports/speed.py",
    "convergence.png": "scripts/reports/convergence.py",
    "long_runs.png": "scripts/reports/long_runs.py",
    "reading_speed.png": "scripts/reports/speed.py",
    "speed.png": "scripts/reports/speed.py",
    "stability_grid.png": "scripts/reports/stability.py",
    "stability_margins.png": "scripts/reports/stability.py",
}
# Kept as they are, their labels checked by eye: studies of many hours, with the numbers of their pages; a solid as another program
# renders it.
KEPT = {
    "balance_solids.png",
    *(f"coaxial_{name}.png" for name in ("best", "direct", "friction", "indirect", "isochronism", "range", "twin")),
    *(f"swiss_study_{name}.png" for name in ("best", "friction", "isochronism", "period", "run_down", "sensitivity")),
    *(f"swiss_study_{name}.png" for name in ("temperature", "torque")),
}


@contextlib.contextmanager
def heard() -> Iterator[set[str]]:
    """The words of all figures that are drawn meanwhile."""
    found: set[str] = set()
    draw = Figure.draw

    def listening(self: Figure, renderer: Any) -> None:
        draw(self, renderer)
        for text in self.findobj(Text):
            if text.get_visible() and "$" not in text.get_text():
                found.update(re.findall(r"[^\W\d_]{3,}", text.get_text()))

    Figure.draw = listening  # type: ignore[method-assign, assignment]
    try:
        yield found
    finally:
        Figure.draw = draw  # type: ignore[method-assign]


def drawn(wanted: Mapping[str, Make], images: Path) -> dict[str, list[str]]:
    """Draw those pictures below `images`, and give the words of each."""
    words = {}
    for name, make in wanted.items():
        path = images / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with heard() as found:
            make(path)
        if path.stat().st_size > LARGEST:
            raise SystemExit(f"{name}: {path.stat().st_size / 1e6:.1f} MB are too many")
        words[name] = sorted(found)
    return words


def shrink(path: Path) -> None:
    """A palette of 256 colours where no pixel changes by more than can be seen (24 of 255, 0.3 on average)."""
    with Image.open(path) as picture:
        if path.suffix != ".png" or picture.mode == "P":
            return
        rgb = picture.convert("RGB")
    small = rgb.quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    off = np.abs(np.asarray(rgb, int) - np.asarray(small.convert("RGB"), int))
    if off.max() <= 24 and off.mean() <= 0.3:
        small.save(path, optimize=True)


def main(name: str) -> None:
    known = groups()
    every = {picture: make for group in known.values() for picture, make in group.items()}
    wanted = every if name == "all" else known.get(name) or ({name: every[name]} if name in every else {})
    if not wanted:
        raise SystemExit(f"{name}: all, one of {', '.join(known)}, or a picture such as {next(iter(every))}")
    for picture, make in wanted.items():
        words = drawn({picture: make}, IMAGES)
        shrink(IMAGES / picture)
        kept = json.loads(WORDS.read_text(encoding="utf-8")) if WORDS.exists() else {}
        WORDS.write_text(
            json.dumps(dict(sorted({**kept, **words}.items())), ensure_ascii=False, indent=0) + "\n", encoding="utf-8"
        )
        print(picture, flush=True)
    GALLERY_PAGE.write_text(gallery_page(), encoding="utf-8")
    PLOTS_PAGE.write_text(plots_page(), encoding="utf-8")


if __name__ == "__main__":
    from usage import arguments

    main(arguments(__doc__, name=(..., "all, a group, or a picture by its path in docs/images")).name)
