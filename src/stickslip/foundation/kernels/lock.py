"""One lock around everything that is made on first use and shared by threads: kernels, parts of the engine, formulas.

A thread may take it again while it holds it. What has been made is looked up without the lock: a thread whose laws are known never
waits for one that compiles.

Who holds the lock must wait for nothing but the compiler and the disk: above all for no `cached_property` of a problem or a
solution; each has a lock of its own in Python 3.11.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from itertools import count
from threading import RLock
from typing import Generic, ParamSpec, TypeVar

LOCK = RLock()
"""The lock."""

if hasattr(os, "register_at_fork"):  # a process that begins while another thread compiles could never compile anything
    os.register_at_fork(before=LOCK.acquire, after_in_parent=LOCK.release, after_in_child=LOCK.release)

P = ParamSpec("P")
Made = TypeVar("Made")


class _Kept(Generic[Made]):
    """Something that was made, and the turn (1) when it was last asked for."""

    __slots__ = ("asked", "made")

    def __init__(self, made: Made, asked: int) -> None:
        self.made, self.asked = made, asked


class MadeOnce(Generic[P, Made]):
    """A function whose results are kept, by its arguments, and made by one thread while others that want the same wait for it.

    At most `largest` results are kept: those that were asked for last.
    """

    def __init__(self, make: Callable[P, Made], largest: int | None) -> None:
        self.__doc__, self.__name__, self.__module__, self.__wrapped__ = make.__doc__, make.__name__, make.__module__, make
        self._largest = largest
        self._known: dict[object, _Kept[Made]] = {}
        self._turns = count()

    def __call__(self, *arguments: P.args, **named: P.kwargs) -> Made:
        """Return what was made for these arguments, which are all given by position; make it if it is new."""
        assert not named
        found = self._known.get(arguments)
        if found is None:
            with LOCK:
                found = self._known.get(arguments) or self._make(*arguments, **named)
        found.asked = next(self._turns)
        return found.made

    def _make(self, *arguments: P.args, **named: P.kwargs) -> _Kept[Made]:
        """Make something, keep it, and forget what has not been asked for for longest if there is too much."""
        new = self._known[arguments] = _Kept(self.__wrapped__(*arguments, **named), next(self._turns))
        if self._largest is not None and len(self._known) > self._largest:
            del self._known[min(self._known, key=lambda key: self._known[key].asked)]
        return new

    def cache_clear(self) -> None:
        """Forget everything."""
        with LOCK:
            self._known.clear()


def made_once(largest: int | None = None) -> Callable[[Callable[P, Made]], MadeOnce[P, Made]]:
    """Return a decorator that keeps what a function makes (see `MadeOnce`)."""
    return lambda make: MadeOnce(make, largest)
