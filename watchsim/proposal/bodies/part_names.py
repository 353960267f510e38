"""What does the name of a layer, a block or a file say about the part drawn there?

In the languages of watchmaking: English, German, French.
"""

from __future__ import annotations

import re

WHEEL, LEVER, OSCILLATOR, CLICK, DRIVER, FIXED = "wheel", "lever", "oscillator", "click", "driver", "fixed"

# Words for a part itself; a layer name that begins with one names its part.
PARTS = {
    **dict.fromkeys(("wheel", "escapewheel", "rad", "gangrad", "ankerrad", "hemmungsrad", "roue", "gear", "pinion"), WHEEL),
    **dict.fromkeys(("ratchet", "sperrrad", "sperrad", "rochet", "star", "stern", "étoile"), WHEEL),
    **dict.fromkeys(("lever", "anker", "anchor", "ancre", "detent"), LEVER),
    **dict.fromkeys(("click", "pawl", "jumper", "klinke", "sperrklinke", "sperrkegel", "raste", "cliquet", "sautoir"), CLICK),
    **dict.fromkeys(("cam", "came", "nocken"), DRIVER),
    **dict.fromkeys(("cross", "malteserkreuz", "croix"), WHEEL),
    **dict.fromkeys(("driver", "crank", "finger", "kurbel", "mitnehmer", "manivelle", "doigt"), DRIVER),
    **dict.fromkeys(("balance", "unruh", "balancier", "pendulum", "pendel", "pendule", "foliot"), OSCILLATOR),
    **dict.fromkeys(("banking", "bankings", "bank", "banks", "plate", "platine", "frame", "bridge", "wall", "stop"), FIXED),
    **dict.fromkeys(("stops", "fixed", "ground", "base", "cock", "anschlag"), FIXED),
}
# Words for a feature, which hint at the part that has it.
FEATURES = {
    **dict.fromkeys(("escape", "teeth", "tooth", "zahn", "zaehne", "zähne", "dents"), WHEEL),
    **dict.fromkeys(("pallet", "pallets", "stone", "stones", "fork", "horn", "horns", "dart", "guard", "arm", "arms"), LEVER),
    **dict.fromkeys(("gabel", "stein", "steine", "fourchette", "palette", "palettes", "levée", "levees"), LEVER),
    **dict.fromkeys(("roller", "table", "safety", "impulse", "jewel", "rim", "hebelstein", "bob", "rod"), OSCILLATOR),
}
TEETH = frozenset(("teeth", "tooth", "zahn", "zaehne", "zähne", "dents", "wheel", "gear", "pinion", "rad", "ratchet", "star"))
STONES = frozenset(("pallet", "pallets", "stone", "stones", "stein", "steine", "palette", "palettes", "teeth"))
CLICKS = frozenset(("click", "pawl", "jumper", "nose", "beak", "klinke", "sperrklinke", "cliquet", "sautoir", "bec"))
FORK = frozenset(("fork", "horn", "horns", "gabel", "fourchette"))
PIN = frozenset(("pin", "jewel", "impulse", "hebelstein"))
GUARD = frozenset(("dart", "guard"))
ROLLER = frozenset(("safety", "roller"))
FACING = ((TEETH, STONES), (TEETH, CLICKS), (FORK, PIN), (GUARD, ROLLER))


def tokens(name: str) -> list[str]:
    """The words of a name in lower case: "ESCAPE_WHEEL_z-1.30" has escape, wheel and z."""
    split = re.sub(r"(?<=[a-zäöü])(?=[A-ZÄÖÜ])", " ", name)
    return [word for word in re.split(r"[^a-zäöüéè]+", split.lower()) if word]


def part_of(name: str) -> str | None:
    """The kind of part that a name speaks of; None where it says nothing, or names features of two kinds."""
    words = tokens(name)
    named = [PARTS[word] for word in words if word in PARTS]
    if named:
        return named[0]
    hinted = hints_of(name)
    return next(iter(hinted)) if len(hinted) == 1 else None


def hints_of(name: str) -> frozenset[str]:
    """All kinds of part that the words of a name may belong to; empty where they say nothing."""
    words = tokens(name)
    named = [PARTS[word] for word in words if word in PARTS]
    return frozenset(named[:1] or (FEATURES[word] for word in words if word in FEATURES))


def part_word(name: str) -> str | None:
    """What the part is called in a layer's name: "escape_wheel" of ESCAPE_WHEEL_z-1.30; None where it is not named."""
    words = tokens(name)
    for k, word in enumerate(words):
        if word in PARTS:
            return f"{words[k - 1]}_{word}" if k and FEATURES.get(words[k - 1]) == PARTS[word] else word
    return None


def facing_by_name(first: str, second: str) -> bool:
    """Do the names of two surfaces say that they work together, as teeth and stones do?"""
    a, b = set(tokens(first)), set(tokens(second))
    return any((a & one and b & other) or (a & other and b & one) for one, other in FACING)
