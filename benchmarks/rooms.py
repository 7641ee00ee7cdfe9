"""Measure the house, and what may only become less: `python -m benchmarks.rooms [--lower]`.

Prints a table of rooms, and what rooms.toml bounds: the size of the core, the names that cross rooms, and imports that run up, or
from the core to an extension, or from one extension to another. With --lower, bounds that have become too wide are narrowed.
"""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from benchmarks.house import CORE, FACE, House
from benchmarks.kinds import functions_that_ask

ROOT = Path(__file__).parents[1]
BOUNDS = Path(__file__).with_name("rooms.toml")
"""The file of what may only become less."""


@dataclass(frozen=True)
class Bounds:
    """What rooms.toml says."""

    most: dict[str, int]
    lists: dict[str, dict[str, str]]
    """The exceptions under each heading, each with its reason."""

    @classmethod
    def read(cls, text: str) -> Bounds:
        """Read the text of rooms.toml."""
        table = tomllib.loads(text)
        most = table.pop("most")
        return cls(
            most, {name: {one: group["reason"] for group in groups for one in group["files"]} for name, groups in table.items()}
        )

    @property
    def doors(self) -> set[str]:
        """Files whose imports inside functions, or for type checkers, may close a circle."""
        return set(self.lists.get(DOORS, {}))

    def measured(self, house: House) -> dict[str, set[str]]:
        """Return for each heading what is there of it; of the doors, those that are needed."""
        needed = {one for one in self.doors if house.circles(self.doors - {one})}
        return house.lists() | {DOORS: needed}

    def broken(self, house: House) -> list[str]:
        """Return a line on all that has become more than they allow, or so much less that they should be narrowed."""
        found = [
            f"a circle in {folder or 'the package'}: {' <- '.join(names)}" for folder, names in house.circles(self.doors).items()
        ]
        for name, value in numbers(house).items():
            most = self.most[name]
            if value > most:
                found.append(f"{name}: {value}, and {most} are allowed")
            elif value < most - slack(most):
                found.append(f"{name}: {value}, and as many as {most} are still allowed: {LOWER}")
        for name, measured in self.measured(house).items():
            listed = set(self.lists.get(name, {}))
            found += [f"{name}: {one} is new" for one in sorted(measured - listed)]
            found += [f"{name}: {one} is gone, and still listed: {LOWER}" for one in sorted(listed - measured)]
        return found


DOORS = "doors"
"""Heading of the files whose imports inside functions may close a circle."""
LOWER = "run `python -m benchmarks.rooms --lower`"
"""How bounds are narrowed."""


def numbers(house: House) -> dict[str, int]:
    """Return the numbers that may only fall."""
    asks = functions_that_ask(house.nodes)
    return house.numbers() | {
        "functions that ask a kind": len(asks),
        "conditions that ask a kind": sum(map(len, asks.values())),
    }


def slack(most: int) -> int:
    """Return how far a number may lie below its bound before the bound has to be lowered."""
    return most // 50


def lowered(text: str, house: House) -> str:
    """Return the text of rooms.toml with bounds as narrow as they can be; none is ever widened."""
    for name, value in numbers(house).items():
        found = re.search(rf'^"{re.escape(name)}" = (\d+)$', text, re.MULTILINE)
        if found and int(found[1]) > value:
            text = text[: found.start(1)] + str(value) + text[found.end(1) :]
    bounds = Bounds.read(text)
    measured = bounds.measured(house)
    gone = {f'    "{one}",' for name, listed in bounds.lists.items() for one in listed if one not in measured[name]}
    text = "".join(f"{line}\n" for line in text.splitlines() if line not in gone)
    return re.sub(r"\n\[\[\w+\]\]\nreason = [^\n]*\nfiles = \[\n\]\n", "", text)


def report(house: House) -> Iterator[str]:
    """Yield the lines of the report."""
    yield f"{'room':12} {'files':>5} {'lines':>6}  {'names taken':>11} {'of files':>8}  imports"
    for room in (*CORE, *house.extensions, FACE):
        files, lines = house.lines(room)
        taken = house.crossing(room)
        uses: dict[str, set[tuple[str, str | None]]] = {}
        for one in house.imports:
            if one.own == room:
                uses.setdefault(one.room, set()).add((one.module, one.name))
        said = ", ".join(f"{other} {len(names)}" for other, names in sorted(uses.items()))
        yield f"{room:12} {files:5} {lines:6}  {len(taken):11} {len({module for module, _ in taken}):8}  {said}"
    yield f"\npairs of rooms that import each other, one way or both: {len({(one.own, one.room) for one in house.imports})}"
    yield from (f"{name}: {value}" for name, value in numbers(house).items())
    for name, measured in house.lists().items():
        yield f"\n{name}:"
        yield from (f"  {one}" for one in sorted(measured))


def main() -> None:
    """Print the report, and narrow the bounds if asked to; an error if they are broken."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lower", action="store_true", help="narrow the bounds in rooms.toml")
    lower = parser.parse_args().lower
    house = House(ROOT / "src" / "stickslip")
    if lower:
        BOUNDS.write_text(lowered(BOUNDS.read_text(encoding="utf-8"), house), encoding="utf-8")
    sys.stdout.write("".join(f"{line}\n" for line in report(house)))
    broken = Bounds.read(BOUNDS.read_text(encoding="utf-8")).broken(house)
    sys.exit("\n".join(["", *broken]) if broken else 0)


if __name__ == "__main__":
    main()
