"""Errors and warnings that a user can act on, and hints at the nearest allowed word."""

from __future__ import annotations

import difflib
import inspect
import re
import warnings
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar


def printable(text: str) -> str:
    """Return a text with line breaks and other unprintable characters escaped."""
    return text if text.isprintable() else "".join(one if one.isprintable() else ascii(one)[1:-1] for one in text)


class InputError(ValueError):
    """Raised for input that cannot be used; the message says in one line where the fault is, what it is and what is allowed.

    What a message repeats of a file or a name may be the work of somebody else: it is shown on that line, with escapes.
    """

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))


class ArgumentError(InputError, TypeError):
    """Raised for an argument that a function or a class does not have, or lacks: also an error of Python's own kind."""


class UnknownAttributeError(AttributeError):
    """Raised for an attribute that an object does not have; the message names the nearest public one, or all."""

    def __init__(self, owner: object, attribute: str) -> None:
        super().__init__(owner, attribute)  # the message is made when it is read: `hasattr` needs none

    def __str__(self) -> str:
        owner, attribute = self.args
        hint = nearest(attribute, [one for one in dir(owner) if not one.startswith("_")], "it has ")
        return f"{type(owner).__name__} has no attribute {ascii(attribute)[:60]}; {hint}"


class InputWarning(UserWarning):
    """Issued for input that can be used but hardly means what it says; the message is one line with the cure."""


NONE = "none"
"""What a hint says where no word at all is allowed."""
_GATHERED: ContextVar[list[str] | None] = ContextVar("gathered", default=None)
"""Where `warn` puts its messages within `gathered`; each thread has its own."""


@contextmanager
def gathered() -> Iterator[list[str]]:
    """Gather the messages of `warn` in a list in place of issuing them; those of other threads are issued as ever."""
    messages: list[str] = []
    before = _GATHERED.set(messages)
    try:
        yield messages
    finally:
        _GATHERED.reset(before)


def warn(message: str) -> None:
    """Issue an `InputWarning` that points at the first line outside this package which led here, or have it gathered."""
    message, messages = printable(message), _GATHERED.get()
    if messages is not None:
        messages.append(message)
        return
    package, level, frame = __name__.partition(".")[0], 1, inspect.currentframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame, level = frame.f_back, level + 1
    warnings.warn(InputWarning(message), stacklevel=level)


def never_show(message: str = "", module: str = "", category: type[Warning] = Warning) -> None:
    """Have Python ignore warnings from now on whose message, and whose module, begin as given (not as regular expressions).

    Between two threads `warnings.catch_warnings` is not safe: one puts back what it found, whatever another has set meanwhile.
    """
    texts = [re.compile(re.escape(text), flags) if text else None for text, flags in ((message, re.IGNORECASE), (module, 0))]
    if ("ignore", texts[0], category, texts[1], 0) not in warnings.filters:
        warnings.filterwarnings("ignore", re.escape(message), category, re.escape(module))


def nearest(word: str, allowed: Iterable[str], before: str = "allowed: ") -> str:
    """Return a hint that names the allowed words nearest to `word`, or else all of them, to be appended to an error message.

    Nearest are words of which it is a part, as slab of elastic-slab, and otherwise the one that is spelt most alike.
    """
    allowed = list(allowed)
    close = [name for name in allowed if word in name.split("-")] or difflib.get_close_matches(word, allowed, n=1)
    if close:
        return f"did you mean {' or '.join(map(repr, close))}?"
    return f"{before}{', '.join(sorted(allowed)) or NONE}"


def nearest_and_all(word: str, allowed: Iterable[str]) -> str:
    """Return a hint that names the allowed word nearest to `word`, if one is near, and all of them in the order given."""
    allowed = list(allowed)
    close = difflib.get_close_matches(word, allowed, n=1)
    return f"{f'did you mean {close[0]!r}? ' if close else ''}allowed: {', '.join(allowed) or NONE}"


def full_name(name: str, known: Collection[str], before: str, unknown: str) -> str:
    """Return the known name that is the given one, or the only one that ends with it: "friction.alpha" for "alpha".

    Raises InputError, whose message begins with `before`, if several names fit, and with the text `unknown` if none does.
    """
    if name in known:
        return name
    fitting = [full for full in known if full.endswith(f".{name}")]
    if len(fitting) > 1:
        raise InputError(f"{before}'{name}' is ambiguous: give one of {', '.join(fitting)}")
    if not fitting:
        entries = [full for full in known if full.partition("[")[0].endswith(f".{name.rpartition('.')[2]}") and "[" in full]
        if entries:
            raise InputError(f"{before}{ascii(name)[:60]} {unknown}; it is a list: name one of its entries, such as {entries[0]}")
        single = [full for full in known if "[" not in full]
        hint = nearest(name, [full.rpartition(".")[2] for full in single])
        hint = hint if hint.startswith("did") and "." not in name else nearest(name, single)
        raise InputError(f"{before}{ascii(name)[:60]} {unknown}; {hint}")
    return fitting[0]
