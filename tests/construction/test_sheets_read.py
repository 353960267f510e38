"""A design's sheet is read without the detour by its DXF file: nothing may differ but the handles in the names of entities."""

import dataclasses
import random
from pathlib import Path

import pytest

from watchsim.construction import registry
from watchsim.construction.design import Design
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read_data, read_sheet
from watchsim.scene.designed import designed


def without_handles(drawing: Drawing) -> Drawing:
    findings = tuple(dataclasses.replace(one, message=one.message.split("#")[0], fix="") for one in drawing.findings)
    return dataclasses.replace(drawing, findings=findings)


def drawn_at_random(design: Design, seed: int) -> dict[str, float]:
    chance = random.Random(f"{design.name}{seed}")
    share = 0.001 * seed
    return {
        one.name: one.default * (1.0 + share * chance.uniform(-1.0, 1.0))
        for one in design.dimensions
        if not one.count and one.name != "embraced"  # a whole number and a half
    }


@pytest.mark.parametrize("name", registry.names())
def test_a_sheet_gives_what_its_file_gives(name: str) -> None:
    design = designed(name)
    for seed in range(3):
        chosen = drawn_at_random(design, seed)
        assert not design.refusals(chosen)
        for file, sheet in design.sheets(design.chosen(chosen)).items():
            direct, read = read_sheet(sheet, Path(file)), read_data(sheet.dxf(), Path(file))
            assert without_handles(direct) == without_handles(read)
            assert direct.loops
