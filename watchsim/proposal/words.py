"""What do the names of layers, blocks and files say, in the languages of watchmaking: English, German, French, Italian?

Accents count for nothing: ZÄHNE, ZAHNE and zähne are one word.
"""

from __future__ import annotations

from watchsim.drawing.material import BORES, CENTRES, MARKS, plain_word, tokens

WHEEL, LEVER, OSCILLATOR, CLICK, DRIVER, FIXED = "wheel", "lever", "oscillator", "click", "driver", "fixed"
PASSING = "passing"  # the spring that a detent carries


def _words(text: str) -> frozenset[str]:
    return frozenset(plain_word(text).split())


# Words for a part itself; a layer name that begins with one names its part.
_PARTS = {
    WHEEL: "wheel gear pinion ratchet star cross rad gangrad steigrad ankerrad hemmungsrad hemmrad sperrrad sperrad stern "
    "trieb malteserkreuz kreuz roue rochet étoile pignon croix ruota stella pignone croce",
    LEVER: "lever anchor detent passing anker hemmstück hebel wippe ancre détente bascule ancora leva",
    CLICK: "click pawl jumper follower tappet rack klinke sperrklinke sperrkegel raste springer fühler rechen cliquet sautoir "
    "palpeur râteau nottolino cricco cricchetto saltarello scatto",
    DRIVER: "driver crank motor finger cam snail antrieb treiber kurbel mitnehmer nocken kurvenscheibe schnecke moteur "
    "manivelle doigt came limaçon motore manovella dito camma chiocciola",
    OSCILLATOR: "balance pendulum foliot unruh unruhe pendel balancier pendule bilanciere pendolo",
    FIXED: "banking bankings bank banks plate frame bridge wall stop stops fixed ground base cock anschlag anschläge platine "
    "brücke kloben gestell pont coq butée butées étoqueau étoqueaux platina ponte arresto arresti",
}
# Words for a feature, which hint at the part that has it.
_FEATURES = {
    WHEEL: "escape scape teeth tooth zahn zaehne zähne dents dent échappement denti dente scappamento",
    LEVER: "pallet pallets stone stones fork horn horns dart guard arm arms gabel stein steine hebestein hebesteine paletten "
    "klaue klauen messer arme hörner fourchette palette palettes levée levées dard bras cornes forchetta leve dardo bracci",
    CLICK: "beak nose bec nase becco",
    OSCILLATOR: "roller table safety impulse jewel rim bob rod hebelstein rolle sicherheitsrolle reif plateau ellipse cheville "
    "serge tige lentille disco ellisse",
}
PARTS = {word: kind for kind, text in _PARTS.items() for word in _words(text)}
FEATURES = {word: kind for kind, text in _FEATURES.items() for word in _words(text)}
ESCAPING = _words("escape scape échappement scappamento")
TEETH = _words("teeth tooth wheel gear pinion ratchet star zahn zaehne zähne rad dents roue étoile denti ruota stella")
TEETH |= _words("steigrad gangrad ankerrad hemmungsrad hemmrad sperrrad sperrad stern")
SPOKES = _words("spoke spokes hub speiche speichen nabe rayon rayons moyeu razza razze raggi mozzo")  # of wheels: no teeth
WHEELS = frozenset(word for word, kind in PARTS.items() if kind == WHEEL)
STONES = _words(
    "pallet pallets stone stones teeth stein steine paletten hebestein hebesteine klaue klauen palette palettes levée"
)
STONES |= _words("levées leve")
CLICKS = _words("click pawl jumper nose beak klinke sperrklinke raste cliquet sautoir bec nottolino saltarello becco")
CAMS = _words("cam snail nocken kurvenscheibe schnecke came limaçon camma chiocciola")
PENDULUMS = _words("pendulum rod bob pendel pendule tige lentille pendolo")
ANCHORS = PENDULUMS | _words("anchor anker hemmstück ancre ancora")  # what swings a little only
FORK = _words("fork horn horns gabel hörner fourchette cornes forchetta")
IMPULSE = _words("impulse impuls impulsion impulso")
PIN = IMPULSE | _words("pin jewel hebelstein cheville ellipse ellisse")
GUARD = _words("dart guard messer dard dardo")
ROLLER = _words("safety roller rolle sicherheitsrolle plateau disco")
RESTING = _words("resting repos ruhe riposo")  # the long teeth of a duplex wheel
LEAVES = _words("passing leaf goldfeder auslösefeder")
DISCHARGES = _words("discharge discharging unlocking auslösestein dégagement doigt finger dito")
LOCKING = _words(
    "locking lock stone repos pierre ruhe ruhestein riposo pietra pins chevilles goupilles stifte spine"
)  # of a lever
OVER = 0.02  # of the smaller area: what overlaps more lies at different heights
COVERS = 1.0  # the same of what is at one height by its names, wherever it is drawn
# What works together, where one of the bodies has that task, and the most by which it may overlap as it is drawn.
FACING = (
    (LEAVES, DISCHARGES, None, OVER),
    (TEETH, STONES, None, OVER),
    (TEETH, LOCKING, LEVER, OVER),
    (TEETH, CLICKS, CLICK, OVER),
    (FORK, PIN, None, COVERS),
    (GUARD, ROLLER, None, OVER),
    (RESTING, ROLLER, None, OVER),
)
# A circle on a layer so called shows where a part turns: its axis, its bore or the arbor in it.
ARBORS = _words("arbor arbour staff shaft spindle welle zapfen arbre albero")
TURNING = MARKS | BORES | ARBORS
DRIVING = _words("trascinamento impulso")  # a PERNO DI TRASCINAMENTO is no pivot, but a pin
COMPOUNDS = ("achse", "welle", "bohrung", "loch", "drehpunkt")  # in which German names end


def shows_pivot(name: str) -> bool:
    """Does a name say so? In any order, but for words such as that of CENTER WHEEL."""
    words = tokens(name)
    if "perno" in words and DRIVING & set(words):
        return False
    return any(word in TURNING or word.endswith(COMPOUNDS) for word in words) or (bool(words) and words[-1] in CENTRES)


def shows_arbor(name: str) -> bool:
    return any(word in ARBORS or word.endswith("welle") for word in tokens(name))


def part_of(name: str) -> str | None:
    """The kind of part that a name speaks of; None where it says nothing, or names features of two kinds."""
    hinted = hints_of(name)
    return next(iter(hinted)) if len(hinted) == 1 else None


def hints_of(name: str) -> frozenset[str]:
    """All kinds of part that the words of a name may belong to; empty where they say nothing."""
    words = tokens(name)
    named = [PARTS[word] for word in words if word in PARTS]
    if WHEEL in named and ESCAPING & set(words):
        return frozenset((WHEEL,))  # an anchor escape wheel
    return frozenset(named[:1] or (FEATURES[word] for word in words if word in FEATURES))


def part_word(name: str) -> str | None:
    """What the part is called in a layer's name: "escape_wheel" of ESCAPE_WHEEL_z-1.30; None where it is not named."""
    words = tokens(name)
    for k, word in enumerate(words):
        if word in PARTS and hints_of(name) == {PARTS[word]}:
            return f"{words[k - 1]}_{word}" if k and FEATURES.get(words[k - 1]) == PARTS[word] else word
    return None


def facing_by_name(first: str, second: str, tasks: frozenset[str] = frozenset()) -> float | None:
    """The most by which two surfaces may overlap whose names say that they work together, as those of teeth and stones do.

    `tasks` of their bodies. None where the names do not say so.
    """
    a, b = (words - WHEELS if words & SPOKES else words for words in (set(tokens(first)), set(tokens(second))))
    fitting = ((one, other, most) for one, other, task, most in FACING if task is None or task in tasks)
    return max((most for one, other, most in fitting if (a & one and b & other) or (a & other and b & one)), default=None)
