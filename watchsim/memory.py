"""How does a process that computes keep its memory in order?"""

import gc
import sys

GARBAGE = 500_000  # objects that may pile up, some 50 MB
MMAP_THRESHOLD, TRIM_THRESHOLD = -3, -1  # of glibc's malloc.h
HELD = {MMAP_THRESHOLD: 32 << 20, TRIM_THRESHOLD: 128 << 20}  # bytes


def tidy_seldom() -> None:
    """Look for garbage seldom, and hold memory that was freed.

    Nearly all objects of a short run are imported modules, which stay to the end: looking for garbage among them every few
    hundred objects, and once more at the end, would take a sixth of its time.
    """
    gc.set_threshold(GARBAGE)
    if sys.platform == "linux":
        hold_memory()


def hold_memory() -> None:
    """Have glibc keep what is freed for the next array; to give it back and get it again, page by page, takes a twentieth of a
    run."""
    import ctypes

    library = ctypes.CDLL(None)
    if hasattr(library, "mallopt"):
        for name, size in HELD.items():
            library.mallopt(name, size)
