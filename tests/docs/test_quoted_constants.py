"""Are the constants that pages quote those of the code?

Each entry holds the page's words with {} in the place of the number, and what the code says there. A page that is rewritten
without the number fails as well: then the entry goes, or the words change here, too.
"""

import math
import re
from pathlib import Path

import pytest

from watchsim import tolerances
from watchsim.analysis import verdict as settling
from watchsim.contact import cells as cell_grid
from watchsim.drawing import chaining as chain
from watchsim.drawing import circles as facets
from watchsim.drawing import projection as plane_projection
from watchsim.drawing import read
from watchsim.drawing import svg as svg_file
from watchsim.drawing import svg_elements as xml_elements
from watchsim.scene import keys
from watchsim.scene import load as read_scene
from watchsim.scene import trains as carriers
from watchsim.simulation import event_loop as advance
from watchsim.simulation import moreau_percussions as prox_relaxation
from watchsim.simulation import overlap_sieve as watched_instants
from watchsim.simulation import overlap_watch
from watchsim.simulation import step_path as root_bracket

DOCS = Path(__file__).resolve().parents[2] / "docs"
WORDS = {
    **{"twice": 2, "two": 2, "three": 3, "seven": 7, "eight": 8, "ten": 10, "a fifth": 0.2, "a tenth": 0.1},
    "an eighth": 0.125,
}
WORDS |= {"sixteenth": 16, "a millionth": 1e-6}
POWERS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
NANO, MICRO = 1e-9, 1e-6
INSTANT = tolerances.SAME_INSTANT * tolerances.ACCUMULATION_TIME

METHOD = "theory/method.md"
GEOMETRY = "theory/contact-geometry.md"
LAWS = "theory/laws.md"
DESIGN = "develop/design.md"
SCENE = "guide/scene-file.md"
DRAWINGS = "guide/drawings.md"
VERDICTS = "guide/verdicts.md"

QUOTED = [
    (METHOD, "Accelerations below {} of the terms", tolerances.ACCELERATION_ROUNDING),
    (METHOD, "w_NᵀM⁻¹w_N ≤ {} w_TᵀM⁻¹w_T take no part", tolerances.IMMOVABLE),
    (METHOD, "G_N − μ sgn(ġ_T) G_c ≤ {} G_N and carries a force", tolerances.PAINLEVE),
    (METHOD, "an approach of {} of the slip", tolerances.NUDGE),
    (METHOD, "Where it exceeds {} of the kinetic energy", tolerances.ENERGY_GAIN),
    (METHOD, "Lemke on {} other paths", tolerances.LCP_PATHS),
    (METHOD, "(up to {} sets)", tolerances.MODE_SETS),
    (METHOD, "missed by more than {} of the driving load", tolerances.LCP_ROUGH),
    (METHOD, "below `accumulation_time` ({} of the scene's unit", tolerances.ACCUMULATION_TIME),
    (METHOD, "rises by no more than {} `gap_zero`", tolerances.HIDDEN_REBOUND),
    (METHOD, "`gap_zero` ({} of the scene's size)", tolerances.HIDDEN_REBOUND * tolerances.GAP_ZERO),
    (METHOD, "has just taken or {} of the kinetic energy", tolerances.CHATTER_BACK),
    (METHOD, "({} in any case), the impacts go on", tolerances.CHATTER_GAIN),
    (METHOD, "turn by less than {} rad are handed over as tangent", tolerances.SMOOTH_TURN),
    (METHOD, "So the error is at most {} of the energy times", tolerances.SMOOTH_TURN**2),
    (METHOD, "all but sin²φ ≤ {} of it", tolerances.DEPENDENT_IN_STEPS),
    (METHOD, "({} at events, where rates", tolerances.DEPENDENT_AT_EVENTS),
    (METHOD, "a gap rate that is not rounding ({} of its terms)", tolerances.CONTRADICTING_RATE * tolerances.RATE_ROUNDING),
    (METHOD, "by less than {} `speed_zero` is not corrected", tolerances.SLIP_SLACK),
    (METHOD, "account for, and beyond that by at most {} of itself", tolerances.EXPLAINED_SHARE),
    (METHOD, "or by that of {} `speed_drift`", tolerances.STOPPABLE_SPEED),
    (METHOD, "may not exceed {} of the energy turned over", tolerances.LEDGER_SHARE),
    (METHOD, "turned over, or {} times the tolerance", tolerances.LEDGER_PER_TOLERANCE),
    (METHOD, "a bisection whenever {} steps have not halved", root_bracket.LOOK_EVERY),
    (METHOD, "Within an instant ({} ns)", INSTANT / NANO),
    (METHOD, "forces are not unique (2.4), is made {} times larger", tolerances.LENIENCE_STEP),
    (METHOD, "until the next instant, at most {} times", math.log(tolerances.MOST_LENIENT, tolerances.LENIENCE_STEP)),
    (METHOD, "and {} such terms, so decisions", math.log(tolerances.MOST_LENIENT, tolerances.LENIENCE_STEP) + 1),
    (METHOD, "More than {} events within an instant", advance.EVENTS_AT_ONCE),
    (METHOD, "no acceleration beyond rounding ({} of the forces", tolerances.SLEEP),
    (METHOD, "Bodies that overlap by up to {} nm therefore touch", tolerances.DRAWING_ROUNDING / NANO),
    (METHOD, "chords deviate by at most {} nm", tolerances.CHORDS_NEAR / NANO),
    (METHOD, "what that adds is added to the {} nm", tolerances.DRAWING_ROUNDING / NANO),
    (METHOD, "over the contacts within {} nm of a touch", tolerances.TOUCH_REACH * tolerances.DRAWING_ROUNDING / NANO),
    (METHOD, "until no gap is below {} `gap_zero`", tolerances.OVERLAP_GONE),
    (METHOD, "by more than {} times the rounding", tolerances.FURTHEST_TAKEN_BACK),
    (METHOD, "deeper than {} of the scene's size", tolerances.OVERLAP_RESOLUTION),
    (METHOD, "chords deviate by {} of that", overlap_watch.CHORD),
    (METHOD, "(of {} coordinates at a time)", watched_instants.FEW),
    (METHOD, "within a way, steps of {} of the", watched_instants.STRIDE),
    (METHOD, "the state at each {} of the scene's duration", overlap_watch.LOOKS),
    (METHOD, "looked at when {} have come together", overlap_watch.STATES_TOGETHER),
    (METHOD, "when {} ways between rows have come together", overlap_watch.TOGETHER),
    (METHOD, "fails beyond {} of the size", tolerances.STEPPED_OVERLAP),
    (METHOD, "and {} of the overlap is taken back", tolerances.TAKEN_BACK),
    (METHOD, "by {} of their own mobility", tolerances.YIELD),
    (METHOD, "none changes by more than {} of the largest", tolerances.SETTLED),
    (METHOD, "After {}, 64, 128 … sweeps", prox_relaxation.FIRST),
    (GEOMETRY, "Edges shorter than {} of the scene's size", tolerances.JOINT_RESOLUTION),
    (GEOMETRY, "larger than {} rad", tolerances.JOINT_RESOLUTION),
    (GEOMETRY, "the scene's size, than {} of the size over its radius", tolerances.JOINT_RESOLUTION),
    (GEOMETRY, "more than the rounding of drawings, {} nm", tolerances.DRAWING_ROUNDING / NANO),
    (GEOMETRY, "Pairs of bodies with at most {} reachable pairs", cell_grid.FEW_CONTACTS),
    (GEOMETRY, "travels {} to 2 % of its reach", 100.0 * cell_grid.FINEST_SHARE),
    (GEOMETRY, "1 to {} % of its reach", 100.0 * cell_grid.CELL_SHARE),
    (LAWS, "where Λ_TC = 0 (to {} of the cone)", tolerances.NO_TANGENTIAL),
    (LAWS, "counts as jammed from {} G_N on", tolerances.PAINLEVE),
    (DESIGN, "convex turns above {} rad get a corner", tolerances.JOINT_RESOLUTION),
    (DESIGN, "no more than the rounding of drawings ({} nm)", tolerances.DRAWING_ROUNDING / NANO),
    (SCENE, "overlaps there by no more than {} nm", tolerances.DRAWING_ROUNDING / NANO),
    (SCENE, "`duration` (default {} s)", keys.RUN["duration"].default),
    (SCENE, "the relative error per step (default {})", keys.RUN["tolerance"].default),
    (SCENE, '`"{} µm"` |', read.SNAP / MICRO),
    (SCENE, "up to {} times as far they are joined", chain.NOTED),
    (SCENE, "lies on its pivot to {} of its size", carriers.POISED),
    (SCENE, "within {} % of which it must lie", 100.0 * read_scene.FAR_OFF),
    (DRAWINGS, "away than {} µm (`--fit`)", read.FIT / MICRO),
    (DRAWINGS, "Drawings of more than {} pieces", plane_projection.MOST_STROKES),
    (DRAWINGS, "unfold into more than {} pieces", plane_projection.UNFOLDED),
    (DRAWINGS, "files above {} MB are refused", read.LARGEST_FILE / 1e6),
    (DRAWINGS, "elements more than {} deep", xml_elements.DEEPEST),
    (DRAWINGS, "unfold into more than {} elements", svg_file.MOST_VISITS),
    (DRAWINGS, "Ends within {} µm are joined (`snap`)", read.SNAP / MICRO),
    (DRAWINGS, "are joined (`snap`); up to {} times that", chain.NOTED),
    (DRAWINGS, "with turns below {}°", math.degrees(facets.SHARPEST)),
    (VERDICTS, "will still change by more than {} %", 100.0 * settling.SETTLED),
    (VERDICTS, "a drift counts beyond {} standard errors", settling.SURE),
]


@pytest.mark.parametrize(("page", "words", "value"), QUOTED, ids=[words for _, words, _ in QUOTED])
def test_a_quoted_constant_is_that_of_the_code(page, words, value):
    text = " ".join((DOCS / page).read_text(encoding="utf-8").split())
    before, after = words.split("{}")
    found = re.findall(f"{re.escape(before)}(.{{1,12}}?){re.escape(after)}", text)
    assert len(found) == 1, f"{page} says this {len(found)} times"
    assert number(found[0]) == pytest.approx(value, rel=1e-12)


def test_the_rows_looked_at_in_any_case():
    assert (0, *(4**i for i in range(6))) == watched_instants.EARLY
    assert "rows 0, 1, 4, 16 … 1024" in (DOCS / METHOD).read_text(encoding="utf-8")


def number(text: str) -> float:
    """The number that stands there as 10⁻¹², 3·10⁻¹¹, 50 000, 1e-9 or in words."""
    if text in WORDS:
        return WORDS[text]
    power = re.fullmatch(r"(?:([0-9.]+)·)?10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", text)
    if power:
        return float(power[1] or 1) * 10.0 ** int(power[2].translate(POWERS))
    return float(text.replace(" ", ""))


@pytest.mark.parametrize(
    ("text", "value"), [("10⁻¹²", 1e-12), ("3·10⁻¹¹", 3e-11), ("2.5·10⁴", 2.5e4), ("50 000", 5e4), ("1e-9", 1e-9), ("ten", 10)]
)
def test_numbers_are_read_as_they_are_written(text, value):
    assert number(text) == pytest.approx(value, rel=1e-15)
