"""What breaks without each rule that guards a near-degenerate case?

    python scripts/checks/price_of_rules.py FOLDER [--count N] [--start K] [SCENE.toml ...]
    python scripts/checks/price_of_rules.py FOLDER --table

In a copy of the package each rule gets a switch. Everything is run with all rules on, which also shows which of them took
effect; each of those is then switched off. Where the motion changes, `watchsim verify` compares its numbers and the hunt judges
the mechanism. Runs: the benchmarks, the scenes in tests/data/hunt and those given, the recorded runs, and `--count` mechanisms
of the hunt. What was found is kept in FOLDER/found.jsonl; a second call goes on where the first one ended.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[2]
SEED = 32


class Rule(NamedTuple):
    """`edits`: (file, condition, the same with ON, which is true where the rule is on, asked only where it takes effect)."""

    name: str
    edits: tuple[tuple[str, str, str], ...]


def _rule(name: str, file: str, old: str, new: str, *more: str) -> Rule:
    edits = (file, old, new, *more)
    return Rule(name, tuple(zip(edits[::3], edits[1::3], edits[2::3], strict=True)))


STEP, EVENTS, CLOSED = "simulation/integrator.py", "simulation/event_loop.py", "simulation/closed_contacts.py"
MODES, IMPACTS, MOTION = "simulation/modes.py", "simulation/impacts.py", "simulation/coupled_motion.py"
CLOSING, FRICTION, IMPACT = "simulation/first_closing.py", "dynamics/friction.py", "dynamics/impact.py"
FORCES, REDUNDANT, GAPS = "dynamics/acceleration.py", "dynamics/redundant.py", "contact/gaps.py"

_NOTHING = "if normal == 0.0 and system.size[2 * i] == 0.0:"
_BESIDE = "if room_beside_active(model, state.regime.active, in_force, options, k, pose)[0] >= 0.0:"

RULES = (
    _rule("handover", CLOSED, "if successor != NO_CONTACT:", "if successor != NO_CONTACT and ON:"),
    _rule("smooth neighbour", CLOSED, _BESIDE, f"{_BESIDE[:-1]} and ON:", CLOSING, "if way < 0.0:", "if way < 0.0 or not ON:"),
    _rule(
        "convex neighbour",
        CLOSED,
        "if model.primitives[mine].before == its or model.primitives[mine].after == its:",
        "if (model.primitives[mine].before == its or model.primitives[mine].after == its) and ON:",
    ),
    _rule("immovable", CLOSED, "return across <= IMMOVABLE * along", "return across <= IMMOVABLE * along and ON"),
    _rule("sunk", CLOSING, "0, options.sunk) else 0.0", "0, options.sunk) and ON else 0.0"),
    _rule("parallel waits", CLOSED, "math.sqrt(own / other) > least:", "math.sqrt(own / other) > least and ON:"),
    _rule("landing", EVENTS, "if not left:", "if not left or not ON:"),
    _rule(
        "touched is closed", CLOSED, "if state.instant.touched != NO_CONTACT:", "if state.instant.touched != NO_CONTACT and ON:"
    ),
    _rule(
        "rates after gaps",
        EVENTS,
        "        project_velocities(closed, m, state.regime.mode",
        "        if ON:\n            project_velocities(closed, m, state.regime.mode",
    ),
    _rule("slip against mode", EVENTS, "rest.kin[i].gT_dot < 0.0 else", "rest.kin[i].gT_dot < 0.0 and ON else"),
    _rule("closing parts", MODES, "* gap_acceleration(rest, i, out_a):", "* gap_acceleration(rest, i, out_a) and ON:"),
    _rule(
        "rates contradict",
        MODES,
        "if left > CONTRADICTING_RATE * rate_rounding(rest, i, options, event.peak_speed):",
        "if left > CONTRADICTING_RATE * rate_rounding(rest, i, options, event.peak_speed) and ON:",
    ),
    _rule("dead centre stops", MODES, "2 * i + 1] >= 0.0:", "2 * i + 1] >= 0.0 or not ON:"),
    _rule(
        "dead centre stands",
        MODES,
        "    event.decided[rest.ids[0]] = STICK\n",
        "    if not ON:\n        return False\n    event.decided[rest.ids[0]] = STICK\n",
    ),
    _rule("dead centre holds", MODES, "if u[one] == 0.0 and u[other] == 0.0:", "if u[one] == 0.0 and u[other] == 0.0 and ON:"),
    _rule(
        "rounded speeds", MODES, "VELOCITY_ROUNDING * event.peak_speed[j]:", "VELOCITY_ROUNDING * event.peak_speed[j] and ON:"
    ),
    _rule("rounded slips", MODES, "options.speed_zero < slip <= rounding", "options.speed_zero < slip <= rounding and ON"),
    _rule("jam holds gaps", MODES, "    hold_gaps(model, r", "    if ON:\n        hold_gaps(model, r"),
    _rule("release pulling", MODES, "        if not found:", "        if not found or not ON:"),
    _rule("modes recur", MODES, "if decided[j] == key:", "if decided[j] == key and ON:"),
    _rule("slow rebounds", IMPACTS, "if slowly and rate >", "if slowly and ON and rate >"),
    _rule("hidden rebounds", IMPACTS, " or hidden:", " or (hidden and ON):"),
    _rule(
        "accumulation", IMPACTS, "if ending < options.accumulation_time or", "if (ending < options.accumulation_time and ON) or"
    ),
    _rule(
        "closing play",
        IMPACTS,
        "if hit and _comes_back_endlessly(watch, time, options, event.closed.ids[i], rate):",
        "if hit and _comes_back_endlessly(watch, time, options, event.closed.ids[i], rate) and ON:",
    ),
    _rule(
        "chatter",
        IMPACTS,
        "may_be_chatter(m, options, event, room):\n        _",
        "may_be_chatter(m, options, event, room) and ON:\n        _",
    ),
    _rule("chatter pressed", IMPACTS, "if apart and 0.0 < time < math.inf:", "if apart and 0.0 < time < math.inf and ON:"),
    _rule("energy rescue", IMPACTS, "if gain <= ENERGY_GAIN * kinetic:", "if gain <= ENERGY_GAIN * kinetic or not ON:"),
    _rule("orientation", FRICTION, "if direction < 0.0:", "if direction < 0.0 and ON:"),
    _rule("no slip, no direction", FRICTION, "* largest and block < m:", "* largest and block < m and ON:"),
    _rule("solver: copositive", FRICTION, "if elements > 0 and _solve", "if elements > 0 and ON and _solve"),
    _rule("solver: detour", FRICTION, "elif _detour(n, False,", "elif ON and _detour(n, False,"),
    _rule("solver: enumeration", FRICTION, "elif enumerate_modes(", "elif ON and enumerate_modes("),
    _rule("solver: inexact", FRICTION, "elif _detour(n, True,", "elif ON and _detour(n, True,"),
    _rule("unloaded jams", FRICTION, "system, problem.loaded[2 * i]):", "system, problem.loaded[2 * i]) or not ON:"),
    _rule(
        "perturbation taken back",
        FORCES,
        "    if pressed:",
        "    if pressed and ON:",
        IMPACT,
        "if perturbed and solver != Solver.FAILED:",
        "if perturbed and solver != Solver.FAILED and ON:",
    ),
    _rule(
        "rates of rounding",
        IMPACT,
        "if abs(out_rates[row]) <= VELOCITY_ROUNDING * terms:",
        "if 0.0 < abs(out_rates[row]) <= VELOCITY_ROUNDING * terms and ON:",
    ),
    _rule("jams grip more", IMPACT, "<= PAINLEVE * own:", "<= PAINLEVE * own and ON:"),
    _rule("jams approach", IMPACT, "<= jam_speed < slip:", "<= jam_speed < slip and ON:"),
    _rule("parallel directions", IMPACT, "if e >= 0 and is_parallel(G, i):", "if e >= 0 and is_parallel(G, i) and ON:"),
    _rule(
        "jams under force",
        FORCES,
        "_slides_into_jam(system, m, i, problem):\n            return False",
        "_slides_into_jam(system, m, i, problem) and ON:\n            return False",
    ),
    _rule("jam watched", MOTION, "-1.0 if slides_into_jam else", "-1.0 if slides_into_jam and ON else"),
    _rule(
        "slides by its end of the cone",
        FORCES,
        "problem.x[m + e] == 0.0:",
        "(problem.x[m + e] == 0.0 or not ON):",
        FORCES,
        "problem.x[m + elements + e] > 0.0:",
        "(problem.x[m + elements + e] > 0.0 or not ON):",
    ),
    _rule("rounding passed on", FORCES, "        if i != row // 2:", "        if i != row // 2 and ON:"),
    _rule("nothing acts", MOTION, _NOTHING, f"{_NOTHING[:-1]} and ON:"),
    _rule("sunk is no drift", MOTION, "drifted = gap >= -behind and", "drifted = (gap >= -behind or not ON) and"),
    _rule(
        "not along the face",
        MOTION,
        "<= TAKEN_BACK_ALONG * behind * G[row, row]",
        "<= TAKEN_BACK_ALONG * behind * G[row, row] or not ON",
    ),
    _rule(
        "gaps met first",
        MOTION,
        "if not _close(closed, n, both, behind, projection):",
        "if not _close(closed, n, both, behind, projection) and ON:",
    ),
    _rule("nearly determined", MOTION, "if own <= independent * easiest:", "if own <= independent * easiest and ON:"),
    _rule("smallest forces", FORCES, "    if rank < n:", "    if rank < n and ON:"),
    _rule("lawful forces", REDUNDANT, "if worst >= -LAW_SLACK * largest:", "if worst >= -LAW_SLACK * largest or not ON:"),
    _rule(
        "laws with slack",
        REDUNDANT,
        "        for line in range(laws):\n            value[line] += ",
        "        if not ON:\n            return\n        for line in range(laws):\n            value[line] += ",
    ),
    _rule(
        "along a law",
        REDUNDANT,
        "if abs(gain) > LAW_ROUNDING else",
        "if abs(gain) > LAW_ROUNDING or (gain != 0.0 and not ON) else",
    ),
    _rule("closes without drift", STEP, "    if touched != NO_CONTACT:", "    if touched != NO_CONTACT and ON:"),
    _rule(
        "gaps turn rates",
        STEP,
        "if _turns_rates(model, state.u, options, m, closed):",
        "if _turns_rates(model, state.u, options, m, closed) and ON:",
    ),
    _rule(
        "before the end",
        STEP,
        "smooth.held.contacts > 1):",
        "smooth.held.contacts > 1 and ON):",
    ),
    _rule(
        "still points",
        CLOSING,
        "            if wait < FINE_LOOK * (end - tau):",
        "            if wait < FINE_LOOK * (end - tau) and ON:",
    ),
    _rule(
        "points apart",
        CLOSING,
        "if outside and safe < FINE_LOOK * (end - tau):",
        "if outside and safe < FINE_LOOK * (end - tau) and ON:",
    ),
)

SWITCH = '''

import numpy
import numba.extending
from llvmlite import ir
from numba.core import cgutils, types

SWITCHES = numpy.zeros((2, 128), numpy.int64)  # by rule: is it off? did it take effect?


@numba.extending.intrinsic
def switched(typing_context, k):
    """True where rule k is on; notes that it was asked for."""
    def make(context, builder, signature, values):
        word = ir.IntType(64)
        place = builder.add(builder.mul(values[0], word(8)), word(SWITCHES.ctypes.data))
        off = builder.load(builder.inttoptr(place, word.as_pointer()))
        noted = builder.inttoptr(builder.add(place, word(8 * 128)), word.as_pointer())
        builder.store(word(1), noted)
        return builder.icmp_signed("==", off, word(0))

    return types.boolean(types.int64), make
'''


def copied(folder: Path) -> None:
    """The package and what it is run with in `folder`, with a switch for each rule."""
    for name in ("watchsim", "profiles", "scripts", "tests"):
        shutil.rmtree(folder / name, ignore_errors=True)
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    jit = folder / "watchsim/jit.py"
    jit.write_text(jit.read_text() + SWITCH)
    for k, rule in enumerate(RULES):
        for file, old, new in rule.edits:
            path = folder / "watchsim" / file
            text = path.read_text()
            if old not in text:
                raise SystemExit(f"{rule.name}: {file} has no {old!r}")
            text = text.replace(old, re.sub(r"\bON\b", f"switched({k})", new))
            if "from watchsim.jit import switched\n" not in text:
                text = text.replace(
                    "from watchsim.jit import ", "from watchsim.jit import switched\nfrom watchsim.jit import ", 1
                )
            path.write_text(text)


Case = tuple[str, Callable[[], Any], Callable[[Any, bool], str] | None]  # name, numbers and run, verdict ("": all well)


def cases(args: argparse.Namespace) -> Iterator[Case]:
    """Everything that is run."""
    from hunt.books import faults
    from hunt.generator.generate import mechanism
    from hunt.generator.material import Material
    from hunt.judge import _Clock, _weights, judged
    from recorded_scenes import all_names, run_of, scene_of, told

    from watchsim.scene.load import load
    from watchsim.simulation.simulate import simulate
    from watchsim.verification import benchmarks, hard_cases, repeated_impacts
    from watchsim.verification.verify import rows_of

    def motion(scene: Any, tolerance: float = 1e-9) -> Any:
        run = simulate(scene, tolerance=tolerance, progress=_Clock())
        shares = run.end_q * _weights(scene) if all(body.loops for body in scene.bodies) else run.end_q
        return (shares.tolist(), run.end_u.tolist(), run.counts, int(run.stop)), run

    def recorded(name: str) -> Any:
        return vars(told(run_of(scene_of(name)))), None

    def verdict(scene: Any, number: int, run: Any, in_full: bool) -> str:
        found = [*faults(run, Material(scene))]
        if in_full and not found:
            whole = judged(scene, number)
            found = [] if whole.kind in ("fine", "sensitive") else [f"{whole.kind}: {whole.reasons[0]}"]
        return found[0] if found else ""

    def wrong(benchmark: Any, _run: Any, _in_full: bool) -> str:
        return "; ".join(row["quantity"] for row in rows_of([benchmark]) if not row["ok"])

    made = (benchmarks.inclines, benchmarks.swings, hard_cases.hard_cases, hard_cases.edge_cases)
    for one in (case for make in (*made, repeated_impacts.repeated_impacts) for case in make()):
        yield f"verify/{one.name}", partial(motion, one.scene), partial(wrong, one)
    for path in (*sorted((ROOT / "tests/data/hunt").glob("*.toml")), *args.scenes):
        for tolerance, name in ((1e-9, path.stem), (1e-7, f"{path.stem} at 1e-7"), (1e-11, f"{path.stem} at 1e-11")):
            yield f"kept/{name}", partial(motion, load(path), tolerance), partial(verdict, load(path), 0)
    for k in range(args.start, args.start + args.count):
        scene = mechanism(SEED, k)
        yield f"hunt/{k}", partial(motion, scene), partial(verdict, scene, k)
    for name in all_names(100):
        yield f"recorded/{name}", partial(recorded, name), None


def priced(case: Case, switches: Any, judged: Counter[str], wrong: Counter[str], in_full_up_to: int) -> dict[str, Any]:
    """Which rules took effect in a case, which moved it, and what is wrong without them."""
    name, run, verdict = case
    switches[:] = 0
    base, whole = run()
    took = [k for k in range(len(RULES)) if switches[1, k]]
    found: dict[str, Any] = {"case": name, "took": [RULES[k].name for k in took], "moved": {}, "far": {}}
    sound: dict[bool, bool] = {}
    for k in took:
        rule = RULES[k].name
        switches[:] = 0
        switches[0, k] = 1
        moved, in_full = None, not wrong[rule] and judged[rule] < in_full_up_to
        try:
            numbers, moved = run()
            if repr(numbers) == repr(base):
                continue
            what = verdict(moved, in_full) if verdict else None
        except Exception as error:
            what = f"crashed: {error}"
        if what and verdict:
            switches[:] = 0
            if in_full not in sound:
                sound[in_full] = not verdict(whole, in_full)
            what = what if sound[in_full] else ""
        found["moved"][rule] = what
        if verdict and moved is not None:
            found["far"][rule] = max((abs(a - b) for a, b in zip(numbers[0], base[0], strict=True)), default=0.0)
        judged[rule] += in_full
        wrong[rule] += bool(what)
    return found


def table(lines: list[dict[str, Any]]) -> str:
    """By rule: in how many cases it took effect, moved the motion, and how many are wrong without it."""
    rows = [
        "| rule | took effect | moved | verify | kept scenes | hunt | by more than 1e-6 | furthest |",
        "|---|---:|---:|---|---|---|---:|---:|",
    ]
    for rule in RULES:
        took = sum(rule.name in line["took"] for line in lines)
        moved = [(line["case"], line["moved"][rule.name]) for line in lines if rule.name in line["moved"]]
        parts = []
        for kind in ("verify", "kept", "hunt"):
            own = [(case.split("/", 1)[1], what) for case, what in moved if case.startswith(kind) and what is not None]
            bad = [case for case, what in own if what]
            parts.append(f"{len(bad)} of {len(own)}" + (f" ({', '.join(bad[:3])})" if bad else ""))
        far = [line["far"][rule.name] for line in lines if rule.name in line.get("far", {})]
        parts += [str(sum(not way <= 1e-6 for way in far)), f"{max(far, default=0.0):.0e}"]
        rows.append(f"| {rule.name} | {took} | {len(moved)} | " + " | ".join(parts) + " |")
    return "\n".join(rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("scenes", type=Path, nargs="*")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--start", type=int, default=0)
    parser.add_argument("--judge", type=int, default=0, metavar="N", help="judge N moved mechanisms of a rule in full")
    parser.add_argument("--table", action="store_true")
    args = parser.parse_args()
    kept = args.folder / "found.jsonl"
    lines = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    if args.table:
        print(table(lines))
        return 0
    copied(args.folder)
    os.environ["WATCHSIM_CACHE"] = str(args.folder / f"cache-{os.getpid()}")
    sys.path[:0] = [str(args.folder / part) for part in (".", "scripts", "tests/simulation")]
    from watchsim import jit

    switches = vars(jit)["SWITCHES"]
    done = {line["case"] for line in lines}
    moved = [found for line in lines for found in line["moved"].items()]
    judged: Counter[str] = Counter()
    wrong = Counter(name for name, what in moved if what)
    for case in cases(args):
        if case[0] not in done:
            try:
                found = priced(case, switches, judged, wrong, args.judge)
            except Exception as error:
                found = {"case": case[0], "took": [], "moved": {}, "error": repr(error)}
            with kept.open("a") as file:
                file.write(json.dumps(found) + "\n")
    shutil.rmtree(os.environ["WATCHSIM_CACHE"], ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
