"""The server of the explorer: it opens one page, with its own explorer and desk, for each browser tab."""

from __future__ import annotations

import errno
import logging
import os
import signal
import socket
from collections import deque
from collections.abc import Awaitable, Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from functools import partial
from logging.handlers import QueueHandler
from queue import Full, Queue
from threading import Thread
from typing import Any, NamedTuple
from urllib.parse import quote
from weakref import WeakKeyDictionary, ref

import bokeh
import panel as pn
from bokeh.application.handlers import Handler
from panel.io.state import set_curdoc
from tornado.ioloop import IOLoop, PeriodicCallback
from typing_extensions import override

from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.tools import begin
from stickslip.extensions.explorer.server.access import LOOPBACK, Access
from stickslip.extensions.explorer.server.desk import OWN, Call, ThreadDesk, Warming, is_ours, unforeseen
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import clean

LINGER_MS = 5_000.0
"""How long (ms) a page that has lost its connection is kept: it may come back after a gap in the network."""
NEVER_SEEN_MS = 60_000
"""How long (ms) a page that has never connected is kept: a browser on a slow line loads its scripts first."""
LOOK_EVERY_MS = 1_000
"""Time (ms) between two looks for pages that have been closed."""


class Sessions:
    """Counts the open pages of a server, at most `most`, and has closed ones removed."""

    def __init__(self, most: int) -> None:
        self.most = most
        self.contexts: Iterable[Any] = ()
        """The application contexts of the Bokeh server, which hold its sessions."""
        self.coming = 0
        """Number of pages that are being built and are no session yet."""
        self._seen: set[str] = set()

    def refusal(self) -> str:
        """Return a sentence if no further page can be opened, and otherwise an empty text."""
        if self.coming + sum(not self._is_closed(session) for session in self._all()) < self.most:
            return ""
        pages = "1 page is" if self.most == 1 else f"{self.most} pages are"
        return f"{pages} open here, which is the limit (--sessions of `stickslip explore`): close one, and load this page again."

    def look(self) -> None:
        """Ask for the removal of pages whose browser has gone: Bokeh itself knows one waiting time for these and for new pages."""
        everything = list(self._all())
        self._seen &= {session.id for session in everything}
        self._seen |= {session.id for session in everything if session.connection_count > 0}
        for session in everything:
            if self._is_closed(session) and session.milliseconds_since_last_unsubscribe > LINGER_MS:
                session.request_expiration()

    def _all(self) -> Iterator[Any]:
        for context in self.contexts:
            yield from list(context.sessions)

    def _is_closed(self, session: Any) -> bool:
        return session.connection_count == 0 and session.id in self._seen


FIRST_PORT = 5018
"""The port that is tried first; the next free one is taken."""
TITLE = "stickslip explorer"
"""Title of the page in the browser."""
PORTS = 50
"""Try this many ports."""
LARGEST_MESSAGE = 4_000_000
"""Size (bytes) of the largest message from a browser: an upload of 1 MB with everything around it."""
LARGEST_REQUEST = {"max_body_size": 10_000, "max_header_size": 100_000, "max_buffer_size": LARGEST_MESSAGE, "body_timeout": 30}
"""Limits for requests outside the websocket: a browser has only an address to send, which can hold a long link."""
LONGEST_LOADING = 60.0
"""A page that has not reported that it is loaded counts as loaded after this time (s)."""
LOGGERS = ("panel", "bokeh", "tornado", "asyncio", "stickslip")
"""Loggers of the libraries in the server."""
LONGEST_LINE = 500
"""Characters of a line of the log that a library wrote."""
MOST_LINES = 1000
"""Lines of the log that wait to be written; further ones are lost."""
STDERR = 2
"""Descriptor of standard error."""
EVERYWHERE = ("0.0.0.0", "::", "")
"""Addresses that make a server listen on all networks of the computer."""

MakeExplorer = Callable[[ThreadDesk, ThreadDesk], Explorer]
Build = Callable[[Explorer], Any]


@dataclass(frozen=True, kw_only=True)
class Endpoint:
    """Where a server listens, and for whom. The default address can be reached from this computer only.

    The port is 0 for any free one, None for the first free one from FIRST_PORT on. `origins` are further hosts (`name` or
    `name:port`) of the page, besides the address itself. At most `sessions` pages may be open at the same time.
    """

    address: str = LOOPBACK[0]
    port: int | None = None
    origins: tuple[str, ...] = ()
    sessions: int = 8

    @property
    def is_loopback(self) -> bool:
        """True if the server can be reached from this computer only."""
        return self.address in ("127.0.0.1", "localhost", "::1")


class _Lines(logging.Formatter):
    """Writes one line for what a library logs, and cuts it: a browser may have sent anything, and libraries repeat it at length.

    Where our own code is among what failed, the traceback follows, because it is a fault of the program.
    """

    def __init__(self) -> None:
        super().__init__("%(asctime)s %(levelname)s %(name)s: %(message)s")

    @override
    def format(self, record: logging.LogRecord) -> str:
        error = record.exc_info[1] if record.exc_info else None
        if record.name.startswith(OWN) or (error is not None and is_ours(error)):
            return super().format(record)
        record.message, record.asctime = record.getMessage(), self.formatTime(record)
        line = self.formatMessage(record) + ("" if error is None else f": {type(error).__name__}: {error}")
        return clean(" ".join(line.split()))[:LONGEST_LINE]


class _Log(QueueHandler):
    """Hands what is logged to a thread of its own; what that cannot write in time is lost.

    That thread may wait for ever, and be ended with the process. It writes past `sys.stderr` and every handler, because the end of
    the process waits for their locks.
    """

    def __init__(self) -> None:
        super().__init__(Queue(MOST_LINES))
        self.setFormatter(_Lines())
        self.setLevel(logging.WARNING)  # Panel's logger passes on all that is for finding faults in it
        Thread(target=self._write, name="log", daemon=True).start()

    def enqueue(self, record: logging.LogRecord) -> None:
        with suppress(Full):
            self.queue.put_nowait(record)

    def _write(self) -> None:
        while True:
            line = f"{self.queue.get().msg}\n"
            with suppress(OSError):
                os.write(STDERR, line.encode("utf-8", "backslashreplace"))


def log_to_stderr() -> None:
    """Have the libraries of the server log to standard error, without waiting for a reader.

    Panel logs to standard output, which also tells the address of the page. A program that reads only the address there would let
    the pipe fill up, and the server would stand still.
    """
    through = _Log()
    for name in LOGGERS:
        logger = logging.getLogger(name)
        logger.handlers, logger.propagate = [through], False


class _NewPage(NamedTuple):
    """A page that has been built, and what brings it to a browser."""

    explorer: Explorer
    delivery: DeliveryToTab


class _BuiltBeside(Handler):  # type: ignore[misc] # bokeh has no types here
    """Has something done with the document of a new session of Bokeh before it is shown; the event loop goes on meanwhile."""

    def __init__(self, fill: Callable[[Any], Awaitable[None]]) -> None:
        super().__init__()
        self._fill = fill

    @override
    async def on_session_created(self, session_context: Any) -> None:
        await session_context.with_locked_document(self._fill)

    @override
    def modify_document(self, doc: Any) -> None:
        """Leave the document to the handler of the page."""


class ExplorerServer:
    """A server that is bound to its port, and answers once its event loop runs.

    `make` makes the explorer of a new page, given its desk and the desk for writing files; `build` builds the page of an explorer.
    With `warms` the compiler is warmed before the first answer needs it.
    """

    def __init__(self, endpoint: Endpoint, make: MakeExplorer, build: Build, *, warms: bool = True) -> None:
        self.endpoint, self._make, self._build, self._warms = endpoint, make, build, warms
        self.warming = Warming()
        self.sessions = Sessions(endpoint.sessions)
        names = frozenset((*LOOPBACK, endpoint.address)) if endpoint.is_loopback else None
        self.access = Access(names, frozenset(one.lower() for one in endpoint.origins), self.sessions.refusal)
        self._desks: set[ThreadDesk] = set()
        self._built: WeakKeyDictionary[Any, _NewPage] = WeakKeyDictionary()  # by document
        self._builder = ThreadPoolExecutor(1, "explorer-pages")
        self._bokeh = self._bound()
        application = application_of(self._bokeh)
        self.access.guard(application)
        self.sessions.contexts = application.applications.values()
        for context in self.sessions.contexts:
            context.application.add(_BuiltBeside(self.prepare))
        self._looking = PeriodicCallback(self.sessions.look, LOOK_EVERY_MS)

    @property
    def port(self) -> int:
        """The port of the server."""
        return int(self._bokeh.port)

    @property
    def url(self) -> str:
        """The address of the page, with the token."""
        host = socket.gethostname() if self.endpoint.address in EVERYWHERE else self.endpoint.address
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}/?token={quote(self.access.token)}"

    def start(self) -> None:
        """Begin to answer, and to warm the compiler."""
        self._bokeh.start()
        self._looking.start()
        if self._warms:
            self.warming.begin()

    def run(self) -> None:
        """Answer until Ctrl-C or the signal SIGTERM."""
        loop: IOLoop = self._bokeh.io_loop

        def leave(*_: Any) -> None:
            signal.signal(signal.SIGINT, signal.default_int_handler)  # a second Ctrl-C does not wait
            loop.add_callback_from_signal(loop.stop)

        signal.signal(signal.SIGINT, leave)
        signal.signal(signal.SIGTERM, leave)
        log_to_stderr()
        self.start()
        loop.start()
        self.stop()

    def stop(self) -> None:
        """End all work and close the port."""
        for desk in list(self._desks):
            desk.close()
        self._looking.stop()
        self._builder.shutdown(wait=False, cancel_futures=True)
        self._bokeh.stop(wait=False)

    def _bound(self) -> Any:
        """Return a Bokeh server on the port that was asked for, or on the first one that is free. Raises InputError."""
        first = FIRST_PORT if self.endpoint.port is None else self.endpoint.port
        for port in range(first, first + (PORTS if self.endpoint.port is None else 1)):
            try:
                check_free(self.endpoint.address, port)
                return self._listening(port)
            except OSError as error:
                if error.errno != errno.EADDRINUSE:
                    raise InputError(f"explore: cannot listen on {self.endpoint.address} port {port}: {error.strerror}") from None
        if self.endpoint.port is None:
            raise InputError(f"explore: ports {first} to {first + PORTS - 1} are all taken: choose one with --port, or 0 for any")
        raise InputError(f"explore: port {first} is taken: choose another one with --port, or 0 for any that is free")

    def _listening(self, port: int) -> Any:
        handler = signal.getsignal(signal.SIGINT)
        server = pn.io.server.get_server(
            {"/": self._page},
            port=port,
            address=self.endpoint.address,
            title=TITLE,
            location=False,
            sign_sessions=True,
            secret_key=self.access.token.encode(),
            include_cookies=[],
            include_headers=["User-Agent"],
            unused_session_lifetime_milliseconds=NEVER_SEEN_MS,
            check_unused_sessions_milliseconds=LOOK_EVERY_MS,
            websocket_max_message_size=LARGEST_MESSAGE,
            http_server_kwargs=dict(LARGEST_REQUEST),
        )
        if handler is not None and signal.getsignal(signal.SIGINT) is not handler:
            signal.signal(signal.SIGINT, handler)  # Panel sets its own
        return server

    async def prepare(self, document: Any) -> None:
        """Fill the document of a new tab in a thread beside the event loop, which answers other pages meanwhile.

        One page is built after the other: what builds them is not made for several threads.
        """
        self.sessions.coming += 1
        try:
            self._built[document] = await self._bokeh.io_loop.run_in_executor(self._builder, self._fill, document)
        finally:
            self.sessions.coming -= 1

    def _page(self) -> None:
        """Begin the work of a new tab, whose document is filled."""
        document = pn.state.curdoc
        explorer, delivery = self._built.pop(document) if document in self._built else self._fill(document)
        self._bokeh.io_loop.call_later(LONGEST_LOADING, delivery.begin)
        begin(explorer, {name: values[-1].decode("utf-8", "replace") for name, values in pn.state.session_args.items() if values})

    def _fill(self, document: Any) -> _NewPage:
        """Fill the document of a new tab with its page, whose work ends with it."""
        delivery = DeliveryToTab(document)
        deliver = partial(self._bokeh.io_loop.add_callback, delivery.take)
        desk, files = ThreadDesk(deliver), ThreadDesk(deliver)
        self._desks |= {desk, files}

        def gone(_: Any) -> None:
            untell()
            for one in (desk, files):
                one.close()
                self._desks.discard(one)

        with set_curdoc(document):
            explorer = self._make(desk, files)
            desk.report = explorer.told
            untell = self.warming.tell(desk.say)
            pn.state.on_session_destroyed(gone)
            pn.config.exception_handler = partial(_failed, explorer)
            page = self._build(explorer)
            freeze = getattr(document.models, "freeze", nullcontext)
            with freeze():  # otherwise Bokeh looks through all models again for each one that is added: 1 s in place of 0.2
                page.server_doc(document, title=TITLE, location=False)
        return _NewPage(explorer, delivery)


def _failed(explorer: Explorer, error: Exception) -> None:
    """Tell a page of an error while it changed, or the log alone if a library refused what the browser sent."""
    if is_ours(error):
        explorer.refuse(str(unforeseen(error)))
    else:
        logging.getLogger("panel").error("what a browser sent was refused", exc_info=error)


def application_of(server: Any) -> Any:
    """Return the Tornado application of a Bokeh server, through private names of Bokeh. Raises InputError if they are missing.

    The application accepts all origins of websockets, because `Access` is stricter: it compares each with the address of the page.
    """
    application: Any = getattr(server, "_tornado", None)
    if not hasattr(application, "_websocket_origins"):
        raise InputError(f"explore: bokeh {bokeh.__version__} does not suit; 3.9 and 3.10 do: pip install 'bokeh>=3.9,<3.11'")
    application._websocket_origins = {"*"}
    return application


def check_free(address: str, port: int) -> None:
    """Raise OSError if nothing can listen there. Tornado would find out too, but leave sockets open."""
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    socket.create_server((address, port), family=family).close()


class DeliveryToTab:
    """Call functions with the lock of a page's document, as soon as the browser has the page.

    All of it runs in the event loop itself: Bokeh loses callbacks that another thread adds while a session is being made, or while
    the changes of its document are held back. It also loses changes that are made after the page was sent and before the browser
    has put it together, so that the page would wait for ever for a first answer that comes in this time. What one call changes goes
    to the browser as one message: Bokeh goes through all models of the page for each.
    """

    def __init__(self, document: Any) -> None:
        self._document, self._waiting = ref(document), deque[Call]()
        self._is_ready = False
        document.on_event("document_ready", lambda _: self.begin())

    def take(self, call: Call) -> None:
        """Call a function on the page, or keep it until the page is there."""
        self._waiting.append(call)
        if self._is_ready:
            self.begin()

    def begin(self) -> None:
        """Call what has waited, if the document is still there."""
        self._is_ready, document = True, self._document()
        while self._waiting:
            call = self._waiting.popleft()
            if document is not None:
                document.add_next_tick_callback(pn.io.hold()(call))
