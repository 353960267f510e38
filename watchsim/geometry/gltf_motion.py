"""How is motion added to a glTF scene?

Each moving body has a node; an animation gives that node places and turns at key times, straight lines and shortest turns
between them (Khronos, glTF 2.0 specification, 3.11 and appendix C).
"""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
FLOAT = 5126  # the code of 32-bit floating point
MOST_TURN = 1.5  # rad between two keys: beyond π the shortest turn would go the other way round


@dataclass(frozen=True)
class Track:
    """Keys of one node: times t (n,) in s from 0 and rising, places (n, 2) in m, angles (n,) in rad without jumps by a turn."""

    name: str
    t: Array
    places: Array
    angles: Array


def add_motion(tracks: Sequence[Track], buffers: MutableMapping[str, bytes], tree: MutableMapping[str, Any]) -> None:
    """Add one animation to a scene that is being written: `buffers` and `tree` as trimesh hands them to its post-processor.

    ValueError where a track turns too far between two keys.
    """
    nodes = {node.get("name"): number for number, node in enumerate(tree["nodes"])}
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for track in tracks:
        if np.any(np.abs(np.diff(track.angles)) > MOST_TURN):
            raise ValueError(f"{track.name} turns by more than {MOST_TURN} rad between two keys; give more of them")
        number = nodes[track.name]
        node = tree["nodes"][number]
        node.pop("matrix", None)  # what is animated must not have one
        values = {"translation": _translations(track), "rotation": _rotations(track)}
        times = _accessor(f"{track.name}.t", track.t, "SCALAR", buffers, tree)
        for path, rows in values.items():
            node[path] = rows[0].astype(np.float32).tolist()
            kind = "VEC3" if path == "translation" else "VEC4"
            output = _accessor(f"{track.name}.{path}", rows, kind, buffers, tree)
            channels.append({"sampler": len(samplers), "target": {"node": number, "path": path}})
            samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
    if channels:
        tree["animations"] = [{"name": "motion", "samplers": samplers, "channels": channels}]


def _translations(track: Track) -> Array:
    return np.column_stack((track.places, np.zeros(len(track.t))))


def _rotations(track: Track) -> Array:
    """Quaternions x, y, z, w of turns about z; halves of steady angles do not jump, so that neighbours lie close together."""
    zero = np.zeros(len(track.t))
    return np.column_stack((zero, zero, np.sin(0.5 * track.angles), np.cos(0.5 * track.angles)))


def _accessor(name: str, values: Array, kind: str, buffers: MutableMapping[str, bytes], tree: Mapping[str, Any]) -> int:
    """The number of a new accessor to these values, which are appended as a buffer of their own."""
    single = np.ascontiguousarray(values, "<f4")
    key = f"motion.{name}"
    buffers[key] = single.tobytes()
    rows = single.reshape(len(single), -1)
    tree["accessors"][key] = {
        "bufferView": len(buffers) - 1,
        "componentType": FLOAT,
        "count": len(single),
        "type": kind,
        "min": rows.min(axis=0).tolist(),
        "max": rows.max(axis=0).tolist(),
    }
    return len(tree["accessors"]) - 1
