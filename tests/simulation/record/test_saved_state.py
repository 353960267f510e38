"""Is a saved state that does not fit together, or belongs to another run, refused?"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
from moving_scenes import profile

from watchsim.mechanism.compile import compile_scene
from watchsim.simulation.record.saved_state import SavedState, model_digest, save_state

COMPILED = compile_scene(profile("incline"))
SETTINGS = {"method": "pfeiffer-glocker", "step": None, "tolerance": 1e-9, "gap": 1e-12}
TALLY = {name: np.zeros(2) for name in ("kinds", "beats", "moments", "last", "carried")}


def arrays() -> dict[str, np.ndarray]:
    return {"clock": np.array([2.5, 0.1, 0.0]), "q": np.array([1.0, 2.0, 3.0]), "returning": np.zeros(4)}


def state() -> SavedState:
    recorded = {"met": np.array(3), "last": np.array([2.5, 1.0]), "row": np.zeros(10), "stays": np.ones(7, bool)}
    saved = save_state(COMPILED, SETTINGS, arrays(), 0.25, dict(TALLY))
    return dataclasses.replace(saved, rows=7, events=4, recorded=recorded)


def test_a_state_is_whole_with_or_without_what_decides_about_rows() -> None:
    assert state().is_whole() and state().time == 2.5
    assert dataclasses.replace(state(), recorded={}).is_whole()
    assert dataclasses.replace(state(), events=0).is_whole()
    begun = {**state().recorded, "row": np.zeros(0), "stays": np.zeros(0, bool)}
    assert dataclasses.replace(state(), rows=0, recorded=begun).is_whole()


def recorded(name: str, value: object) -> Callable[[SavedState], SavedState]:
    return lambda whole: dataclasses.replace(whole, recorded={**whole.recorded, name: np.asarray(value)})


def array(name: str, value: object) -> Callable[[SavedState], SavedState]:
    return lambda whole: dataclasses.replace(whole, arrays={**whole.arrays, name: np.asarray(value)})


def given(**changed: object) -> Callable[[SavedState], SavedState]:
    return lambda whole: dataclasses.replace(whole, **changed)


BROKEN = {
    "no clock": given(arrays={"q": np.zeros(3)}),
    "another clock": array("clock", np.zeros(2)),
    "not a number": array("q", [0.0, np.nan, 0.0]),
    "no end": array("clock", [np.inf, 0.0, 0.0]),
    "a sum less": given(tally={name: TALLY[name] for name in list(TALLY)[1:]}),
    "a sum more": given(tally={**TALLY, "other": np.zeros(1)}),
    "no settings": given(settings=None),
    "energy as text": given(stored_at_start="0.25"),
    "negative events": given(events=-1),
    "half an event": given(events=0.5),
    "negative rows": given(rows=-1, recorded={}),
    "part of what decides": given(recorded={"met": np.array(3)}),
    "several numbers met": recorded("met", [3]),
    "half a row met": recorded("met", 3.0),
    "time alone": recorded("last", [2.5]),
    "whole seconds": recorded("last", [2, 1]),
    "a table for a row": recorded("row", np.zeros((1, 10))),
    "a row of whole numbers": recorded("row", np.zeros(10, int)),
    "fewer rows that stay": recorded("stays", np.ones(6, bool)),
    "numbers for rows that stay": recorded("stays", np.ones(7)),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_does_not_fit_together_is_not_whole(name: str) -> None:
    assert not BROKEN[name](state()).is_whole()


def test_a_state_goes_with_its_model_and_settings() -> None:
    state().check(COMPILED, SETTINGS)
    steeper = compile_scene(dataclasses.replace(profile("incline"), gravity=(0.0, -9.0)))
    with pytest.raises(ValueError, match="another scene"):
        state().check(steeper, SETTINGS)
    moved = dataclasses.replace(COMPILED, q=COMPILED.q + 1e-15)
    assert model_digest(moved) != model_digest(COMPILED) == model_digest(compile_scene(profile("incline")))
    assert len(model_digest(COMPILED)) == 16  # as in states that earlier versions have written


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"tolerance": 1e-6}, "tolerance was 1e-09, now 1e-06"),
        ({"tolerance": 1e-6, "method": "moreau", "step": 1e-5}, "method was pfeiffer-glocker, now moreau"),
        ({"gap": 1e-13}, "another version of watchsim .gap was 1e-12, now 1e-13"),
        ({"new": 1}, "another version of watchsim .new was None, now 1"),
    ],
)
def test_other_settings_are_named(changed: dict[str, object], words: str) -> None:
    """Of what is asked the first; what follows from it is not mentioned."""
    with pytest.raises(ValueError, match=words):
        state().check(COMPILED, {**SETTINGS, **changed})


def test_what_is_restored_is_what_was_saved() -> None:
    """Copies; what earlier versions had not begins blank."""
    source = arrays()
    saved = dataclasses.replace(save_state(COMPILED, SETTINGS, source, 0.25, {}), recorded={})
    source["q"][:] = 9.0
    room = {name: np.full_like(one, 7.0) for name, one in source.items()}
    saved.restore(room)
    assert {name: one.tolist() for name, one in room.items()} == {name: one.tolist() for name, one in arrays().items()}
    earlier = dataclasses.replace(saved, arrays={name: saved.arrays[name] for name in ("clock", "q")})
    room["returning"][:] = 7.0
    earlier.restore(room)
    assert room["returning"].tolist() == [0.0] * 4


@pytest.mark.parametrize("broken", [array("q", np.zeros(4)), array("other", 1.0), recorded("row", np.zeros(9))])
def test_a_state_of_another_shape_is_refused(broken: Callable[[SavedState], SavedState]) -> None:
    """A row holds t and three times as many numbers as there are coordinates."""
    state().restore(arrays())
    with pytest.raises(ValueError, match="another version"):
        broken(state()).restore(arrays())
