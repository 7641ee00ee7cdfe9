"""Names of parameters in figures, made from their declared meaning: "normal stress S on the contact, ..." has the symbol S.

Declarations write symbols as plain words (rho, muS, u0, d2, v_s); figures typeset them.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from stickslip.foundation.names import GREEK

_SYMBOL = re.compile(rf"(?P<letter>{'|'.join(GREEK)}|[A-Z]|[b-df-z](?!\w)|[a-z](?=\d|_))_?(?P<index>\d|(?<=_)[a-z]|(?<!_)[A-Zcd]|)")
_USERS = re.compile(rf"(?P<letter>{'|'.join(sorted(GREEK, key=len, reverse=True))}|[A-Za-z])_?(?P<index>[0-9]*|[A-Za-z])")
"""A name of a number in a formula that is a symbol, as users write them: vw, mu0, tau_c. Any other name is a word."""
_CONNECTED = ("of", "in", "per", "at", "that")
"""Words before a symbol that is not the parameter's own, as in "exponent of v"."""
_FORMULA = ".parameters."
"""Part of the names of the parameters of a formula, which users choose."""
_INSTRUCTIONS = ("run.duration", "run.events", "run.creep_rtol", "run.shortest_event")
"""Entries of a scenario whose meaning says what the run is to do; they go by their own names."""


def parameter_name(name: str, meaning: str) -> str:
    """Return the name of a parameter for an axis or a legend, with its symbol as mathtext: "normal stress $S$ on the contact".

    `name` is its place in a scenario. Of its declared meaning, what follows a comma, a colon, a semicolon or a bracket is left out.
    """
    words, is_users = _words(name, meaning), _FORMULA in name
    return _typeset(words, lambda letter, index: f"${_tex(letter)}{f'_{{{index}}}' if index else ''}$", is_users)


def plain_name(name: str, meaning: str) -> str:
    """Return the name of a parameter as plain text, such as "density ρ"."""
    return _typeset(_words(name, meaning), lambda letter, index: GREEK.get(letter, letter) + index, _FORMULA in name)


def symbol(name: str, meaning: str) -> str:
    """Return the symbol of a parameter as mathtext, such as "$S$", or "" if its meaning has none."""
    words = parameter_name(name, meaning).split()
    own = (word for word, before in zip(words, ["", *words], strict=False) if word[0] == "$" and before not in _CONNECTED)
    return next(own, "")


def _words(name: str, meaning: str) -> str:
    """Return the words that name a parameter: the beginning of its meaning, or its own name where the meaning is about others."""
    last = name.rpartition(".")[2]
    index = last[last.find("[") :] if "[" in last else ""
    if _FORMULA in name:
        return last
    if name in _INSTRUCTIONS or not meaning:
        return last.replace("_", " ")
    if name.startswith("loading.") and name.count(".") == 2:  # a number of a loading history: its meaning does not name the history
        return " ".join([*name.partition("[")[0].replace("_", " ").split(".")[1:], *([index] if index else [])])
    return re.split(r"\s*[,;:(]", meaning, maxsplit=1)[0].replace("`", "") + (f" {index}" if index else "")


def _typeset(text: str, show: Callable[[str, str], str], is_users: bool) -> str:
    """Return a text with what `show` makes of letter and index in place of each word that is a symbol.

    The name of a number in a formula (`is_users`) is one word.
    """
    if is_users:
        found = _USERS.fullmatch(text)
        return show(found["letter"], found["index"]) if found else text.replace("_", " ")
    words = text.split()
    for place, word in enumerate(words):
        found = _SYMBOL.fullmatch(word)
        # The article "a" is not followed by "of", and ends no text.
        if found is None and word == "a" and (words[place + 1 :] or ["of"])[0] == "of":
            words[place] = show("a", "")
        elif found is not None:
            words[place] = show(found["letter"], found["index"])
    return " ".join(words)


def _tex(letter: str) -> str:
    return f"\\{letter}" if letter in GREEK else letter
