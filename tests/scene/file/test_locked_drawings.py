"""Is a scene refused whose drawings have changed since it was locked?"""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from watchsim.scene.errors import SceneError
from watchsim.scene.load import load


def test_a_locked_scene_refuses_drawings_that_have_changed(tmp_path: Path) -> None:
    """What is not there is no change; nor is another table in place of the digests."""
    (tmp_path / "a.dxf").write_bytes(b"anything")
    digest = hashlib.sha256(b"anything").hexdigest()
    body = '[bodies.b]\ninertia = "1 g·cm²"\n'
    path = tmp_path / "scene.toml"
    for lock, refused in (
        (f'"a.dxf" = "{digest}"', False),
        (f'"a.dxf" = "{digest[::-1]}"', True),
        (f'"none.dxf" = "{digest}"', False),
    ):
        path.write_text(f"{body}[lock.drawings]\n{lock}\n", encoding="utf-8")
        if refused:
            with pytest.raises(SceneError, match=r"lock\.drawings\.a\.dxf\n  the drawing was changed"):
                load(path)
        else:
            assert load(path).bodies
