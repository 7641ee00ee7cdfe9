"""Who may use the server: only a browser that has shown the token, that asks for a name of this server, from its own page."""

from __future__ import annotations

import hmac
from collections.abc import Callable
from dataclasses import dataclass, field
from html import escape
from secrets import token_urlsafe
from typing import Any
from urllib.parse import unquote, urlencode, urlsplit

from tornado.httputil import HTTPHeaders, HTTPServerRequest
from tornado.routing import Matcher, Rule
from tornado.web import Application, OutputTransform, RequestHandler

LOOPBACK = ("127.0.0.1", "localhost", "[::1]")
"""The names that a computer has for itself."""
PATHS = ("/", "/ws", "/favicon.ico")
"""What the server answers, beside the bundled files in `STATIC`."""
STATIC = "/static/"
NO_TOKEN = "This page needs its token: open the whole address that `stickslip explore` printed in the terminal."
NOTHING_HERE = "There is nothing here: the explorer is at the address that `stickslip explore` printed in the terminal."
SOURCES = {
    "default-src": "'self'",
    "script-src": "'self' 'unsafe-inline' 'unsafe-eval' blob:",
    "style-src": "'self' 'unsafe-inline'",
    "img-src": "'self' data: blob:",
    "font-src": "'self' data:",
    "connect-src": "'self' blob: ws: wss:",
    "worker-src": "'self' blob:",
    "frame-ancestors": "'self'",
}
"""Where a page may load what from; Bokeh makes functions from text, and Panel loads its modules through blobs."""
HEADERS = {
    "Content-Security-Policy": "; ".join(f"{kind} {allowed}" for kind, allowed in SOURCES.items()),
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
"""Headers of every answer: a page loads nothing from elsewhere, and no other page can hold it in a frame."""


@dataclass(frozen=True)
class Reply:
    """A reply instead of the requested page: a page of one sentence, or another address together with a cookie."""

    status: int
    sentence: str = ""
    address: str = ""
    cookie: tuple[str, str] | None = None


@dataclass(frozen=True)
class Access:
    """The conditions for answering requests.

    `names` are the allowed host names of requests, without a port; None for any. The list for a server on the loopback address
    protects it from pages that let their own name point to this computer. Pages of `origins` (with a port unless it is the usual
    one) may connect, besides the server's own. `is_full` returns a sentence if no further page can be opened. The first address
    must contain the `token`, which the browser keeps as a cookie.
    """

    names: frozenset[str] | None
    origins: frozenset[str]
    is_full: Callable[[], str] = field(default=lambda: "")
    token: str = field(default_factory=token_urlsafe, repr=False)

    def reply_to(self, request: HTTPServerRequest) -> Reply | None:
        """Return the reply that refuses or redirects a request; None if the request is to be answered."""
        if (
            self.names is not None
            and _name_and_port(request.host)[0] not in self.names
            and request.host.lower() not in self.origins
        ):
            return Reply(403, f"This server is not known as {request.host}: `stickslip explore --allow-origin` permits that name.")
        given = request.query_arguments.get("token")
        if given is not None and self._is_token(given[-1]):
            return Reply(302, address=_without_token(request), cookie=(cookie_name(request.host), self.token))
        kept = request.cookies.get(cookie_name(request.host))
        if given is not None or kept is None or not self._is_token(kept.value.encode()):
            return Reply(403, NO_TOKEN)
        if request.path not in PATHS and not (request.path.startswith(STATIC) and unquote(request.path).isprintable()):
            return Reply(404, NOTHING_HERE)
        if request.path == "/ws":
            return None if self._may_connect(request) else Reply(403, "Another site's page may not connect to the explorer.")
        sentence = self.is_full() if request.path == "/" else ""
        return Reply(503, sentence) if sentence else None

    def _is_token(self, given: bytes) -> bool:
        return hmac.compare_digest(given, self.token.encode())

    def _may_connect(self, request: HTTPServerRequest) -> bool:
        """Return True if a websocket comes from a page of this server, or of a host that is allowed, or from no page at all."""
        origin = request.headers.get("Origin")
        host = "" if origin is None else urlsplit(origin).netloc.lower()
        return origin is None or host == request.host.lower() or host in self.origins

    def guard(self, application: Application) -> None:
        """Have every request of a Tornado application pass here first."""
        application.add_handlers(r".*", [Rule(_Held(self), _Replies)])
        application.transforms.append(_WithHeaders)


def cookie_name(host: str) -> str:
    """Return the name of the cookie for a host: browsers keep cookies by host and not by port, so the port is in the name."""
    return f"stickslip-{_name_and_port(host)[1]}"


def _name_and_port(host: str) -> tuple[str, str]:
    """Return the two parts of `name:port`; the name may be a numerical address in brackets, and the port may be missing."""
    name, _, port = host.lower().rpartition(":")
    return (name, port) if port.isdigit() and port.isascii() else (host.lower(), "80")


def _without_token(request: HTTPServerRequest) -> str:
    others = [(name, value) for name, values in request.query_arguments.items() if name != "token" for value in values]
    return "/" + (f"?{urlencode(others)}" if others else "")


class _Held(Matcher):
    """Matches the requests that are refused or redirected."""

    def __init__(self, access: Access) -> None:
        self._access = access

    def match(self, request: HTTPServerRequest) -> dict[str, Any] | None:
        """Return the arguments of `_Replies`, or None if the request is to be answered."""
        reply = self._access.reply_to(request)
        return None if reply is None else {"target_kwargs": {"reply": reply}}


class _Replies(RequestHandler):
    """Sends a `Reply`, whatever the method of the request."""

    def initialize(self, reply: Reply) -> None:
        self._reply = reply

    def prepare(self) -> None:
        reply = self._reply
        if reply.cookie is not None:
            self.set_cookie(*reply.cookie, httponly=True, samesite="Lax", path="/")
        self.set_header("Cache-Control", "no-store")
        if reply.address:
            self.redirect(reply.address, status=reply.status)
            return
        self.set_status(reply.status)
        self.finish(f"<!DOCTYPE html>\n<title>stickslip</title>\n<p>{escape(reply.sentence)}</p>\n")


class _WithHeaders(OutputTransform):
    """Adds `HEADERS` to every answer."""

    def __init__(self, request: HTTPServerRequest) -> None:
        pass

    def transform_first_chunk(
        self, status_code: int, headers: HTTPHeaders, chunk: bytes, finishing: bool
    ) -> tuple[int, HTTPHeaders, bytes]:
        for name, value in HEADERS.items():
            headers[name] = value
        return status_code, headers, chunk
