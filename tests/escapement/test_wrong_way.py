"""Is a wheel that is driven the way in which its teeth do not lock reported, and no other?"""

import json
import math
from dataclasses import replace

import ezdxf
import pytest

import watchsim as ws
from watchsim.cli import main
from watchsim.construction import registry
from watchsim.escapement.measure import measure, wrong_way
from watchsim.paths import profiles_dir
from watchsim.scene.load import from_mapping, load
from watchsim.scene.scene import Scene

PROFILES = sorted(path.parent.name for path in profiles_dir().glob("*/scene.toml"))
TICKING_EITHER_WAY = ("graham", "recoil_anchor", "pin_pallet", "swiss_lever")


def reversed_drive(scene: Scene) -> Scene:
    turned = (replace(one, value=-one.value, table=tuple((at, -value) for at, value in one.table)) for one in scene.torques)
    return replace(scene, torques=tuple(turned))


def test_no_profile_and_no_design_is_said_to_be_driven_the_wrong_way():
    scenes = {name: load(profiles_dir() / name) for name in PROFILES}
    scenes |= {f"design {name}": from_mapping({"design": {"of": name}}, None) for name in registry.names()}
    assert {name: wrong_way(scene) for name, scene in scenes.items() if wrong_way(scene)} == {}


@pytest.mark.parametrize("name", TICKING_EITHER_WAY)
def test_a_reversed_drive_is_a_verdict(name):
    scene = reversed_drive(load(profiles_dir() / name))
    assert "Change the sign of the torque" in (wrong_way(scene) or "")
    found = ws.verdict(ws.simulate(scene, 12.0))
    assert found.name == "backwards" and not found.works and "Change the sign of the torque" in found.message


@pytest.mark.parametrize("teeth", (12, 17, 18))
def test_teeth_for_pins_that_lock_either_way_drop_far_where_they_are_driven_the_wrong_way(teeth):
    """With 18 teeth they lean against the way in which they work."""
    scene = from_mapping({"design": {"of": "pin_pallet", "teeth": teeth}}, None)
    said = wrong_way(reversed_drive(scene)) or ""
    assert wrong_way(scene) is None and "driven the other way" in said
    assert ("drop far between the pins" in said) == (teeth > 15)


@pytest.mark.parametrize("name", ("graham", "pin_pallet"))
def test_check_and_steady_say_it_of_a_scene_file(tmp_path, capsys, name):
    torque = load(profiles_dir() / name).torques[0].value
    options = [str(profiles_dir() / name), "--set", f"torques.0.value={-torque} N·m", "--json"]
    assert main(["check", *options]) == 0
    findings = json.loads(capsys.readouterr().out)["findings"]
    assert [one["severity"] for one in findings if one["code"] == "wrong-way"] == ["warning"]
    main(["steady", *options])
    assert json.loads(capsys.readouterr().out)["verdict"] == "backwards"


def test_dead_faces_drawn_as_splines_lock_as_arcs_do(tmp_path):
    """Fitted by arcs they lie a little to either side: that drives nothing."""
    ws.designs.graham().write(tmp_path)
    document = ezdxf.readfile(tmp_path / "pendulum.dxf")
    space = document.modelspace()
    for one in [one for one in space.query("LWPOLYLINE ARC") if one.dxf.layer == "PALLETS"]:
        for edge in list(one.virtual_entities()) if one.dxftype() == "LWPOLYLINE" else [one]:
            if edge.dxftype() == "ARC":
                space.add_spline(fit_points=list(edge.flattening(1e-4)), dxfattribs={"layer": "PALLETS"})
            else:
                space.add_line(edge.dxf.start, edge.dxf.end, dxfattribs={"layer": "PALLETS"})
        space.delete_entity(one)
    document.saveas(tmp_path / "pendulum.dxf")
    assert len(space.query("SPLINE")) >= 4
    pallets = measure(load(tmp_path)).pallets
    assert [math.degrees(one.lock.value) for one in pallets] == pytest.approx([0.4, 0.4], abs=2e-3)
    assert [math.degrees(one.lift.value) for one in pallets] == pytest.approx([2.0, 2.0], abs=2e-3)
