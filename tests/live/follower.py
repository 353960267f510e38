"""watchsim live as a process, and what its page would hear."""

import http.client
import json
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from watchsim.paths import profiles_dir

pytest.importorskip("watchfiles", reason="the server is not installed: pip install 'watchsim[live]'")
PATIENCE = 90.0  # s; a busy machine


def copied(name: str, folder: Path) -> Path:
    """A profile to change."""
    return Path(shutil.copytree(Path(str(profiles_dir())) / name, folder / name))


class Follower:
    """`heard` holds (kind, value) in order."""

    def __init__(self, scene: Path, *options: str) -> None:
        words = [sys.executable, "-m", "watchsim", "live", str(scene), "--no-browser", *options]
        self.process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.process.stdout
        self.url = self.process.stdout.readline().strip()
        self.address, _, self.token = self.url.removeprefix("http://").partition("/?token=")
        self.heard: list[tuple[str, dict[str, Any]]] = []
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        connection = http.client.HTTPConnection(self.address)
        connection.request("GET", f"/events?token={self.token}")
        lines, kind = connection.getresponse(), ""
        for line in iter(lines.readline, b""):
            name, _, rest = line.decode().rstrip("\n").partition(": ")
            if name == "event":
                kind = rest
            elif name == "data":
                self.heard.append((kind, json.loads(rest)))

    def ask(self, method: str, path: str, body: Any = None, headers: dict[str, str] | None = None) -> tuple[int, str]:
        connection = http.client.HTTPConnection(self.address, timeout=PATIENCE)
        connection.request(method, path, None if body is None else json.dumps(body), headers or {"X-Token": self.token})
        answer = connection.getresponse()
        return answer.status, answer.read().decode()

    def until(self, kind: str, order: int = 0, holds: Callable[[dict[str, Any]], bool] = lambda _: True) -> dict[str, Any]:
        """The first of that kind, of that order or a later one."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            for name, value in list(self.heard):
                if name == kind and value["order"] >= order and holds(value):
                    return value
            time.sleep(0.01)
        raise AssertionError(f"no {kind} of order {order}: {[(name, value['order']) for name, value in self.heard]}")

    @property
    def orders(self) -> int:
        return max((value["order"] for name, value in self.heard if name == "status"), default=0)

    def ended(self, number: int = signal.SIGINT) -> int:
        self.process.send_signal(number)
        return self.process.wait(timeout=20)


@contextmanager
def following(scene: Path, *options: str) -> Iterator[Follower]:
    follower = Follower(scene, *options)
    try:
        yield follower
    finally:
        follower.process.kill()
        follower.process.wait()
        for pipe in (follower.process.stdout, follower.process.stderr):
            assert pipe
            pipe.close()
