"""What is drawn in the plots, sheets and frames of short runs and small studies?

Words stand where their widths place them, which another version of matplotlib may take for others.
"""

import contextlib
import functools
import io
import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from records.drawn import lines, noted
from records.run_records import ROUNDING, shaken
from records.wording import without_unsure

import watchsim as ws
from watchsim.cli import main
from watchsim.commands.pictures import KINDS, Request
from watchsim.scene.scene import Scene

PLOTTED = {"swiss_lever": 1.2, "graham": 5.0, "incline": 0.4}  # s
FRAMED = ("coaxial", "tourbillon", "jumper", "geneva", "verge", "governor", "carriage", "remontoir")
SHORT = 0.06  # s
EVERYTHING: dict[str, Any] = {"names": True, "contacts": True, "forces": True, "phases": True, "strip": True}
LOOKS: Mapping[str, dict[str, Any]] = {
    "plain": {},
    "dark with everything": {"dark": True, "insets": ("entry stone",), **EVERYTHING},
    "whole, turned": {"zoom": ("all",), "turn": 0.5, "names": True},
}
SIZE = (960, 540)
GUIDE = Path(__file__).parents[2] / "docs" / "guide"
COMMANDS = {  # each with --png
    **{f"{name}, check": ("check", str(ws.profiles_dir() / name)) for name in ("swiss_lever", "graham", "jumper")},
    "tolerances, check": ("check", str(GUIDE / "tolerances" / "swiss_lever.toml")),
    "swiss_lever, turned by hand": ("check", str(ws.profiles_dir() / "swiss_lever"), "--turn"),
    "lever, inspect": ("inspect", str(ws.profiles_dir() / "swiss_lever" / "lever.dxf"), "--centres"),
    "two faults, inspect": ("inspect", str(Path(__file__).parents[1] / "data" / "two_faults.dxf")),
}
TORQUE = "torques.0.value"


def records() -> dict[str, Callable[[Path], str]]:
    """By name: what is drawn."""
    plots = {f"{name}, {kind}": partial(_plot, name, kind) for name in PLOTTED for kind in KINDS}
    frames = {f"swiss_lever, frame {look}": partial(_frame, "swiss_lever", look) for look in LOOKS}
    frames |= {f"{name}, frame": partial(_frame, name, "plain") for name in FRAMED}
    commands = {name: partial(_command, name) for name in COMMANDS}
    studies = {name: partial(_study, name) for name in STUDIES}
    return {"matplotlib": lambda _, _change=0.0: f"{matplotlib.__version__}\n", **plots, **frames, **commands, **studies}


def kept(name: str, text: str) -> str:
    """A text as it is to be kept: what rounding moves is blotted out."""
    for change in ROUNDING:
        text = without_unsure(text, _again(name, change))
    return text


def _again(name: str, change: float) -> str:
    with tempfile.TemporaryDirectory() as scratch:
        return records()[name](Path(scratch), change)  # type: ignore[call-arg]


@functools.cache
def _scene(name: str, change: float) -> Scene:
    return shaken(ws.load(ws.profiles_dir() / name), change)


@functools.cache
def _run(name: str, change: float) -> ws.Trajectory:
    return ws.simulate(_scene(name, change), duration=PLOTTED.get(name, SHORT), record="all")


def _said(draw: Callable[[], Any]) -> str:
    """What is drawn by something that gives a figure, or draws itself; or why nothing is."""
    with noted() as strokes:
        try:
            figure = draw()
        except ValueError as error:
            return f"{error}\n"
        if isinstance(figure, Figure):
            figure.savefig(io.BytesIO(), format="png", dpi=100)
    return "\n".join(lines(strokes)) + "\n"


def _plot(name: str, kind: str, _: Path, change: float = 0.0) -> str:
    return _said(lambda: Request(_run(name, change), None, ("angle", "velocity"), None, 170.0).figure(kind))


def _frame(name: str, look: str, _: Path, change: float = 0.0) -> str:
    run = _run(name, change)
    return _said(lambda: ws.frame(run, run.t[-1], SIZE, **LOOKS[look]))


def _command(name: str, scratch: Path, change: float = 0.0) -> str:
    with contextlib.redirect_stdout(io.StringIO()):
        return _said(lambda: main([*COMMANDS[name], "--png", str(scratch / f"{change}.png")]))


def _study(name: str, _: Path, change: float = 0.0) -> str:
    return _said(lambda: STUDIES[name](_scene("swiss_lever", change)))


def _compared(scene: Scene) -> Figure:
    sides = (scene, scene.set("torques.0.value", "-0.9 µN·m").set("bodies.balance.velocity", "190 rad/s"))
    return ws.plot_comparison(ws.compare(*(ws.simulate(one, duration=0.9) for one in sides)))


def _toleranced(_: Scene) -> Figure:
    return ws.plot_tolerance(ws.tolerance(GUIDE / "tolerances" / "swiss_lever.toml", 16))


def _in_positions(_: Scene) -> Figure:
    return ws.plot_positions(ws.positions(GUIDE / "positions" / "swiss_lever.toml", ("CH", "3H", "9H")))


def _struck(scene: Scene) -> Figure:
    loaded = scene.set("bodies.balance.mass", "60 mg").set("bodies.balance.centre_of_mass", ["5 µm", "0 µm"])
    return ws.plot_shock_map(ws.shock_map(loaded, directions=3, phases=2, after=0.4))


STUDIES: Mapping[str, Callable[[Scene], Figure]] = {
    "comparison": _compared,
    "sweep": lambda scene: ws.plot_sweep(ws.sweep(scene, {TORQUE: ["-0.9 µN·m", "-1 µN·m", "-1.1 µN·m"]})),
    "sensitivity": lambda scene: ws.plot_sensitivity(ws.sensitivity(scene, [TORQUE, "contacts.0.friction"])),
    "positions": _in_positions,
    "tolerance": _toleranced,
    "shock map": _struck,
}
