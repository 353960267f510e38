"""Does any damaged scene file bring watchsim down, or make it slow?

Damages scene files at random, one to three accidents each, and has `watchsim check` judge them (every fourth one `watchsim run`
for a millisecond, where the check finds nothing; with `--command` each one another command). A file fails that brings exit
status 4, a traceback, the death of the process or more than 20 s. Files are numbered: number k is the same damage on every
machine, so `--only K` repeats it. With `--seed WORD` it is other damages, and of designs as well.
"""

import argparse
import random
import re
import shutil
import sys
import tempfile
from pathlib import Path

from rounds import FINE, add_numbers, campaign, in_a_process, judged

# Which accidents happen to a scene file? Each takes a random generator and a text, and returns another text.


VALUES = (  # in place of what a key has
    *("", "0", "-1", "1", "1e308", "1e-320", "5e101", "nan", "inf", "-inf", "true", "[]", "{}", "[[]]", "[{}]", '""', '"x"'),
    *("'''a'''", '"5e101 mm"', '"-1 mm"', '"0 mm"', '"1e-320 g"', '"1e400 m"', '"nan m"', '"1 mm/0"', '"28800"'),
    *('"28800 vph"', '"1e5000 Hz"', '"every 99999999999999999999"', '"every 0"', '"events"', '["1 s", "0 s"]'),
    *('["0 s", "1e99 s"]', "1979-05-27T07:32:00Z", "07:32:00"),
    *("9" * 5000, f'"{"9" * 5000} mm"', f'"every {"9" * 5000}"'),
    *("[" * 400 + "]" * 400, "{a=" * 400 + "1" + "}" * 400, "[" * 5000),
    *('"wheel"', '"wheel.TEETH"', '["wheel.TEETH", "wheel.TEETH"]', '["a", "b", "c"]', '"../../etc/passwd"', '"/dev/null"'),
    *('"."', "1_0", '"\\u0000"', '"\\ud800"', '"µ"', '"1 µN·m"', "[1, 2]", '["1 mm", "1 mm"]', '["0 mm", "0 mm", "0 mm"]'),
    *("0x10", "1e-14", '"free"', '"fixed"', '"slide"', '"moving"', "[0.0, 0.0]", "[1.0, 0.0]", '"-0 mm"', '"1 mm mm mm"'),
    *('"((((mm))))"', '"1 mm^9"', '"1 mm^-9"'),
)
LINES = (  # put in somewhere
    *("[bodies]", "[[bodies]]", "[[contacts]]", "[[springs]]", "[[torques]]", "[[damping]]", "[run]", "[expect]", "[scene]"),
    *("[lock]", "[bodies.x]", "[bodies.'']", "[bodies.'a.b']", "[timegrapher]", "[bodies.wheel.solids]"),
    *("[[bodies.wheel.solids]]", "[[]]", "["),
    *("[bodies]\ndrawing = 'x.dxf'\nposition = ['0 mm', '0 mm']", "[[contacts]]\n[[contacts]]", "bodies = 1", "contacts = [1]"),
    *("contacts = [[]]", "springs = {}", "x = 1", "=", "a.b.c.d = 1"),
    *("[a." + "a." * 400 + "a]", "\x00", "\ufeff", "# \x01", "[expect.x]"),
    *('"amplitude" = 1', '"amplitude" = { value = "1", tolerance = "1" }', '"x.y" = { value = "1 s", tolerance = "-1 s" }'),
    *("[lock.drawings]", 'on = "wheel"', 'on = "balance"', 'record = "statistics"', "tolerance = 1e-14"),
    *('duration = "1e300 s"',),
)


def _value(rng: random.Random, text: str) -> str:
    """Another value for a key."""
    lines = text.splitlines()
    places = [k for k, line in enumerate(lines) if re.match(r"\s*[\w\"]+\s*=", line)]
    if places:
        k = rng.choice(places)
        lines[k] = f"{lines[k].split('=')[0]}= {rng.choice(VALUES)}"
    return "\n".join(lines)


def _line(rng: random.Random, text: str) -> str:
    """Another line somewhere."""
    lines = text.splitlines()
    lines.insert(rng.randrange(len(lines) + 1), rng.choice(LINES))
    return "\n".join(lines)


def _lost(rng: random.Random, text: str) -> str:
    """Some lines lost."""
    lines = text.splitlines()
    at = rng.randrange(len(lines) + 1)
    return "\n".join(lines[:at] + lines[at + rng.randrange(1, 6) :])


def _moved(rng: random.Random, text: str) -> str:
    """Some lines doubled, or in another place."""
    lines = text.splitlines() or [""]
    at, to = rng.randrange(len(lines)), rng.randrange(len(lines))
    part = lines[at : at + rng.randrange(1, 8)]
    return "\n".join(lines[:to] + part + lines[to:])


def _key(rng: random.Random, text: str) -> str:
    """A key or a name misspelt."""
    words = list(re.finditer(r"[A-Za-z_]{2,}", text))
    if not words:
        return text
    word = rng.choice(words)
    other = rng.choice((word[0][:-1], word[0] + "s", rng.choice(words)[0], word[0].upper(), ""))
    return text[: word.start()] + other + text[word.end() :]


def _number(rng: random.Random, text: str) -> str:
    """Another number."""
    numbers = list(re.finditer(r"-?\d+\.?\d*(e-?\d+)?", text))
    if not numbers:
        return text
    found = rng.choice(numbers)
    other = rng.choice(
        ("0", "-1", "1e9", "1e-9", "1e30", "1e-30", "1e300", "-" + found[0], found[0] + "0", "1e-320", "99999999999999999999")
    )
    return text[: found.start()] + other + text[found.end() :]


def _cut(rng: random.Random, text: str) -> str:
    return text[: rng.randrange(len(text) + 1)]


ACCIDENTS = (_value, _value, _value, _line, _line, _lost, _moved, _key, _key, _number, _number, _number, _cut)


ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
SCENES = ("profiles/swiss_lever", "profiles/bench_lever", "profiles/incline", "profiles/balance")
DESIGNS = ("carriage", "coaxial", "geneva", "graham", "involute_pair", "recoil_anchor", "set_a")
SEEDED = (*SCENES, *(f"profiles/{name}" for name in DESIGNS))


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
    answer = in_a_process(copies, lambda: judged(*commands))
    for report in copies.glob("watchsim-fault-*.txt"):
        report.unlink()
    shutil.rmtree(place.parent / "out", ignore_errors=True)
    return answer


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_numbers(parser, 500)
    parser.add_argument("--seed", default="")
    parser.add_argument("--command", choices=("run", "steady", "export", "turn"), default="run", help="besides the check")
    parser.add_argument("-o", "--output", type=Path, default=Path("results/fuzz"), help="where files that fail are kept")
    args = parser.parse_args()
    from watchsim.analysis.expectation_faults import expectation_faults
    from watchsim.commands.inputs import load_scene
    from watchsim.simulation.simulate import simulate

    # Loaded once, for all the processes that are forked.
    simulate(load_scene(str(ROOT / SCENES[2])), 1e-3)
    expectation_faults(load_scene(str(ROOT / SCENES[1])))
    with tempfile.TemporaryDirectory() as folder:
        for name in SEEDED:
            shutil.copytree(ROOT / name, Path(folder) / Path(name).name)

        def round_of(number: int) -> tuple[str, str, float]:
            name, content = damaged(number, args.seed)
            words, took = one(number, args.seed, Path(folder), args.command)
            if words not in FINE or args.only is not None:
                args.output.mkdir(parents=True, exist_ok=True)
                (args.output / f"scene-{args.seed}{number}.toml").write_bytes(content)
            return name, words, took

        what = f"scenes{f' of seed {args.seed}' if args.seed else ''}"
        sys.exit(campaign(args, round_of, what))


if __name__ == "__main__":
    main()
