"""A setting as the parameters of a link: the name of its scenario and what was changed, or the whole document in short.

    scenario=fig6-slab&friction.alpha=0.7 s/m&v=1

Only the changes of a bundled scenario are written, as a person would. A document that is not bundled, or is changed in very much,
is compressed. Links come from strangers: their size is limited before and after they are unpacked, and nothing is evaluated.
"""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from collections.abc import Mapping
from typing import Any

from stickslip.explorer.model.setting import Setting, document_of, leaves_of
from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, nearest
from stickslip.scenarios import library
from stickslip.scenarios.entries import typed_number
from stickslip.scenarios.schema import TABLES

VERSION = "1"
"""Version of what links look like."""
LONGEST = 16_000
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
    if _length(found) > LONGEST:
        raise InputError(f"link: the scenario is too large for a link of {LONGEST} characters; save it as a file instead")
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
    """Return the entry that was written as a text."""
    if text[:1] in ("[", '"', "{") or text in ("true", "false", "null"):
        try:
            return json.loads(text)
        except (ValueError, RecursionError):
            return text
    whole = text.lstrip("+-")
    return int(text) if whole.isdecimal() and whole.isascii() and len(whole) < 18 else typed_number(text)


def setting_of(parameters: Mapping[str, str]) -> Setting:
    """Return the setting, which makes a scenario, to which the decoded parameters of a link lead.

    Parameters that are no entries of a scenario, such as the place of a cursor, are left to others. Raises InputError, in one line,
    if the link is too long, of another version, broken, or does not lead to a scenario.
    """
    ours = {key: value for key, value in parameters.items() if key in ("scenario", "document", "v") or key.split(".")[0] in TABLES}
    if _length(ours) > LONGEST:
        raise InputError(f"link: it has more than {LONGEST} characters")
    if ours.get("v", VERSION) != VERSION:
        raise InputError(f"link: version {shown(ours['v'])} is unknown, this explorer reads version {VERSION}")
    name = ours.get("scenario", "")
    setting = _unpacked(name, ours["document"]) if "document" in ours else _changed(name, ours)
    setting.scenario()
    return setting


def _changed(name: str, parameters: Mapping[str, str]) -> Setting:
    if name not in library.names():
        raise InputError(f"link: no bundled scenario {ascii(name)[:60]}; {nearest(name, library.names())}")
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
