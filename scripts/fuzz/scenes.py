"""Does any damaged scene file bring watchsim down, or make it slow?

Damages scene files at random, one to three accidents each, and has `watchsim check` judge them (every fourth one `watchsim run`
for a millisecond, where the check finds nothing; with `--command` each one another command). A file fails that brings exit
status 4, a traceback, the death of the process or more than 20 s. Files are numbered: number k is the same damage on every
machine, so `--only K` repeats it. With `--seed WORD` it is other damages, and of designs as well.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from scene_accidents import ACCIDENTS

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
SCENES = ("profiles/swiss_lever", "profiles/bench_lever", "profiles/incline", "profiles/balance")
DESIGNS = ("carriage", "coaxial", "geneva", "graham", "involute_pair", "recoil_anchor", "set_a")
SEEDED = (*SCENES, *(f"profiles/{name}" for name in DESIGNS))
SECONDS = 20
NOTED = 100  # after so many files a line says how far it has come
MEMORY = 4 << 30


def damaged(number: int, seed: str) -> tuple[str, bytes]:
    """Which scene, and the file."""
    rng = random.Random(f"scene {seed} {number}" if seed else f"scene {number}")
    name = rng.choice(SEEDED if seed else SCENES)
    data = (ROOT / name / "scene.toml").read_text(encoding="utf-8")
    for _ in range(rng.choice((1, 1, 2, 3))):
        data = rng.choice(ACCIDENTS)(rng, data)
    content = data.encode("utf-8", "surrogatepass")
    if rng.random() < 0.1:
        at = rng.randrange(len(content) + 1)
        content = content[:at] + bytes(rng.randrange(256) for _ in range(rng.randrange(1, 4))) + content[at:]
    return name, content


def judged(arguments: list[str]) -> tuple[int, str]:
    """Exit status of a command, and what it said."""
    from watchsim.cli import main

    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        status = main(arguments)
    return status, said.getvalue()


def judge(*commands: list[str]) -> tuple[str, str]:
    """The exit status of the last command that is reached, each one where the one before was fine, and a fault's report."""
    text, status = "", 0
    for arguments in commands:
        status, said = judged(arguments) if status == 0 else (status, "")
        text += said
    if status == 4 or "Traceback" in text:
        where = [path.read_text()[-600:] for path in Path().glob("watchsim-fault-*.txt")]
        return "a fault of the program", text[-1500:] + "".join(where)
    return str(status), ""


def in_a_process(place: Path, *commands: list[str]) -> tuple[str, float]:
    """What became of the commands in a process of its own with little time and memory, and the seconds it took."""
    reading, writing = os.pipe()
    start = time.perf_counter()
    child = os.fork()
    if child == 0:
        try:
            os.chdir(place)
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
            os.write(writing, "\n".join(judge(*commands)).encode()[:4000])
        except BaseException as error:
            os.write(writing, f"escaped: {type(error).__name__}: {error}".encode()[:4000])
        finally:
            os._exit(0)
    os.close(writing)
    status = os.waitpid(child, 0)[1]
    with os.fdopen(reading) as pipe:
        words = pipe.read()
    took = time.perf_counter() - start
    if os.WIFSIGNALED(status):
        slow = os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL)
        words = f"more than {SECONDS} s of processor time" if slow else f"died of signal {os.WTERMSIG(status)}"
    for report in place.glob("watchsim-fault-*.txt"):
        report.unlink()
    return words, took


def one(number: int, seed: str, copies: Path, command: str) -> tuple[str, float]:
    """Judge file `number`; the `command` runs where the check finds nothing."""
    name, content = damaged(number, seed)
    place = copies / Path(name).name / "scene.toml"
    place.write_bytes(content)
    commands = [["check", str(place), "--json"]]
    out = ["-o", str(place.parent / "out")]
    if command == "run" and number % 4 == 0:
        commands.append(["run", str(place), "--duration", "1 ms", "--no-plots", *out])
    elif command == "steady":
        commands.append(["steady", str(place)])
    elif command == "export":
        commands.append(["export", str(place), *out])
    elif command == "turn":
        commands.append(["check", str(place), "--turn", "--swing", "20°"])
    answer = in_a_process(copies, *commands)
    shutil.rmtree(place.parent / "out", ignore_errors=True)
    return answer


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", default="")
    parser.add_argument("--command", choices=("run", "steady", "export", "turn"), default="run", help="besides the check")
    parser.add_argument("--only", type=int, help="print this file and what becomes of it")
    parser.add_argument("-o", "--output", type=Path, default=Path("results/fuzz"), help="where files that fail are kept")
    args = parser.parse_args()
    from watchsim.analysis.expectation_faults import expectation_faults
    from watchsim.commands.inputs import load_scene
    from watchsim.simulation.simulate import simulate

    # Loaded once, for all the processes that are forked.
    simulate(load_scene(str(ROOT / SCENES[2])), 1e-3)
    expectation_faults(load_scene(str(ROOT / SCENES[1])))
    kinds: Counter[str] = Counter()
    slowest = (0.0, -1)
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        for name in SEEDED:
            shutil.copytree(ROOT / name, Path(folder) / Path(name).name)
        for number in range(args.first, args.first + args.count) if args.only is None else [args.only]:
            words, took = one(number, args.seed, Path(folder), args.command)
            slowest = max(slowest, (took, number))
            kind = words.splitlines()[0] if words else "nothing said"
            kinds[kind] += 1
            if sum(kinds.values()) % NOTED == 0:
                print(f"{sum(kinds.values())} done, to number {number}: {dict(sorted(kinds.items()))}", flush=True)
            if kind not in ("0", "1", "2", "3") or args.only is not None:
                args.output.mkdir(parents=True, exist_ok=True)
                name, content = damaged(number, args.seed)
                (args.output / f"scene-{args.seed}{number}.toml").write_bytes(content)
                print(f"{number} ({name}): {words}", flush=True)
    seeded = f" with seed {args.seed}" if args.seed else ""
    print(
        f"{sum(kinds.values())} scenes from number {args.first}{seeded}: exit statuses {dict(sorted(kinds.items()))}; "
        f"{time.perf_counter() - start:.0f} s, the slowest {slowest[0]:.1f} s (number {slowest[1]})"
    )
    sys.exit(bool(set(kinds) - {"0", "1", "2", "3"}) and args.only is None)


if __name__ == "__main__":
    main()
