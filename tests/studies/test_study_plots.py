"""Are studies drawn, whatever their keys and gaps?"""

from __future__ import annotations

import io

import pytest

import watchsim as ws
from watchsim.render.study_plot import plot_sweep
from watchsim.studies.axes import Axis
from watchsim.studies.point import outputs_named
from watchsim.studies.sweep import Sweep

TORQUE = Axis("torques.0.value", (-1e-6, -2e-6, -3e-6), "N·m", "µN·m")
FRICTION = Axis("contacts.0.friction", tuple(0.01 * i for i in range(9)))
DRAWING = Axis("bodies.wheel.drawing", ("a.dxf", "b.dxf"))


def made(*axes):
    import itertools

    rows = []
    for values in itertools.product(*(axis.values for axis in axes)):
        row = dict(zip((axis.key for axis in axes), values, strict=True))
        good = len(rows) % 4 != 3
        row |= {"amplitude_deg": 280.0 - len(rows) if good else None, "amplitude_deg_error": 0.1 if good else None}
        rows.append({**row, "verdict": "ticks" if good else "knocks", "message": ""})
    return Sweep("A watch", axes, outputs_named(["amplitude"]), tuple(rows), True, 0.0)


def words(figure):
    figure.savefig(io.BytesIO(), format="png")
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    labels = [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]
    return texts + labels + [axes.get_title(loc="right") for axes in figure.axes]


def test_a_curve_in_usual_units_with_what_failed():
    found = words(plot_sweep(made(FRICTION)))
    assert "contacts.0.friction" in found and "amplitude (°)" in found and "knocks" in found


def test_a_family_and_a_map():
    figure = plot_sweep(made(TORQUE, DRAWING))
    assert "torques.0.value (µN·m)" in words(figure)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a.dxf", "b.dxf"]
    other = Axis("springs.0.stiffness", tuple(1e-6 * (1.0 + 0.1 * i) for i in range(8)), "N·m/rad", "µN·m/rad")
    assert "grey: knocks" in words(plot_sweep(made(FRICTION, other)))


def test_what_cannot_be_drawn():
    with pytest.raises(ValueError, match="one or two keys"):
        plot_sweep(made(DRAWING))
    with pytest.raises(ValueError, match="one or two keys"):
        plot_sweep(made(TORQUE, FRICTION, DRAWING))


def test_from_the_package():
    assert ws.plot_sweep is plot_sweep
