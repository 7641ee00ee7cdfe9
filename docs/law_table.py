"""Write the table of friction laws in laws-and-bodies.md from `LAWS`; with --check, only compare.

python docs/law_table.py
"""

from __future__ import annotations

import sys
from pathlib import Path

from stickslip.foundation.quantities import Quantity, fields_of
from stickslip.friction import LAWS, FrictionLaw

PAGE = Path(__file__).with_name("laws-and-bodies.md")
HEADING, NEXT = "## The laws\n", "\n## "


def table() -> str:
    """Return the table of all laws."""
    rows = [row(law) for law in LAWS.values()]
    heading = "| `kind` in a scenario, class in Python | friction | slip | parameters | source |"
    return "\n".join([heading, "| --- " * 5 + "|", *rows])


def row(law: type[FrictionLaw]) -> str:
    """Return the row of a law, from what it declares."""
    about = (law.__doc__ or "").strip().split("\n\n")[0]
    text = " ".join(about.split()).replace("|", "\\|")
    given = ", ".join(f"`{name}`{unit(declared)}" for name, (declared, _) in fields_of(law).items())
    counts = law.counts if isinstance(law.counts, str) else "of its parts"
    counts = "either" if "counts" in fields_of(law) else counts
    return f"| `{law.kind}`, `{law.__name__}` | {text} | {counts} | {given} | {law.source} |"


def unit(declared: object) -> str:
    """Return the unit of a parameter in brackets, or nothing for a pure number."""
    return f" ({declared.unit})" if isinstance(declared, Quantity) and declared.unit != "1" else ""


def with_table(text: str) -> str:
    """Return the page with the table as the first thing under its heading."""
    before, _, rest = text.partition(HEADING)
    _, _, after = rest.partition(NEXT)
    intro = "`python docs/law_table.py` writes this table from the code. `stickslip new slab --friction KIND` prints a scenario."
    return f"{before}{HEADING}\n{intro}\n\n{table()}\n{NEXT}{after}"


def main() -> int:
    """Write the page, or say that it must be written."""
    old = PAGE.read_text(encoding="utf-8")
    new = with_table(old)
    if "--check" in sys.argv:
        if old != new:
            sys.stdout.write("the table of laws does not agree with LAWS: run `python docs/law_table.py`\n")
        return int(old != new)
    PAGE.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
