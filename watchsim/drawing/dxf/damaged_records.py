"""Does this record look damaged, though it can be read?"""

from __future__ import annotations

from watchsim.drawing.dxf.entities import READERS
from watchsim.drawing.dxf.group_codes import strange_codes
from watchsim.drawing.dxf_records import Record
from watchsim.drawing.findings import Finding


def swallowed(record: Record, following: Record | None, layer: str) -> list[Finding]:
    """Signs that the record behind it was lost. What is read complains itself where groups stand twice."""
    if record.kind == "SEQEND":
        return strange_groups(record, layer)
    if record.kind not in READERS and record.codes.count(8) > 1:
        message = f"{record.name} at {record.place} names two layers: the entity behind it seems to have been swallowed"
        return [Finding("damaged", "error", message, "Draw again what is missing there, or export anew.")]
    announced = record.kind == "INSERT" and record.text(66, "0") not in ("0", "")
    if announced and (following is None or following.kind != "ATTRIB"):
        message = f"{record.name} at {record.place} announces attributes (group 66) and none follow: it may be damaged"
        return [Finding("strange-group", "warning", message, "Check that it is complete.", layer)]
    return []


def strange_groups(record: Record, layer: str) -> list[Finding]:
    strange = strange_codes(record)
    if not strange:
        return []
    codes = ", ".join(map(str, strange[:6]))
    message = f"{record.name} at {record.place} has groups that do not belong there ({codes}): it may be damaged"
    return [Finding("strange-group", "warning", message, "Check its shape.", layer)]


def odd_copies(record: Record, layer: str) -> list[Finding]:
    """An INSERT without rows or columns."""
    counts = ((record.integer(code, 1), what, code) for code, what in ((70, "columns"), (71, "rows")))
    return [
        Finding(
            "strange-group",
            "warning",
            f"{record.name} has {count} {what} (group {code}); one is read",
            "Insert it again.",
            layer,
        )
        for count, what, code in counts
        if count < 1
    ]


def odd_radius(record: Record, layer: str) -> list[Finding]:
    """A negative one."""
    if record.kind not in ("CIRCLE", "ARC") or record.number(40) >= 0.0:
        return []
    message = f"the radius of {record.name} is {record.number(40):g}; it is read without its sign"
    return [Finding("negative-radius", "warning", message, "Draw it again.", layer)]
