"""Does the repository need nothing that lies beside it?"""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
DOOR = "tests/strangers.py"  # the one place that may look outside
TEXT = {".py", ".toml", ".md", ".sh", ".ipynb", ".yaml", ""}
OUT = re.compile(
    r"""(?P<up>(?:\.\./)+)|parents\[(?P<index>\d+)\](?P<parent>\.parent)?|\bROOT\.parents?\b|/ ["']\.\.["']|os\.pardir"""
)


def leaving(path: str, text: str) -> list[str]:
    """What in a file (its path in the repository, its text) names a place outside."""
    depth = path.count("/")

    def leaves(found: re.Match[str]) -> bool:
        if found["up"]:
            return found["up"].count("/") > depth
        return found["index"] is None or int(found["index"]) + bool(found["parent"]) > depth

    return [found.group() for found in OUT.finditer(text) if leaves(found)]


@pytest.mark.parametrize(
    ("path", "text", "out"),
    [
        ("tests/a/b.py", 'parents[2] / "docs"', False),
        ("tests/a/b.py", 'parents[3] / "shared"', True),
        ("tests/a/b.py", 'parents[2].parent / "shared"', True),
        ("tests/b.py", "ROOT.parent", True),
        ("tests/b.py", 'folder / ".."', True),
        ("docs/guide/a.md", "../images/a.png", False),
        ("tests/a/scene.toml", "../../../shared/a.dxf", True),
    ],
)
def test_what_leaves_is_recognised(path: str, text: str, out: bool) -> None:
    assert bool(leaving(path, text)) is out


def test_nothing_leaves_the_repository_but_at_one_place() -> None:
    tops = [ROOT / name for name in ("tests", "scripts", "docs", "profiles", "watchsim", ".ci")]
    files = [path for top in tops for path in top.rglob("*") if path.is_file() and path.suffix in TEXT] + list(
        ROOT.glob("*.md")
    )
    own = {Path(__file__).relative_to(ROOT).as_posix()}
    assert len(files) > 500
    found = {
        name: leaving(name, path.read_text(encoding="utf-8"))
        for path in files
        if (name := path.relative_to(ROOT).as_posix()) not in own
    }
    assert [name for name, places in found.items() if places] == [DOOR]


# What tests of drawings and scenes that are not ours look for, and the tests that look for the same in our own. Where only some
# of a test's cases are strangers (test_real_drawings, test_meshes, test_mass_of_solids), the others are ours.
COUNTERPARTS = {
    "drawing/test_pin_lever_drawings.py": {
        "test_every_layer_is_closed_and_nothing_is_wrong":
            "drawing/test_own_drawings.py::test_every_layer_is_closed_and_nothing_is_wrong",
        "test_pivots_are_points":
            "drawing/test_own_drawings.py::test_single_parts_are_the_same_as_in_the_assembly",
        "test_wheel_has_fifteen_teeth_of_the_stated_radii":
            "drawing/test_own_drawings.py::test_the_wheel_has_its_teeth",
        "test_guard_pin_and_banking":
            "drawing/test_real_drawings.py::test_extents",
        "test_tilted_stop_is_an_ellipse_within_a_tenth_of_a_micrometre":
            "drawing/test_dxf_entities.py::test_tilted_circle_becomes_an_ellipse",
        "test_impulse_pin_is_smooth_arcs_not_two_thousand_facets":
            "drawing/test_ellipses_and_splines.py::test_polygon_spline_with_invisible_facets_becomes_arcs",
        "test_pallets_are_four_lines":
            "drawing/test_real_drawings.py::test_counts_of_what_comes_out",
        "test_single_parts_are_the_same_as_in_the_assembly":
            "drawing/test_own_drawings.py::test_single_parts_are_the_same_as_in_the_assembly",
    },
    "pin_lever/test_real_lever.py": {
        "test_as_drawn_it_jams_and_the_tool_says_where":
            "pin_lever/test_own_lever.py::test_with_the_wheel_too_near_it_jams_and_the_tool_says_where",
        "test_with_the_wheel_moved_away_it_ticks":
            "pin_lever/test_own_lever.py::test_with_the_wheel_where_it_is_drawn_or_further_away_it_ticks",
        "test_it_ticks_for_twenty_seconds":
            "profiles/test_every_profile.py::test_it_runs_for_five_minutes",
    },
    "drawing/test_real_drawings.py": {
        "test_drawings_without_geometry_are_errors":
            "drawing/test_broken_drawings.py::test_only_hidden_or_only_text_is_empty",
    },
    "proposal/test_propose.py": {
        "test_a_real_assembly":
            "proposal/test_propose.py::test_an_assembly_gives_its_bodies_pivots_and_contacts",
        "test_no_drawing_brings_it_down":
            "proposal/test_propose.py::test_no_drawing_of_our_own_brings_it_down",
    },
    "scene/test_whole_scenes.py": {
        "test_the_real_lever_loads":
            "scene/test_whole_scenes.py::test_profiles_load_do_not_overlap_and_lock",
        "test_bench_lever_agrees_with_its_source":
            "test_profiles_geometry.py::test_drawings_in_the_profile_are_what_the_script_draws",
    },
    "test_profiles_geometry.py": {
        "test_nothing_overlaps_in_the_real_lever":
            "test_profiles_geometry.py::test_nothing_overlaps_at_the_start",
        "test_bench_lever_is_the_published_scene":
            "test_profiles_geometry.py::test_bench_lever_measures_as_designed",
    },
}  # fmt: skip


def functions_of(name: str) -> tuple[set[str], set[str]]:
    """(the tests of a file, those of them that are of strangers alone)."""
    module = ast.parse((ROOT / "tests" / name).read_text(encoding="utf-8"))
    tests = [node for node in module.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")]
    marked = any(isinstance(node, ast.Assign) and ast.unparse(node).startswith("pytestmark = marks(") for node in module.body)
    strange = re.compile(r"needs\(|marks=MARKS\) for name in EMPTY")
    alone = {one.name for one in tests if marked or any(strange.search(ast.unparse(mark)) for mark in one.decorator_list)}
    return {one.name for one in tests}, alone


def test_what_is_looked_for_in_drawings_of_strangers_is_looked_for_in_our_own() -> None:
    users = [
        path.relative_to(ROOT / "tests").as_posix()
        for path in (ROOT / "tests").rglob("test_*.py")
        if "from strangers import" in path.read_text(encoding="utf-8") and path != Path(__file__)
    ]
    assert {name: alone for name in users if (alone := functions_of(name)[1])} == {k: set(v) for k, v in COUNTERPARTS.items()}
    for own in {one for table in COUNTERPARTS.values() for one in table.values()}:
        name, _, test = own.partition("::")
        tests, alone = functions_of(name)
        assert test in tests - alone, own
