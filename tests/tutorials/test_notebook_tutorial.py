"""Does the tutorial that is a notebook run from its first cell to its last, and does everything in it show itself?"""

import json
import re
from pathlib import Path
from typing import Any

import pytest

NOTEBOOK = Path(__file__).resolve().parents[2] / "docs" / "tutorials" / "lever-in-a-notebook.ipynb"
LARGEST = {"text/html": 30_000, "image/png": 300_000}  # bytes of what a cell shows
PLAYER = 400_000


def cells() -> list[dict[str, Any]]:
    return [cell for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]


def test_it_is_kept_without_outputs() -> None:
    assert len(cells()) > 10
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells())


def test_its_python_is_python() -> None:
    for cell in cells():
        compile("".join(cell["source"]), NOTEBOOK.name, "exec")
        assert not re.search(r"^[%!]", "".join(cell["source"]), re.MULTILINE)  # no magic word


@pytest.mark.slow
def test_it_runs_and_every_value_shows_itself(tmp_path: Path) -> None:
    client = pytest.importorskip("nbclient", reason="nbclient is not installed: pip install 'watchsim[notebook]'")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed: pip install 'watchsim[notebook]'")
    import nbformat

    notebook = nbformat.read(NOTEBOOK, as_version=4)
    client.NotebookClient(notebook, timeout=900, resources={"metadata": {"path": str(tmp_path)}}).execute()
    for cell in (cell for cell in notebook.cells if cell.cell_type == "code"):
        assert not any(output.output_type == "error" for output in cell.outputs)
        last = cell.source.rstrip().splitlines()[-1]
        (shown,) = (output for output in cell.outputs if output.output_type in ("execute_result", "stream"))
        if shown.output_type == "stream":
            assert last.startswith("print(") and "found again" in shown.text
            continue
        assert len(shown.data["text/plain"].splitlines()) <= 3 and len(shown.data["text/plain"]) < 400
        kind = "image/png" if last.startswith("ws.plot_") else "text/html"
        text = shown.data[kind]
        if "player" in last:
            assert "<iframe" in text and "allow-same-origin" not in text and len(text.encode()) < PLAYER
        else:
            assert 300 < len(text.encode()) < LARGEST[kind]
