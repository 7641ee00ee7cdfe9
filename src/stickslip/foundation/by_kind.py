"""Answers by kind: what one part of the program asks of each kind of body or of driver, a module of answers for each kind."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Generic, TypeVar

Answers = TypeVar("Answers")


class ByKind(dict[str, Answers], Generic[Answers]):
    """The answers of every kind to the questions of one part of the program; `TABLE[name]` are those of one.

    A folder has a module for each kind, whose `ANSWERS` answers all questions. It is imported when the first of its kind is asked
    about. A kind without a module there answers as the one that it is like. Somebody else's kind is put in by its name:
    `TABLE["beam"] = AnswersOfBeams()`.
    """

    def __init__(self, home: str, kinds: Mapping[str, str]) -> None:
        """Take the folder with the modules, as a package, and all kinds, each with the one that it is like ("" for none)."""
        super().__init__()
        self.home, self.kinds = home, kinds

    def __missing__(self, kind: str) -> Answers:
        found: Answers = import_module(f"{self.home}.{self._answering(kind)}").ANSWERS
        self[kind] = found
        return found

    def _answering(self, kind: str) -> str:
        """Return the kind whose module answers for one."""
        like = self.kinds[kind]
        return kind if not like or find_spec(f"{self.home}.{kind}") is not None else self._answering(like)
