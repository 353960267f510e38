"""Is an old movie left as it was where the new one cannot be written, and is a picture made of the longest words?"""

import os
import stat
import time
from pathlib import Path

import imageio.v3 as imageio
import pytest
from render.fake_runs import watch_run

import watchsim as ws

SMALL = (480, 270)
FULL_DISK = "cat > /dev/null; echo 'frame 1' >&2; echo 'write: No space left on device' >&2; exit {}"


@pytest.mark.skipif(os.name != "posix", reason="the encoder here is a script of the shell")
@pytest.mark.parametrize(
    ("does", "said"),
    [
        (FULL_DISK.format(1), "write: No space left on device"),
        (FULL_DISK.format(0), "write: No space left on device"),  # as some releases of ffmpeg end
        ("echo 'it dies at once' >&2; exit 1", "it dies at once"),
        ("exit 3", "stopped without a message"),
    ],
)
@pytest.mark.parametrize("name", ["beat.mp4", "beat.gif"])
def test_an_encoder_that_fails_leaves_the_old_movie(
    does: str, said: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    encoder = tmp_path / "ffmpeg"
    encoder.write_text(f'#!/bin/sh\nfor last; do :; done\necho half > "$last"\n{does}\n', encoding="utf-8")
    encoder.chmod(encoder.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(encoder))
    folder = tmp_path / "movies"
    folder.mkdir()
    (folder / name).write_bytes(b"the old movie")
    with pytest.raises(OSError, match=said):
        ws.movie(watch_run(), folder / name, size=SMALL, speed=2.0, fps=20)
    assert (folder / name).read_bytes() == b"the old movie" and list(folder.iterdir()) == [folder / name]


def test_a_title_of_ten_megabytes_is_cut_in_a_plot(tmp_path: Path) -> None:
    """In less time than its letters would take to be measured."""
    begun = time.process_time()
    run = watch_run(title="tick " * 2_000_000)
    place = tmp_path / "kinematics.png"
    ws.plot_kinematics(run).savefig(place)
    assert imageio.imread(place).shape[0] > 0 and time.process_time() - begun < 20.0
