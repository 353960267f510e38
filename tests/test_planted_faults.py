"""Is each planted fault one small change that still is Python, and are texts, types and messages left alone?"""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
if not (ROOT / "scripts").is_dir():
    pytest.skip("the scripts are not here", allow_module_level=True)
sys.path.insert(0, str(ROOT / "scripts" / "planted"))

from faults import faults  # noqa: E402

TEXT = '''"""Numbers 1 and 2."""
Side = str | float
def f(x: float, n: int = 3) -> float | None:
    """Less than 4."""
    if not x < 0.5 and n == 3:
        raise ValueError(f"{n + 1} is too much, {7}")
    return -x * max(x, 2.0) + abs(x) / 3
'''
EXPECTED = {
    *(("3", "4"), ("not x < 0.5 and n == 3", "(not x < 0.5 or n == 3)"), ("not x < 0.5", "(x < 0.5)"), ("x < 0.5", "x >= 0.5")),
    *(("0.5", "0.625"), ("n == 3", "n != 3"), ("-x * max(x, 2.0) + abs(x) / 3", "(-x * max(x, 2.0) - abs(x) / 3)")),
    *(("-x * max(x, 2.0)", "(-x / max(x, 2.0))"), ("-x", "(x)"), ("max(x, 2.0)", "min(x, 2.0)"), ("2.0", "2.5")),
    *(("abs(x) / 3", "(abs(x) * 3)"), ("abs(x)", "(x)")),
}


def test_what_is_planted_and_what_is_not() -> None:
    assert {(one.before, one.after) for one in faults(TEXT)} == EXPECTED


@pytest.mark.parametrize(
    "name", ["drawing/projection.py", "analysis/timegrapher.py", "render/movie.py", "dynamics/impact.py", "units.py"]
)
def test_every_fault_is_one_change_of_a_real_file(name: str) -> None:
    source = (ROOT / "watchsim" / name).read_text(encoding="utf-8")
    found = list(faults(source))
    assert len(found) > 20
    for one in found[:: len(found) // 20]:  # a source is taken apart for each
        assert ast.dump(ast.parse(one.source)) != ast.dump(ast.parse(source)), (one.line, one.before)
        line = source.encode().splitlines()[one.line - 1]
        assert line[one.column :].decode().startswith(one.before.splitlines()[0])
        assert len(one.source) == len(source) + len(one.after) - len(one.before)


def test_the_tests_that_reach_a_function_are_found_in_the_project() -> None:
    """Faults are planted in this copy of the package, not in a folder that is not there."""
    import plant_faults
    import reached

    assert reached.ROOT == plant_faults.ROOT == ROOT
    assert Path(reached.PACKAGE, "units.py").is_file()
    for files, tests in plant_faults.AREAS.values():
        assert all(any((ROOT / "watchsim").glob(pattern)) for pattern in files), files
        assert all((ROOT / name).exists() for name in tests), tests


def test_faults_are_planted_in_the_files_asked_for_in_order_or_at_random() -> None:
    import plant_faults

    every = plant_faults.chosen("reader", 0, 1, ["drawing/circles.py", "drawing/svg*.py", "units.py"])
    assert {one.file.partition("/")[0] for one in every} == {"drawing"} and len(
        {one.file for one in every}
    ) > 2  # units.py is no part of the area
    alone = plant_faults.chosen("reader", 0, 1, ["drawing/circles.py"])
    text = (ROOT / "watchsim" / "drawing" / "circles.py").read_text(encoding="utf-8")
    assert sorted((one.fault.line, one.fault.column, one.fault.after) for one in alone) == sorted(
        (one.line, one.column, one.after) for one in faults(text)
    )
    assert plant_faults.chosen("reader", 0, 1, ["drawing/circles.py"], 7) == alone[::7]
    sample = plant_faults.chosen("reader", 9, 1, ["drawing/circles.py"])
    assert len(sample) == 9 and all(one in alone for one in sample)


def test_the_rest_begins_with_what_reaches_the_place_and_stops_at_the_limit() -> None:
    import reached

    seconds = {"a.py::one": 1.0, "a.py::two": 0.5, "a.py::three": 4.0, "b.py::four": 0.1}
    known = reached.Reached(seconds, {"a.py::one": {("x.py", "f")}, "b.py::four": set()})
    names = known.with_neighbours(known.tests("x.py", "f"))
    assert names == ["a.py::one", "a.py::two", "a.py::three"]
    assert known.within(names, 1.5) == names[:2] and known.within(names, 9.0) == names
    assert known.within(names, 0.2) == names[:1] and known.within([], 1.0) == []


NESTED = """
LIMIT = 3
@cache
def f(x,
      y=1):
    def g():
        return 1
    return g
class C:
    size = 4
    @property
    def f(self):
        return 5
    @f.setter
    def f(self, value):
        self.x = value
h = lambda x: x + 1
"""


def test_functions_are_known_by_their_names_wherever_they_stand() -> None:
    """Not by lines, which move: inner ones, methods, a setter of its property's name."""
    import reached

    for text, shift in ((NESTED, 0), ("\n# Something above.\n" + NESTED, 2)):
        lines = {line: reached.function_of(text, line + shift) for line in range(2, 18)}
        assert lines == {
            **{2: "", 3: "", 4: "", 5: "", 6: "f", 7: "f.g", 8: "f", 9: "", 10: "", 11: "", 12: "", 13: "C.f"},
            **{14: "", 15: "", 16: "C.f 2", 17: "lambda"},
        }
        assert [one.first - shift for one in reached.functions(text)] == [3, 6, 11, 14, 17]
