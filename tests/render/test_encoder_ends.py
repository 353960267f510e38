"""Does the encoder get every byte of every frame, and is it noticed however it fails?"""

import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from watchsim.render import encoder
from watchsim.render.encoder import _command, _run, check_path, encode

FRAMES = [np.random.default_rng(k).integers(0, 256, (90, 70, 4), np.uint8) for k in range(5)]


def program(*lines: str) -> list[str]:
    return [sys.executable, "-c", "\n".join(("import sys", *lines))]


def test_every_byte_arrives(tmp_path: Path) -> None:
    place = tmp_path / "bytes"
    _run(program(f"open({str(place)!r}, 'wb').write(sys.stdin.buffer.read())"), [frame.data for frame in FRAMES])
    assert place.read_bytes() == b"".join(frame.tobytes() for frame in FRAMES)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (("sys.stdin.buffer.read()", "sys.exit('bad frame')"), "bad frame"),
        (("sys.stdin.buffer.read()", "sys.exit(3)"), "without a message"),
        (
            ("sys.stdin.buffer.read()", "print('first\\n disk: No space left on it', file=sys.stderr)"),
            "disk: No space left on it",
        ),
        (("sys.stdin.buffer.read(9)", "print('had enough', file=sys.stderr)"), "had enough"),
    ],
)
def test_however_it_fails(lines: tuple[str, ...], said: str) -> None:
    """By its status, by its words, or by taking no more."""
    with pytest.raises(OSError, match=said):
        _run(program(*lines), [frame.data for frame in FRAMES] * 12)  # more than a pipe holds


def test_small_frames_do_not_linger_on_the_way() -> None:
    """They would fail once more when the pipe is closed, and hide what the encoder has said."""
    with pytest.raises(OSError, match="had enough"):
        _run(program("sys.stdin.buffer.read(9)", "print('had enough', file=sys.stderr)"), [bytes(1000)] * 1500)


def test_words_alone_are_no_failure() -> None:
    _run(program("sys.stdin.buffer.read()", "print('a warning', file=sys.stderr)"), [FRAMES[0].data])


@pytest.mark.parametrize("gif", [False, True])
@pytest.mark.parametrize("sound", [False, True])
def test_frames_of_a_palette_make_a_gif(gif: bool, sound: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Others are piped as they are; the sound is written beside the movie before the encoder runs."""
    made: list[Any] = []

    def run(command: list[str], frames: Any) -> None:
        made.append((command, [bytes(frame) for frame in frames]))
        heard = [one for one in command if one.endswith(".wav")]
        assert [Path(one).read_text(encoding="utf-8") for one in heard] == (["tick"] if sound and not gif else [])
        Path(command[-1]).write_text("movie", encoding="utf-8")

    class Palette:
        def indexed(self, frame: np.ndarray) -> bytes:
            return b"indexed" + frame[:1, :1].tobytes()

    monkeypatch.setattr(encoder, "_run", run)
    palette: Any = Palette() if gif else None

    def write(place: Path) -> None:
        place.write_text("tick", encoding="utf-8")

    encode(iter(FRAMES), tmp_path / "a.gif", (70, 90), 12.5, palette, write if sound else None)
    ((command, frames),) = made
    assert frames == [palette.indexed(one) if gif else one.tobytes() for one in FRAMES]
    asked = dict(pairwise(command))
    assert (asked["-s"], asked["-r"], asked["-pix_fmt"]) == ("70x90", "12.500000", "pal8" if gif else "rgba")
    assert ("-loop" in command) is gif and ("-an" in command) is (not gif and not sound)
    assert asked["-f"] == "rawvideo" and list(tmp_path.iterdir()) == [tmp_path / "a.gif"]


def test_options_of_an_mp4() -> None:
    command = _command(Path("a"), (70, 90), 60.0, False, Path("b.wav"))
    asked = dict(pairwise(command))
    assert [asked[name] for name in ("-c:v", "-crf", "-c:a", "-b:a", "-colorspace")] == [
        "libx264",
        "19",
        "aac",
        "128k",
        "bt709",
    ]
    assert command[-1] == "a" and command.index("b.wav") > command.index("-") and asked["-vf"].endswith("format=yuv420p")


def test_where_a_movie_can_be_written(tmp_path: Path) -> None:
    (tmp_path / "folder.mp4").mkdir()
    assert check_path(str(tmp_path / "a.Mp4")) == tmp_path / "a.Mp4" and check_path(tmp_path / "b.gif") == tmp_path / "b.gif"
    assert check_path(tmp_path / "new" / "a.mp4") == tmp_path / "new" / "a.mp4"  # missing folders are made
    for name, error in (("a.avi", ValueError), ("folder.mp4", IsADirectoryError)):
        with pytest.raises(error):
            check_path(tmp_path / name)
