"""How do outlines and solids become trimesh's paths and meshes, and the other way round?

Everything here is in millimetres: trimesh's own tolerances are absolute and made for numbers of that size. GLB files, which are
in metres by their standard, are scaled as they are written. There each moving body has a node; an animation gives that node
places and turns at key times, straight lines and shortest turns between them (Khronos, glTF 2.0 specification, 3.11 and
appendix C).
"""

from __future__ import annotations

import functools
import importlib.util
import io
import math
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping, MutableMapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, cast

import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray
from shapely.geometry.polygon import orient
from trimesh.path import Path2D, entities
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from watchsim.geometry.loops import Loop, chords, polyline
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.sections import Solid
from watchsim.geometry.solids import pieces, region

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


@dataclass(frozen=True)
class Bend:
    """How the one mesh of a node bends: `shapes` (k, n, 3), m, of its vertices, the first that in which it is drawn, and at the
    times t (s) the shares (len(t), k) of all of them."""

    name: str
    t: Array
    shapes: Array
    shares: Array


def add_motion(
    tracks: Sequence[Track], bends: Sequence[Bend], buffers: MutableMapping[str, bytes], tree: MutableMapping[str, Any]
) -> None:
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
        zero = np.zeros(len(track.t))
        # Quaternions x, y, z, w of turns about z; halves of steady angles do not jump, so that neighbours lie close together.
        turns = np.column_stack((zero, zero, np.sin(0.5 * track.angles), np.cos(0.5 * track.angles)))
        values = {"translation": np.column_stack((track.places, zero)), "rotation": turns}
        times = _accessor(f"{track.name}.t", track.t, "SCALAR", buffers, tree)
        for path, rows in values.items():
            node[path] = rows[0].astype(np.float32).tolist()
            kind = "VEC3" if path == "translation" else "VEC4"
            output = _accessor(f"{track.name}.{path}", rows, kind, buffers, tree)
            channels.append({"sampler": len(samplers), "target": {"node": number, "path": path}})
            samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
    for bend in bends:
        number = nodes[bend.name]
        mesh = tree["meshes"][tree["nodes"][number]["mesh"]]
        ways = bend.shapes[1:] - bend.shapes[:1]
        mesh["primitives"][0]["targets"] = [
            {"POSITION": _accessor(f"{bend.name}.{k}", way, "VEC3", buffers, tree)} for k, way in enumerate(ways)
        ]
        mesh["weights"] = bend.shares[0, 1:].tolist()
        times = _accessor(f"{bend.name}.t", bend.t, "SCALAR", buffers, tree)
        output = _accessor(f"{bend.name}.shares", bend.shares[:, 1:].reshape(-1), "SCALAR", buffers, tree)
        channels.append({"sampler": len(samplers), "target": {"node": number, "path": "weights"}})
        samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
    if channels:
        tree["animations"] = [{"name": "motion", "samplers": samplers, "channels": channels}]


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


MM = 1e3
SAME_VERTEX = 1e-12  # m: two edges this close share a vertex, so that trimesh sees the outline closed


@dataclass(frozen=True)
class Piece:
    """A named mesh (mm, in the frame of its body), its colour "#rrggbb" as a screen shows it, and whether it is of metal."""

    name: str
    mesh: trimesh.Trimesh
    colour: str
    metal: bool


@dataclass(frozen=True)
class Placed:
    """The pieces of one body and where the body stands: position in metres, angle in radians."""

    name: str
    pieces: Sequence[Piece]
    position: Point = (0.0, 0.0)
    angle: float = 0.0


def plate(loops: Iterable[Loop], bottom: float, thickness: float, deviation: float) -> trimesh.Trimesh | None:
    """The outlines (metres, holes kept) from the height `bottom` up by `thickness` metres; None where they have no area."""
    return united([loops], bottom, thickness, deviation)


def united(layers: Iterable[Iterable[Loop]], bottom: float, thickness: float, deviation: float) -> trimesh.Trimesh | None:
    """A plate of several layers, each with its own holes, without walls where they meet; None where they have no area."""
    whole = shapely.union_all([region(loops, deviation, MM) for loops in layers])
    parts = [trimesh.creation.extrude_polygon(part, MM * thickness, engine="earcut") for part in pieces(whole)]
    if not parts:
        return None
    mesh = _together(parts)
    mesh.apply_translation((0.0, 0.0, MM * bottom))
    return mesh


def revolved(profile: Iterable[Loop], deviation: float) -> trimesh.Trimesh | None:
    """A half profile (metres, its axis along x, material at y >= 0) turned about the z axis: x becomes the height."""
    closed = [loop for loop in profile if loop.closed]
    widest = max((float(polyline(loop, deviation)[:, 1].max()) for loop in closed), default=0.0)
    if not widest > 0.0:
        return None
    sections = chords(Arc(0.0, 0.0, widest, 0.0, TURN), deviation)
    parts = []
    for part in pieces(region(closed, deviation, MM)):
        clockwise = orient(part, -1.0)  # as revolve wants outer rings, seen so
        for ring in (clockwise.exterior, *clockwise.interiors):
            line = np.asarray(ring.coords)[:, ::-1].copy()  # (radius, height)
            line[:, 0] = np.maximum(line[:, 0], 0.0)
            parts.append(trimesh.creation.revolve(line, sections=sections))
    return _together(parts) if parts else None


def sheet(points: Array, faces: NDArray[np.int64]) -> trimesh.Trimesh:
    """A surface without thickness through points (n, 3), mm, in their order."""
    return trimesh.Trimesh(points, faces, process=False)


def laid(mesh: trimesh.Trimesh, foot: Point, direction: Point, height: float) -> trimesh.Trimesh:
    """The turned mesh with its axis in the plane through `foot` (metres) along `direction`, at the height `height` (metres)."""
    (x, y), (ux, uy) = foot, direction
    matrix = np.eye(4)
    matrix[:3] = [0.0, uy, ux, MM * x], [0.0, -ux, uy, MM * y], [1.0, 0.0, 0.0, MM * height]
    return mesh.copy().apply_transform(matrix)


def turned_about(mesh: trimesh.Trimesh, pivot: Point, angle: float) -> trimesh.Trimesh:
    """A copy turned by `angle` radians about the upright line through `pivot` (metres)."""
    return mesh.copy().apply_transform(_pose(pivot, angle) @ _pose((-pivot[0], -pivot[1]), 0.0))


def glb(bodies: Sequence[Placed], motion: Sequence[Track] = (), bends: Sequence[Bend] = ()) -> bytes:
    """A binary glTF scene in metres: one node per body at its pose, below it one per piece, with colours.

    `motion` moves the nodes of the bodies that it names, `bends` the meshes of the pieces BODY.PIECE.
    """
    scene = trimesh.Scene()
    for body in bodies:
        pose = _pose(body.position, body.angle)
        pose[:3, 3] /= MM
        scene.graph.update(frame_from=scene.graph.base_frame, frame_to=body.name, matrix=pose)
        for piece in body.pieces:
            mesh = piece.mesh.copy()
            mesh.apply_scale(1.0 / MM)
            mesh.visual = TextureVisuals(material=_material(piece))
            name = f"{body.name}.{piece.name}"
            scene.add_geometry(mesh, node_name=name, geom_name=name, parent_node_name=body.name)
    known = {body.name for body in bodies}
    moving = [track for track in motion if track.name in known]
    return trimesh.exchange.gltf.export_glb(
        scene, buffer_postprocessor=functools.partial(add_motion, moving, bends), tree_postprocessor=_linear_colours
    )


def triangles(pieces: Iterable[Piece], crease: float) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Vertices (n, 3) in metres, normals (n, 3) and faces (m, 3) of all pieces; edges above `crease` (rad) stay sharp."""
    smooth = trimesh.graph.smooth_shade(_together([piece.mesh for piece in pieces]), angle=crease)
    return np.asarray(smooth.vertices) / MM, np.asarray(smooth.vertex_normals), np.asarray(smooth.faces)


def stl(body: Placed) -> bytes:
    """A binary STL file of all pieces of one body, millimetres, in the body's frame."""
    return trimesh.exchange.stl.export_stl(_together([piece.mesh for piece in body.pieces]))


def _together(parts: list[trimesh.Trimesh]) -> trimesh.Trimesh:
    return cast(trimesh.Trimesh, trimesh.util.concatenate(parts))


def _material(piece: Piece) -> PBRMaterial:
    """Named after its colour, which trimesh would round to 1/255: `_linear_colours` writes it."""
    return PBRMaterial(piece.colour, metallicFactor=float(piece.metal), roughnessFactor=0.3 if piece.metal else 0.1)


def _linear_colours(tree: Mapping[str, Any]) -> None:
    """glTF wants the light of a colour, not the code of a screen: by IEC 61966-2-1 (sRGB), each share of 0 to 1."""
    for material in tree.get("materials", ()):
        codes = [int(material["name"][k : k + 2], 16) / 255 for k in (1, 3, 5)]
        linear = [code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4 for code in codes]
        material["pbrMetallicRoughness"]["baseColorFactor"] = [*linear, 1.0]


def _pose(position: Point, angle: float) -> NDArray[np.float64]:
    c, s = math.cos(angle), math.sin(angle)
    x, y = MM * position[0], MM * position[1]
    return np.array([[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def path2d(chains: Iterable[Loop]) -> Path2D:
    """The edges as trimesh lines and three-point arcs, millimetres, layers kept, full circles closed."""
    vertices: list[Point] = []
    found: list[entities.Entity] = []

    def vertex(p: Point) -> int:
        vertices.append((MM * p[0], MM * p[1]))
        return len(vertices) - 1

    for chain in chains:
        first = last = -1
        for k, edge in enumerate(chain.edges):
            if isinstance(edge, Arc) and edge.is_circle:
                thirds = [vertex(edge.point(third / 3.0)) for third in range(3)]
                found.append(entities.Arc(thirds, closed=True, layer=chain.layer))
                continue
            start = last if k and math.dist(chain.edges[k - 1].end, edge.start) <= SAME_VERTEX else vertex(edge.start)
            first = start if first < 0 else first
            back = k == len(chain.edges) - 1 and chain.closed and math.dist(edge.end, chain.edges[0].start) <= SAME_VERTEX
            middle = [vertex(edge.point(0.5))] if isinstance(edge, Arc) else []
            last = first if back and k else vertex(edge.end)
            kind = entities.Arc if middle else entities.Line
            found.append(kind([start, *middle, last], layer=chain.layer))
    made = Path2D(entities=found, vertices=np.array(vertices, float).reshape(-1, 2), process=False)
    made.units = "mm"
    return made


def edges_of(path: Path2D, scale: float) -> list[tuple[str, list[Edge]]]:
    """For every entity of the path its layer and its lines and arcs; `scale` is metres per unit of the path.

    ValueError for what is neither: curves, texts, arcs through three points in a line.
    """
    found = []
    points = scale * np.asarray(path.vertices, float)
    for number, entity in enumerate(path.entities):
        corners = [(float(x), float(y)) for x, y in points[entity.points]]
        edges: list[Edge] = []
        if isinstance(entity, entities.Arc):
            edges = [_arc(corners, bool(entity.closed), number)]
        elif isinstance(entity, entities.Line):
            edges = [Line(*a, *b) for a, b in pairwise(corners) if a != b]
        else:
            kind = type(entity).__name__
            raise ValueError(f"entity {number} of the path is a {kind}: only lines and arcs make an outline")
        found.append(("0" if entity.layer is None else str(entity.layer), edges))
    return found


def _arc(points: Sequence[Point], closed: bool, number: int) -> Arc:
    """The arc from the first of three points through the second to the third; all the way round if `closed`."""
    (ax, ay), (bx, by), (cx, cy) = points
    ux, uy, vx, vy = ax - bx, ay - by, cx - bx, cy - by
    doubled = 2.0 * (ux * vy - uy * vx)
    if doubled == 0.0:
        raise ValueError(f"entity {number} of the path is an arc through three points in a straight line")
    uu, vv = ux * ux + uy * uy, vx * vx + vy * vy
    x, y = bx + (vy * uu - uy * vv) / doubled, by + (ux * vv - vx * uu) / doubled
    side = -math.copysign(1.0, doubled)
    start, middle, end = (math.atan2(q - y, p - x) for p, q in points)
    radius = math.fsum(math.dist(p, (x, y)) for p in points) / 3.0
    sweep = TURN if closed else side * (middle - start) % TURN + side * (end - middle) % TURN
    return Arc(x, y, radius, start, side * sweep)


UNNAMED = "0"
LENGTHS = {"micron": "µm", "millimeter": "mm", "millimeters": "mm", "centimeter": "cm", "meter": "m", "foot": "ft"}  # of 3MF
CHORD_TURN = 0.1  # rad between two chords of a STEP file's curve: an arc of a tenth of a turn still has six


def solids_of(data: bytes, ending: str, chord: float) -> tuple[list[Solid], str | None]:
    """The meshes of an STL, OBJ, GLB, 3MF or STEP file, placed as its scene says, and its unit, where it has one.

    Exact surfaces are replaced by chords that leave them by `chord` metres at most. Whatever trimesh raises goes on:
    ImportError where it lacks a package for that format, anything else where the file is damaged. Other files, such as
    textures, are not read.
    """
    more: dict[str, Any] = {"skip_materials": True} if ending == "obj" else {}
    if exact := ending in ("step", "stp"):
        data, ending = _glb_of_step(data, chord), "glb"
    loaded: Any = trimesh.load(io.BytesIO(data), file_type=ending, process=False, **more)
    scene = loaded if isinstance(loaded, trimesh.Scene) else trimesh.Scene(loaded)
    found = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
            continue
        points = trimesh.transform_points(np.asarray(mesh.vertices, float), matrix)
        if not np.isfinite(points).all():
            raise ValueError("it has coordinates that are not finite")
        # Corners of neighbours are equal to the last bit; within a tolerance small parts in metres would melt.
        vertices, number = np.unique(MM * points if exact else points, axis=0, return_inverse=True)
        faces = number.reshape(-1)[np.asarray(mesh.faces)]
        faces = faces[np.all(faces != np.roll(faces, 1, axis=1), axis=1)]  # without those that are a line or a point
        parent = f"{scene.graph.transforms.parents.get(node)}."  # our own exports name a layer BODY.LAYER
        found.append(Solid(UNNAMED if ending in ("stl", "obj") else str(node).removeprefix(parent), vertices, faces))
    unit = "mm" if exact else "m" if ending == "glb" else scene.units if ending == "3mf" else None
    return found, LENGTHS.get(str(unit), unit)


def _glb_of_step(data: bytes, chord: float) -> bytes:
    """By a process of its own: OpenCASCADE writes to stdout, and a damaged file may be the end of it."""
    if importlib.util.find_spec("cascadio") is None:
        raise ImportError("No module named 'cascadio'")
    code = "import cascadio, sys; cascadio.step_to_glb(*sys.argv[1:3], *map(float, sys.argv[3:]))"
    with tempfile.TemporaryDirectory() as folder:
        source, made = Path(folder, "solid.step"), Path(folder, "solid.glb")
        source.write_bytes(data)
        command = [sys.executable, "-c", code, str(source), str(made), repr(MM * chord), repr(CHORD_TURN)]
        done = subprocess.run(command, capture_output=True, check=False, text=True, errors="replace")
        if not made.is_file():
            found = re.search(r"Line \d+: [^*\n]+", done.stdout + done.stderr)
            raise ValueError(found[0].strip() if found else "OpenCASCADE finds no solid in it")
        return made.read_bytes()
