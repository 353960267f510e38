"""Which rule of a style sheet counts, and where does one end?"""

from __future__ import annotations

from collections.abc import Callable

import pytest
import svg_text as s

from watchsim.drawing.drawing import Drawing

Reader = Callable[..., Drawing]


def shown(read_svg: Reader, style: str, attributes: str, around: str = "{}") -> bool:
    """Is a line with these attributes drawn, beside one that always is?"""
    line = s.path("M0 0L5 5", attributes)
    drawing = read_svg(s.svg(f"<style>{style}</style>{around.format(line)}<polyline points='9,9 20,9'/>"))
    return len(s.edges(drawing)) == 2


@pytest.mark.parametrize(
    ("style", "attributes", "is_shown"),
    [
        (".a{display:none}.b{display:none}", 'class="b"', False),
        (".a{display:none}\n.b{display:none}", 'class="c"', True),
        (".a{display:none} path{display:inline}", 'class="a"', False),
        ("path{display:none} .a{display:inline}", 'class="a"', True),
        (".a{display:inline} .b{display:none}", 'class="b a"', False),
        (".b{display:none} .a{display:inline}", 'class="b a"', True),
        ("#k{display:inline} .a.b{display:none}", 'id="k" class="a b"', True),
        (".a.b{display:inline} .a{display:none}", 'class="a b"', True),
        ("[id]{display:none} path{display:inline}", 'id="k"', False),
        (".a[id]{display:inline} .a{display:none}", 'id="k" class="a"', True),
        ("*{display:inline} path{display:none}", "", False),
        ("path{display:none} *{display:inline}", "", False),
        (".a{display:none!important} #k{display:inline}", 'id="k" class="a"', False),
        (".a{display:none ! IMPORTANT} #k{display:inline!important}", 'id="k" class="a"', True),
        (".a{display:none} ", 'class="a" style="display:inline"', True),
        (".a{display:none!important} ", 'class="a" style="display:inline"', False),
        (".a{display:inline!urgent} #k{display:none}", 'id="k" class="a"', False),
        (".a{display:inline;display:none}", 'class="a"', False),
        (".a{display:none!important;display:inline}", 'class="a"', False),
        ("@font-face{src:x}.a{display:none}", 'class="a"', False),
        ("@media print{.a{display:none}}.b{display:none}", 'class="b"', False),
        ("@media print{.a{display:none}}.b{display:none}", 'class="a"', True),
    ],
)
def test_the_most_particular_rule_counts_and_of_equals_the_last(
    read_svg: Reader, style: str, attributes: str, is_shown: bool
) -> None:
    assert shown(read_svg, style, attributes) is is_shown


@pytest.mark.parametrize(
    ("style", "around", "is_shown"),
    [
        ("g path{display:none}", "<g><g>{}</g></g>", False),
        ("g path{display:none}", "{}", True),
        ("g>path{display:none}", "<g>{}</g>", False),
        (".o>path{display:none}", '<g class="o"><g>{}</g></g>', True),
        (".o path{display:none}", '<g class="o"><g>{}</g></g>', False),
        (".o g>path{display:none}", '<g class="o"><g>{}</g></g>', False),
        (".o>.o path{display:none}", '<g class="o"><g>{}</g></g>', True),
        (".o,.p path{display:none}", '<g class="p">{}</g>', False),
    ],
)
def test_rules_for_what_lies_within(read_svg: Reader, style: str, around: str, is_shown: bool) -> None:
    assert shown(read_svg, style, "", around) is is_shown


@pytest.mark.parametrize(
    ("style", "told"),
    [
        ("@media print{.a{display:none}}", True),
        ("@media print{.a{stroke:red}}", False),
        ("@media print{.a{color:red;cursor:help}}", False),
        ("@media print{.a{r : 2px}}", True),
        ("@supports (x:y){.a{visibility:hidden}}", True),
        ("@font-face{display:none}", False),
        ('@import "other.css";', True),
    ],
)
def test_rules_that_are_not_read_are_told_where_they_could_hide_something(read_svg: Reader, style: str, told: bool) -> None:
    drawing = read_svg(s.svg(f"<style>{style}</style>{s.path('M9 9L20 9')}"))
    assert bool({"css", "external"} & set(s.codes(drawing))) is told
