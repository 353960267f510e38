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
            "render/movies/run_movie.py",
            "render/frame/pose_history.py",
            "render/figures/speed_plot.py",
            "render/frame/marks/readouts.py",
            "render/movies/encoder.py",
            "render/movies/busy_stretches.py",
            "render/keyframes.py",
            "render/fewest_rows.py",
        ),
        ("tests/render", RECORDS),
    ),
    "plain": (
        ("dynamics/**/*.py", "candidates/*.py", "contact/*.py", "simulation/**/*.py", "tolerances.py"),
        ("tests/dynamics", "tests/candidates", "tests/contact", "tests/simulation", QUOTED),
    ),
    "kernels": (
        ("dynamics/**/*.py", "candidates/*.py", "contact/*.py", "simulation/**/*.py", "tolerances.py"),
        ("tests/dynamics", "tests/candidates", "tests/contact", "tests/simulation", QUOTED),
    ),
}
