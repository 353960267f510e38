"""How does a simulation run from Python, whatever the stepping?

The compiled loop is called slice by slice; unknown cells, full buffers, progress and interrupts are dealt with between
slices. What is handed back stands in `frozen_run`.
"""

from __future__ import annotations

import dataclasses
import functools
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim import stopping
from watchsim.contact.broad_phase import load_shapely
from watchsim.contact.cells import CellFinder
from watchsim.dynamics.forces import stored_energy
from watchsim.mechanism.compile import Compiled
from watchsim.model import words_of
from watchsim.scene.roles import frequency
from watchsim.scene.scene import WHOLE_RUN, Recording, Scene, Window
from watchsim.simulation import EVENT_DRIVEN
from watchsim.simulation.event_loop import EVENTS_PER_CONTACT, ROWS_PER_STEP, advance
from watchsim.simulation.foregone import Foregone
from watchsim.simulation.options import Options, options_of
from watchsim.simulation.overlap_watch import OverlapWatch
from watchsim.simulation.overlap_watch import warm_up as warm_up_watch
from watchsim.simulation.recording import Recorder, columns_of, pairs_of, tail_length
from watchsim.simulation.run_end import (
    Crowd,
    accelerating,
    driven_into,
    failure_of,
    furthest,
    ledger,
    ledger_fails,
    turned_over,
    unaccounted,
    unexplained,
    usual_energy,
    what_alternates,
)
from watchsim.simulation.saved_state import SavedState, save_state
from watchsim.simulation.scratch import Until, new_record, new_scratch, new_until
from watchsim.simulation.start import clear_start
from watchsim.simulation.start import warm_up as warm_up_start
from watchsim.simulation.state import COUNT_NAMES, EVENT_DTYPE, State, Stop, arrays_of, new_state, room_for
from watchsim.simulation.tally import Tally
from watchsim.simulation.trajectory import Trajectory, events_of_scene, rows_of_scene
from watchsim.tolerances import FIRST_STEP

# How long may the loop go on before Python looks at clock, progress and interrupts again?
#
# A slice ends after a simulated time or a number of steps, whichever comes first: where events crowd, time is no measure of
# work. How slices end changes no bit of a run.

SLICE_WALL = 0.1  # s between looks at the clock
FEWEST_STEPS, MORE_STEPS, MOST_STEPS = 64.0, 4.0, 4000.0  # of a slice; steps may become much slower from one to the next


class Pace:
    """The length of the next slice, from how long the last one took."""

    def __init__(self, duration: float, wall: float = SLICE_WALL) -> None:
        self.duration, self.wall = duration, wall
        self.length = 1e-2 * duration  # s, simulated; grows tenfold at most: a long slice would be deaf
        self.steps = FEWEST_STEPS
        self.start = self.begun = 0.0

    def begin(self, now: float, until: Until, look: float) -> None:
        """Set in `until` where the slice from `now` ends, at the latest at `look` (s)."""
        self.start, self.begun = time.perf_counter(), now
        until.slice_end = min(self.duration, now + self.length, look)
        until.steps = self.steps

    def end(self, now: float, until: Until) -> None:
        """Learn from the slice that came to its end."""
        pace = self.wall / max(time.perf_counter() - self.start, 1e-4)
        if until.steps > 0.0:
            self.length = min(max((now - self.begun) * pace, 1e-9 * self.duration), 10.0 * self.length)
        self.steps = min(max(pace * (self.steps - until.steps), 1.0), MORE_STEPS * self.steps, MOST_STEPS)


# How does Ctrl-C end a run between two slices, and never in the middle of keeping what it has made?

_USUAL = signal.default_int_handler


@contextmanager
def held_interrupts() -> Iterator[Callable[[], bool]]:
    """Within, the first Ctrl-C is only remembered: the function handed out says whether it came. A second one raises.

    In a process of the command line SIGTERM is heard alike (see stopping.py). Where somebody else listens to the signal, or
    outside the main thread, everything stays as it is.
    """
    if stopping.installed():
        with stopping.held() as requested:
            yield lambda: requested() != 0
        return
    came = threading.Event()
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGINT) is not _USUAL:
        yield came.is_set
        return

    def remember(number: int, frame: FrameType | None) -> None:
        if came.is_set():
            _USUAL(number, frame)
        came.set()

    signal.signal(signal.SIGINT, remember)
    try:
        yield came.is_set
    finally:
        signal.signal(signal.SIGINT, _USUAL)


# What is handed back of a run when it ends, and what is said of its end?


def trajectory_of(run: Run, stop: Stop, wall: float, compile_time: float) -> Trajectory:
    """Everything kept of a run that ended with `stop`, as a frozen value; `wall` and `compile_time` in seconds."""
    compiled, state = run.compiled, run.state
    time = float(state.clock.time)
    nothing = columns_of(np.zeros((0, 1 + 3 * len(state.q)))), np.zeros(0, EVENT_DTYPE)
    (t, q, u, a), events = run.kept.closed(time) or nothing
    return Trajectory(
        scene=run.scene,
        t=t,
        q=q,
        u=u,
        a=a,
        slices=compiled.slices,
        events=events,
        pairs=run.pairs,
        stop=stop,
        stop_message=f"t = {time:.9g} s: {_words(run.failing, stop)}",
        simulated=time,
        wall=wall,
        compile=compile_time,
        method=run.method,
        tolerance=run.tolerance,
        worst_penetration=float(state.worst.penetration),
        worst_residual=float(run.worst_residual()[0]),
        overlap=run.watch.result(float(state.worst.penetration)),
        energy=run.energy(),
        counts=run.counts(),
        step=run.step,
        end_q=compiled.relative(state.q[None])[0].copy(),
        end_u=compiled.relative(state.u[None], rates=True)[0].copy(),
        keep=run.kept.recording.keep,
        spans=run.kept.spans(time),
        sums=run.tally.finished(),
        end_state=_end_state(run),
        failure=run.failing.failure() if stop == Stop.LCP_FAILED else None,
    )


def _end_state(run: Run) -> SavedState | None:
    """The state to go on from, with how many of the rows and events that were kept belong to it."""
    if run.saved is None:
        return None
    time = float(run.state.clock.time)
    rows, events = run.kept.counts(time, run.parts_before)
    recorded = {**run.saved.recorded, "stays": run.kept.for_good(time, run.parts_before)}
    return dataclasses.replace(run.saved, rows=rows, events=events, recorded=recorded)


def _words(run: Run, stop: Stop) -> str:
    """The cause and what is known of where and why; where a driven body jams another, that is the cause."""
    driven = {body.name for body in run.scene.bodies if body.prescribed is not None}
    if stop == Stop.LCP_FAILED:
        failed = run.failure()["contacts"] if driven else ()
        return driven_into((one["number"] for one in failed), run.pairs, driven) or stop.sentence
    model, bodies = run.compiled.model, [body.name for body in run.scene.bodies]
    details: dict[Stop, Callable[[], str]] = {
        Stop.OVERLAP: run.watch.words,
        Stop.FOREGONE: lambda: run.foregone.words if run.foregone else "",
        Stop.LEDGER: lambda: unaccounted(run.energy()),
        Stop.UNEXPLAINED: lambda: unexplained(run.state, run.pairs),
        Stop.TOO_MANY_EVENTS: run._what_alternates,
        Stop.STEP_TOO_SMALL: lambda: accelerating(run.state, model, bodies, run.pairs),
        Stop.BLOCKED: lambda: driven_into([int(run.state.instant.touched)], run.pairs, driven),
        Stop.FAR_AWAY: lambda: furthest(run.state, model, bodies),
    }
    words = details[stop]() if stop in details else ""
    return f"{stop.sentence}: {words}" if words else stop.sentence


Progress = Callable[[float, float], None]  # simulated time, duration

ROWS, EVENTS = 20000, 20000

_warm: set[type[Run]] = set()  # ways of stepping whose kernels are loaded


def load_for(compiled: Compiled) -> None:
    """Load what a run needs before it can be made: once in a process, 40 ms that say nothing about the scene."""
    if len(compiled.model.contacts):
        load_shapely()
    stored_energy(compiled.model, compiled.q, compiled.u)


def widened(windows: Sequence[Window], options: Options, steps: float = 1.0) -> NDArray[np.float64]:
    """(k, 2): windows wider by so many steps on both sides, for the rows next to them."""
    ends = np.array(windows, float).reshape(-1, 2)
    return ends + steps * np.maximum(options.max_step, np.minimum(ends, options.natural)) * np.array([-1.0, 1.0])


class Run:
    """A run under way: the loop's arrays and what has been kept. By events; see `moreau.MoreauRun` for fixed steps.

    How far a run is to go must not change a bit of it: steps and looks follow from the scene and the time reached.
    """

    method = EVENT_DRIVEN
    step: float | None = None  # s, where steps are fixed
    slice_wall = SLICE_WALL

    def __init__(self, scene: Scene, compiled: Compiled, tolerance: float, recording: Recording) -> None:
        model = compiled.model
        self.scene, self.compiled, self.tolerance = scene, compiled, tolerance
        self.options: Options = options_of(scene, compiled, tolerance)
        self.state: State = new_state(model, compiled.q, compiled.u)
        self.state.clock.step = FIRST_STEP * self.options.max_step
        self.finder = CellFinder(compiled.seen or model)
        self.scratch = new_scratch(model)
        self.pairs = pairs_of(compiled)
        forms = functools.partial(rows_of_scene, compiled), functools.partial(events_of_scene, compiled)
        self.kept = Recorder(recording, tail_length(frequency(scene)), *forms)
        self.tally = Tally(scene, self.pairs, compiled.slices, *forms)
        self.tally.waits = self.kept.windows == WHOLE_RUN
        windows = widened(self.kept.windows, self.options)
        self.record = new_record(model, ROWS + ROWS_PER_STEP, EVENTS + EVENTS_PER_CONTACT * room_for(model), windows)
        self.watch = OverlapWatch(scene, compiled, self.method, self.kept.windows)
        self.stored_at_start = stored_energy(model, self.state.q, self.state.u)
        self._usual_energy, self._turned_over = usual_energy(model), turned_over(model)
        self.crowd = Crowd(compiled.unit)
        self.foregone: Foregone | None = None  # looks for what ends the run early
        self.saved: SavedState | None = None
        self.parts_before = 0  # what was flushed before the state was saved

    @property
    def failing(self) -> Run:
        """The run to ask about why it ended."""
        return self

    def begin(self) -> None:
        """Begin at the scene's start; SceneError where bodies overlap there (see `start.clear_start`)."""
        q, taken_back = clear_start(self.scene, self.compiled, self.finder, self.options)
        if taken_back > 0.0:
            self.state.q[:], self.state.worst.penetration = q, taken_back
            self.stored_at_start = stored_energy(self.compiled.model, q, self.state.u)

    def begin_from(self, saved: SavedState) -> None:
        """Take up a saved state; ValueError where it is not one of this model with these settings."""
        saved.check(self.compiled, self.settings())
        saved.restore(self.arrays())
        self.stored_at_start = saved.stored_at_start
        self.tally.restore(saved.tally)
        self.kept.go_on(saved.recorded)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything the future depends on, besides the model and the settings."""
        return {**arrays_of(self.state)._asdict(), "worst_residual": self.worst_residual(), "overlap": self.watch.numbers}

    def worst_residual(self) -> NDArray[np.float64]:
        """(1,): the worst violation of a complementarity condition so far."""
        return words_of(self.scratch.work.problem.lcp.worst, float)

    def settings(self) -> dict[str, Any]:
        """What must be the same when a saved state is taken up; the natural step follows from the model."""
        return {
            "method": self.method,
            **{name: float(value) for name, value in self.options._asdict().items() if name != "natural"},
        }

    def save(self) -> SavedState:
        """The state now, with the sums over all events so far."""
        self.flush()
        self.parts_before = self.kept.parts
        state = save_state(self.compiled, self.settings(), self.arrays(), self.stored_at_start, self.tally.arrays())
        self.watch.fill_in_later(state.arrays["overlap"])
        return dataclasses.replace(state, recorded=self.kept.unfinished())

    def flush(self) -> None:
        """Empty the buffers: count the events, keep what the recording wants."""
        rows, events = self.record.used.rows, self.record.used.events
        if rows == 0 and events == 0:
            return
        self.tally.fold(self.record.events[:events], self.record.rows[:rows])
        self.watch.see_rows(self.record.rows[:rows])
        self.kept.flush(self.record.rows[:rows], self.record.events[:events])
        self.record.used.rows, self.record.used.events = 0, 0

    def warm_up(self) -> None:
        """Load or compile the kernels, once in a process: a call that returns at once because it has no room to record."""
        if type(self) not in _warm:
            nowhere = new_record(self.compiled.model, 0, 0, self.record.windows)
            self._advance(new_until(), nowhere)
            self.finder.warm_up()
            _warm.add(type(self))
        warm_up_start(self.scene, self.compiled.model)
        if self.scene.contacts:
            warm_up_watch()

    def _advance(self, until: Until, record: Any) -> Stop:
        code = advance(self.compiled.model, self.finder.cells, self.state, self.options, until, self.scratch, record)
        return Stop(int(code))

    def _learn(self) -> None:
        """Look up the cell that the loop has met."""
        self.finder.learn(int(self.scratch.requested.cell.pair), self.scratch.requested.at.copy(), self.state.u)

    def to_the_end(self, duration: float, progress: Progress | None) -> Stop:
        """Run until the duration is over or something ends the run for good."""
        try:
            with held_interrupts() as interrupted:
                stop = self._slices(duration, progress, interrupted)
        except KeyboardInterrupt:
            stop = Stop.INTERRUPTED
        except OverflowError:  # so far away that no cell has a number
            stop = Stop.FAR_AWAY
        except MemoryError:
            stop = Stop.OUT_OF_MEMORY
        if self.saved is None:
            self.saved = self.save()
        self._come_together()
        self.flush()
        self._look()
        self.watch.see()
        if stop not in (Stop.DURATION, Stop.INTERRUPTED, Stop.FOREGONE):
            return stop
        if self._overlaps():
            return Stop.OVERLAP
        return Stop.LEDGER if self._ledger_fails() else stop

    def _come_together(self) -> None:
        """Bring what runs side by side to one time at the end."""

    def _ledger_fails(self) -> bool:
        """Is the residual of the energy ledger more than rounding?"""
        held = max(float(self.state.worst.kinetic_energy), self.stored_at_start, self._usual_energy)
        return ledger_fails(self.energy(), held, self.tolerance)

    def _look(self) -> None:
        """Look, soon, at the state now for bodies inside each other."""
        self.watch.see_state(float(self.state.clock.time), self.state.q.copy())

    def _overlaps(self) -> bool:
        return self.watch.fails(float(self.state.worst.penetration))

    def _slices(self, duration: float, progress: Progress | None, interrupted: Callable[[], bool]) -> Stop:
        """Slice after slice, with what has to be done between them."""
        pace = Pace(duration, self.slice_wall)
        until = new_until(0.0, duration)
        look = self.watch.next_look(float(self.state.clock.time))
        while True:
            pace.begin(float(self.state.clock.time), until, min(look, self.foregone.next if self.foregone else look))
            stop = self._advance(until, self.record)
            if stop == Stop.CELL_UNKNOWN:
                self._learn()
                if interrupted():
                    return Stop.INTERRUPTED
                continue
            if stop == Stop.BUFFER_FULL:
                self.flush()
            elif stop == Stop.LAST_STEP:
                # The next step is cut short by the end. Who goes on later must go on from here, to take it whole.
                self.saved, until.may_cut = self.save(), 1
            elif stop != Stop.SLICE:
                return stop
            else:
                pace.end(float(self.state.clock.time), until)
            if self.state.clock.time >= look:
                self._look()
                look = self.watch.next_look(float(self.state.clock.time))
            if self._ledger_fails():
                return Stop.LEDGER
            if self._overlaps():
                return Stop.OVERLAP
            if self._is_foregone():
                return Stop.FOREGONE
            if progress is not None:
                crowded, words = getattr(progress, "crowded", None), self._crowding()
                if crowded is not None:
                    crowded(words)
                progress(float(self.state.clock.time), duration)
            if interrupted():
                return Stop.INTERRUPTED

    def _crowding(self) -> str:
        """Which events crowd, in words; "" where none do."""
        self.crowd.look(float(self.state.clock.time), int(self.state.counts.instants))
        return self.crowd.words(self._what_alternates())

    def _what_alternates(self) -> str:
        bodies = [self.scene.bodies[k].name for k in self.compiled.model.coordinates.body]
        return what_alternates(self.scratch.ended, self.pairs, bodies)

    def _is_foregone(self) -> bool:
        time = float(self.state.clock.time)
        if self.foregone is None or time < self.foregone.next:
            return False
        return self.foregone.look(time, self.state.q, self._last_passage)

    def _last_passage(self) -> float:
        """When the oscillator last passed its rest position, s."""
        self.flush()
        return float(self.tally.last[0])

    def failure(self) -> dict[str, Any]:
        """What is known of the problem that nothing solved."""
        return failure_of(self.state, self.scratch, self.pairs)

    def counts(self) -> dict[str, int]:
        """How much work was done: the names of COUNT_NAMES and of the cells."""
        counts = {name: int(value) for name, value in zip(COUNT_NAMES, words_of(self.state.counts, int), strict=True)}
        counts["cells"] = self.finder.number
        counts["cells_asked"] = self.finder.learned
        counts["declared_pairs"] = len(self.compiled.model.contacts)
        return counts

    def _dissipated(self) -> dict[str, float]:
        sums = self.state.sums
        return {"friction": float(sums.friction), "damping": float(sums.damping), "impacts": float(sums.impacts)}

    def energy(self) -> dict[str, Any]:
        """The ledger: work in = stored + dissipated + residual, J."""
        at_end = stored_energy(self.compiled.model, self.state.q, self.state.u)
        return ledger(float(self.state.sums.drive), self._dissipated(), (self.stored_at_start, at_end), self._turned_over)
