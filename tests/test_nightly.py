"""Does the nightly script run every step, and say which failed?"""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SCRIPT = ROOT / "scripts" / "nightly.sh"
if not SCRIPT.is_file():
    pytest.skip("the scripts are not here", allow_module_level=True)

PROGRAM = """#!/bin/sh
echo "$(basename "$0") $*" >>'{log}'
case "$*" in *'{failing}'*) exit 7 ;; esac
"""
PYTHON = """#!/bin/sh
mkdir -p "$3/bin"
for name in pip pytest python watchsim; do cp '{program}' "$3/bin/$name"; done
"""


def nightly(folder: Path, failing: str) -> tuple[subprocess.CompletedProcess[str], list[str]]:
    """The script in a folder of its own, where programs only write down how they are called; and what they wrote.

    A call with the word `failing` in it ends with status 7.
    """
    (folder / "scripts").mkdir()
    script, log, program, python = (folder / name for name in ("scripts/nightly.sh", "log", "program", "python3"))
    script.write_bytes(SCRIPT.read_bytes())
    program.write_text(PROGRAM.format(log=log, failing=failing))
    python.write_text(PYTHON.format(program=program))
    for one in (program, python):
        one.chmod(0o755)
    environment = {"PATH": f"{folder}:/usr/bin:/bin", "TMPDIR": str(folder)}
    done = subprocess.run(["bash", str(script)], env=environment, capture_output=True, text=True, check=False)
    return done, log.read_text().splitlines()


def test_a_step_that_fails_hides_no_other(tmp_path_factory: pytest.TempPathFactory) -> None:
    whole, calls = nightly(tmp_path_factory.mktemp("whole"), "nothing fails")
    broken, again = nightly(tmp_path_factory.mktemp("broken"), "scripts/fuzz/")
    assert len(again) == len(calls) > 10
    assert [re.sub(r"/\S*/", "", line) for line in again] == [re.sub(r"/\S*/", "", line) for line in calls]
    told = re.findall(r"^Failed: (.+) \(status 7\)$", broken.stdout, re.MULTILINE)
    assert len(told) == sum("scripts/fuzz/" in line for line in calls) > 3
    assert all(f"== {name}\n" in broken.stdout for name in told)
    assert broken.returncode == 1
    # The pages that are shown are not written here.
    assert re.findall("^Failed: .*", whole.stdout, re.MULTILINE) == ["Failed: the pages of these (status 1)"]


def test_nothing_goes_on_without_an_environment(tmp_path: Path) -> None:
    done, calls = nightly(tmp_path, "install")
    assert done.returncode == 7
    assert len(calls) == 1


def test_the_scripts_it_runs_are_there() -> None:
    named = re.findall(r"scripts/\S+\.py", SCRIPT.read_text(encoding="utf-8"))
    assert named
    assert [name for name in named if not (ROOT / name).is_file()] == []


@pytest.mark.parametrize("name", ["scripts/nightly.sh", "scripts/try_versions.sh", ".ci/run"])
def test_asked_for_help_they_say_what_they_do_and_do_nothing(name: str) -> None:
    script = ROOT / name
    told = subprocess.run(["bash", str(script), "--help"], capture_output=True, text=True, timeout=10, check=True).stdout
    said = script.read_text(encoding="utf-8").splitlines()[1].removeprefix("# ")
    assert told.splitlines()[0] == said and "set -" not in told
