"""Do the books of every phase close, and do its times agree with what the events say?"""

import csv
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from analysis.made_beats import lever_run
from escapement.made import one_faced_anchor
from every_time import few

import watchsim as ws
from watchsim.analysis.flows import held_by_lines, line_spring_energies, line_spring_power
from watchsim.analysis.headlines import phases_csv
from watchsim.analysis.timeline import shown_beats, timeline, timeline_text
from watchsim.analysis.timing import beats
from watchsim.cli import main
from watchsim.commands.console import BAD_INPUT, FINE
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.render.energy_plot import pushes
from watchsim.render.phase_plots import plot_phases
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

# Do the books of every phase close, and do its times and angles agree with what the events say?


@pytest.fixture(scope="module")
def swiss() -> Trajectory:
    return simulate(load(profiles_dir() / "swiss_lever" / "scene.toml"), duration=1.4)


def test_energies_of_all_phases_are_the_ledger_of_the_run(bench_lever):
    """From the first phase to the last they follow without a gap; before and after them the balance alone turns freely."""
    run = bench_lever
    told = timeline(run)
    assert all(a.phase.end == b.phase.start for a, b in pairwise(told))
    # What the run lost in impacts and friction, it lost in phases, but for the beat before the first and after the last.
    start, end = told[0].phase.start, told[-1].phase.end
    inside = (run.events["t"] >= start) & (run.events["t"] < end)
    impacts = sum(sum(one.energy.impacts.values()) for one in told)
    assert impacts == pytest.approx(float(run.events["energy_lost"][inside].sum()), rel=1e-12, abs=0.0)
    wheel = run.slices["wheel"].start
    turned = run.sample(np.array([start, end]))[0][:, wheel]
    # Summed up from velocities and accelerations, to the tolerance of the run.
    assert sum(one.energy.supplied for one in told) == pytest.approx(-6e-6 * float(turned[1] - turned[0]), rel=1e-9, abs=0.0)


def test_phases_of_a_run_and_the_rest_of_it_add_up_to_its_ledger(bench_lever):
    """The same run over two durations: the difference of its ledgers is what happened between."""
    run = bench_lever
    told = timeline(run)
    first, last = told[0].phase.start, told[-1].phase.end
    # Just before the impacts with which the first beat begins, and with which the one after the last does.
    early, late = (simulate(run.scene, duration=t - 1e-9) for t in (first, last))
    for cause in ("friction", "damping", "impacts"):
        between = late.energy["dissipated"][cause] - early.energy["dissipated"][cause]
        own = {
            "friction": sum(one.energy.friction for one in told),
            "damping": sum(one.energy.damping for one in told),
            "impacts": sum(sum(one.energy.impacts.values()) for one in told),
        }[cause]
        # The ledgers of the solver close to their residuals.
        close = 1e-9 * late.energy["in_J"] + abs(late.energy["residual_J"]) + abs(early.energy["residual_J"])
        assert own == pytest.approx(between, abs=close)
    stored = sum(one.energy.stored for one in told)
    assert stored == pytest.approx(late.energy["stored_J"] - early.energy["stored_J"], abs=close)


@pytest.mark.parametrize("name", ["swiss", "bench_lever"])
def test_the_books_of_a_beat_close(name, request):
    """Friction as worked out from forces and slip is what the balance of energies lacks, phase by phase."""
    run = request.getfixturevalue(name)
    for beat in shown_beats(run):
        supplied = sum(stage.energy.supplied for stage in beat.stages)
        assert abs(beat.residual) < 1e-9 * supplied
        for stage, friction in zip(beat.stages, beat.friction, strict=True):
            assert stage.energy.friction == pytest.approx(sum(friction.values()), abs=2e-9 * supplied)
            assert all(value > -1e-20 for value in friction.values())


def test_the_oscillator_gets_what_it_gains_and_loses(swiss):
    """Over a beat: work of the contacts = gain + damping; the impulse is the change of momentum that no spring explains."""
    run, c = swiss, swiss.slices["balance"].start
    spring, inertia = 1.2e-9 * (8.0 * math.pi) ** 2, 1.2e-9
    viscous = inertia * 8.0 * math.pi / 250.0
    for beat in shown_beats(run):
        t = np.linspace(beat.start, beat.end, 20001) - 1e-10  # before the impacts with which beats begin
        q, u = run.sample(t)
        gain = 0.5 * np.diff(inertia * u[[0, -1], c] ** 2 + spring * q[[0, -1], c] ** 2)[0]
        damping = viscous * np.trapezoid(u[:, c] ** 2, t) if hasattr(np, "trapezoid") else viscous * np.trapz(u[:, c] ** 2, t)
        assert sum(one.energy.to_balance for one in beat.stages) == pytest.approx(gain + damping, abs=2e-13)
        swept = float(np.sum(0.5 * (q[1:, c] + q[:-1, c]) * np.diff(t)))
        push = inertia * (u[-1, c] - u[0, c]) + viscous * (q[-1, c] - q[0, c]) + spring * swept
        assert sum(one.impulse for one in beat.stages) == pytest.approx(push, abs=1e-14)


def test_signs_of_the_work(swiss):
    """Unlocking costs the balance, impulses pay it; wheel and drive do the opposite."""
    for beat in shown_beats(swiss):
        by = {(stage.name, stage.phase.on): stage.energy for stage in beat.stages}
        assert by["unlock", ""].to_balance < 0.0 and by["unlock", ""].supplied < 0.0  # recoil winds the drive
        assert by["impulse", "stone"].to_balance > 0.0 and by["impulse", "tooth"].to_balance > 0.0
        assert abs(by["locked", ""].to_balance) < 1e-15
        assert by["drop", ""].impacts["wheel-lever"] > 0.0


def test_times_are_those_of_the_events(swiss):
    """Read a second time, straight from the event table, without the code that makes the phases."""
    run = swiss
    pairs = [run.pairs[k] if k >= 0 else None for k in run.events["contact"].tolist()]
    rows = list(zip(run.events["t"].tolist(), run.events["kind"].tolist(), pairs, strict=True))

    def times(first: str, second: str, kinds: tuple[EventKind, ...], flat: str | None = None) -> np.ndarray:
        bodies = {first, second}
        return np.array(
            [t for t, kind, pair in rows if pair and kind in kinds and {pair.body_a, pair.body_b} == bodies
             and (flat is None or pair.body_b == flat)]
        )  # fmt: skip

    pin = times("lever", "balance", (EventKind.IMPACT,))
    banking = times("lever", "banking", (EventKind.IMPACT, EventKind.CLOSE))
    lifted = times("wheel", "lever", (EventKind.OPEN,), flat="wheel")
    for beat in shown_beats(run):
        at = {(stage.name, stage.phase.on): stage.phase for stage in beat.stages}
        assert at["unlock", ""].start == pin[pin > beat.start - 0.05][0]
        assert at["run to banking", ""].end == banking[banking > at["drop", ""].end][0]
        # The discharge corner of the stone leaves the tooth's face as the wheel is let off.
        assert at["drop", ""].start == lifted[lifted > at["impulse", "tooth"].start][0]
        # The wheel stands furthest back when it is let go.
        column = run.slices["wheel"].start
        inside = (run.t >= beat.start) & (run.t <= at["drop", ""].end)
        assert run.t[inside][np.argmax(run.q[inside, column])] == pytest.approx(at["unlock", ""].end, abs=1e-12)


def test_angles_are_those_of_the_drawing(swiss):
    """Static geometry (docs/guide/glossary.md): 25.587° pin meets fork, 2° total lock, 11.125° of the balance to unlock."""
    for beat in shown_beats(swiss):
        start, end = beat.stages[0].phase, beat.stages[1].phase
        assert abs(math.degrees(start.angles[2])) == pytest.approx(25.5866, abs=1e-3)
        assert abs(math.degrees(start.turns[1])) == pytest.approx(2.0, abs=1e-4)
        assert abs(math.degrees(end.angles[2] - start.angles[2])) == pytest.approx(11.1255, abs=2e-3)
    assert {beat.stages[0].pallet for beat in shown_beats(swiss)} == {"entry", "exit"}
    # At -5° the exit stone locks: the lever of this drawing turns counter-clockwise to put the entry stone deep.
    for beat in shown_beats(swiss):
        assert (math.degrees(beat.stages[0].phase.angles[1]) > 0.0) is (beat.stages[0].pallet == "entry")


def test_the_table_in_the_results_folder(swiss):
    rows = list(csv.DictReader("".join(phases_csv(swiss, beats(swiss))).splitlines()))
    total = {
        name: sum(float(row[f"{name}_J"]) for row in rows) for name in ("supplied", "stored", "damping", "friction", "impacts")
    }
    assert total["supplied"] == pytest.approx(sum(total[name] for name in total if name != "supplied"), abs=1e-18)
    assert {row["on"] for row in rows if row["phase"] == "impulse"} == {"stone", "tooth"}
    assert {row["stone"] for row in rows} == {"entry", "exit"}


def test_fixed_steps_have_no_energies(swiss):
    rows = list(csv.DictReader("".join(phases_csv(replace(swiss, method="moreau"), beats(swiss))).splitlines()))
    assert rows and all(row["friction_J"] == "" and row["balance_turn_deg"] != "" for row in rows)


def test_the_printed_table(swiss):
    text = timeline_text(swiss)
    assert "entry stone" in text and "exit stone" in text and "impulse on tooth" in text
    assert text.count("the account closes to") == 2 and max(len(line) for line in text.splitlines()) < 170
    told = shown_beats(swiss)
    assert text.startswith(f"Timeline, t = {told[0].start:.6f} s to {told[1].end:.6f} s\n")
    for beat, line in zip(told, (line.split() for line in text.splitlines() if line.startswith("  end ")), strict=True):
        assert float(line[1]) == pytest.approx(1e3 * (beat.end - beat.start), abs=1e-3)
        assert [float(one) for one in line[2::2]] == pytest.approx(np.degrees(beat.stages[-1].end_angles), abs=1e-3)
    energies = text[text.index("energy in nJ") :].splitlines()[1:]
    assert len({len(line) for line in energies if not line.startswith(("beat", "  the account"))}) == 1  # one below the other


@pytest.mark.parametrize("width", few([85.0, 170.0], 1))
def test_the_plot_is_as_wide_as_asked_and_nothing_is_cut_off(swiss, width):
    figure = plot_phases(swiss, width=width)
    assert figure.get_figwidth() * 25.4 == pytest.approx(width)
    figure.canvas.draw()
    box = figure.bbox
    for axes in figure.axes:
        for text in (*axes.texts, axes.xaxis.label, axes.yaxis.label):
            extent = text.get_window_extent()
            assert box.x0 <= extent.x0 and extent.x1 <= box.x1 and box.y0 <= extent.y0 and extent.y1 <= box.y1, text


def test_the_command(tmp_path, capsys):
    folder = tmp_path / "run"
    scene = str(profiles_dir() / "swiss_lever")
    assert main(["run", scene, "--duration", "1.4 s", "--no-plots", "-o", str(folder)]) == FINE
    capsys.readouterr()
    assert main(["plot", str(folder), "--phases", "--window", "1.0 s:1.35 s", "--format", "png,pdf"]) == FINE
    out = capsys.readouterr().out
    assert (
        "impulse on stone" in out and (folder / "plots" / "phases.png").exists() and (folder / "plots" / "phases.pdf").exists()
    )
    assert main(["plot", str(folder), "--phases", "--window", "0 s:0.05 s"]) == BAD_INPUT
    assert "no beat" in capsys.readouterr().err


def test_what_has_no_beats_says_so():
    run = simulate(load(profiles_dir() / "incline" / "scene.toml"), duration=0.1)
    assert timeline(run) == []
    with pytest.raises(ValueError, match="nothing in this scene swings"):
        shown_beats(run)


def test_an_anchor_needs_its_lift_angle_and_then_has_beats(tmp_path: Path) -> None:
    """What swings and holds a wheel itself may be a click: the scene says which, and is said to be to."""
    scene, *_ = one_faced_anchor(tmp_path)
    with pytest.raises(ValueError, match="whether pendulum, which touches wheel itself, is its anchor is not known"):
        shown_beats(simulate(scene, 5.0))
    named = shown_beats(simulate(scene.set("timegrapher.lift_angle", "3°"), 5.0))
    assert "recoil" in {stage.name for beat in named for stage in beat.stages}


def test_the_lock_is_counted_once_where_the_lever_is_on_its_bank_before_it():
    """As in a co-axial escapement: no run to the banking is left, and the free oscillation begins with the lock."""
    run = simulate(load(profiles_dir() / "coaxial" / "scene.toml"), duration=1.2, record="all")
    told = shown_beats(run)
    runs = [stage.phase for beat in told for stage in beat.stages if stage.name == "run to banking"]
    assert runs and all(one.start == one.end for one in runs)
    for beat in told:
        assert abs(beat.residual) < 1e-9 * sum(stage.energy.supplied for stage in beat.stages)
        inside = (run.events["t"] >= beat.start) & (run.events["t"] < beat.end)
        impacts = sum(sum(stage.energy.impacts.values()) for stage in beat.stages)
        assert impacts == pytest.approx(float(run.events["energy_lost"][inside].sum()), rel=1e-12)


def test_what_a_torque_on_the_balance_does_is_not_done_by_the_lever() -> None:
    """The same motion under other forces: the difference in every phase is their own work and their own impulse."""
    run, push, stiffer, off, slow = lever_run(6), 2e-8, 3e-8, 0.3, 5e-11
    scene = run.scene
    alone = timeline(run)
    pushed = timeline(replace(run, scene=replace(scene, torques=(*scene.torques, Torque("balance", push)))))
    slowed = timeline(replace(run, scene=replace(scene, damping=(Damping("balance", slow),))))
    sprung = timeline(replace(run, scene=replace(scene, springs=(*scene.springs, Spring("balance", stiffer, off)))))
    column = run.slices["balance"].start
    assert len(alone) > 20
    for before, a, b, c in zip(alone, pushed, slowed, sprung, strict=True):
        start, end = before.phase.start, before.phase.end
        q, _ = run.sample(np.linspace(start, end, 2001))
        way, far, took = q[-1, column] - q[0, column], np.trapezoid(q[:, column] - off, dx=(end - start) / 2000), end - start
        assert a.energy.to_balance - before.energy.to_balance == pytest.approx(-push * way, rel=1e-7, abs=1e-18)
        assert a.impulse - before.impulse == pytest.approx(-push * took, rel=1e-6, abs=1e-18)
        assert b.impulse - before.impulse == pytest.approx(slow * way, rel=1e-6, abs=1e-18)
        lost = b.energy.damping - before.energy.damping
        assert lost > 0.0 and b.energy.to_balance - before.energy.to_balance == pytest.approx(lost, rel=1e-6, abs=1e-18)
        wound = 0.5 * stiffer * ((q[-1, column] - off) ** 2 - (q[0, column] - off) ** 2)
        assert c.energy.to_balance - before.energy.to_balance == pytest.approx(wound, rel=1e-6, abs=1e-16)
        assert c.impulse - before.impulse == pytest.approx(stiffer * far, rel=1e-4, abs=1e-15)


@pytest.mark.parametrize(("name", "close"), [("tourbillon", 2e-5), ("graham", 2e-5), ("grasshopper", 4e-4)])
def test_carried_and_heavy_oscillators_get_what_the_contacts_give(name, close):
    """Work and impulse by the books of motion, spring, weight and damping, against the contact forces and the impacts.

    Of pallets hinged on a pendulum the forces act at the hinge.
    """
    run = simulate(
        load(profiles_dir() / name / "scene.toml"),
        **({} if name == "graham" else {"duration": 1.4 if name == "tourbillon" else 5.0}),
    )
    told = shown_beats(run, None, rubbed=False)[-2:]
    given = [push for found in pushes(run, told) for push in found]
    most = max(abs(push.stage.energy.to_balance) for push in given)
    assert most > 0.0
    for push in given:
        assert push.forces + push.impacts == pytest.approx(push.stage.energy.to_balance, abs=close * most)
        if push.forces == push.impacts == 0.0:
            assert push.stage.impulse == pytest.approx(0.0, abs=1e-8 * max(abs(one.stage.impulse) for one in given))


# Do the books of springs between points close at any instant, with driven bodies at either end?

SCENE = """
[scene]
schema = 1
[bodies.slide]
motion = "driven"
circle = "1 mm"
axis = [0.6, 0.8]
velocity = "5 mm/s"
[bodies.rotor]
motion = "driven"
circle = "1 mm"
position = ["30 mm", "0 mm"]
swing = { amplitude = "30°", frequency = "3 Hz" }
[bodies.lever]
circle = "1 mm"
position = ["0 mm", "40 mm"]
inertia = "1 g·cm²"
[[line_springs]]
between = ["lever", "rotor"]
points = [["3 mm", "1 mm"], ["4 mm", "-7 mm"]]
stiffness = "20 N/m"
viscous = "3 N·s/m"
length = "12 mm"
[[line_springs]]
between = ["lever"]
points = [["-2 mm", "5 mm"], ["45 mm", "8 mm"]]
stiffness = "7 N/m"
viscous = "0.1 N·s/m"
tension = "0.02 N"
[[line_springs]]
between = ["lever", "slide"]
points = [["6 mm", "-2 mm"], ["0 mm", "9 mm"]]
stiffness = "11 N/m"
viscous = "2 N·s/m"
"""


def test_what_drives_supplies_what_is_stored_and_damped(tmp_path: Path) -> None:
    """E' + damping = power of the drives, while the lever stands; E' by five points. The lever by itself needs no drive."""
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    compiled = compile_scene(ws.load(tmp_path))
    model, rng = compiled.model, np.random.default_rng(5)
    free = compiled.slices["lever"].start
    q, u = rng.normal(size=(30, 3)) * 0.3, rng.normal(size=(30, 3))
    q[:, compiled.slices["slide"].start] *= 0.02
    u[:, compiled.slices["slide"].start] *= 0.02
    u[:, free] = 0.0
    h = 1e-3

    def stored(s: float) -> np.ndarray:
        energies = np.zeros(len(q))
        line_spring_energies(model, q + s * h * u, energies)
        return energies

    rate = (8.0 * (stored(1.0) - stored(-1.0)) - (stored(2.0) - stored(-2.0))) / (12.0 * h)
    assert held_by_lines(model) == {0, 1, 2}
    driven, damped = (power.sum(axis=1) for power in line_spring_power(model, dict(enumerate(q.T)), dict(enumerate(u.T))))
    assert driven == pytest.approx(rate + damped, abs=1e-9 * np.abs(driven).max())
    assert damped.min() > 0.0 and np.abs(damped).max() > 0.1 * np.abs(driven).max()
    alone = np.zeros_like(u)
    alone[:, free] = 1.0
    driven, damped = (power.sum(axis=1) for power in line_spring_power(model, dict(enumerate(q.T)), dict(enumerate(alone.T))))
    assert not driven.any() and damped.min() > 0.0
