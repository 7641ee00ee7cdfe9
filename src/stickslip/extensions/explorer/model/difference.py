"""A setting as a scenario file, what was changed in it, and the named difference of two runs."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from typing import Any

import tomli_w

from stickslip.extensions.explorer.model.answer import Answer, KeyNumber, short
from stickslip.extensions.explorer.model.fault import FaultAnswer
from stickslip.extensions.explorer.model.setting import Setting, inner_leaves_of
from stickslip.foundation.arguments import shown
from stickslip.foundation.show import clean


def toml_of(setting: Setting) -> str:
    """Return a setting as the text of a scenario file, with units as they were given; it runs with the same numbers."""
    document, changed = dict(setting.document), changes_of(setting)
    if changed:
        document["title"] = setting.title
        document["description"] = f"{setting.name} with {', '.join(changed)}"
    return tomli_w.dumps(document, multiline_strings=True)


def changes_of(setting: Setting) -> list[str]:
    """Return what was changed in a bundled scenario, as "friction.alpha = 0.7 s/m"; empty for another scenario."""
    if not setting.is_changed:
        return []
    began, now = (inner_leaves_of(one.document) for one in (Setting.bundled(setting.name), setting))
    changed = [f"{path} = {_short(value)}" for path, value in now.items() if path not in began or began[path] != value]
    return changed + [f"no {path}" for path in began if path not in now]


def _short(value: Any) -> str:
    return f"{len(value)} values" if isinstance(value, list) else clean(str(value))


EQUAL_NUMBERS = 1e-9
"""Two numbers that differ by less than this (relative) count as equal."""
ENTRIES_OF_TEXT = ("title", "description")
"""Entries that change no number."""
MOST_NAMED = 6
"""Largest number of changes, and of moved numbers, that the text names."""


@dataclass(frozen=True)
class ChangedEntry:
    """An entry of the document that differs: its path, and what it was and is, "" where there is none."""

    path: str
    before: str
    after: str

    def __str__(self) -> str:
        return f"{self.path}: {self.before or 'nothing'} → {self.after or 'nothing'}"


@dataclass(frozen=True)
class Moved:
    """A key number that differs, in both runs; NaN where a run has no such number."""

    name: str
    before: float
    after: float
    unit: str

    @property
    def share(self) -> float:
        """The difference as a share of the number before; NaN if that is 0, or one of them is unknown."""
        return (self.after - self.before) / abs(self.before) if self.before else math.nan

    def __str__(self) -> str:
        before, after = ("none" if math.isnan(value) else short(value, self.unit) for value in (self.before, self.after))
        percent = f" ({100.0 * self.share:+.3g} %)" if math.isfinite(self.share) and abs(self.share) < 10.0 else ""
        return f"{self.name}: {before} → {after}{percent}"


@dataclass(frozen=True)
class Difference:
    """All changes from one run to another, and all key numbers that moved."""

    changes: tuple[ChangedEntry, ...]
    moved: tuple[Moved, ...]

    @property
    def text(self) -> str:
        """One line that names them."""
        if not self.changes:
            return "the same setting"
        named = "; ".join(str(one) for one in self.changes[:MOST_NAMED]) + _more(len(self.changes))
        numbers = "; ".join(str(one) for one in self.moved[:MOST_NAMED]) + _more(len(self.moved))
        return f"{named}. {'Moved: ' + numbers if self.moved else 'No number moved'}."


def _more(count: int) -> str:
    return f"; and {count - MOST_NAMED} more" if count > MOST_NAMED else ""


def difference(before: tuple[Setting, Answer | FaultAnswer], after: tuple[Setting, Answer | FaultAnswer]) -> Difference:
    """Return the named difference of two runs, each a setting and its answer."""
    (old, old_answer), (new, new_answer) = before, after
    return Difference(_changes(old, new), _moved(old_answer.numbers, new_answer.numbers))


def _changes(old: Setting, new: Setting) -> tuple[ChangedEntry, ...]:
    """Return the changes; "1 s/m" and 1.0 are the same."""
    was, now = (inner_leaves_of(tomllib.loads(one.scenario().to_toml())) for one in (old, new))
    paths = [path for path in dict.fromkeys((*was, *now)) if path not in ENTRIES_OF_TEXT and was.get(path) != now.get(path)]
    return tuple(ChangedEntry(path, _shown(old, path, was), _shown(new, path, now)) for path in paths)


def _shown(setting: Setting, path: str, in_si: dict[str, Any]) -> str:
    """Return an entry as it stands in the document, or its value if it is a default."""
    value = setting.value(path)
    value = in_si.get(path) if value is None else value
    return "" if value is None else value if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else shown(value)


def _moved(old: tuple[KeyNumber, ...], new: tuple[KeyNumber, ...]) -> tuple[Moved, ...]:
    now = {one.name: one for one in new}
    both = [(one, now[one.name]) for one in old if one.name in now and one.unit == now[one.name].unit]
    return tuple(Moved(one.name, one.value, other.value, one.unit) for one, other in both if not _equal(one.value, other.value))


def _equal(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=EQUAL_NUMBERS) or (math.isnan(one) and math.isnan(other))
