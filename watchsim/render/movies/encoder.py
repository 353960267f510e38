"""How do frames become a file?

Raw frames are piped into the ffmpeg that comes with imageio-ffmpeg. The file gets its name only when the encoder has ended
well, so that a full disk or an interrupt never leaves half a movie.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from watchsim.render.movies.gif_colours import Palette
from watchsim.storage.write import write_file

Pixels = NDArray[np.uint8]

ENDINGS = (".mp4", ".gif")
AUDIO = "128k"  # bits per second of one channel
PIPE = 2**20  # bytes: the most that Linux grants anybody


def check_path(path: str | os.PathLike[str]) -> Path:
    """The path, if a movie can be written there: ValueError for a wrong ending, OSError where there is no such folder."""
    target = Path(path)
    if target.suffix.lower() not in ENDINGS:
        raise ValueError(f"{target}: the ending decides the format of a movie; use {' or '.join(ENDINGS)}")
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{target}: there is no folder {target.parent}; create it first")
    if target.is_dir():
        raise IsADirectoryError(f"{target} is a folder; a movie needs the name of a file")
    return target


def encode(
    frames: Iterable[Pixels],
    path: Path,
    size: tuple[int, int],
    fps: float,
    palette: Palette | None = None,
    sound: Callable[[Path], None] | None = None,
) -> None:
    """Write frames, each (height, width, 4) 8-bit RGBA, as MP4 or, with a `palette`, as GIF.

    `sound` writes a WAV file to the place it is given, which becomes the sound of an MP4.
    OSError with the encoder's own words where it fails; the destination then is as it was before.
    """
    raw = (np.ascontiguousarray(frame).data for frame in frames) if palette is None else map(palette.indexed, frames)

    def make(scratch: Path) -> None:
        if sound is None:
            _run(_command(scratch, size, fps, palette is not None), raw)
            return
        with tempfile.TemporaryDirectory(dir=scratch.parent) as folder:
            heard = Path(folder) / "sound.wav"
            sound(heard)
            _run(_command(scratch, size, fps, palette is not None, heard), raw)

    write_file(path, make, "the movie")


def _command(scratch: Path, size: tuple[int, int], fps: float, gif: bool, sound: Path | None = None) -> list[str]:
    from imageio_ffmpeg import get_ffmpeg_exe

    layout = "pal8" if gif else "rgba"
    source = ["-f", "rawvideo", "-pix_fmt", layout, "-s", f"{size[0]}x{size[1]}", "-r", f"{fps:.6f}", "-i", "-"]
    head = [get_ffmpeg_exe(), "-y", "-nostdin", "-hide_banner", "-loglevel", "error", *source]
    if gif:
        return [*head, "-loop", "0", str(scratch)]
    # High definition is BT.709; untagged files show their colours differently from player to player.
    convert = ["-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"]
    tags = ["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"]
    quality = ["-c:v", "libx264", "-preset", "veryfast", "-crf", "19", "-tune", "animation", "-subq", "1"]
    heard = ["-an"] if sound is None else ["-i", str(sound), "-map", "0:v", "-map", "1:a", "-c:a", "aac", "-b:a", AUDIO]
    return [*head, *heard, *convert, *quality, *tags, "-movflags", "+faststart", str(scratch)]


def _run(command: list[str], frames: Iterable[bytes | memoryview]) -> None:
    """Feed the encoder; its own session keeps a Ctrl-C meant for us from cutting it off unnoticed."""
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stderr=pipe, bufsize=0, start_new_session=True) as process:
        assert process.stdin is not None and process.stderr is not None
        _widen(process.stdin)
        broken = False
        try:
            for frame in frames:
                _feed(process.stdin, memoryview(frame).cast("B"))
        except BrokenPipeError:
            broken = True  # the encoder died; what it said is reported below
        except BaseException:
            process.kill()
            raise
        process.stdin.close()
        words = process.stderr.read().decode(errors="replace")
        # Some releases of ffmpeg end with status 0 after a write that failed.
        if process.wait() != 0 or broken or _refusals(words):
            raise OSError(_reason(words))


def _widen(pipe: IO[bytes]) -> None:
    """A pipe that holds a quarter of a frame, where the system has such: drawing and encoding wait less for one another."""
    try:
        import fcntl

        fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, PIPE)
    except (ImportError, AttributeError, OSError):
        pass  # not Linux, or a limit below it: the usual pipe does as well, more slowly


def _feed(pipe: IO[bytes], rest: memoryview) -> None:
    """An unbuffered pipe takes what it can; nothing lingers in a buffer to fail again when the pipe is closed."""
    while rest:
        rest = rest[pipe.write(rest) :]


def _lines(words: str) -> list[str]:
    return [line.strip() for line in words.splitlines() if line.strip()]


def _refusals(words: str) -> list[str]:
    """The lines that say why a file could not be written."""
    return [line for line in _lines(words) if any(why in line for why in ("No space left", "denied", "File too large"))]


def _reason(words: str) -> str:
    return (_refusals(words) or _lines(words) or ["the encoder stopped without a message"])[0]
