"""How is a pin-pallet (Roskopf) lever escapement drawn?

In: its `pin_pallet_dimensions`. Out: the outlines of its parts and `pin_pallet_scene`, or conflicts; `pin_pallet_design` is the
whole. Fork, roller and banking are those of `swiss_lever`. Imports `construction` and below.
"""
