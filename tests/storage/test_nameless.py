"""Does a file made without a name appear whole under the name it is given, and not before?"""

import os
from pathlib import Path

import pytest

from watchsim.storage.destination import give_name, nameless

CONTENT = bytes(range(256)) * 10_000


@pytest.mark.parametrize("linked", [True, False])
def test_it_appears_with_its_name(linked: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not linked:  # a file system without such files
        flag, opened = getattr(os, "O_TMPFILE", 0), os.open

        def refusing(path: object, flags: int, *rest: int, **named: int) -> int:
            if flag and flags & flag == flag:
                raise OSError
            return opened(path, flags, *rest, **named)  # type: ignore[call-overload, no-any-return]

        monkeypatch.setattr(os, "open", refusing)
    (tmp_path / "below").mkdir()
    target = tmp_path / "below" / "content.bin"
    with nameless(tmp_path) as file:
        file.write(CONTENT)
        assert [path.name for path in tmp_path.rglob("*")] == ["below"] or os.name == "nt"
        give_name(file, target)
    assert target.read_bytes() == CONTENT
    plain = tmp_path / "plain"
    plain.write_bytes(b"")
    assert target.stat().st_mode == plain.stat().st_mode


def test_where_links_fail_it_is_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object, **__: object) -> None:
        raise OSError

    with nameless(tmp_path) as file:
        file.write(CONTENT)
        monkeypatch.setattr(os, "link", fails)
        give_name(file, tmp_path / "content.bin")
    assert (tmp_path / "content.bin").read_bytes() == CONTENT


def test_what_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    with nameless(tmp_path) as file, pytest.raises(OSError):
        file.write(CONTENT)
        give_name(file, tmp_path / "missing" / "content.bin")
