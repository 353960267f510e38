"""How do outlines of several bodies on one layer get layers of their own?

A scene chooses by layer what can touch. Where a layer holds parts of several bodies, each outline gets one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from watchsim.proposal.bodies.part import Part

APART = "#"  # between the name of a layer and the number of an outline on it


def apart(parts: Sequence[Part], crowded: Sequence[frozenset[str]]) -> None:
    """Rename the layers of the pieces on layers that several parts share, or on which outlines cross; the largest is the first.

    `crowded` are the layers of each drawing on which they cross.
    """
    owners = Counter((part.file, layer) for part in parts for layer in part.layers)
    for part in parts:
        part.pieces.sort(key=lambda piece: -piece.area)
        numbers: Counter[str] = Counter()
        for k, piece in enumerate(part.pieces):
            if owners[piece.file, piece.layer] > 1 or piece.layer in crowded[piece.file]:
                numbers[piece.layer] += 1
                part.pieces[k] = replace(piece, layer=f"{piece.layer}{APART}{numbers[piece.layer]}")


def plain(layer: str) -> tuple[str, str]:
    """The layer as it was, and the number of the outline on it; empty where the layer was left as it is."""
    name, _, number = layer.partition(APART)
    return (name, number) if number.isdigit() else (layer, "")
