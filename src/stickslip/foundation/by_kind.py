"""Answers by kind: what one part of the program asks of each kind of body or of driver, a module of answers for each kind."""

from __future__ import annotations

from importlib import import_module
from typing import Generic, TypeVar

Answers = TypeVar("Answers")


class ByKind(Generic[Answers]):
    """The answers of every kind to the questions of one part of the program; `KINDS[name]` are those of one.

    A folder has a module for each kind, whose `ANSWERS` answers all questions. It is imported when the first of its kind is asked
    about. A kind of somebody else is added by its name: `KINDS.add("beam", AnswersOfBeams())`.
    """

    def __init__(self, home: str) -> None:
        """Take the folder with the modules, as a package."""
        self.home = home
        self._known: dict[str, Answers] = {}

    def __getitem__(self, kind: str) -> Answers:
        found = self._known.get(kind)
        if found is None:
            found = self._known[kind] = import_module(f"{self.home}.{kind}").ANSWERS
        return found

    def add(self, kind: str, answers: Answers) -> None:
        """Add a kind, or put other answers in place of its own."""
        self._known[kind] = answers
