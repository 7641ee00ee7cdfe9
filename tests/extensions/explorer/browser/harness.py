"""What the browser tests share: finding a browser, a server in a process of its own, and pages that may do nothing wrong."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

NO_BROWSER = (
    "no chromium was found: tests/extensions/explorer/install_browser.sh installs one; until then the explorer is not tested in a"
    " browser"
)
NAMES = ("chromium", "chromium-browser", "google-chrome")
"""Commands under which a browser may be installed, as in install_browser.sh."""
URL = re.compile(r"https?://\S+")
PATIENCE = 180_000
"""How long a page may take to show what is waited for, in ms. Only a test that fails waits so long; a busy machine
that compiles for the first time may need it."""


def installed() -> str | None:
    """Return the path of an installed browser, or None."""
    return next((found for found in map(shutil.which, NAMES) if found), None)


def launch(playwright: Any) -> Any:
    """Return a browser, an installed one or else that of playwright; None if there is neither."""
    path = installed() or playwright.chromium.executable_path
    if not Path(path).exists():
        return None
    return playwright.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-dev-shm-usage"])


@dataclass
class Watched:
    """A page of the browser, with everything that it should not have done: errors, and requests to other places."""

    page: Any
    origin: str
    faults: list[str] = field(default_factory=list)

    def until(self, condition: str) -> None:
        """Wait until a condition in JavaScript holds, where `model(name)` is a model of Bokeh."""
        self.page.wait_for_function(
            f"() => {{ const model = (name) => Bokeh.documents[0].get_model_by_name(name); return {condition}; }}"
        )

    def until_near(self, expression: str, value: float, within: float) -> None:
        """Wait until a number of the page is as near to a value as it should be."""
        self.until(f"Math.abs({expression} - ({value!r})) <= {within!r}")

    def __post_init__(self) -> None:
        self.page.set_default_timeout(PATIENCE)
        self.page.on("console", self._console)
        self.page.on("pageerror", lambda error: self.faults.append(f"error: {error}"))
        self.page.on("request", self._request)

    def _console(self, message: Any) -> None:
        if message.type in ("error", "warning"):
            self.faults.append(f"{message.type}: {message.text}")

    def _request(self, request: Any) -> None:
        found = urlsplit(request.url)
        local = (
            found.scheme in ("data", "blob", self.origin.partition(":")[0] if self.origin == "file://" else "")
            or f"{found.scheme}://{found.netloc}" == self.origin
        )
        if not local and f"ws://{found.netloc}" != self.origin.replace("http", "ws"):
            self.faults.append(f"request to {request.url[:200]}")


@dataclass
class Served:
    """A server of the explorer in a process of its own, and the address that it has said."""

    process: subprocess.Popen[str]
    url: str

    @property
    def origin(self) -> str:
        """Scheme, host and port."""
        found = urlsplit(self.url)
        return f"{found.scheme}://{found.netloc}"

    def end(self) -> int:
        """End the server as Ctrl-C does, and return its exit code."""
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(30)
        if self.process.stdout is not None:
            self.process.stdout.close()
        return code


def serve(*arguments: str, folder: Path) -> Served:
    """Start `stickslip explore` and wait until it has said its address."""
    process = subprocess.Popen(
        [sys.executable, "-m", "stickslip", "explore", "--no-browser", "--port", "0", *arguments],
        cwd=folder,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert process.stdout is not None
    said: list[str] = []
    for line in process.stdout:
        said.append(line)
        if found := URL.search(line):
            return Served(process, found[0])
    raise AssertionError(f"the server ended before it said its address: {''.join(said)}")
