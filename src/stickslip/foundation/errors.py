"""Errors and warnings that a user can act on, and hints at the nearest allowed word."""

from __future__ import annotations

import difflib
import inspect
import re
import warnings
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import is_dataclass
from types import ModuleType

from stickslip.foundation.synonyms import last, meanings, parts_of, plain, same, words


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
    """Raised for an attribute that an object or a module does not have; the message names the nearest public ones."""

    def __init__(self, owner: object, attribute: str) -> None:
        super().__init__(owner, attribute)  # the message is made when it is read: `hasattr` needs none

    def __str__(self) -> str:
        owner, attribute = self.args
        public = getattr(owner, "__all__", None) or [one for one in dir(owner) if not one.startswith("_")]
        hint = nearest(attribute, public, "it has ", "dir() of it lists all")
        if attribute in ("replace", "set", "update", "copy") and is_dataclass(owner):
            hint = "dataclasses.replace(it, NAME=VALUE) makes another"
        who = owner.__name__ if isinstance(owner, ModuleType) else type(owner).__name__
        inside = [getattr(owner, one) for one in public] if isinstance(owner, ModuleType) else []
        homes = [one.__name__ for one in inside if isinstance(one, ModuleType) and attribute in getattr(one, "__all__", ())]
        hint = f"it is {homes[0]}.{attribute}" if homes else hint
        return f"{who} has no attribute {ascii(attribute)[:60]}; {hint}"


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


MOST_NAMED, FEW = 8, 6
"""So many allowed words a hint names in full; of more it names the few that are spelled most like the word."""
MOST_MEANT = 4
"""A part that more of the allowed words have says nothing about which one is meant."""
MOST_ABSENT = 2
"""Largest number of meanings of a word that are named although none of them is allowed."""
LONGEST_WORD = 80
"""Largest number of characters of a word that is compared with others."""
MISTYPED = 0.85
"""So much (1) of a mistyped word and of the right one is the same, at least."""
SHORT, ALIKE = 5, (0.65, 0.6)
"""Longest word that counts as short, and how much (1) of a short word, and of a longer one, is the same in one spelled alike."""


def nearest(word: str, allowed: Iterable[str], before: str = "allowed: ", listed: str = "") -> str:
    """Return a hint that names the allowed words nearest to `word`, to be appended to an error message.

    Those are words that mean the same or contain it, or the one that is spelled most alike. If there is none, the hint names all,
    or of many a few and where all are `listed`.
    """
    allowed = list(allowed)
    if close := meant(word, allowed):
        return did_you_mean(close)
    return before + some_of(allowed, word, listed)


def _elsewhere(word: str) -> str:
    """Return what a word of the trades means where that is not allowed, if it means little else."""
    known = meanings(word)
    if not 0 < len(known) <= MOST_ABSENT:
        return ""
    return f"it may stand for {' or '.join(known)}, which {'is' if len(known) == 1 else 'are'} not here; "


def did_you_mean(close: Iterable[str]) -> str:
    """Return a hint that asks for one of some words."""
    return f"did you mean {' or '.join(map(repr, close))}?"


def some_of(allowed: Iterable[str], word: str = "", listed: str = "") -> str:
    """Return the allowed words, or of many those spelled most like a word, the number of the others, and where all are listed."""
    allowed = sorted(allowed)
    if len(allowed) <= MOST_NAMED:
        return ", ".join(allowed) or NONE
    few = sorted(sorted(allowed, key=lambda one: -_likeness(word, one))[:FEW])
    return f"{', '.join(few)} and {len(allowed) - FEW} more{f': {listed}' if listed else ''}"


def meant(word: str, allowed: Collection[str]) -> list[str]:
    """Return the allowed words that `word` may stand for; none if nothing is near.

    They are those with the same meaning (`synonyms.same`); else one that differs by a slip of the pen; else those of which it is a
    part, as slab of elastic-slab, or the beginning, or that has all of their words, as block-on-spring those of spring-block; else
    the one that is spelled most alike; else those that a misspelt word of the trades means.
    """
    found, best = same(word, allowed), max(allowed, key=lambda one: _likeness(word, one), default="")
    if not found and _likeness(word, best) >= MISTYPED:
        return [best]
    if not found:
        found = [one for one in allowed if word.casefold() in parts_of(one)]
        found = found or [one for one in allowed if len(word) > 2 and plain(one).startswith(plain(word) or "-")]
        given = set(parts_of(word[:LONGEST_WORD]))
        found = found or [one for one in allowed if len(parts := set(parts_of(one))) > 1 and parts <= given]
        found = found if len(found) <= MOST_MEANT else []
    if found or meanings(word):  # a word that is known is not a misspelt one
        return found[:MOST_MEANT]
    if _likeness(word, best) >= ALIKE[len(word) > SHORT]:
        return [best]
    known = max(words(), key=lambda one: _likeness(last(word), one)) if len(word) >= SHORT else ""
    return same(known, allowed)[:MOST_MEANT] if _likeness(last(word), known) >= MISTYPED else []


def _likeness(word: str, other: str) -> float:
    """Return how much of two words is the same (1), in capitals or not; dashes before an option do not count.

    Words may come from files of strangers: only their beginnings are compared.
    """
    first, second = (one[:LONGEST_WORD].lstrip("-").casefold() for one in (other, word))
    return difflib.SequenceMatcher(None, first, second).ratio()


def full_name(name: str, known: Collection[str], before: str, unknown: str, listed: str = "") -> str:
    """Return the known name that is the given one, or the only one that ends with it: "friction.alpha" for "alpha".

    Raises InputError, whose message begins with `before`, if several names fit, and with the text `unknown` if none does; `listed`
    says where all names are.
    """
    if name in known:
        return name
    fitting = [full for full in known if full.endswith(f".{name}")]
    if len(fitting) > 1:
        raise InputError(f"{before}'{name}' is ambiguous: give one of {', '.join(fitting)}")
    if not fitting:
        entries = [full for full in known if full.partition("[")[0].endswith(f".{last(name)}") and "[" in full]
        if entries:
            raise InputError(f"{before}{ascii(name)[:60]} {unknown}; it is a list: name one of its entries, such as {entries[0]}")
        single = [full for full in known if "[" not in full]
        raise InputError(f"{before}{ascii(name)[:60]} {unknown}; {_nearest_end(name, single, listed)}")
    return fitting[0]


def _nearest_end(name: str, known: Sequence[str], listed: str) -> str:
    """Return a hint at the names that end like `name`: their ends, if no others end so and `name` is such an end itself."""
    ends = Counter(map(last, known))
    close = same(name, known) or [full for full in known if last(full) in meant(name, ends)] if "." not in name else []
    if not close:
        hint = nearest(name, known, listed=listed)
        return hint if hint.startswith("did") else _elsewhere(name) + hint
    return did_you_mean(last(full) if ends[last(full)] == 1 else full for full in close[:MOST_MEANT])
