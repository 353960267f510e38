"""The mechanisms of the profiles, each drawn as a whole in one file, as a designer would send it."""

from dataclasses import replace
from pathlib import Path

import ezdxf

from watchsim.drawing.write import dxf_text
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.roles import keeps_time, oscillators
from watchsim.scene.scene import Scene
from watchsim.scene.trains import start_poses

NAMES = ("swiss_lever", "bench_lever", "set_a", "coaxial", "geneva", "graham", "recoil_anchor", "involute_pair", "ratchet")


def scene_of(name: str) -> Scene:
    return load(profiles_dir() / name)


def assembly(scene: Scene, path: Path, layers: str = "own", marks: bool = True, without: tuple[str, ...] = ()) -> Path:
    """Draw a scene in `path`: what swings, and a lever, at rest, all else as it starts; fixed parts have no mark.

    layers  own: as in the drawings of the parts; body: with the body's name before; whole: the body's name;
            loose: everything on layer 0
    """
    springs = {spring.body for spring in scene.springs} if keeps_time(scene) else set()
    hang = {one.body: one.rest for one in oscillators(scene) if not one.spring}
    loops, points = [], []
    for body in scene.bodies:
        x, y, angle = start_poses(scene)[body.name]
        angle = 0.0 if springs and body.name in (*springs, "lever") else hang.get(body.name, angle)
        for loop in (*body.loops, *body.decoration):
            if loop.layer in without:
                continue
            before = f"{body.name}_{loop.layer}"
            name = {"own": loop.layer, "body": before, "whole": body.name, "loose": "0"}[layers]
            loops.append(replace(loop.moved(angle, (x, y)), layer=name))
        if body.motion != "fixed" and marks:
            points.append(("PIVOT", (x, y)))
    path.write_text(dxf_text(loops, points), encoding="utf-8")
    return path


def mirror(path: Path) -> Path:
    """A drawing seen from behind."""
    document = ezdxf.readfile(path)
    for entity in document.modelspace():
        entity.transform(ezdxf.math.Matrix44.scale(-1.0, 1.0, 1.0))
    document.saveas(path)
    return path
