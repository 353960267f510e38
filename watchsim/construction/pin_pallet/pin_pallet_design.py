"""What makes the pin-pallet escapement a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.pin_pallet.pin_pallet_conflicts import conflicts
from watchsim.construction.pin_pallet.pin_pallet_dimensions import PinPallet
from watchsim.construction.pin_pallet.pin_pallet_lever import pin_pallet_lever
from watchsim.construction.pin_pallet.pin_pallet_numbers import pin_lever
from watchsim.construction.pin_pallet.pin_pallet_scene import scene_text
from watchsim.construction.swiss_lever.swiss_lever_roller import banking, roller
from watchsim.construction.swiss_lever.swiss_lever_wheel import wheel
from watchsim.drawing.sheet import Sheet


def draw(values: PinPallet) -> dict[str, Sheet]:
    """Its four sheets."""
    design = pin_lever(values)
    parts = {
        "escape_wheel": wheel(design),
        "lever": pin_pallet_lever(design),
        "roller": roller(design, values.balance_inertia),
        "banking": banking(design),
    }
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}


DESIGN = Design("pin_pallet", "Pin-pallet (Roskopf) lever escapement with its balance", PinPallet, draw, scene_text, conflicts)
