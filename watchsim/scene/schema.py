"""What may stand in a scene file, as a JSON Schema that editors read?

Made from the table of keys (`watchsim.scene.keys`) and the dimensions of the designs, in Draft 4, by which Taplo completes and
checks TOML in editors (https://taplo.tamasfe.dev/configuration/developing-schemas.html). It says what holds for a value by
itself and for keys of one table; what relates tables, drawings and numbers is found when a scene is read.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from watchsim.construction import registry
from watchsim.construction.design import Dimension
from watchsim.scene.designed import kind_of
from watchsim.scene.keys import (
    DESIGN,
    FLAG,
    GEAR,
    LAYERS,
    LISTED,
    NAMED_TABLES,
    NUMBER_OR_TABLE,
    PAIR,
    POINTS,
    SECTIONS,
    TABLE,
    TABLES_LISTED,
    TEXT,
    TEXTS,
    VALUES,
    Key,
    Keys,
)
from watchsim.units import LENGTH, NUMBER, PER_LENGTH, TRAVEL_PER_TURN, pattern
from watchsim.units import Dimension as Kind

DRAFT = "http://json-schema.org/draft-04/schema#"
FILE = "scene.schema.json"  # beside a new scene, so that editors need no network
HEADER = f"#:schema {FILE}\n"  # first line of a scene, from which an editor knows it
WORDED = ("pivot", "position", "about", "turned", "material", "record")  # a text may stand in place of numbers
LISTABLE = ("velocity", "material", "record")  # two components, or several windows, in place of one value
IDENTITY = ("body", "between")  # what an entry must say that changes one of a design

Schema = dict[str, Any]


def schema(design: str = "") -> Schema:
    """The schema as JSON's objects, lists and texts; with the dimensions of one `design` only, of all of ours without."""
    sections = {name: _value(name, key) for name, key in SECTIONS.items()}
    sections[DESIGN] = {**sections[DESIGN], **_designs([design] if design else registry.own())}
    needed = {name: {"items": {"required": missing}} for name, keys in LISTED.items() if (missing := _required(keys, IDENTITY))}
    definitions: Schema = {}
    whole = _shared(_object(sections), definitions)
    either = [{"required": [DESIGN]}, {"required": ["bodies"], "properties": needed}]
    return {"$schema": DRAFT, "title": "Scene file of watchsim", **whole, "anyOf": either, "definitions": definitions}


def schema_text(design: str = "") -> str:
    """The same as the text of a file."""
    return json.dumps(schema(design), ensure_ascii=False, separators=(",", ":")) + "\n"


def _shared(part: Any, definitions: Schema) -> Any:
    """The same with each pattern of a quantity written once, among the definitions."""
    if isinstance(part, list):
        return [_shared(one, definitions) for one in part]
    if not isinstance(part, dict):
        return part
    found = {key: _shared(value, definitions) for key, value in part.items() if key != "pattern"}
    if "pattern" not in part:
        return found
    text = {"type": found.pop("type"), "pattern": part["pattern"]}
    name = next((name for name, one in definitions.items() if one == text), f"quantity{len(definitions)}")
    definitions[name] = text
    return {**found, "allOf": [{"$ref": f"#/definitions/{name}"}]}


def _object(properties: Mapping[str, Schema], **more: object) -> Schema:
    return {"type": "object", "properties": dict(properties), "additionalProperties": False, **more}


def _required(keys: Keys, beside: Sequence[str] = ()) -> list[str]:
    return [name for name, key in keys.items() if key.required and name not in beside]


def _table(keys: Keys, section: str) -> Schema:
    """One table: its keys, those that it needs, those that exclude each other, and those for some motions only."""
    required = [name for name in _required(keys) if section not in LISTED or name in IDENTITY]
    rivals = dict.fromkeys(tuple(sorted((name, other))) for name, key in keys.items() for other in key.instead_of)
    motions = {name: key.motions for name, key in keys.items() if key.motions}
    return _object(
        {name: _value(name, key) for name, key in keys.items()},
        **({"required": required} if required else {}),
        **({"not": {"anyOf": [{"required": list(pair)} for pair in rivals]}} if rivals else {}),
        **({"dependencies": {name: _moving(some) for name, some in motions.items()}} if motions else {}),
    )


def _moving(motions: Sequence[str]) -> Schema:
    return {"required": ["motion"], "properties": {"motion": {"enum": list(motions)}}}


def _value(name: str, key: Key) -> Schema:
    """What may stand behind a key, with its description."""
    words = key.doc.replace("`", "") + (f" (default: {key.absent})" if key.absent else "")
    found = _inner(name, key) if key.inner else _form(name, key)
    return {"description": words[:1].upper() + words[1:], **found} if words else found


def _inner(name: str, key: Key) -> Schema:
    table = _table(key.inner, name)
    listed = {"type": "array", "items": table}
    if key.form == NUMBER_OR_TABLE:
        return _either([_form(name, key), table])
    if key.form == LAYERS:
        return {"type": "object", "additionalProperties": {"anyOf": [table, listed]}}
    named = {"type": "object", "additionalProperties": table}
    return {TABLE: table, NAMED_TABLES: named, TABLES_LISTED: listed}[key.form]


def _form(name: str, key: Key) -> Schema:
    if key.form == TEXT:
        return {"type": "string", **({"enum": list(key.choices)} if key.choices else {})}
    kind = key.dimension_for("")
    if key.form == TEXTS:
        pair = {"minItems": 1, "maxItems": 2} if name == "between" else {}
        return {"type": "array", "items": {"type": "string"}, **pair}
    if key.form == POINTS:
        point = {"type": "array", "minItems": 2, "maxItems": 2, **({"items": _quantity(kind, key)} if kind else {})}
        return _either([{"type": "array", "items": point, "minItems": 2}, *_words(name)])
    if key.form == FLAG:
        return {"type": "boolean"}
    if kind is None:
        return {"type": "object"} if key.form not in ("value", VALUES) else {}
    number = _quantity(kind, key)
    if key.form == PAIR:
        return _either([{"type": "array", "items": number, "minItems": 2, "maxItems": 2}, *_words(name)])
    if key is GEAR["ratio"]:  # by what the two bodies do
        return _either([number, *(_quantity(other, key) for other in (TRAVEL_PER_TURN, PER_LENGTH, LENGTH))])
    lists = [{"type": "array"}] if key.form == VALUES or name in LISTABLE else []
    return _either([number, *lists, *_words(name)])


def _words(name: str) -> list[Schema]:
    return [{"type": "string"}, {"type": "object"}] if name in WORDED else []


def _either(several: list[Schema]) -> Schema:
    return several[0] if len(several) == 1 else {"anyOf": several}


def _quantity(kind: Kind, key: Key) -> Schema:
    """A number with its unit as text, a plain number where no unit is needed; within the limits as far as a schema can say."""
    lowest = [(limit.low, limit.open == "low") for limit in key.limits if limit.low > -float("inf") and not limit.zero]
    low, above = max(lowest, default=(-float("inf"), False))
    text = {"type": "string", "pattern": pattern(kind, signed=low < 0.0, zero=low < 0.0 or (low == 0.0 and not above))}
    if kind is not NUMBER:
        return text
    return {"anyOf": [{"type": "number", **_range(key)}, text]}


def _range(key: Key) -> Schema:
    found: Schema = {}
    for limit in key.limits:
        if limit.low > found.get("minimum", -float("inf")) and not limit.zero:
            found |= {"minimum": limit.low} | ({"exclusiveMinimum": True} if limit.open == "low" else {})
        if limit.high < float("inf"):
            found |= {"maximum": limit.high} | ({"exclusiveMaximum": True} if limit.open == "high" else {})
    return found


def _designs(names: Sequence[str]) -> Schema:
    """The dimensions of these designs; what is none of them is left to whoever knows it."""
    known = [_design(name, registry.design(name).dimensions) for name in names]
    other = {"properties": {"of": {"not": {"enum": list(names)}}}}
    return {"required": ["of"], "properties": {"of": {"type": "string"}}, "anyOf": [*known, other]}


def _design(name: str, dimensions: Iterable[Dimension]) -> Schema:
    return _object({"of": {"enum": [name]}, **{one.name: _dimension(one) for one in dimensions}})


def _dimension(one: Dimension) -> Schema:
    words = f"{one.meaning}: {one.shortly(one.low)} to {one.shortly(one.high)} (default: {one.shortly(one.default)})"
    kind = kind_of(one)
    text: Schema = {"type": "string", "pattern": pattern(kind, signed=one.low < 0.0, zero=one.low <= 0.0)}
    if kind is NUMBER:
        text = {"anyOf": [{"type": "integer" if one.count else "number", "minimum": one.low, "maximum": one.high}, text]}
    return {"description": words[:1].upper() + words[1:], **text}
