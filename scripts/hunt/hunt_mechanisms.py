"""Is any random mechanism simulated wrongly, or not at all?

Judges mechanisms `--start` to `--start + --count` of `--seed` and prints what is not fine, one a line, then a table of
families. Number k of a seed is the same mechanism on every machine, so `--only K` repeats it. `--keep FOLDER` writes each that
fails as a scene file, `--shrink` after making it as small as it fails. What is generated and what is judged:
docs/reports/hunt.md.

    python scripts/hunt/hunt_mechanisms.py --count 20000 --jobs 2
    python scripts/hunt/hunt_mechanisms.py --only 17 --keep results/hunt --shrink

Ctrl-C and SIGTERM end the hunt with the table of what it has judged so far.
Exit status: 0 all fine, 1 something was wrong, hung or gave up.
"""

import argparse
import re
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from hunt.generate import FAMILIES, mechanism
from hunt.judge import Verdict, judged
from hunt.pool import answers
from hunt.write import write_scene
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene

CLEAN = ("fine", "sensitive")
TOLD = 500  # mechanisms between lines that say how far it is
KINDS = ("fine", "sensitive", "wrong", "gave up", "hanging", "crashed")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--start", type=int, default=0, help="number of the first mechanism (default %(default)s)")
    parser.add_argument("--count", type=int, default=1000, help="how many (default %(default)s)")
    parser.add_argument("--only", type=int, help="this number alone")
    parser.add_argument("--family", choices=sorted(FAMILIES), help="only mechanisms of this family")
    parser.add_argument("--jobs", type=int, default=1, help="processes (default %(default)s)")
    parser.add_argument("--witness", type=float, default=0.1, help="share that Moreau's stepping checks (default %(default)s)")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="write what fails as scene files")
    parser.add_argument("--shrink", action="store_true", help="make what is kept as small as it fails")
    parser.add_argument("--scene", type=Path, nargs="+", help="judge these scene files instead")
    return parser.parse_args()


def verdict_of(number: int, args: argparse.Namespace) -> tuple[str, Verdict]:
    """Family and verdict; an exception is a verdict, too."""
    title = "?"
    try:
        scene = mechanism(args.seed, number, args.family)
        title = scene.title
        with_witness = number % 1000 < 1000 * args.witness if args.only is None else True
        return title, judged(scene, number, with_witness)
    except Exception as error:
        return title, Verdict("crashed", [f"{type(error).__name__}: {error}"])


def kept(args: argparse.Namespace, number: int, verdict: Verdict) -> Path:
    """Where the scene of what fails was written."""
    scene = mechanism(args.seed, number, args.family)
    path = args.keep / f"{scene.title}-{args.seed}-{number}.toml"
    if args.shrink:
        write_scene(shrunk(scene, verdict, number), path)
        if judged_file(path).kind not in CLEAN:
            return path
    return write_scene(scene, path)


def judged_file(path: Path) -> Verdict:
    """A scene file, with Moreau's stepping; the orientations are those of the number at the end of its name."""
    number = re.search(r"(\d+)$", path.stem)
    return judged(load(path), int(number[1]) if number else 0, True)


def table(found: list[tuple[str, Verdict]]) -> str:
    rows = Counter((title, verdict.kind) for title, verdict in found)
    lines = ["| Family | mechanisms | " + " | ".join(KINDS) + " |", "|---" * (len(KINDS) + 2) + "|"]
    for title in [*sorted({title for title, _ in found}), "all"]:
        counts = [sum(n for (t, k), n in rows.items() if k == kind and title in (t, "all")) for kind in KINDS]
        lines.append(f"| {title} | {sum(counts)} | " + " | ".join(str(n) for n in counts) + " |")
    return "\n".join(lines)


def classes(found: list[tuple[str, Verdict]]) -> str:
    """How many mechanisms have a reason of each class."""
    count: Counter[str] = Counter()
    for _, verdict in found:
        count.update({reason.split(":")[0] for reason in verdict.reasons})
    return ", ".join(f"{word} {n}" for word, n in count.most_common()) or "none"


def report(label: str, title: str, verdict: Verdict) -> None:
    if verdict.kind not in CLEAN:
        reasons = "; ".join(verdict.reasons[:3]) + (f" and {len(verdict.reasons) - 3} more" if len(verdict.reasons) > 3 else "")
        print(f"{label} {title}: {verdict.kind}: {reasons}", flush=True)


def main() -> int:
    args = arguments()
    begun = time.perf_counter()
    found: list[tuple[str, Verdict]] = []
    if args.scene:
        for path in args.scene:
            found.append((load(path).title, judged_file(path)))
            report(str(path), *found[-1])
    else:
        numbers = [args.only] if args.only is not None else range(args.start, args.start + args.count)
        judged(mechanism(1, 0), 0, True)  # compiles once, for all processes

        def work(number: int) -> Any:
            return verdict_of(number, args)

        for ended in (signal.SIGINT, signal.SIGTERM):  # in the background the first one is ignored
            signal.signal(ended, signal.default_int_handler)
        with suppress(KeyboardInterrupt):
            for number, answer in answers(numbers, work, args.jobs):
                title, verdict = answer or ("?", Verdict("hanging", ["hanging: did not answer"]))
                found.append((title, verdict))
                report(str(number), title, verdict)
                if args.keep and verdict.kind not in CLEAN and answer:
                    print(f"  kept as {kept(args, number, verdict)}", flush=True)
                if len(found) % TOLD == 0:
                    print(f"{len(found)} judged in {time.perf_counter() - begun:.0f} s", flush=True)
    print(table(found))
    print(f"Classes of faults: {classes(found)}")
    runs, took = sum(verdict.runs for _, verdict in found), time.perf_counter() - begun
    print(f"{len(found)} mechanisms, {runs} runs, {took:.0f} s; seed {args.seed}, from number {args.start}")
    return int(any(verdict.kind not in CLEAN for _, verdict in found))


BUDGET = 40.0  # s
SHORTEST = 1e-2  # of the duration: below that runs are so short that anything is large against them


def shrunk(scene: Scene, verdict: Verdict, seed: int) -> Scene:
    """The smallest scene found that fails likewise: bodies, forces, corners and digits are dropped one after another."""
    classes = {reason.split(":")[0] for reason in verdict.reasons}
    witness = classes == {"witness"}

    def fails(other: Scene) -> bool:
        try:
            if overlaps(other):
                return False
            found = judged(other, seed, witness)
        except Exception:  # what cannot be compiled is no mechanism
            return False
        return bool(classes & {reason.split(":")[0] for reason in found.reasons})

    end, shortest = time.perf_counter() + BUDGET, SHORTEST * scene.duration
    smaller = True
    while smaller and time.perf_counter() < end:
        smaller = False
        for candidate in _smaller(scene):
            if time.perf_counter() > end:
                break
            if candidate.duration >= shortest and fails(candidate):
                scene, smaller = candidate, True
                break
    return scene


def _smaller(scene: Scene) -> Iterator[Scene]:
    for share in (0.5, 0.75, 0.9):
        yield replace(scene, duration=float(f"{share * scene.duration:.3g}"))
    for body in scene.bodies if len(scene.bodies) > 2 else ():
        yield _without(scene, body.name)
    for name in ("springs", "damping", "torques"):
        entries = getattr(scene, name)
        for k in range(len(entries)):
            yield replace(scene, **{name: entries[:k] + entries[k + 1 :]})
    if any(scene.gravity):
        yield replace(scene, gravity=(0.0, 0.0))
    for k, contact in enumerate(scene.contacts):
        for changed in (replace(contact, friction=0.0), replace(contact, restitution=0.0)):
            if changed != contact:
                yield replace(scene, contacts=(*scene.contacts[:k], changed, *scene.contacts[k + 1 :]))
    for k, body in enumerate(scene.bodies):
        for other in _plainer(body):
            yield replace(scene, bodies=(*scene.bodies[:k], other, *scene.bodies[k + 1 :]))


def _without(scene: Scene, name: str) -> Scene:
    def keep(entries: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple(entry for entry in entries if entry.body != name)

    return replace(
        scene,
        bodies=tuple(body for body in scene.bodies if body.name != name),
        springs=keep(scene.springs),
        torques=keep(scene.torques),
        damping=keep(scene.damping),
        contacts=tuple(c for c in scene.contacts if name not in (c.sides[0].body, c.sides[1].body)),
    )


def _plainer(body: Body) -> Iterator[Body]:
    if any(body.velocity):
        yield replace(body, velocity=(0.0,) * len(body.velocity))
    (loop,) = body.loops
    if len(loop.edges) > 3 and all(isinstance(edge, Line) for edge in loop.edges):
        points = [edge.start for edge in loop.edges]
        for k in range(len(points)):
            yield replace(body, loops=(_polygon([*points[:k], *points[k + 1 :]]),))
    rounded: list[Callable[[], Body]] = [
        lambda: replace(body, velocity=tuple(_round(v) for v in body.velocity)),
        lambda: replace(body, angle=_round(body.angle)),
        lambda: replace(body, mass=_round(body.mass), inertia=_round(body.inertia)),
    ]
    for make in rounded:
        if (other := make()) != body:
            yield other


def _polygon(points: list[tuple[float, float]]) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, [*points[1:], points[0]], strict=True)), "polygon")


def _round(value: float) -> float:
    return float(f"{value:.2g}")


if __name__ == "__main__":
    sys.exit(main())
