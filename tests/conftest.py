"""Where do the tests find their independent truths, and what several folders of them share?

This folder is put on the path, so that `naive` (slow oracles) and `reference` (closed forms) can be imported everywhere, and so
are the folders whose made-up scenes and drawings tests in other folders use, too.
"""

import gc
import os
import signal
import sys
import time
import zlib
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from watchsim.jit import is_cached
from watchsim.jit_cache import cache_folder

HERE = Path(__file__).resolve().parent
YOUNG = 100_000  # new objects until garbage is looked for: Python's 700 are for small programs
UNCOMPILED = ("construction", "drawing", "escapement", "geometry", "storage")  # folders
LARGEST = ("event_loop.advance", "moreau.advance_fixed")  # what takes half a minute and more to compile: file and function
PATIENCE = 120.0  # s to wait for the machine code of the first worker; after that each compiles for itself
# Matrices here are small: threads of the linear algebra would only wait for each other, at the cost of the other worker.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
COMPILED = pytest.StashKey[bool]()
SHARED = ("contact", "drawing", "dynamics", "scene", "simulation")
sys.path[:0] = [str(HERE), *(str(HERE / name) for name in SHARED)]

# A test says whether the program is right, not whether the machine has something else to do.
for name, examples in (("short", 25), ("nightly", 300)):
    settings.register_profile(name, deadline=None, max_examples=examples, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("short")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """All workers but the first begin with what needs no machine code: it is then there, and not compiled by each of them.

    pytest-xdist deals the tests out in as many equal parts as there are workers, one behind the other.
    """
    workers = int(getattr(config, "workerinput", {}).get("workercount", 1))
    if workers == 1:
        return
    compiled = [not is_plain(item) for item in items]
    plain = iter([item for item, is_so in zip(items, compiled, strict=True) if not is_so])
    others = iter([item for item, is_so in zip(items, compiled, strict=True) if is_so])
    part, share = -(-len(items) // workers), -(-compiled.count(False) // (workers - 1))
    dealt = list(islice(others, part))
    for _ in range(workers - 1):
        first = list(islice(plain, share))
        dealt += [*first, *islice(others, max(0, part - len(first)))]
    items[:] = [*dealt, *plain, *others]


def is_plain(item: pytest.Item) -> bool:
    """Does it need no machine code that takes long to compile?"""
    return item.path.relative_to(HERE).parts[0] in UNCOMPILED


def pytest_runtest_setup(item: pytest.Item) -> None:
    """The first worker compiles what is largest before its first test that may need it; the others wait for that."""
    draw_anew(item)
    workerinput = getattr(item.config, "workerinput", None)
    if workerinput is None or is_plain(item) or item.config.stash.get(COMPILED, False):
        return
    item.config.stash[COMPILED] = True
    if workerinput["workerid"] == "gw0":
        compile_largest()
    else:
        until = time.monotonic() + PATIENCE
        while not all(map(is_cached, LARGEST)) and cache_folder() is not None and time.monotonic() < until:
            time.sleep(0.2)


def draw_anew(item: pytest.Item) -> None:
    """The random numbers of a file (RNG) do not depend on which of its tests ran before."""
    module = item.getparent(pytest.Module)
    rng = getattr(module.obj, "RNG", None) if module else None
    if isinstance(rng, np.random.Generator):
        rng.bit_generator.state = np.random.default_rng(zlib.crc32(item.name.encode())).bit_generator.state


def compile_largest() -> None:
    """By both methods, a scene that moves at once."""
    import watchsim
    from watchsim.simulation import METHODS

    scene = watchsim.load(watchsim.profiles_dir() / "incline")
    for method in METHODS:
        watchsim.simulate(scene, duration=1e-3, method=method)


def pytest_collection_finish() -> None:
    """What is loaded by now stays: looking through it for garbage again and again took an eighth of the processor time."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(YOUNG)


def pytest_report_header() -> str:
    """Says which copy of the package is tested: as installed, or a checkout on the path."""
    import watchsim

    return f"watchsim from {Path(watchsim.__file__).parent}"


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A desk with a good scene and its drawings."""
    from made_scenes import Desk

    return Desk(tmp_path, monkeypatch)


@pytest.fixture
def good() -> Any:
    """The mapping of the good scene."""
    from made_scenes import GOOD

    return GOOD


@pytest.fixture
def heard() -> Iterator[None]:
    """Commands hear what they are sent: who runs the tests behind something else (nohup, &) may have it switched off."""
    ignored = [one for one in (signal.SIGINT, signal.SIGHUP) if signal.getsignal(one) is signal.SIG_IGN]
    for one in ignored:
        signal.signal(one, signal.SIG_DFL)
    yield
    for one in ignored:
        signal.signal(one, signal.SIG_IGN)
