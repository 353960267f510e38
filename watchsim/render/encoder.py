"""How do frames become a file, in how many colours, and how large are they?

Raw frames are piped into the ffmpeg that comes with imageio-ffmpeg. The file gets its name only when the encoder has ended
well, so that a full disk or an interrupt never leaves half a movie. A GIF has one palette for all frames: nothing flickers,
unchanged pixels stay unchanged, and the file stays small.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np
from matplotlib.figure import Figure

from watchsim.render.palette import LIGHT
from watchsim.render.stage import DPI, Extras, rooms
from watchsim.render.view import Pixels, Window
from watchsim.render.words import lay_out
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.write import write_file

COLOURS = 64
PINNED = 24  # of these: the plain faces, exactly
HEAVIEST = 400  # weight above which a colour needs no more say
BITS = 6  # per channel, of the table from colours to the palette


@dataclass(frozen=True)
class Palette:
    """`colours` (COLOURS, 3); `table` gives the nearest of them for every colour of BITS bits per channel."""

    colours: Pixels
    table: Pixels

    def indexed(self, picture: Pixels) -> bytes:
        """The picture (height, width, 3 or 4) as one palette index a pixel, followed by 256 colours as B, G, R, A."""
        channels = (picture[..., :3] >> (8 - BITS)).astype(np.int32)
        index = self.table[(channels[..., 0] << (2 * BITS)) | (channels[..., 1] << BITS) | channels[..., 2]]
        entries = np.zeros((256, 4), dtype=np.uint8)  # those left over are transparent: the encoder marks "as before" with one
        entries[: len(self.colours), :3], entries[: len(self.colours), 3] = self.colours[:, ::-1], 255
        return index.tobytes() + entries.tobytes()


def shared_palette(samples: Iterable[Pixels], named: Iterable[str] = ()) -> Palette:
    """The palette for frames like the samples, each (height, width, 3 or 4), and for these `named` colours (#rrggbb) exactly.

    Colours count by the root of their area, so that a ruby of a few pixels keeps its red beside a large pale ground.
    """
    from PIL import Image

    seen = np.concatenate([sample[..., :3].reshape(-1, 3) for sample in samples]).astype(np.uint32)
    packed, counts = np.unique(seen @ np.array([65536, 256, 1], dtype=np.uint32), return_counts=True)
    found = np.column_stack((packed >> 16, (packed >> 8) & 255, packed & 255)).astype(np.uint8)
    strip = np.repeat(found, np.minimum(np.ceil(np.sqrt(counts)), HEAVIEST).astype(int), axis=0)
    asked = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in named], np.uint8).reshape(-1, 3)
    pinned = np.concatenate((asked, found[np.argsort(-counts)][: PINNED - len(asked)]))
    image = Image.fromarray(strip[None]).quantize(COLOURS - len(pinned), method=Image.Quantize.MEDIANCUT, kmeans=3)
    mixed = np.array(image.getpalette(), dtype=np.uint8).reshape(-1, 3)[: COLOURS - len(pinned)]
    return _with_table(np.concatenate((pinned, mixed)))


def _with_table(colours: Pixels) -> Palette:
    levels = (np.arange(2**BITS) * 2 ** (8 - BITS) + 2 ** (7 - BITS)).astype(np.float32)
    grid = np.stack(np.meshgrid(levels, levels, levels, indexing="ij"), axis=-1).reshape(-1, 3)
    points = colours.astype(np.float32)
    # |grid - point|² without the term that is the same for all points
    distance = (points * points).sum(axis=1) - 2.0 * grid @ points.T
    table = distance.argmin(axis=1).astype(np.uint8)
    exact = colours.astype(np.int32) >> (8 - BITS)
    table[((exact[:, 0] << (2 * BITS)) | (exact[:, 1] << BITS) | exact[:, 2])[::-1]] = np.arange(len(colours))[::-1]
    return Palette(colours, table)


ENDINGS = (".mp4", ".gif")
AUDIO = "128k"  # bits per second of one channel
PIPE = 2**20  # bytes: the most that Linux grants anybody


def check_path(path: str | os.PathLike[str], endings: tuple[str, ...] = ENDINGS, what: str = "a movie") -> Path:
    """The path, if `what` can be written there: ValueError for a wrong ending, OSError for a folder."""
    target = Path(path)
    if target.suffix.lower() not in endings:
        raise ValueError(f"{target}: the ending decides the format of {what}; use {' or '.join(endings)}")
    if target.is_dir():
        raise IsADirectoryError(f"{target} is a folder; {what} needs the name of a file")
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


AUTO = "auto"  # a size
MP4_SIZE, GIF_SIZE = (1280, 720), (800, 450)
FORMATS = ((1280, 720), (960, 960), (860, 1076), (720, 1280))  # wide, square, 4 : 5, tall; about as many pixels in all
FORMATS_GIF = ((800, 450), (600, 600), (536, 670), (450, 800))
SIZES = (64, 8192)  # pixels a side
GAIN = 1.05  # by which a less usual format must enlarge the mechanism

Size = tuple[int, int]


def fitting(
    run: Trajectory, window: Window, extras: Extras, zoom: Sequence[str] | None, gif: bool, turn: float | None
) -> tuple[Size, float | None]:
    """The format in which the mechanism is largest, and the turn (rad) to draw it with: as asked, else as it is drawn."""
    if turn is None and not any(run.scene.gravity):
        turn = 0.0
    best, largest = (GIF_SIZE if gif else MP4_SIZE), 0.0
    for size in FORMATS_GIF if gif else FORMATS:
        figure = Figure(figsize=((size[0] + 0.5) / DPI, (size[1] + 0.5) / DPI), dpi=DPI)
        layout = lay_out(figure, run, window, (window[1] - window[0]) / 2000.0, LIGHT)
        seen = rooms(run, window, layout, extras, size[1], zoom, turn).sight.view
        if seen.follow is not None:
            return best, None
        if seen.scale > GAIN * largest:
            best, largest = size, seen.scale
    return best, turn


def checked(size: Size) -> Size:
    """The size, if a picture can have it; ValueError else."""
    try:
        width, height = (int(side) for side in size)
    except (TypeError, ValueError):
        raise ValueError(f'size = {size!r}: give (width, height) in pixels, or "{AUTO}"') from None
    if not all(SIZES[0] <= side <= SIZES[1] for side in (width, height)):
        raise ValueError(f"size = {width}x{height}: each side must be {SIZES[0]} to {SIZES[1]} pixels")
    return width, height


def even_sides(size: Size) -> Size:
    """The colour planes of an MP4 have half the size, so its sides must be even."""
    width, height = checked(size)
    return width + width % 2, height + height % 2
