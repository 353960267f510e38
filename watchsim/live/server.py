"""Who watches the files, who may ask, and what is sent?

One process serves the page on this machine's own address, watches the folders of the scene and its drawings, and orders an
answer for each content that it has not seen yet (`engine`). The page hears by server-sent events: of each kind the latest, so
that a slow reader skips what is out of date and nothing piles up. Whoever asks needs the token that the address holds; Host and
Origin are checked besides, since a page of another site can ask this address, too.
"""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import secrets
import socket
import time
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, PlainTextResponse, Response, StreamingResponse
from starlette.routing import Route
from starlette.types import ASGIApp, Receive, Scope, Send
from watchfiles import awatch

from watchsim.live.edit import Edits, Refused
from watchsim.live.engine import Answer, Engine, Order
from watchsim.pages.live_page import live_page
from watchsim.scene.toml import parsed

LOOPBACK = "127.0.0.1"
HOSTS = (LOOPBACK, "localhost")
STEP = 50  # ms without a change, after which changes are looked at
TIMEOUT = 1000  # ms between looks where the system reports nothing, as on a shared drive
SETTLING, PATIENCE = 0.06, 0.6  # s: between two equal looks; that a file may be empty or missing while an editor saves it
BEAT = 0.5  # s between looks whether the server is to end
LEFT = 1  # s that requests may take then
HEADERS = {
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}


class Live:
    """A scene that is followed; `url` is where its page is."""

    def __init__(self, path: Path, port: int = 0) -> None:
        """OSError where the port cannot be had."""
        self.path, self.edits, self.token = path, Edits(path), secrets.token_urlsafe(24)
        self._socket = socket.create_server((LOOPBACK, port))
        self.origin = f"http://{LOOPBACK}:{self._socket.getsockname()[1]}"
        self.url = f"{self.origin}/?token={self.token}"
        self._state: dict[str, tuple[int, str]] = {}  # latest news of each kind, with its place in the order of all
        self._count = self._number = 0
        self._seen: dict[Path, str] = {}
        self._named: tuple[Path, ...] = ()
        self._hold = False
        self._engine: Engine | None = None
        self._server: uvicorn.Server | None = None

    def serve(self, ready: Callable[[str], object] = lambda _: None) -> None:
        """Until the process is asked to stop; `ready` is called with the address once it answers."""
        self._ready = ready
        config = uvicorn.Config(self._app(), log_level="critical", timeout_graceful_shutdown=LEFT, lifespan="on", ws="none")
        self._server = uvicorn.Server(config)
        self._server.run(sockets=[self._socket])

    def _app(self) -> ASGIApp:
        routes = [
            Route("/", self._page),
            Route("/events", self._events),
            Route("/set", self._set, methods=["POST"]),
            Route("/undo", self._undo, methods=["POST"]),
            Route("/hold", self._set_hold, methods=["POST"]),
        ]
        guards = [Middleware(TrustedHostMiddleware, allowed_hosts=list(HOSTS)), Middleware(_Guard, live=self)]
        return Starlette(routes=routes, middleware=guards, lifespan=self._lifespan)

    @contextlib.asynccontextmanager
    async def _lifespan(self, _: Starlette) -> AsyncIterator[None]:
        self._news, self._loop, self._lock = asyncio.Event(), asyncio.get_running_loop(), asyncio.Lock()
        self._order(self._look())
        watching = asyncio.create_task(self._watch())
        self._loop.call_soon(self._ready, self.url)
        try:
            yield
        finally:
            watching.cancel()
            if self._engine:
                self._engine.close()
            with contextlib.suppress(asyncio.CancelledError):
                await watching

    # What is watched: the folders, since an editor may put another file in the place of one, and the content decides.

    async def _watch(self) -> None:
        while True:
            folders = {path.parent for path in self._files() if path.parent.is_dir()}
            with contextlib.suppress(OSError, RuntimeError):  # a folder has gone: look again
                async for _ in awatch(
                    *folders, watch_filter=None, step=STEP, rust_timeout=TIMEOUT, yield_on_timeout=True, recursive=False
                ):
                    await self._check()
                    if folders != {path.parent for path in self._files() if path.parent.is_dir()}:
                        break
            await asyncio.sleep(SETTLING)

    def _files(self) -> tuple[Path, ...]:
        """The scene and the drawings that it names, as long as it can be read; each with what it is a link to."""
        with contextlib.suppress(OSError, ValueError, AttributeError):
            bodies = parsed(self.path.read_text(encoding="utf-8-sig")).get("bodies", {}).values()
            names = [body["drawing"] for body in bodies if isinstance(body, dict) and isinstance(body.get("drawing"), str)]
            paths = [self.path, *(self.path.parent / name for name in names)]
            self._named = tuple(dict.fromkeys(one for path in paths for one in (path, path.resolve())))
        return self._named or (self.path,)

    def _look(self) -> dict[Path, str]:
        """A digest of every file; "" for one that is empty or not there."""
        found = {}
        for path in self._files():
            content = b""
            with contextlib.suppress(OSError):
                content = path.read_bytes()
            found[path] = hashlib.sha256(content).hexdigest() if content else ""
        return found

    async def _check(self) -> None:
        """Order an answer where something is there that was not seen before, once it has come to rest."""
        begun, now = time.monotonic(), self._look()
        while now != self._seen:
            await asyncio.sleep(SETTLING)
            before, now = now, self._look()
            lacks = any(not digest and self._seen.get(path) for path, digest in now.items())
            if now == before and not (lacks and time.monotonic() - begun < PATIENCE):
                break
        if now != self._seen:
            self._order(now)

    def _order(self, seen: dict[Path, str]) -> None:
        self._seen, self._number = seen, self._number + 1
        order = Order(self._number, self.path, self._hold)
        if self._engine is None:
            self._engine = Engine(order, lambda answer: self._loop.call_soon_threadsafe(self._hear, answer))
        else:
            self._engine.order(order)
        self._tell_status()

    def _tell_status(self) -> None:
        self._put("status", order=self._number, undo=self.edits.count, hold=self._hold)

    def _hear(self, answer: Answer) -> None:
        if answer.kind == "lost":
            self._engine = self._engine if answer.number else None
            words = (
                "The process that computes was ended from outside, perhaps for lack of memory. The next save begins a new one."
            )
            self._put("faults", order=self._number, faults=[words], drawings=[])
        elif answer.kind == "faults" and self._look() != self._seen:
            return  # it was read while it was saved: the next order is on its way
        elif answer.number == self._number:
            if answer.kind == "scene":
                self._state.pop("faults", None)
            self._put(answer.kind, order=answer.number, **answer.value)

    # What is sent.

    def _put(self, kind: str, **value: Any) -> None:
        self._count += 1
        self._state[kind] = self._count, json.dumps(value, allow_nan=False)
        self._news.set()
        self._news = asyncio.Event()

    async def _page(self, _: Request) -> Response:
        return HTMLResponse(live_page(self.path.parent.name, self.token))

    async def _events(self, _: Request) -> Response:
        async def stream() -> AsyncIterator[str]:
            sent = 0
            while self._server is None or not self._server.should_exit:
                news, last = self._news, self._count
                for count, kind, text in sorted((count, kind, text) for kind, (count, text) in self._state.items()):
                    if sent < count <= last:
                        yield f"event: {kind}\ndata: {text}\n\n"
                sent = last
                with contextlib.suppress(asyncio.TimeoutError):
                    await asyncio.wait_for(news.wait(), BEAT)

        return StreamingResponse(stream(), media_type="text/event-stream")

    async def _set(self, request: Request) -> Response:
        asked = await request.json()
        return await self._edited(lambda: self.edits.set(str(asked["key"]), str(asked["value"]).strip()))

    async def _undo(self, _: Request) -> Response:
        return await self._edited(self.edits.undo)

    async def _set_hold(self, request: Request) -> Response:
        self._hold = bool((await request.json())["hold"])
        self._tell_status()
        return JSONResponse({})

    async def _edited(self, edit: Callable[[], None]) -> Response:
        async with self._lock:
            try:
                await run_in_threadpool(edit)
            except (Refused, OSError) as error:
                self._tell_status()
                return JSONResponse({"refused": str(error)}, 409)
        self._tell_status()
        await self._check()
        return JSONResponse({})


class _Guard:
    """Lets in who has the token and comes from no other page, and says how browsers are to treat what they get."""

    def __init__(self, app: ASGIApp, live: Live) -> None:
        self.app, self.live = app, live

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        request = Request(scope)
        given = request.headers.get("x-token") or request.query_params.get("token") or ""
        port = self.live.origin.rpartition(":")[2]
        origin = request.headers.get("origin")
        if origin not in (None, *(f"http://{host}:{port}" for host in HOSTS)):
            await PlainTextResponse("This comes from the page of another site.\n", 403)(scope, receive, send)
            return
        if not secrets.compare_digest(given.encode(), self.live.token.encode()):
            words = "This address needs its token: open the one that watchsim live has printed.\n"
            await PlainTextResponse(words, 403)(scope, receive, send)
            return

        async def with_headers(message: Any) -> None:
            if message["type"] == "http.response.start":
                message["headers"] += [(name.lower().encode(), value.encode()) for name, value in HEADERS.items()]
            await send(message)

        await self.app(scope, receive, with_headers)
