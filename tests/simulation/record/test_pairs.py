"""Do the pairs of a run read like a tuple of all of them?"""

from __future__ import annotations

import functools
import pickle
from itertools import islice

import numpy as np
import pytest
from moving_scenes import profile

from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.simulation.record.contact_names import Pair, Pairs, as_pairs, pairs_of

WORDS = ("corner", "line", "arc")


@functools.cache
def lever() -> Compiled:
    return compile_scene(profile("swiss_lever"))


@functools.cache
def in_words() -> tuple[Pair, ...]:
    """One object for each contact of the lever, made one by one."""
    compiled = lever()

    def side(row: int) -> tuple[str, str, int, str]:
        owner = compiled.owners[row]
        return owner, WORDS[compiled.model.primitives[row].kind], row - compiled.owners.index(owner), compiled.layers[row]

    return tuple(Pair(int(one.group), *side(int(one.a)), *side(int(one.b))) for one in compiled.model.contacts)


def test_all_of_a_lever() -> None:
    pairs, expected = pairs_of(lever()), in_words()
    assert len(pairs) == len(expected) > 1000
    assert tuple(pairs) == expected and list(reversed(pairs)) == list(reversed(expected))
    assert [pairs[k] for k in range(len(pairs))] == list(expected)
    assert pairs == expected and expected == pairs and pairs == pairs_of(lever()) and hash(pairs) == hash(expected)
    assert str(pairs[7]) == str(expected[7]) and pairs[np.int32(7)] == expected[7]


def test_places_as_in_a_tuple() -> None:
    pairs, expected = pairs_of(lever()), in_words()
    for part in (slice(3, 9), slice(None, None, 400), slice(-5, None), slice(9, 3), slice(None, None, -300)):
        assert pairs[part] == expected[part]
    assert pairs[-1] == expected[-1] and expected[5] in pairs and pairs.index(expected[5]) == 5
    for place in (len(expected), -len(expected) - 1):
        with pytest.raises(IndexError):
            pairs[place]


def test_other_pairs_are_not_equal() -> None:
    pairs, expected = pairs_of(lever()), in_words()
    assert pairs != expected[:-1] and pairs != (*expected[1:], expected[0]) and pairs != as_pairs(expected[:-1])
    assert pairs != list(expected) and as_pairs(()) == () and len(as_pairs(())) == 0


def test_however_they_are_kept() -> None:
    pairs, expected = pairs_of(lever()), in_words()
    assert as_pairs(pairs) is pairs
    made = as_pairs(expected)
    assert isinstance(made, Pairs) and made == pairs and tuple(made) == expected
    assert pickle.loads(pickle.dumps(pairs)) == pairs


@pytest.mark.parametrize("name", ["wheel", "lever", "balance", "banking", "nothing"])
def test_those_of_a_body(name: str) -> None:
    expected = [name in (pair.body_a, pair.body_b) for pair in in_words()]
    assert pairs_of(lever()).of_body(name).tolist() == expected
    assert any(expected) == (name != "nothing")


def test_pairs_are_made_when_they_are_looked_at() -> None:
    """A million and more: what all of them cost is an array."""
    names = [("wheel", "arc", i, "T") for i in range(2000)]
    row, column = np.divmod(np.arange(2_000_000), 1000)
    pairs = Pairs(names, np.stack([np.zeros(len(row), int), row, 1000 + column], axis=1).astype(np.int32))
    assert len(pairs) == 2_000_000
    assert pairs[1_234_567] == Pair(0, *names[1234], *names[1567])
    assert list(islice(pairs, 2)) == [Pair(0, *names[0], *names[1000]), Pair(0, *names[0], *names[1001])]
    several = list(islice(pairs, 10_000))  # more than are made at a time
    assert [(pair.index_a, pair.index_b) for pair in several] == [(k // 1000, 1000 + k % 1000) for k in range(10_000)]
