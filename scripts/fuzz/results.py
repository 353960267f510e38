"""Does any damaged results folder bring watchsim down?

Makes one folder, damages copies of it at random (files lost, cut, overwritten, exchanged; arrays and headers changed within
sound archives), and has `plot`, `movie` or `run --resume` read them, or what `--command` names. A folder fails that brings
exit status 4, a traceback, the death of the process, or takes more than 20 s. `--only K` repeats number K.
"""

import argparse
import contextlib
import io
import json
import random
import shutil
import sys
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rounds import add_numbers, campaign, in_a_process, judged

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
SCENE = str(ROOT / "profiles" / "bench_lever")
FILES = ("trajectory.npz", "state.npz", "scene.lock.toml", "summary.json")
COMMANDS = ("plot", "plot", "movie", "resume")
NASTY: tuple[object, ...] = (None, [], {}, "x", -1, 10**30, 1e300, [[]], {"a": 1}, True, "DURATION")


def damage(rng: random.Random, folder: Path) -> None:
    """One accident."""
    path = folder / rng.choice((*FILES, "trajectory.npz", "state.npz"))
    if path.is_dir():
        return
    kind = rng.choice(("lost", "cut", "bytes", "folder", "exchanged", "empty", "header", "array", "array", "member"))
    data = path.read_bytes() if path.is_file() else b""
    if kind == "lost":
        path.unlink(missing_ok=True)
    elif kind == "cut":
        path.write_bytes(data[: rng.randrange(len(data) + 1)])
    elif kind == "bytes":
        changed = bytearray(data)
        for _ in range(rng.randrange(1, 20) if changed else 0):
            changed[rng.randrange(len(changed))] = rng.randrange(256)
        path.write_bytes(changed)
    elif kind == "folder":
        path.unlink(missing_ok=True)
        path.mkdir(exist_ok=True)
    elif kind == "exchanged":
        other = folder / rng.choice(FILES)
        path.write_bytes(other.read_bytes() if other.is_file() else b"")
    elif kind == "empty":
        path.write_bytes(b"")
    else:
        with contextlib.suppress(Exception):  # damaged already
            _inside(rng, path, kind)


def _inside(rng: random.Random, path: Path, kind: str) -> None:
    """Another content in a sound archive."""
    with np.load(path, allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    name = rng.choice([name for name in arrays if (name == "header") == (kind == "header")])
    array = arrays[name]
    if kind == "header":
        header = json.loads(array.tobytes())
        key = rng.choice(list(header))
        if rng.random() < 0.2:
            del header[key]
        else:
            header[key] = rng.choice(NASTY)
        arrays[name] = np.frombuffer(json.dumps(header).encode(), np.uint8)
    elif kind == "member":
        if rng.random() < 0.5:
            del arrays[name]
        else:
            arrays[name] = np.zeros((3, 3))
    else:
        arrays[name] = rng.choice(CHANGES)(rng, array)
    with zipfile.ZipFile(path, "w") as file:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(array), allow_pickle=False)
            file.writestr(f"{name}.npy", buffer.getvalue())


def _nan(rng: random.Random, array: np.ndarray) -> np.ndarray:
    array = array.copy()
    if array.dtype.kind == "f" and array.size:
        array.flat[rng.randrange(array.size)] = rng.choice((np.nan, np.inf, -np.inf))
    return array


def _other_type(rng: random.Random, array: np.ndarray) -> np.ndarray:
    return np.zeros(array.shape, rng.choice(("i1", "f4", "U3", "c16", "?")))


def _huge(_: random.Random, array: np.ndarray) -> np.ndarray:
    whole = array.dtype.kind in "iu" and array.dtype.itemsize > 2
    return np.full_like(array, 10**9 if whole else 100) if array.dtype.names is None else array


CHANGES: tuple[Callable[[random.Random, np.ndarray], np.ndarray], ...] = (
    lambda rng, array: array[: rng.randrange(len(array) + 1)] if array.ndim else array,
    *(_nan, lambda _, array: array.reshape(-1), _other_type, lambda _, array: np.zeros_like(array), _huge),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_numbers(parser, 200)
    parser.add_argument(
        "--command", choices=("plot", "movie", "resume", "report", "sound", "export"), help="read all by this one"
    )
    args = parser.parse_args()
    from watchsim.cli import main as watchsim

    with tempfile.TemporaryDirectory() as parent:
        whole = Path(parent) / "whole"
        watchsim(["run", SCENE, "--duration", "0.2 s", "-o", str(whole)])

        def round_of(number: int) -> tuple[str, str, float]:
            rng = random.Random(f"results {number}")
            folder = Path(parent) / "copy"
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(whole, folder)
            for _ in range(rng.choice((1, 1, 2))):
                damage(rng, folder)
            command = args.command or rng.choice(COMMANDS)
            answer = in_a_process(Path(parent), lambda: judged(_arguments(command, folder)))
            for report in Path(parent).glob("watchsim-fault-*.txt"):
                report.unlink()
            return command, *answer

        sys.exit(campaign(args, round_of, "results folders"))


def _arguments(command: str, folder: Path) -> list[str]:
    if command == "plot":
        return ["plot", str(folder)]
    if command == "movie":
        return ["movie", str(folder), "--size", "64x64", "--window", "0.1 s:0.11 s", "--speed", "1/10"]
    if command in ("report", "sound"):
        return [command, str(folder)]
    if command == "export":
        return ["export", str(folder), "-o", str(folder.parent / "exported"), "--format", "glb", "--force"]
    return ["run", SCENE, "--resume", str(folder), "--duration", "0.21 s", "--no-plots"]


if __name__ == "__main__":
    main()
