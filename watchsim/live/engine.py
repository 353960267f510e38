"""Who computes what a saved scene does, so that nothing is loaded or compiled at a save, and an older answer is given up?

A process of its own loads the kernels and answers for the scene once. Each order is then answered by a copy of it (fork), which
knows all that is loaded and is simply ended when the next order comes: whatever a scene does to the solver, the engine stays as
it was. Where there is no fork that is safe, the engine answers itself, one order after the other.
"""

from __future__ import annotations

import base64
import contextlib
import gc
import io
import multiprocessing
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.live.edit import knobs, values
from watchsim.scene.errors import SceneError
from watchsim.scene.keys import DESIGN, in_words
from watchsim.scene.load import load_set
from watchsim.scene.scene import Scene

if TYPE_CHECKING:
    from watchsim.drawing.drawing import Drawing
    from watchsim.simulation.trajectory import Trajectory
    from watchsim.studies.compare import Comparison, Side

FORKS = hasattr(os, "fork") and sys.platform != "darwin"  # the system libraries of macOS do not survive one
PACE = 0.25  # s between two reports of how far a run has come
GRACE = 2.0  # s that a process may take to end
SHOWN = 2e-4  # of a value: digits beyond that help nobody who draws
DPI = 110  # of the picture of a drawing with faults


@dataclass(frozen=True)
class Order:
    """What is to be answered: the scene of that file as it stands there now.

    number  each order has one; answers carry it
    hold    compare with the same result as before, not with the latest one
    """

    number: int
    path: Path
    hold: bool


@dataclass(frozen=True)
class Answer:
    """One of the things that come of an order.

    kind   "scene" (it was read), "faults", "numbers", "progress", "motion", "sheet" (the last), "lost" (the process was)
    value  what the page gets; of "motion" the data of the player and what stands around it
    side   with "motion": what later results are compared with
    """

    number: int
    kind: str
    value: dict[str, Any]
    side: Side | None = None


Send = Callable[[Answer], None]


class Engine:
    """The process, which begins with the first order, and a thread that hands its answers to `heard`; `close` ends both."""

    def __init__(self, first: Order, heard: Callable[[Answer], object]) -> None:
        spawn = multiprocessing.get_context("spawn")
        self._orders, theirs = spawn.Pipe()
        self._process = spawn.Process(target=serve, args=(theirs, first), name="engine")
        self._process.start()
        theirs.close()
        self._thread = threading.Thread(target=self._listen, args=(heard,), daemon=True, name="answers")
        self._thread.start()

    def order(self, order: Order) -> None:
        """Answer this, and give up what is under way."""
        with contextlib.suppress(OSError):  # a lost engine is reported by the thread
            self._orders.send(order)

    def close(self) -> None:
        self._process.kill()
        self._process.join()
        self._orders.close()

    def _listen(self, heard: Callable[[Answer], object]) -> None:
        with contextlib.suppress(OSError, EOFError, TypeError):  # TypeError: closed meanwhile
            while True:
                heard(self._orders.recv())
        heard(Answer(0, "lost", {}))


def serve(orders: Connection, first: Order) -> None:
    """The engine's process: orders in, answers out, until whoever started it has gone."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # for the process that started it, which closes the pipe
    with contextlib.suppress(EOFError, OSError):
        _Server(orders).serve(first)


class _Server:
    """One job at a time; `latest` is the result of the last order that was answered to the end."""

    def __init__(self, orders: Connection) -> None:
        self.orders = orders
        self.reference: Side | None = None
        self.latest: Side | None = None
        self.job: Job | None = None
        self.warm = False

    def serve(self, first: Order) -> None:
        self._warm_up(first, self._pass_on)
        try:
            while True:
                for ready in wait([self.orders, *([self.job.answers] if self.job else [])]):
                    if ready is self.orders:
                        self._begin(self.orders.recv())
                    elif self.job and ready is self.job.answers:
                        self._hear(self.job)
        finally:
            if self.job:
                self.job.end()

    def _warm_up(self, order: Order, send: Send) -> None:
        """All that is loaded here is not loaded again by the copies."""
        _answers(order, None, send)
        self.warm = self.latest is not None
        gc.collect()
        gc.freeze()  # no copy looks through it

    def _begin(self, order: Order) -> None:
        if self.job:
            self.job.end()
        if not (order.hold and self.reference):
            self.reference = self.latest
        self.job = Job(order, self.reference)

    def _hear(self, job: Job) -> None:
        try:
            self._pass_on(job.answers.recv())
        except (EOFError, OSError):
            lost, self.job = job.lost(), None
            job.end()
            if lost:
                self.orders.send(Answer(job.order.number, "lost", {}))
            elif not self.warm and self.latest:
                self._warm_up(job.order, lambda _: None)

    def _pass_on(self, answer: Answer) -> None:
        self.latest = answer.side or self.latest
        self.orders.send(replace(answer, side=None))


class Job:
    """A copy of this process that answers an order; where there is none, a thread."""

    def __init__(self, order: Order, reference: Side | None) -> None:
        self.order = order
        self.answers, theirs = multiprocessing.Pipe(duplex=False)
        self._process: Any = multiprocessing.get_context("fork").Process if FORKS else threading.Thread
        self._process = self._process(target=_work, args=(order, reference, theirs))
        self._process.start()
        if FORKS:
            theirs.close()

    def lost(self) -> bool:
        """True where it came to an end, but not to its own; to be asked when no answer comes any more."""
        self._process.join(GRACE)
        return getattr(self._process, "exitcode", 0) not in (0, None)

    def end(self) -> None:
        """End it now."""
        if FORKS:
            self._process.kill()
        self._process.join()
        self.answers.close()


def _work(order: Order, reference: Side | None, theirs: Connection) -> None:
    if FORKS:
        threading.Thread(target=_end_with_parent, daemon=True).start()
    with contextlib.suppress(OSError), theirs:
        _answers(order, reference, theirs.send)


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


# What is answered?


def _answers(order: Order, reference: Side | None, send: Send) -> None:
    begun = time.perf_counter()
    give = partial(_give, send, order.number, begun)
    try:
        scene = _sound_scene(order.path)
        give("scene", title=scene.title, knobs=knobs(scene), values=values(scene))
        run, side = _numbers(scene, give)
        give("numbers", **_compared(reference, side))
        run = run or _run(scene, give)
        give("motion", side=replace(side, run=None), **_motion(run))
        give("sheet", **_sheet(run))
    except SceneError as error:
        faults = [str(fault) for fault in error.faults]
        give("faults", faults=faults, drawings=[])
        if pictures := _pictures(order.path, error):
            give("faults", faults=faults, drawings=pictures)
    except (ValueError, MemoryError, OSError) as error:
        give("faults", faults=[str(error) or type(error).__name__], drawings=[])


def _give(send: Send, number: int, begun: float, kind: str, side: Side | None = None, **value: Any) -> None:
    send(Answer(number, kind, {**value, "seconds": round(time.perf_counter() - begun, 3)}, side))


def _sound_scene(path: Path) -> Scene:
    """The scene, if `watchsim run` would begin with it."""
    from watchsim.analysis.expectation_faults import expectation_faults
    from watchsim.mechanism.overlap import overlap_faults

    scene = load_set(path, {})
    if faults := [*overlap_faults(scene), *expectation_faults(scene)]:
        raise SceneError(faults)
    return scene


def _numbers(scene: Scene, give: Callable[..., None]) -> tuple[Trajectory | None, Side]:
    """What the scene does, as `watchsim compare` has it; with the run where it took one."""
    from watchsim.escapement.measure import with_lift
    from watchsim.scene.roles import is_driven, keeps_time
    from watchsim.studies.compare import side_of

    if keeps_time(with_lift(scene)) and is_driven(scene):
        with contextlib.suppress(SceneError):  # nothing swings on: a run says what happens instead
            return None, side_of(scene)
    run = _run(scene, give)
    return run, side_of(run)


def _run(scene: Scene, give: Callable[..., None]) -> Trajectory:
    from watchsim.escapement.measure import with_measured_lift
    from watchsim.simulation.simulate import simulate

    said = time.perf_counter()

    def progress(done: float, whole: float) -> None:
        nonlocal said
        if time.perf_counter() - said > PACE:
            said = time.perf_counter()
            give("progress", done=done, whole=whole)

    return with_measured_lift(simulate(scene, progress=progress, to_the_end=False))


def _compared(reference: Side | None, side: Side) -> dict[str, Any]:
    """Rows to read; without a reference the result stands alone."""
    from watchsim.studies.compare import changed_rows, compare, result_rows

    found: Comparison = compare(reference or side, side)
    changed, design = changed_rows(found), f"{DESIGN}."
    if any(key.startswith(design) for key, *_ in changed):  # the drawings follow from its dimensions
        changed = [row for row in changed if not row[0].endswith(".drawing")]
    changed = [[in_words(key), *values] for key, *values in changed]
    results = result_rows(found, SHOWN)
    return {"first": reference is None, "changed": changed, "results": results, "off": found.off, "message": side.message}


def _motion(run: Trajectory) -> dict[str, Any]:
    from watchsim.pages.report_page import page_parts

    places, data = page_parts(run)
    return {"places": {name: str(places[name]) for name in ("poster", "lead", "made")}, "data": data}


def _sheet(run: Trajectory) -> dict[str, Any]:
    from watchsim.analysis.summary import summary
    from watchsim.pages.timing_sheet import sheet, verdict
    from watchsim.results.tables import plain

    numbers = plain(summary(run))
    return {"verdict": str(verdict(numbers) or ""), "sheet": str(sheet(run, numbers))}


# What does a drawing with faults look like?


def _pictures(path: Path, error: SceneError) -> list[dict[str, Any]]:
    """Of every drawing that a fault names: a picture with its errors in numbered circles, and what each of them is."""
    found = []
    for name, drawing in _faulty(path, error):
        errors = tuple(finding for finding in drawing.findings if finding.severity == "error")
        if errors:
            listed = [[_place(one.x_mm, one.y_mm), f"{one.message.rstrip('.')}. {one.fix}".strip()] for one in errors]
            found.append({"name": name, "picture": _picture(replace(drawing, findings=errors)), "faults": listed})
    with contextlib.suppress(SceneError, ValueError, OSError):
        found += [] if found else _overlapping(load_set(path, {}))
    return found


def _overlapping(scene: Scene) -> list[dict[str, Any]]:
    """The bodies at the start, with rings where they overlap; none where they do not."""
    from watchsim.mechanism.check import modelled_pairs
    from watchsim.mechanism.compile import compile_scene
    from watchsim.mechanism.overlap import overlaps
    from watchsim.render.stage import still

    places = [one.place for one in overlaps(scene)]
    if not places:
        return []
    compiled = compile_scene(scene)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "start.png"
        still(scene, path, compiled, modelled_pairs(compiled, [body.name for body in scene.bodies]), places)
        picture = base64.b64encode(path.read_bytes()).decode("ascii")
    return [{"name": "The start, with a ring at every overlap", "picture": picture, "faults": []}]


def _faulty(path: Path, error: SceneError) -> Iterator[tuple[str, Drawing]]:
    from watchsim.drawing.read import read
    from watchsim.scene.toml import parsed
    from watchsim.units import LENGTH, parse

    with contextlib.suppress(OSError, ValueError):
        folder = path if path.is_dir() else path.parent
        bodies = parsed((folder / "scene.toml" if path.is_dir() else path).read_text(encoding="utf-8-sig"))["bodies"]
        named = dict.fromkeys(fault.key.split(".")[1] for fault in error.faults if fault.key.startswith("bodies."))
        entries = {bodies[name]["drawing"]: bodies[name] for name in named if "drawing" in bodies.get(name, {})}
        for name, entry in entries.items():
            lengths = {key: parse(entry[key], LENGTH) for key in ("snap", "section") if key in entry}
            with contextlib.suppress(OSError, ValueError):
                yield name, read(folder / name, units=entry.get("units"), **lengths)


def _place(x: float | None, y: float | None) -> str:
    return "" if x is None or y is None else f"({x:.3f}, {y:.3f}) mm".replace("-", "−")


def _picture(drawing: Drawing) -> str:
    from watchsim.render.drawing_picture import picture

    out = io.BytesIO()
    picture(drawing).savefig(out, format="png", dpi=DPI)
    return base64.b64encode(out.getvalue()).decode("ascii")
