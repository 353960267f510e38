"""Is it read rightly what to keep of a run?"""

import pytest

from watchsim.scene.errors import Faults
from watchsim.scene.keys import RUN
from watchsim.scene.read_settings import read_record
from watchsim.scene.scene import Recording, as_recording
from watchsim.scene.values import Table

WINDOWS = ((179.0, 180.0), (1.0, 2.0))


def read(value: object) -> tuple[Recording, list[str]]:
    faults = Faults("scene.toml")
    found = read_record(Table({"record": value}, "run", RUN, faults))
    try:
        faults.raise_any()
    except ValueError as error:
        return found, str(error).splitlines()
    return found, []


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ([], Recording()),
        ("all", Recording()),
        ("statistics", Recording(keep="statistics")),
        ("every 10", Recording(stride=10)),
        ("every 1", Recording(stride=1)),
        ("every 999999999", Recording(stride=999999999)),
        (["179 s", "180 s"], Recording(WINDOWS[:1])),
        ([["179 s", "180 s"], ["1 s", "2000 ms"]], Recording(WINDOWS)),
        (["statistics", ["179 s", "180 s"]], Recording(WINDOWS[:1], "statistics")),
        (["events", "every 3"], Recording((), "events", 3)),
    ],
)
def test_words_and_windows(value: object, expected: Recording) -> None:
    assert read(value) == (expected, [])


@pytest.mark.parametrize(
    ("value", "key", "said"),
    [
        ("statistic", "run.record", 'Did you mean "statistics"?'),
        ("evry 5", "run.record", 'Did you mean "every 10"?'),
        ("every", "run.record", '"every 10" for every tenth row'),
        ("every 0", "run.record", '"every 10" for every tenth row'),
        ("every 1000000000", "run.record", '"every 10" for every tenth row'),
        (["statistics", ["2 s", "1 s"]], "run.record.1", "from an earlier to a later time"),
        (["1 s"], "run.record", 'a window: two times, such as ["179 s", "180 s"]'),
        (["all", "statistics"], "run.record", "all and statistics exclude each other"),
        (["every 2", "every 3"], "run.record", "only one of every 2, every 3 can hold"),
        (["179", "180 s"], "run.record.0", "needs a unit"),
        ("x1", "run.record", "write all, events, statistics, "),
        (7, "run.record", "or a window: two times"),
        ("0.5 s", "run.record", "or a window: two times"),
    ],
)
def test_what_cannot_be_read(value: object, key: str, said: str) -> None:
    text = " ".join(read(value)[1])
    assert key in text
    assert said in text


def test_in_python() -> None:
    assert as_recording("events") == Recording(keep="events")
    assert as_recording([(1, 2)]) == Recording(((1.0, 2.0),))
    assert as_recording(None) is None
