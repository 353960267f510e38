"""What does the scene of a remontoir before a Swiss lever say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.outline import polar
from watchsim.construction.remontoir.remontoir_dimensions import Remontoir
from watchsim.construction.remontoir.remontoir_proportions import (
    START,
    centre_distance,
    half_span,
    lever_at,
    middle,
)
from watchsim.construction.swiss_lever.swiss_lever_derived import swiss
from watchsim.construction.swiss_lever.swiss_lever_scene import CLEAR, parts, rest, wheel_angle

HEAD = """\
# A remontoir before a Swiss lever: the train does not drive the escape wheel but winds a weak spring on its arbor. An eccentric
# disc on the escape wheel leads a stop lever; twice in a turn it lets a tooth of the stop wheel go, and the train winds the
# spring by half a turn. So the escapement feels the spring alone, whatever the mainspring does. Drawn to these dimensions:
{dimensions}

[scene]
title  = "Remontoir before a Swiss lever"
schema = 1

"""

OWN = """\
[bodies.eccentric]                   # on the escape wheel
on       = "wheel"
motion   = "fixed"
circle   = "{values.disc:.15g} mm"
position = ["{disc[0]!r} mm", "{disc[1]!r} mm"]

[bodies.winder]                      # holds the outer end of the spring; on the axis of the escape wheel
polygon  = [["-0.06 mm", "-0.06 mm"], ["1.1 mm", "-0.06 mm"], ["1.1 mm", "0.06 mm"], ["-0.06 mm", "0.06 mm"]]
position = ["0 mm", "0 mm"]
inertia  = "{values.winder_inertia:.15g} mg·cm²"

[bodies.stop_wheel]                  # turns counter-clockwise, by half a pitch for half a turn of the winder
drawing  = "stop_wheel.dxf"
layers   = ["TEETH"]
pivot    = ["0 mm", "0 mm"]
position = ["{stop_x!r} mm", "0 mm"]
angle    = "{stop_wheel:.15g}°"      # a tooth a few nanometres off the upper pallet
inertia  = "{values.stop_wheel_inertia:.15g} mg·cm²"      # with the train as felt here

[bodies.stop_lever]
drawing  = "stop_lever.dxf"
layers   = ["PALLETS", "FORK"]
pivot    = ["0 mm", "0 mm"]
position = ["{lever_x!r} mm", "0 mm"]
angle    = "{stop_lever!r}°"
inertia  = "{values.stop_lever_inertia:.15g} mg·cm²"

[[gears]]
between = ["stop_wheel", "winder"]
ratio   = {ratio}

[[torques]]                          # the remontoir's spring, wound far: so much in the middle between two windings ...
body    = "wheel"
against = "winder"
value   = "{torque:.15g} µN·m"

[[springs]]                          # ... and {share:.3g} % more or less at their ends, a quarter of a turn to either side
body      = "wheel"
against   = "winder"
stiffness = "{values.spring_rate:.15g} µN·m/rad"
rest      = "{middle!r}°"

[[torques]]                          # of the train
body  = "stop_wheel"
value = "{values.train:.15g} µN·m"

{contacts}
"""

CONTACTS = (("stop_wheel.TEETH", "stop_lever.PALLETS"), ("eccentric.circle", "stop_lever.FORK"))


class _Plastic:
    """The law of the remontoir's own contacts: dry, without rebound."""

    def __init__(self, friction: float) -> None:
        self.friction, self.restitution = friction, 0.0


def scene_text(values: Remontoir) -> str:
    """The text of scene.toml: the lever as by itself, a tooth of the stop wheel on the upper pallet."""
    wheel = wheel_angle(swiss(values))
    own = OWN.format(
        values=values,
        disc=polar(values.eccentricity, START - wheel),
        stop_x=-values.arm - centre_distance(values),
        stop_wheel=half_span(values) - 2.0 * CLEAR,
        lever_x=-values.arm,
        stop_lever=lever_at(values, START),
        ratio=-values.stop_teeth,
        torque=-values.torque,
        share=100.0 * values.spring_rate * 0.5 * math.pi / values.torque,
        middle=wheel + middle(values),
        contacts=contact_tables(_Plastic(values.stop_friction), *CONTACTS),
    )
    return HEAD.format(dimensions=told(values)) + parts(values) + own + rest(values)
