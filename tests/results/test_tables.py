"""Are events and numbers written as a slow writer, row by row, would write them?"""

import csv
import io
import json
import math
from enum import Enum
from pathlib import Path, PurePath
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.results import tables as module
from watchsim.results.tables import HEAD, EventLines, json_text, plain, write_events
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.recording import Pair
from watchsim.simulation.state import EVENT_DTYPE, EventKind

SCENE = Scene("Made", (Body("wheel"), Body('odd, "name"'), Body("lever")))
PAIRS = (
    Pair(0, "wheel", "corner", 3, "TEETH", "lever", "line", 5, "STONES"),
    Pair(1, 'odd, "name"', "arc", 7, "PIN", "lever", "line", 2, "FORK"),
    Pair(1, "lever", "arc", 4, "", "wheel", "corner", 11, "ARMS, left"),
)


def made(count: int, seed: int = 3) -> Any:
    """Some at one instant, some without a contact, a body or an impulse."""
    rng = np.random.default_rng(seed)
    events = np.zeros(count, EVENT_DTYPE)
    events["t"] = np.sort(rng.choice([0.0, 1e-7, 0.1, 1.0 / 3.0, 2.5], count))
    events["kind"], events["contact"] = rng.choice(list(EventKind), count), rng.integers(-1, len(PAIRS), count)
    events["body"] = rng.integers(-1, len(SCENE.bodies), count)
    for name in ("impulse_normal", "impulse_tangential", "energy_lost"):
        events[name] = rng.choice([0.0, 0.0, 0.0, -0.0, 1.5e-9, -2.0], count)
    events["value"] = rng.choice([0.0, -0.0, -1.0, 0.1, np.nan], count)
    return events


def slowly(events: Any) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow(HEAD.decode().rstrip().split(","))
    names = [body.name for body in SCENE.bodies]
    for event in events:
        contact, body = int(event["contact"]), int(event["body"])
        sides: tuple[object, ...] = ("", names[body] if body >= 0 else "", "")
        if contact >= 0:
            pair = PAIRS[contact]
            first = f"{pair.layer_a} {pair.primitive_a} {pair.index_a}"
            sides = contact, f"{pair.body_a}/{pair.body_b}", f"{first} / {pair.layer_b} {pair.primitive_b} {pair.index_b}"
        sizes = [repr(float(event[name])) for name in ("impulse_normal", "impulse_tangential", "energy_lost", "value")]
        writer.writerow([repr(float(event["t"])), EventKind(int(event["kind"])).name.lower(), *sides, *sizes])
    return out.getvalue()


def written(path: Path) -> str:
    return path.read_bytes().decode()


@pytest.mark.parametrize("at_once", [3, 7, 1000])
@pytest.mark.parametrize("count", [0, 1, 2, 60])
def test_events_are_those_of_a_slow_writer(count: int, at_once: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "ROWS", at_once)
    run: Any = SimpleNamespace(scene=SCENE, pairs=PAIRS, events=made(count))
    write_events(run, tmp_path / "events.csv")
    assert written(tmp_path / "events.csv") == slowly(run.events)


@pytest.mark.parametrize("begun", [(), (0,), (5,), (3, 4), (10,)])
def test_a_table_that_was_begun_while_the_run_went_on(begun: tuple[int, ...], tmp_path: Path) -> None:
    run: Any = SimpleNamespace(scene=SCENE, pairs=PAIRS, events=made(10))
    lines = EventLines(SCENE, PAIRS, tmp_path)
    for count in begun:
        lines.add(run.events[lines.rows : lines.rows + count])
    assert lines.rows == sum(begun)
    lines.settle(run)
    lines.write(run, tmp_path / "events.csv")
    assert written(tmp_path / "events.csv") == slowly(run.events)
    assert [path.name for path in tmp_path.iterdir()] == ["events.csv"]


def test_a_table_that_could_not_be_settled_is_written_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run: Any = SimpleNamespace(scene=SCENE, pairs=PAIRS, events=made(10))
    for settled in (True, False):
        lines = EventLines(SCENE, PAIRS, tmp_path)
        lines.add(made(4, 99))  # something else: it must not be in the file
        if settled:
            monkeypatch.setattr(lines, "rest", lambda run: (_ for _ in ()).throw(OSError("full")))
            lines.settle(run)
        lines.write(run, tmp_path / f"{settled}.csv")
        assert written(tmp_path / f"{settled}.csv") == slowly(run.events)


class Colour(Enum):
    """An enum whose values are something else than its names."""

    RED = 3


def test_everything_becomes_what_json_knows() -> None:
    folder = PurePath("a") / "b"
    given = {
        **{"text": "Größe", "whole": 3, "true": True, "no": None, "number": 2.5, 7: Colour.RED, "path": Path(folder)},
        **{"np": (np.float64(0.1), np.int64(-4), np.bool_(True), np.float32(0.5)), "array": np.array([[1, 2], [3, 5]])},
        "not": [math.nan, -math.inf, np.float64("nan"), np.array([1.5, np.inf])],
    }
    expected = {
        **{"text": "Größe", "whole": 3, "true": True, "no": None, "number": 2.5, "7": "RED", "path": str(folder)},
        **{"np": [0.1, -4, True, 0.5], "array": [[1, 2], [3, 5]], "not": [None, None, None, [1.5, None]]},
    }
    assert plain(given) == expected and list(plain(given)) == list(expected)
    assert [type(one) for one in plain(given)["np"]] == [float, int, bool, float]
    assert json.loads(json_text(given)) == expected and json_text({"a": "Größe"}) == '{\n  "a": "Größe"\n}\n'
