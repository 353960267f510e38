"""Which made-up scenes use, between them, every key and most units of a scene file?"""

from __future__ import annotations

from pathlib import Path

import dxf_text as d

MARKS = d.record("POINT", *d.point(10, (1, 2)), layer="PIVOT") + d.record("POINT", *d.point(10, (3, 2)), layer="PLACE")
DRAWING = d.dxf(
    d.lwpolyline([(-2, 0), (4, 0, 0.4), (4, 4), (-2, 4)], True, "PLATE")
    + d.circle(1, 2, 0.5, layer="BORE")
    + d.circle(3, 1, 0.25, layer="PINS")
    + d.circle(3, 3, 0.25, layer="PINS")
    + d.lwpolyline([(10, 0), (10.5, 0), (10.5, 3), (10, 3)], True, "STAFF")
    + d.line((10, -1), (10, 4), "AXIS")
    + d.lwpolyline([(5, 2), (5.4, 2), (5.4, 2.2), (5, 2.2)], True, "SCREW")
    + d.line((4.5, 2), (6, 2), "SCREW_AXIS")
    + d.line((-3, 0), (-3, 4), "BANK")
    + MARKS
)
SCENES = {
    "forces": """
[scene]
title = "Forces"
gravity = ["0.1 m/s²", "-9.81 N/kg"]
tangential_law = "pg1996"
nu = 0.3
[bodies.balance]
circle = "0.12 inch"
inertia = "12 mg·cm²"
angle = "-0.75 rev"
velocity = "60 rpm"
[bodies.slider]
line = [["0 mm", "1 mm"], ["2 mm", "1 mm"]]
motion = "slide"
axis = [3, 4]
mass = "2.5 g"
position = ["1 cm", "20 mm"]
velocity = "-3 mm/s"
[bodies.stone]
polygon = [["-1 mm", "0 mm"], ["1 mm", "0 mm"], ["0.25 mm", "3 mm"]]
motion = "free"
mass = "80 mg"
inertia = "0.6 g·mm²"
position = ["-20 mm", "0.5 cm"]
velocity = ["1 mm/s", "-2 mm/s"]
spin = "5 °/s"
[bodies.pendulum]
mass = "1.2 kg"
inertia = "0.4 kg·m²"
centre_of_mass = ["10 mm", "-0.4 m"]
position = ["1 m", "0 m"]
[bodies.stop]
circle = "300 µm"
motion = "fixed"
position = ["-8 mm", "0 mm"]
[[springs]]
body = "balance"
frequency = "21600 vph"
rest = "2°"
draw = { inner = "0.5 mm", outer = "2.8 mm", turns = 12, stud = "80°", width = "0.04 mm" }
[[springs]]
body = "slider"
stiffness = "40 N/m"
preload = "5 mN"
stop = "0.2 mm"
restitution = 0.3
[[springs]]
body = "pendulum"
leaf = { modulus = "200 GPa", length = "5 mm", width = "0.5 mm", thickness = "0.08 mm", arm = "2 mm" }
rest = "3°"
[[torques]]
body = "balance"
over = "time"
table = [["0 s", "-1 µN·m"], ["20 ms", "0.5 mN·mm"], ["0.1 s", "0 µN·m"]]
period = "0.2 s"
[[torques]]
body = "slider"
over = "travel"
table = [["0 mm", "1 mN"], ["3 mm", "2 gf"]]
[[damping]]
body = "balance"
q_factor = 210
coulomb = "3 nN·m"
[[damping]]
body = "slider"
viscous = "0.4 mN·s/m"
quadratic = "2 N·s²/m²"
coulomb = "1 mN"
[[damping]]
body = "pendulum"
viscous = "0.6 mN·m·s/rad"
quadratic = "1 mN·m·s²/rad²"
[[contacts]]
between = ["slider", "stop"]
friction = "12 %"
restitution = 0.4
tangential_restitution = 0.2
[[contacts]]
between = ["stone", "slider"]
[[line_springs]]
between = ["balance", "slider"]
points = [["2 mm", "0 mm"], ["1 mm", "1 mm"]]
stiffness = "20 N/m"
length = "9 mm"
viscous = "0.05 N·s/m"
[[line_springs]]
between = ["stone"]
points = [["0 mm", "1 mm"], ["-30 mm", "4 mm"]]
leaf = { modulus = "100 GPa", length = "8 mm", width = "1 mm", thickness = "0.1 mm" }
tension = "-2 mN"
[run]
duration = "2 min"
tolerance = 1e-7
record = [["1 s", "90 s"], ["119 s", "2 min"]]
[timegrapher]
lift_angle = "51.5°"
frequency = "3 Hz"
[expect]
amplitude = { value = "270°", tolerance = "2°" }
impacts = { value = 3, tolerance = 1 }
rate = { value = "4 s/d", tolerance = "0.5 s/d" }
""",
    "drawn": """
[bodies.lever]
drawing = "plate.dxf"
layers = ["PLATE"]
draw = ["SCREW"]
pivot = "PIVOT"
angle = "7°"
[[bodies.lever.solids]]
layer = "PLATE"
thickness = "0.2 mm"
density = "7.85 g/cm³"
bores = ["BORE"]
[[bodies.lever.solids]]
layer = "STAFF"
turned = "AXIS"
density = "8000 kg/m³"
[[bodies.lever.solids]]
layer = "SCREW"
turned = "SCREW_AXIS"
lying = true
count = 4
density = "15.5 g/cm³"
[[bodies.lever.solids]]
hairspring = true
inner = "0.6 mm"
outer = "2.6 mm"
turns = 13
width = "0.03 mm"
thickness = "0.11 mm"
density = "8.1 g/cm³"
[bodies.lever.adjust]
PLATE = { turn = "0.5°", about = "PIVOT", shift = ["1 µm", "-2 µm"] }
[bodies.bank]
drawing = "plate.dxf"
layers = ["BANK", "PINS"]
motion = "fixed"
position = ["30 mm", "0 mm"]
material = { BANK = ["-5 mm", "1 mm"] }
[bodies.bank.adjust]
PINS = [
  { near = ["3 mm", "1 mm"], radial = "20 µm", about = ["1 mm", "2 mm"] },
  { near = ["3 mm", "3 mm"], shift = ["0 mm", "0.1 mm"] },
]
[bodies.imperial]
drawing = "plate.dxf"
units = "inch"
snap = "2 µm"
layers = ["PLATE"]
pivot = ["1 inch", "2 inch"]
position = ["0.3 m", "0 mm"]
mass = "1 kg"
inertia = "30 kg·cm²"
[[springs]]
body = "imperial"
stiffness = "2 N·m/rad"
[[contacts]]
between = ["lever.PLATE", "bank.BANK"]
friction = 0.2
[[contacts]]
between = ["lever", "bank.PINS"]
""",
    "trains": """
[scene]
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.barrel]
inertia = "2 g·cm²"
mass = "3 g"
[bodies.wheel]
inertia = "0.2 g·cm²"
position = ["12 mm", "0 mm"]
[bodies.pinion]
inertia = "30 mg·cm²"
position = ["20 mm", "3 mm"]
velocity = "2 rev/min"
[bodies.crown]
inertia = "40 mg·cm²"
position = ["0 mm", "30 mm"]
[bodies.rack]
motion = "slide"
axis = [1, 0]
mass = "1 g"
position = ["0 mm", "40 mm"]
[bodies.carriage]
inertia = "20 mg·cm²"
position = ["60 mm", "0 mm"]
velocity = "6 °/s"
[bodies.balance]
on = "carriage"
position = ["5 mm", "1 mm"]
angle = "-100 °"
mass = "40 mg"
inertia = "12 mg·cm²"
circle = "1 mm"
[bodies.bridge]
on = "carriage"
motion = "fixed"
position = ["-4 mm", "0 mm"]
angle = "30°"
mass = "90 mg"
inertia = "8 mg·cm²"
circle = "0.5 mm"
[bodies.planet]
on = "carriage"
position = ["0 mm", "6 mm"]
mass = "10 mg"
inertia = "1 mg·cm²"
[bodies.driver]
motion = "driven"
swing = { amplitude = "10°", frequency = "2 Hz", phase = "30°" }
position = ["90 mm", "0 mm"]
[bodies.pusher]
motion = "driven"
path = [["0.1 s", "36°"], ["0.2 s", "36°"], ["0.4 s", "0°"]]
position = ["95 mm", "0 mm"]
[bodies.lifter]
motion = "driven"
axis = [0, 1]
path = [["0.1 s", "2 mm"], ["0.3 s", "-1 mm"]]
[bodies.even]
motion = "driven"
velocity = "60 rpm"
position = ["99 mm", "0 mm"]
[[gears]]
between = ["barrel", "wheel"]
ratio = -6
backlash = "0.5°"
restitution = 0.2
efficiency = 0.95
pressure_angle = "22°"
[[gears]]
between = ["wheel", "pinion"]
ratio = -8
[[gears]]
between = ["crown", "rack"]
ratio = "40 mm/rad"
[[gears]]
between = ["carriage", "planet"]
ratio = 8
[[springs]]
body = "balance"
frequency = "2.5 Hz"
[[springs]]
body = "carriage"
against = "crown"
stiffness = "2 µN·m/rad"
rest = "-90°"
[[damping]]
body = "carriage"
against = "driver"
viscous = "0.3 µN·m·s/rad"
[[torques]]
body = "wheel"
over = "barrel"
table = [["0 rev", "9.7 mN·m"], ["3.5 rev", "7.9 mN·m"], ["7 rev", "3 mN·m"]]
ratio = -6480
efficiency = 0.8
run_down = "2.5 rev"
train = [{ ratio = 10, inertia = "0.5 mg·cm²" }, { ratio = 80, inertia = "3 mg·cm²" }]
[[torques]]
body = "rack"
value = "-2 mN"
[run]
duration = "3 s"
record = "every 5"
""",
    "design": """
[design]
of = "swiss_lever"
lock = "2.2°"
[[torques]]
body = "wheel"
value = "-1.1 µN·m"
[[contacts]]
between = ["lever.STONES", "wheel.TEETH"]
friction = 0.25
[bodies.stop]
circle = "0.1 mm"
position = ["-5 mm", "0 mm"]
motion = "fixed"
""",
}


def write(name: str, folder: Path) -> Path:
    """The scene file of that name, its drawing beside it."""
    (folder / "plate.dxf").write_bytes(DRAWING)
    path = folder / "scene.toml"
    path.write_text(SCENES[name], encoding="utf-8")
    return path
