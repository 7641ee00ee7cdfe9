"""The setting of the controls, a scenario document and what was changed in it, and the link that reproduces it.

    scenario=fig6-slab&friction.alpha=0.7 s/m&v=1

Only the changes of a bundled scenario are written, as a person would. A document that is not bundled, or is changed in very much,
is compressed. Links come from strangers: their size is limited before and after they are unpacked, and nothing is evaluated.
"""

from __future__ import annotations

import base64
import binascii
import json
import tomllib
import zlib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Any, Self

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, gathered, nearest
from stickslip.problem.scenarios import (
    TABLES,
    Scenario,
    Source,
    check_solved_by_core,
    kind_of,
    library,
    place_of,
    scenario_of,
    typed_number,
)

CONTACT = "contact"
"""The table of scenario files that tells of a fault, which an extension adds: where it is not there, there are no faults."""
DEEPEST = 5
"""Largest number of parts in a path."""


MOST_NODES = 1024
"""A page shows at most this many nodes of a fault."""


def explorable(scenario: Scenario) -> Scenario:
    """Return a scenario if pages show runs of its kind: those of the core, and faults. Raises InputError."""
    if scenario.table(CONTACT) is None:
        check_solved_by_core("explore", scenario)
    return scenario


def leaves_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return all entries that are no tables by their paths; an empty table is one of them."""
    return dict(_leaves(document, ""))


def inner_leaves_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return all entries that are no tables, those of tables in lists too: "contact.patches[0].initial.load"."""
    return dict(_leaves(document, "", in_lists=True))


def _leaves(table: Mapping[str, Any], before: str, *, in_lists: bool = False) -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping) and value:
            yield from _leaves(value, f"{before}{key}.", in_lists=in_lists)
        elif in_lists and isinstance(value, list) and value and all(isinstance(one, Mapping) for one in value):
            for i, one in enumerate(value):
                yield from _leaves(one, f"{before}{key}[{i}].", in_lists=True)
        else:
            yield f"{before}{key}", value


def document_of(leaves: Mapping[str, Any]) -> dict[str, Any]:
    """Return the document with these entries. Raises InputError if a path is too deep, or leads through an entry."""
    document: dict[str, Any] = {}
    for path, value in leaves.items():
        *tables, key = path.split(".")
        place = document
        for table in tables:
            place = place.setdefault(table, {})
            if not isinstance(place, dict):
                break
        if len(tables) >= DEEPEST or not isinstance(place, dict) or isinstance(place.get(key), dict):
            raise InputError(f"{ascii(path)[:60]} is not the place of an entry: it is too deep, or leads through another one")
        place[key] = value
    return document


@dataclass(frozen=True)
class Setting:
    """A scenario as the controls hold it: a TOML document, never changed in place, whose entries can be replaced one by one.

    `name` is the bundled scenario it began with, or the name of a file or an upload. `notes` are doubts about the file that
    the friction law was read, one line each; they go with that law.
    """

    name: str
    document: Mapping[str, Any] = field(repr=False)
    notes: tuple[str, ...] = field(default=(), compare=False, repr=False)

    @classmethod
    def bundled(cls, name: str) -> Self:
        """Return the setting of a bundled scenario. Raises InputError for an unknown name."""
        return cls(name, _bundled(name))

    @classmethod
    def of(cls, scenario: Scenario) -> Self:
        """Return the setting of a scenario: with the entries of its text, or in SI if it has none or names files of data.

        Raises InputError if the scenario cannot be written as text, because its law is a function of Python.
        """
        if scenario.source:
            setting = cls(scenario.name, tomllib.loads(scenario.source))
            with suppress(InputError):
                if setting.scenario() == scenario:
                    return setting
        return cls(scenario.name, tomllib.loads(scenario.to_toml()))

    def value(self, path: str) -> Any:
        """Return the entry at a path such as "friction.alpha" or "loading.pull_rate"; None if the document has none."""
        try:
            owner, key = place_of(path, self.document)
            return owner[key] if isinstance(key, int) else owner.get(key)
        except (KeyError, IndexError, TypeError, AttributeError):
            return None

    def with_value(self, path: str, value: Any) -> Self:
        """Return a setting with one entry replaced, or left out if `value` is None."""
        document = deepcopy(dict(self.document))
        *tables, key = path.split(".")
        place: Any = document
        if "[" in path:
            place, key = place_of(path, document)
        else:
            for table in tables:
                place = place.setdefault(table, {})
        if value is None:
            place.pop(key, None)
        else:
            place[key] = value
        return replace(self, document=document, notes=() if path.partition(".")[0] == "friction" else self.notes)

    @property
    def load_unit(self) -> str:
        """The unit of the body's loads: it decides the units of laws and loading. Raises InputError for an unknown body."""
        unit: str = kind_of("body", self.value("body") or {}, self.name).load_unit  # type: ignore[attr-defined] # registered
        return unit

    @property
    def is_fault(self) -> bool:
        """True if the contact has many nodes."""
        return CONTACT in self.document

    @property
    def is_changed(self) -> bool:
        """True if the setting began with a bundled scenario and differs from it."""
        return self.name in library.names() and self.document != _bundled(self.name)

    @property
    def title(self) -> str:
        """The title of the scenario; it says so if the scenario is changed, because it may name numbers that no longer hold."""
        title = str(self.value("title") or "")
        return f"{title}, changed" if title and self.is_changed else title

    def scenario(self) -> Scenario:
        """Return the scenario. Raises InputError, with one line that names the entry that is wrong."""
        return self.read()[0]

    def read(self) -> tuple[Scenario, tuple[str, ...]]:
        """Return the scenario, and doubts about its entries, one line each. Raises InputError as `scenario` does."""
        scenario, doubts = self._read
        return scenario, tuple(dict.fromkeys((*self.notes, *doubts)))

    @cached_property
    def _read(self) -> tuple[Scenario, tuple[str, ...]]:
        with gathered() as doubts:
            source = Source(self.name, None, MOST_NODES)
            scenario = replace(scenario_of(self.document, source), name=self.name, title=self.title)
        if scenario.table(CONTACT) is not None and scenario.to_solve.is_plane:
            raise InputError("explore: a fault in 3D is not shown: `stickslip run --figure` and `--animation` draw the run")
        return scenario, tuple(doubts)


@cache
def _bundled(name: str) -> dict[str, Any]:
    """Return the document of a bundled scenario, which must not be changed."""
    return tomllib.loads(library.text(name))


VERSION = "1"
"""Version of the form of links."""
FIRST_SCENARIO = "fig6-slab"
"""The explorer shows this scenario first if none is named."""
LONGEST_SETTING = 16_000
"""Largest number of characters of all parameters together: browsers and servers pass on about twice as many."""
READABLE = 2_000
"""Largest number of characters of readable parameters; a longer link is compressed."""
LARGEST_DOCUMENT = 1_000_000
"""Largest number of bytes of a document after it is unpacked."""
LONGEST_NAME = 100
"""Largest number of characters in the name of a setting."""


def parameters_of(setting: Setting) -> dict[str, str]:
    """Return the parameters of a link to a setting, not yet encoded for a URL. Raises InputError if they are too long for one."""
    readable = _changes(setting) if setting.name in library.names() else None
    if readable is not None and _length(readable) <= READABLE:
        return readable
    packed = base64.urlsafe_b64encode(zlib.compress(json.dumps(setting.document).encode(), 9)).decode().rstrip("=")
    found = {"scenario": setting.name[:LONGEST_NAME], "document": packed, "v": VERSION}
    if _length(found) > LONGEST_SETTING:
        raise InputError(f"link: the scenario is too large for a link of {LONGEST_SETTING} characters; save it as a file instead")
    return found


def _length(parameters: Mapping[str, str]) -> int:
    return sum(len(key) + len(value) + 2 for key, value in parameters.items())


def _changes(setting: Setting) -> dict[str, str] | None:
    """Return the changes of a bundled scenario; None if one of them cannot be written as text."""
    began, now = leaves_of(Setting.bundled(setting.name).document), leaves_of(setting.document)
    changed = {path: _written(value) for path, value in now.items() if path not in began or not _same(began[path], value)}
    removed = {path: "" for path in began if path not in now}
    if any("." not in path or not path.isprintable() for path in (*changed, *removed)) or "" in changed.values():
        return None
    return {"scenario": setting.name} | changed | removed | {"v": VERSION}


def _same(one: Any, other: Any) -> bool:
    return type(one) is type(other) and bool(one == other)


def _written(value: Any) -> str:
    """Return an entry as text: texts as they are unless they could be taken for another entry, all else as JSON."""
    if isinstance(value, str) and _read(value) == value:
        return value
    return json.dumps(value)


def _read(text: str) -> Any:
    if text[:1] in ("[", '"', "{") or text in ("true", "false", "null"):
        try:
            return json.loads(text)
        except (ValueError, RecursionError):
            return text
    whole = text.lstrip("+-")
    return int(text) if whole.isdecimal() and whole.isascii() and len(whole) < 18 else typed_number(text)


def setting_of(parameters: Mapping[str, str]) -> Setting:
    """Return the setting from the decoded parameters of a link; it makes a valid scenario.

    Parameters that are no entries of a scenario, such as the place of a cursor, are left to others. Raises InputError, in one line,
    if the link is too long, of another version, broken, or does not lead to a scenario.
    """
    ours = {
        key: value
        for key, value in parameters.items()
        if key in ("scenario", "document", "v") or key.split(".")[0] in (*TABLES, CONTACT)
    }
    if _length(ours) > LONGEST_SETTING:
        raise InputError(f"link: it has more than {LONGEST_SETTING} characters")
    if ours.get("v", VERSION) != VERSION:
        raise InputError(f"link: version {shown(ours['v'])} is unknown, this explorer reads version {VERSION}")
    name = ours.get("scenario", "")
    setting = _unpacked(name, ours["document"]) if "document" in ours else _changed(name, ours)
    setting.scenario()
    return setting


def _changed(name: str, parameters: Mapping[str, str]) -> Setting:
    if name not in library.names():
        raise InputError(
            f"link: no bundled scenario {ascii(name)[:60]}; {nearest(name, library.names(), listed=library.NAMES_LISTED)}"
        )
    leaves = leaves_of(Setting.bundled(name).document)
    changes = {path: text for path, text in parameters.items() if path not in ("scenario", "v")}
    for path, text in changes.items():
        if text == "":
            leaves.pop(path, None)
        else:
            leaves[path] = _read(text)
    try:
        return Setting(name, document_of(leaves))
    except InputError as error:
        raise InputError(f"link: {error}") from None


def _unpacked(name: str, packed: str) -> Setting:
    if not name or len(name) > LONGEST_NAME or not name.isprintable():
        raise InputError(f"link: the name of the scenario must have 1 to {LONGEST_NAME} printable characters")
    try:
        stream = zlib.decompressobj()
        text = stream.decompress(
            base64.b64decode(packed + "=" * (-len(packed) % 4), altchars=b"-_", validate=True), LARGEST_DOCUMENT
        )
        document = json.loads(text)
    except (binascii.Error, zlib.error, ValueError, RecursionError):
        raise InputError("link: the document in it is broken or too large; was the link cut off?") from None
    if not stream.eof or not isinstance(document, dict):
        raise InputError("link: the document in it is broken or too large; was the link cut off?")
    return Setting(name, document)
