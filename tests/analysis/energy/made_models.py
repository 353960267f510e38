"""What is a model made up of a few coordinates, joints and tables?"""

from __future__ import annotations

from typing import Any

import numpy as np

from watchsim.model.records import (
    BODY,
    BODY_PAIR,
    CONTACT,
    COORDINATE,
    JOINT,
    LAW,
    LINE_SPRING,
    PRIMITIVE,
    TABLE,
    Model,
    records,
)


def model_of(**parts: Any) -> Any:
    """`coordinates`: {field: values by coordinate}; `joints`, `tables`: lists of {field: value}; tables bring their knots."""
    none = {"bodies": BODY, "lines": LINE_SPRING, "primitives": PRIMITIVE, "contacts": CONTACT, "laws": LAW, "pairs": BODY_PAIR}
    made: dict[str, Any] = {name: records(dtype, 0) for name, dtype in none.items()} | {"near": np.zeros(0, np.int64)}
    made["coordinates"] = records(COORDINATE, len(parts["coordinates"]["mass"]))
    for name, values in parts["coordinates"].items():
        made["coordinates"][name] = values
    joints, tables = parts.get("joints", []), parts.get("tables", [])
    made["joints"], made["tables"] = records(JOINT, len(joints)), records(TABLE, len(tables))
    for i, joint in enumerate(joints):
        for name, value in joint.items():
            made["joints"][name][i] = value
    knots = [knot for table in tables for knot in table["knots"]]
    for i, table in enumerate(tables):
        start = sum(len(one["knots"]) for one in tables[:i])
        row = {"on": -1, **{name: value for name, value in table.items() if name != "knots"}}
        for name, value in (row | {"start": start, "count": len(table["knots"])}).items():
            made["tables"][name][i] = value
    return Model(**made, knots=np.array(knots, float).reshape(-1, 2))
