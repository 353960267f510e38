"""Which files can be saved from a page? The scene with its drawings, and the numbers: one zip archive, and each by itself."""

from __future__ import annotations

import base64
import io
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from watchsim.analysis.summary import tables
from watchsim.results.scene_copy import LOCK, travelling
from watchsim.results.tables import json_text
from watchsim.simulation.record.trajectory import Trajectory

MOST = 300_000  # bytes of packed files; a page must fit into a mail
LONGEST = 20_000_000  # bytes of a table that is worth trying: packed it is a tenth
TYPES = {"json": "application/json", "csv": "text/csv", "toml": "application/toml", "svg": "image/svg+xml"}
HEADER = 30  # bytes of a local header, to which name and extra field are added (PKWARE APPNOTE 4.3.7)
STAMP = (1980, 1, 1, 0, 0, 0)  # the same run makes the same page


def packed_files(run: Trajectory, numbers: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """The archive with where each file lies in it, and the names of those that would make the page too large."""
    found = tables(run, Path(tempfile.gettempdir()))
    long = [name for name, text in found.items() if text.size > LONGEST]
    contents: dict[str, str | bytes] = {**travelling(run.scene), "summary.json": json_text(numbers)}
    contents |= {name: str(text) for name, text in found.items() if name not in long}
    if not contents[LOCK]:
        contents.pop(LOCK)
    raw = {name: text.encode("utf-8", "replace") if isinstance(text, str) else text for name, text in contents.items()}
    fitting, left_out = _chosen(raw)
    archive = _zipped({name: raw[name] for name in raw if name in fitting})
    with zipfile.ZipFile(io.BytesIO(archive)) as opened:
        entries = [_entry(archive, info) for info in opened.infolist()]
    return {"entries": entries, "data": base64.b64encode(archive).decode("ascii")}, [*left_out, *long]


def _chosen(raw: Mapping[str, bytes]) -> tuple[set[str], list[str]]:
    """Names that fit, the smallest first, and those that do not."""
    room, fitting = MOST, set()
    sizes = {name: len(_zipped({name: content})) for name, content in raw.items()}
    for name in sorted(sizes, key=lambda name: sizes[name]):
        if sizes[name] <= room:
            room -= sizes[name]
            fitting.add(name)
    return fitting, [name for name in raw if name not in fitting]


def _zipped(contents: Mapping[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in contents.items():
            info = zipfile.ZipInfo(name, STAMP)
            info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(info, content)
    return out.getvalue()


def _entry(archive: bytes, info: zipfile.ZipInfo) -> dict[str, Any]:
    """Name, type, size, and where the packed bytes begin and end."""
    at = info.header_offset
    start = at + HEADER + sum(int.from_bytes(archive[at + k : at + k + 2], "little") for k in (26, 28))
    kind = TYPES.get(info.filename.rsplit(".", 1)[-1].lower(), "application/octet-stream")
    return {"name": info.filename, "type": kind, "size": info.file_size, "from": start, "to": start + info.compress_size}
