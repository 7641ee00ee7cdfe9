"""Count the lines of the package by room, as a table for README.md: `python -m benchmarks.lines`."""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.house import CORE, FACE, House

ROOT = Path(__file__).parents[1]


def main() -> None:
    """Print the table: the rooms of the core from the bottom up, what stands in no room, and the extensions."""
    house = House(ROOT / "src" / "stickslip")
    rooms = {room: house.lines(room) for room in (*CORE, FACE, *house.extensions)}
    tests = [path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("*.py")]
    rows = [(room, *rooms[room]) for room in CORE]
    rows.append(("**core**", *map(sum, zip(*(rooms[room] for room in CORE), strict=True))))
    rows += [("public names, extension.py", *rooms[FACE]), *((room, *rooms[room]) for room in house.extensions)]
    rows.append(("**all**", *map(sum, zip(*rooms.values(), strict=True))))
    rows.append(("tests", len(tests), sum(len(text.splitlines()) for text in tests)))
    sys.stdout.write("| room | files | lines |\n| --- | --- | --- |\n")
    sys.stdout.write("".join(f"| {name} | {files} | {count} |\n" for name, files, count in rows))


if __name__ == "__main__":
    main()
