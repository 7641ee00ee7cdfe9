"""The server of the explorer: who gets in, how many, and what is left of a page that was closed."""

from __future__ import annotations

import asyncio
import gc
import logging
import logging.handlers
import re
import socket
import subprocess
import sys
import threading
import time
import weakref
import webbrowser
from collections.abc import Awaitable, Callable
from functools import partial
from itertools import product
from pathlib import Path
from queue import Queue
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch
from urllib.parse import urlsplit
from urllib.request import url2pathname

import panel as pn
import pytest
from bokeh.document import Document
from bokeh.events import DocumentReady
from panel.io.state import set_curdoc
from tornado.httpclient import AsyncHTTPClient, HTTPRequest, HTTPResponse
from tornado.websocket import WebSocketClientConnection, websocket_connect

from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.page import build
from stickslip.extensions.explorer.server import serve as serving
from stickslip.extensions.explorer.server.desk import ThreadDesk, Warming
from stickslip.extensions.explorer.server.serve import Endpoint, ExplorerServer
from stickslip.extensions.explorer.server.start import open_browser, start
from stickslip.foundation.errors import InputError

TOKEN = re.compile(r'"token":"([^"]+)"')
"""Where a page holds the token of its websocket."""


class Served:
    """A server with pages of one line, and a browser without a window that keeps cookies."""

    def __init__(self, place: Endpoint) -> None:
        self.explorers: list[weakref.ref[Explorer]] = []
        self.lines: list[WebSocketClientConnection] = []
        self.server = ExplorerServer(place, self._make, lambda explorer: pn.pane.HTML("a page"))
        self.server.warming.begin = lambda: None  # type: ignore[method-assign] # nothing is calculated here
        self.server.start()
        self.base = f"http://127.0.0.1:{self.server.port}/"
        self.cookie = ""

    def _make(self, desk: ThreadDesk, files: ThreadDesk) -> Explorer:
        made = Explorer(Setting.bundled("fig6-slab"), desk, lambda scenario, told: None, files)  # type: ignore[arg-type,return-value]
        self.explorers.append(weakref.ref(made))
        return made

    async def get(self, path: str = "", **headers: str) -> HTTPResponse:
        """Ask for a path below the address; the cookie is sent along."""
        sent = {"Cookie": self.cookie, **headers} if self.cookie else headers
        request = HTTPRequest(self.base + path, headers=sent, follow_redirects=False)
        return await AsyncHTTPClient(force_instance=True).fetch(request, raise_error=False)

    async def enter(self) -> HTTPResponse:
        """Open the address with the token, and keep the cookie."""
        answer = await self.get(self.server.url.partition("/?")[2].join(("?", "")))
        self.cookie = answer.headers["Set-Cookie"].partition(";")[0]
        return answer

    async def connect(self, page: HTTPResponse, origin: str | None = None) -> WebSocketClientConnection:
        """Connect a page to its session, as its scripts do."""
        found = TOKEN.search(page.body.decode())
        assert found is not None
        headers = {"Cookie": self.cookie} if self.cookie else {}
        if origin is not None:
            headers["Origin"] = origin
        request = HTTPRequest(f"{self.base.replace('http', 'ws')}ws", headers=headers)
        line = await websocket_connect(request, subprotocols=["bokeh", found[1]])
        self.lines.append(line)
        return line

    async def hang_up(self) -> None:
        """Close the first connection that is still open, as a browser does with a tab."""
        line = self.lines.pop(0)
        line.close()
        while await line.read_message() is not None:
            pass

    @property
    def open_pages(self) -> int:
        """The number of sessions."""
        return len(self.server._bokeh.get_sessions("/"))


def with_server(test: Callable[[Served], Awaitable[None]], **place: Any) -> None:
    """Run a test beside a server, in one event loop.

    The browsers of these tests do not tell that they have put a page together: it is taken to be there at once.
    """

    async def run() -> None:
        served = Served(Endpoint(**({"port": 0} | place)))
        try:
            await test(served)
            while served.lines:
                await served.hang_up()
        finally:
            served.server.stop()

    with patch.object(serving, "LONGEST_LOADING", 0.0):
        asyncio.run(run())


async def until(reached: Callable[[], bool]) -> None:
    """Wait until something is reached."""
    for _ in range(400):
        if reached():
            return
        await asyncio.sleep(0.02)
    raise AssertionError("it was never reached")


def said(answer: HTTPResponse) -> str:
    """Return the one sentence of a plain page."""
    found = re.fullmatch(r"<!DOCTYPE html>\n<title>stickslip</title>\n<p>(.*)</p>\n", answer.body.decode())
    assert found is not None, answer.body[:300]
    return found[1]


def test_nothing_is_shown_without_the_token() -> None:
    async def test(served: Served) -> None:
        refused = [await served.get(path) for path in ("", "?token=", "?token=%ff", "?token=wrong", "static/js/bokeh.min.js", "ws")]
        assert [one.code for one in refused] == [403] * 6
        assert {said(one) for one in refused} == {
            "This page needs its token: open the whole address that `stickslip explore` printed in the terminal."
        }
        served.cookie = f"stickslip-{served.server.port}=wrong"
        assert (await served.get()).code == 403
        assert served.open_pages == 0

    with_server(test)


def test_the_token_becomes_a_cookie_and_leaves_the_address() -> None:
    async def test(served: Served) -> None:
        token = served.server.access.token
        answer = await served.get(f"?token={token}&scenario=fig6-slab&friction.alpha=0.7%20s%2Fm")
        assert (answer.code, answer.headers["Location"]) == (302, "/?scenario=fig6-slab&friction.alpha=0.7+s%2Fm")
        cookie = answer.headers["Set-Cookie"]
        assert cookie.startswith(f"stickslip-{served.server.port}={token};")
        assert {"HttpOnly", "SameSite=Lax"} <= set(cookie.split("; "))
        await served.enter()
        page = await served.get()
        assert page.code == 200
        assert token not in page.body.decode()

    with_server(test)


def test_only_the_page_and_the_bundled_files_are_answered() -> None:
    async def test(served: Served) -> None:
        await served.enter()
        codes = {
            path: (await served.get(path)).code
            for path in (
                "static/js/bokeh.min.js",
                "favicon.ico",
                "static/",
                "static/js/",
                "static/%00",
                "static/js/%0a",
                "static/%2e%2e/%2e%2e/bokeh/settings.py",
                "autoload.js?bokeh-autoload-element=a",
                "metadata",
                "components/os/path/_css/a",
                "../",
                "x",
            )
        }
        assert codes.pop("static/js/bokeh.min.js") == codes.pop("favicon.ico") == 200
        assert set(codes.values()) <= {403, 404}

    with_server(test)


def test_every_answer_forbids_what_comes_from_elsewhere() -> None:
    async def test(served: Served) -> None:
        await served.enter()
        for path in ("", "?token=wrong", "static/js/bokeh.min.js", "x"):
            policy = (await served.get(path)).headers["Content-Security-Policy"]
            assert policy.startswith("default-src 'self'; ")
            assert "frame-ancestors 'self'" in policy
            assert "http" not in policy

    with_server(test)


@pytest.mark.parametrize(
    ("origin", "allowed"),
    [
        (None, True),
        ("http://127.0.0.1:{port}", True),
        ("https://proxy.example", True),
        ("http://localhost:{port}", False),  # the page was asked for as 127.0.0.1
        ("https://evil.example", False),
    ],
)
def test_only_pages_of_this_server_may_connect(origin: str | None, allowed: bool) -> None:
    async def test(served: Served) -> None:
        await served.enter()
        page = await served.get()
        named = None if origin is None else origin.format(port=served.server.port)
        if allowed:
            await served.connect(page, named)
            return
        with pytest.raises(Exception, match="403"):
            await served.connect(page, named)

    with_server(test, origins=("Proxy.example",))


def test_a_websocket_needs_the_cookie_too() -> None:
    async def test(served: Served) -> None:
        await served.enter()
        page = await served.get()
        served.cookie = ""
        with pytest.raises(Exception, match="403"):
            await served.connect(page)

    with_server(test)


def test_a_server_on_the_loopback_address_has_no_other_name() -> None:
    async def test(served: Served) -> None:
        await served.enter()
        port = served.server.port
        assert (await served.get(Host=f"localhost:{port}")).code == 200
        for host in ("evil.example", f"evil.example:{port}", "127.0.0.1.evil.example", ""):
            assert (await served.get(Host=host)).code in (400, 403)

    with_server(test)


def test_a_body_that_is_too_large_is_refused() -> None:
    async def test(served: Served) -> None:
        await served.enter()
        request = HTTPRequest(served.base, method="POST", body=b"0" * 20_000, headers={"Cookie": served.cookie})
        answer = await AsyncHTTPClient(force_instance=True).fetch(request, raise_error=False)
        assert answer.code == 400

    with_server(test)


def test_one_page_too_many_is_refused_in_a_sentence_until_another_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(serving, "LOOK_EVERY_MS", 20)
    monkeypatch.setattr(serving, "LINGER_MS", 40.0)

    async def test(served: Served) -> None:
        await served.enter()
        pages = [await served.get() for _ in range(2)]
        for page in pages:
            await served.connect(page)
        refused = await served.get()
        assert (refused.code, said(refused).partition(":")[0]) == (
            503,
            "2 pages are open here, which is the limit (--sessions of `stickslip explore`)",
        )
        await until(lambda: len(served.server.sessions._seen) == 2)
        await served.hang_up()
        await until(lambda: served.open_pages == 1)
        assert (await served.get()).code == 200

    with_server(test, sessions=2)


def test_a_result_that_comes_while_the_page_is_being_made_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Bokeh now and then loses what another thread gives to a document: half of the pages waited for their first picture."""
    shown, threads, take = [], set(), serving.DeliveryToTab.take

    def noted(delivery: serving.DeliveryToTab, call: Callable[[], None]) -> None:
        threads.add(threading.current_thread())
        take(delivery, call)

    def build(explorer: Explorer) -> Any:
        explorer.listen("answer", lambda: shown.append(explorer.setting))
        explorer.change(explorer.setting)
        time.sleep(0.05)  # the work takes no time: its result is delivered now, while the event loop is busy here
        return pn.pane.HTML("a page")

    async def test(served: Served) -> None:
        served.server._build = build
        await served.enter()
        await served.connect(await served.get())
        await until(lambda: len(shown) == 2)  # this one, and that of the address
        assert threads == {threading.current_thread()}, "the document must be given callbacks by the event loop alone"

    monkeypatch.setattr(serving.DeliveryToTab, "take", noted)
    with_server(test)


def test_what_comes_before_the_browser_has_the_page_waits_for_it_in_order() -> None:
    """What changes after a page was sent and before it was put together is lost: some first answers were never shown."""
    document, called = Document(), []
    delivery = serving.DeliveryToTab(document)
    with patch.object(document, "add_next_tick_callback", lambda call: call()):
        for number in (1, 2):
            delivery.take(partial(called.append, number))
        assert called == []
        document.callbacks.trigger_event(DocumentReady())
        delivery.take(partial(called.append, 3))
    assert called == [1, 2, 3]


def test_what_one_call_changes_on_a_page_waits_until_its_end() -> None:
    """Then all changes are one message: each message costs a walk through all models of the page."""
    document, held = Document(), list[Any]()
    delivery = serving.DeliveryToTab(document)
    with patch.object(document, "add_next_tick_callback", lambda call: call()), set_curdoc(document):
        delivery.take(lambda: held.append(document.callbacks.hold_value))
        delivery.begin()
    assert (held, document.callbacks.hold_value) == (["combine"], None)


def test_nothing_of_a_closed_page_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(serving, "LOOK_EVERY_MS", 20)
    monkeypatch.setattr(serving, "LINGER_MS", 40.0)

    async def test(served: Served) -> None:
        await served.enter()
        await served.connect(await served.get())
        await until(lambda: bool(served.server.sessions._seen))
        (explorer,) = served.explorers
        assert explorer() is not None
        assert len(served.server._desks) == 2
        await served.hang_up()
        await until(lambda: served.open_pages == 0)
        assert served.server._desks == set()
        await until(lambda: gc.collect() >= 0 and explorer() is None)  # callbacks that were under way end first

    with_server(test)


ODD = ["1" * 400, "NaN", '{"type": "number", "value": "nan"}', '"x"', "null", "[1]"]
"""What a browser may send for a number, as JSON."""
FORMS = [
    '{"cursor": %s}',
    '{"step": %s}',
    '{"path": "body.density", "value": %s}',
    '{"parameter": %s, "low": 1}',
    '{"do": %s}',
    "%s",
]
"""What the scripts of the page send with a number."""


async def tell(line: WebSocketClientConnection, event: str) -> None:
    """Send one change of a document as Bokeh's scripts do."""
    for part in ('{"msgid": "1", "msgtype": "PATCH-DOC"}', "{}", f'{{"events": [{event}]}}'):
        await line.write_message(part)


def test_whatever_a_browser_sends_gets_one_short_line_in_the_log_and_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numbers beyond all floats and NaN, as what is entered, and in place of each property."""
    monkeypatch.setattr("bokeh.io.doc._PATCHED_CURDOCS", [])  # where Bokeh forgets a document for each change that it refuses
    log: Queue[logging.LogRecord] = Queue()
    handler = logging.handlers.QueueHandler(log)
    handler.setFormatter(serving._Lines())

    async def test(served: Served) -> None:
        served.server._build = build
        await served.enter()
        line = await served.connect(await served.get())
        await until(lambda: served.open_pages == 1)
        document = served.server._bokeh.get_sessions("/")[0].document
        scripts = [model for model in document.models if type(model).__name__ == "ReactiveESM"]
        assert len(scripts) == 6
        for script in scripts:
            for value in (entry % odd for entry in FORMS for odd in ODD):
                data = f'[["model", {{"id": "{script.id}"}}], ["data", {value}]]'
                values = f'{{"type": "event", "name": "data_event", "values": {{"type": "map", "entries": {data}}}}}'
                await tell(line, f'{{"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": {values}}}')
            for name, odd in product(sorted(script.data.properties_with_values()), ODD[:2]):
                model = f'{{"id": "{script.data.id}"}}'
                await tell(line, f'{{"kind": "ModelChanged", "model": {model}, "attr": "{name}", "new": {odd}}}')
        seen = log.qsize
        await until(lambda: bool(seen()))
        await asyncio.sleep(0.5)
        explorer = served.explorers[0]()
        assert explorer is not None
        assert "program fault" not in explorer.fault
        assert explorer.cursor == 0.0

    loggers = [logging.getLogger(name) for name in serving.LOGGERS]
    before = [(logger.handlers, logger.propagate) for logger in loggers]
    try:
        for logger in loggers:
            logger.handlers, logger.propagate = [handler], False
        with_server(test)
    finally:
        for logger, (handlers, propagates) in zip(loggers, before, strict=True):
            logger.handlers, logger.propagate = handlers, propagates
    lines = [log.get().msg for _ in range(log.qsize())]
    assert any("failed to validate" in line for line in lines)
    assert [line for line in lines if not line.isprintable() or len(line) > serving.LONGEST_LINE] == []


def test_a_page_that_is_being_built_holds_up_no_other_page() -> None:
    """A page whose building waits until another one has been answered; the limit of pages counts it from its beginning."""
    answered, waits = threading.Event(), threading.Event()

    def build(explorer: Explorer) -> Any:
        waits.set()
        assert answered.wait(20.0)
        return pn.pane.HTML("a page")

    async def test(served: Served) -> None:
        await served.enter()
        first = await served.get()
        served.server._build = build
        second = asyncio.ensure_future(served.get())
        await until(waits.is_set)
        line = await served.connect(first)  # the first page goes on
        assert await line.read_message() is not None
        assert (await served.get()).code == 503
        answered.set()
        assert (await second).code == 200
        await until(lambda: served.open_pages == 2)

    with_server(test, sessions=2)


def test_a_fault_of_our_own_code_keeps_its_traceback_in_the_log() -> None:
    try:
        Explorer.refuse(None, None)  # type: ignore[arg-type]
    except AttributeError:
        record = logging.LogRecord("bokeh.server", logging.ERROR, __file__, 1, "failed", None, sys.exc_info())
    assert "explorer.py" in serving._Lines().format(record)


def test_a_taken_port_is_one_line_and_by_default_the_next_one_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        monkeypatch.setattr(serving, "FIRST_PORT", port)

        async def test(served: Served) -> None:
            assert port < served.server.port < port + serving.PORTS

        with_server(test, port=None)
        with pytest.raises(InputError, match=f"^explore: port {port} is taken: choose another one with --port, or 0"):
            with_server(test, port=port)


def test_an_address_that_is_not_of_this_computer_is_one_line() -> None:
    with pytest.raises(InputError, match=r"^explore: cannot listen on 203\.0\.113\.1 port 0: "):
        with_server(lambda served: asyncio.sleep(0), address="203.0.113.1")


def test_the_address_of_a_server_for_all_networks_names_the_computer() -> None:
    async def test(served: Served) -> None:
        assert urlsplit(served.server.url).hostname == socket.gethostname().lower()
        assert (await served.get(Host=f"any.example:{served.server.port}")).code == 403
        await served.enter()
        assert (await served.get(Host=f"any.example:{served.server.port}")).code == 200

    with_server(test, address="0.0.0.0")


def test_no_browser_is_opened_where_there_are_no_windows(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    assert not open_browser(tmp_path / "page.html")


def test_the_browser_is_opened_without_the_token_on_its_command_line(monkeypatch: pytest.MonkeyPatch) -> None:
    """The command line shows in the list of processes; the file that leads to the address is this user's alone."""
    opened: list[tuple[str, str, int, int]] = []

    def note(url: str) -> bool:
        page = Path(url2pathname(urlsplit(url).path))
        opened.append((url, page.read_text(), page.stat().st_mode & 0o777, page.parent.stat().st_mode & 0o777))
        return True

    lines: list[str] = []
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(webbrowser, "open", note)
    monkeypatch.setattr(ExplorerServer, "run", ExplorerServer.stop)
    start(Setting.bundled("fig6-slab"), Endpoint(port=0), browser=True, say=lines.append)
    ((url, text, mode, folder),) = opened
    address = lines[0].removeprefix("explorer: ")
    token = address.partition("token=")[2]
    assert url.startswith("file:///")
    assert len(token) > 30
    assert token not in url
    assert f'content="0; url={address}"' in text
    assert (mode, folder) == (0o600, 0o700)
    assert not Path(url2pathname(urlsplit(url).path)).parent.exists()


def test_pages_are_told_that_the_compiler_is_being_warmed_and_when_it_is_warm(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.extensions.explorer.server.desk.FIRST_RUNS", ())
    warming, lines, others = Warming(), [], []
    warming.tell(lines.append)
    warming.tell(others.append)()
    warming._warm()
    assert lines == ["The engine is being loaded: the first picture takes a moment longer.", ""]
    assert others == lines[:1]


@pytest.mark.parametrize("name", ["_tornado", "_websocket_origins"])
def test_a_bokeh_without_a_private_name_gets_one_line(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    application = SimpleNamespace(_websocket_origins=set())
    server = SimpleNamespace(_tornado=application)
    monkeypatch.delattr(server if name == "_tornado" else application, name)
    with pytest.raises(InputError, match=r"^explore: bokeh .* does not suit; .*: pip install 'bokeh>=3.9,<3.11'$"):
        serving.application_of(server)


LOGS = """
import logging, select, time
import panel  # whose log goes to standard output
from stickslip.extensions.explorer.server import serve

serve.MOST_LINES = 10_000  # nothing is lost before the pipe is full
serve.log_to_stderr()
for _ in range(1000):
    logging.getLogger("panel.io").error("x" * 200)
while select.select([], [2], [], 0)[1]:
    time.sleep(0.01)
print("through", flush=True)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="only POSIX says that a pipe is full")
def test_a_log_that_nobody_reads_holds_up_nothing() -> None:
    """A pipe holds some 64 kB; what is logged here is 200 kB. The process ends although its log is never written."""
    with subprocess.Popen([sys.executable, "-c", LOGS], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        try:
            assert process.stdout.readline() == "through\n"
            assert process.wait(60.0) == 0
            assert process.stderr.readline().endswith(f"ERROR panel.io: {'x' * 200}\n")
        finally:
            process.kill()
