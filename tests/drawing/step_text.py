"""A plate as a STEP file (ISO 10303-21, AP 214): planes and cylinders, exact, as a CAD program writes it."""

from collections.abc import Iterable

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc

UP, RIGHT = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
Vector = tuple[float, ...]


def _row(values: Iterable[str]) -> str:
    return f"({','.join(values)})"


class _File:
    def __init__(self) -> None:
        self.lines: list[str] = []

    def add(self, kind: str, *values: str) -> str:
        """The number of a new line; without values `kind` is all of its text."""
        text = f"{kind}({','.join(values)})" if values else kind
        self.lines.append(f"#{len(self.lines) + 1}={text};")
        return f"#{len(self.lines)}"

    def named(self, kind: str, *values: str) -> str:
        return self.add(kind, "''", *values)

    def triple(self, kind: str, values: Vector) -> str:
        return self.named(kind, _row(repr(float(value)) for value in values))

    def axes(self, at: Vector, axis: Vector, across: Vector) -> str:
        point, z, x = self.triple("CARTESIAN_POINT", at), self.triple("DIRECTION", axis), self.triple("DIRECTION", across)
        return self.named("AXIS2_PLACEMENT_3D", point, z, x)

    def line(self, at: Vector, way: Vector) -> str:
        point, direction = self.triple("CARTESIAN_POINT", at), self.triple("DIRECTION", way)
        return self.named("LINE", point, self.named("VECTOR", direction, "1."))

    def edge(self, start: str, end: str, curve: str) -> str:
        return self.named("EDGE_CURVE", start, end, curve, ".T.")

    def face(self, rows: list[list[tuple[str, bool]]], surface: str, outward: bool = True) -> str:
        bounds = []
        for row in rows:
            edges = [self.named("ORIENTED_EDGE", "*", "*", edge, ".T." if ahead else ".F.") for edge, ahead in row]
            bounds.append(self.named("FACE_BOUND", self.named("EDGE_LOOP", _row(edges)), ".T."))
        return self.named("ADVANCED_FACE", _row(bounds), surface, ".T." if outward else ".F.")


def step_text(loops: list[Loop], bottom: float, top: float) -> str:
    """The plate between two heights (m) of outlines with the material on their left; full circles are not among them."""
    file = _File()
    faces: list[str] = []
    lids: list[list[list[tuple[str, bool]]]] = [[], []]
    for loop in loops:
        rows: list[list[str]] = []
        corners = []
        for z in (bottom, top):
            points = [(1e3 * x, 1e3 * y, 1e3 * z) for x, y in (edge.start for edge in loop.edges)]
            corners.append([file.named("VERTEX_POINT", file.triple("CARTESIAN_POINT", p)) for p in points])
            curves = []
            for edge, at in zip(loop.edges, points, strict=True):
                if isinstance(edge, Arc):
                    axis = (0.0, 0.0, 1.0 if edge.sweep > 0.0 else -1.0)
                    placed = file.axes((1e3 * edge.x, 1e3 * edge.y, 1e3 * z), axis, RIGHT)
                    curves.append(file.named("CIRCLE", placed, repr(1e3 * edge.radius)))
                else:
                    curves.append(file.line(at, (*edge.tangent(0.0), 0.0)))
            ends = corners[-1][1:] + corners[-1][:1]
            rows.append([file.edge(*three) for three in zip(corners[-1], ends, curves, strict=True)])
        rising = [
            file.edge(low, high, file.line((1e3 * e.start[0], 1e3 * e.start[1], 1e3 * bottom), UP))
            for low, high, e in zip(*corners, loop.edges, strict=True)
        ]
        for k, edge in enumerate(loop.edges):
            after = rising[(k + 1) % len(rising)]
            row = [(rows[0][k], True), (after, True), (rows[1][k], False), (rising[k], False)]
            if isinstance(edge, Arc):
                placed = file.axes((1e3 * edge.x, 1e3 * edge.y, 1e3 * bottom), UP, RIGHT)
                surface = file.named("CYLINDRICAL_SURFACE", placed, repr(1e3 * edge.radius))
                faces.append(file.face([row], surface, edge.sweep > 0.0))
            else:
                (x, y), (tx, ty) = edge.start, edge.tangent(0.0)
                surface = file.named("PLANE", file.axes((1e3 * x, 1e3 * y, 1e3 * bottom), (ty, -tx, 0.0), (tx, ty, 0.0)))
                faces.append(file.face([row], surface))
        lids[0].append([(edge, False) for edge in reversed(rows[0])])
        lids[1].append([(edge, True) for edge in rows[1]])
    for lid, z, axis in zip(lids, (bottom, top), ((0.0, 0.0, -1.0), UP), strict=True):
        faces.append(file.face(lid, file.named("PLANE", file.axes((0.0, 0.0, 1e3 * z), axis, RIGHT))))
    solid = file.named("MANIFOLD_SOLID_BREP", file.named("CLOSED_SHELL", _row(faces)))
    _product(file, solid)
    head = "HEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));"
    return "\n".join(("ISO-10303-21;", head, "ENDSEC;", "DATA;", *file.lines, "ENDSEC;", "END-ISO-10303-21;", ""))


def _product(file: _File, solid: str) -> None:
    """What a reader of assemblies wants around a solid: a product, and its units."""
    context = file.add("APPLICATION_CONTEXT('automotive design')")
    product = file.add("PRODUCT", "'plate'", "'plate'", "''", _row([file.named("PRODUCT_CONTEXT", context, "'mechanical'")]))
    version = file.named("PRODUCT_DEFINITION_FORMATION", "''", product)
    view = file.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{context},'design')")
    shape = file.named("PRODUCT_DEFINITION_SHAPE", "''", file.named("PRODUCT_DEFINITION", "''", version, view))
    mm = file.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
    radian = file.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
    solid_angle = file.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
    close = file.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),{mm},'distance_accuracy_value','')")
    units = file.add(
        f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({close}))"
        f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({mm},{radian},{solid_angle}))REPRESENTATION_CONTEXT('',''))"
    )
    body = file.named("ADVANCED_BREP_SHAPE_REPRESENTATION", _row([file.axes((0.0, 0.0, 0.0), UP, RIGHT), solid]), units)
    file.add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{body})")
