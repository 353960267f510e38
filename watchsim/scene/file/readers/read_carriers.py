"""Can the bodies of a scene file be carried as it says? What cannot be simulated exactly is a fault with its reason."""

from __future__ import annotations

from watchsim.scene.body import Body
from watchsim.scene.carriers import rides, weigh
from watchsim.scene.errors import Faults
from watchsim.scene.force import Contact, Damping

NOTHING = "so this contact does nothing"


def note_carriers(
    bodies: tuple[Body, ...], damping: tuple[Damping, ...], contacts: tuple[Contact, ...], faults: Faults
) -> None:
    """Faults of carried bodies, of dry friction in their pivots, and of contacts between parts rigid with each other."""
    if all(body.on is None for body in bodies):
        return

    def complain(name: str, message: str) -> None:
        faults.add(f"bodies.{name}.on" if by_name[name].on else f"bodies.{name}", message)

    by_name = {body.name: body for body in bodies}
    hung = rides(bodies, complain)
    weigh(bodies, hung, complain)
    ride_of = dict(zip(by_name, hung, strict=True))
    for i, damper in enumerate(damping):
        if damper.coulomb and damper.body and ride_of[damper.body].turns_with >= 0:
            message = (
                f"dry friction between {damper.body} and a carrier that turns is not simulated. Write viscous, or leave it out"
            )
            faults.add(f"damping.{i}.coulomb", message)
    for i, contact in enumerate(contacts):
        first, second = (side.body for side in contact.sides)
        if not first or not second or first == second:
            continue
        parts = {ride_of[first].part_of, ride_of[second].part_of}
        if len(parts) == 1:
            faults.add(f"contacts.{i}.between", f"{first} and {second} are rigid with each other, {NOTHING}")
        elif all(bodies[part].motion == "fixed" for part in parts) and (by_name[first].on or by_name[second].on):
            faults.add(f"contacts.{i}.between", f"{first} and {second} are both fixed, {NOTHING}")
