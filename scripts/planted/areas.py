"""Where can faults be planted, and which tests are asked first about them?"""

from __future__ import annotations

RECORDS = "tests/records"
QUOTED = "tests/docs/test_quoted_constants.py"
COMPILED = "kernels"
PLAIN = "plain"
AREAS = {  # name -> (files, tests)
    "reader": (("drawing/**/*.py",), ("tests/drawing", "tests/construction", RECORDS)),
    "geometry": (
        ("geometry/**/*.py",),
        (
            "tests/geometry",
            RECORDS,
            "tests/drawing/test_chaining.py",
            "tests/drawing/test_ellipses_and_splines.py",
            "tests/drawing/test_profile.py",
            "tests/render/test_solids_for_others.py",
        ),
    ),
    "scene": (
        ("scene/**/*.py", "mechanism/*.py", "units.py"),
        (
            "tests/scene",
            "tests/mechanism",
            "tests/designs",
            "tests/test_units.py",
            "tests/simulation/test_bound_bodies.py",
            RECORDS,
        ),
    ),
    "analysis": (
        ("analysis/**/*.py", "results/*.py", "verification/**/*.py"),
        ("tests/analysis", "tests/results", "tests/verification", "tests/render/test_curves_and_colours.py", RECORDS),
    ),
    "pictures": (
        (
            "render/movie.py",
            "render/view.py",
            "render/phase_plots.py",
            "render/marks.py",
            "render/encoder.py",
            "render/keyframes.py",
            "render/rows.py",
        ),
        ("tests/render", RECORDS),
    ),
    "studies": (
        ("studies/*.py", "escapement/*.py", "construction/*.py"),
        ("tests/studies", "tests/escapement", "tests/construction", "tests/turning", "tests/proposal", RECORDS),
    ),
    "plain": (
        ("dynamics/**/*.py", "contact/*.py", "simulation/**/*.py", "tolerances.py"),
        ("tests/dynamics", "tests/candidates", "tests/contact", "tests/simulation", QUOTED),
    ),
    "kernels": (
        ("dynamics/**/*.py", "contact/*.py", "simulation/**/*.py", "tolerances.py"),
        ("tests/dynamics", "tests/candidates", "tests/contact", "tests/simulation", QUOTED),
    ),
}
