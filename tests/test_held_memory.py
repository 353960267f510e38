"""Does a process of the command line keep what it frees for the next array?"""

import platform

import pytest
from interpreter import python

FAULTS = """
import resource
import numpy as np
from watchsim.memory import hold_memory
{hold}
for _ in range(5):
    several = [np.ones(1_000_000) for _ in range(6)]; del several
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(5):
    several = [np.ones(1_000_000) for _ in range(6)]; del several
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="the allocator of glibc")
def test_memory_is_not_asked_for_again() -> None:
    """Six arrays are 12 000 pages."""
    held, given_back = (int(python(FAULTS.format(hold=hold))) for hold in ("hold_memory()", ""))
    assert held < 1000 and given_back > 10_000
