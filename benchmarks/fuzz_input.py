"""Expressions, scenarios and tables that a stranger may write, damaged at random: each is read, or refused in one clear line.

    python -m benchmarks.fuzz_input --expressions 100000 --scenarios 50000 --tables 20000

Anything but a law, a scenario, or an InputError of one line within the time limit is a failure; the exit code is 1 then. Nothing is
run: what a run does with what was read is the soak's business (`benchmarks.soak`).
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from rich.progress import track

from stickslip.foundation.errors import InputError, gathered
from stickslip.friction import FromExpression
from stickslip.problem.scenarios import load_scenario
from stickslip.problem.scenarios.library import names, text

LIMIT = 2.0
"""Processor time (s) in which each must be read or refused."""
LONGEST_LINE = 1000
"""Characters of a message: what was wrong must not be repeated whole."""
WORDS = (
    *[
        "u",
        "v",
        "pi",
        "+",
        "-",
        "*",
        "/",
        "**",
        "(",
        ")",
        ",",
        ".",
        "0",
        "1",
        "2",
        "1e300",
        "1e-300",
        "0.5",
        "17",
        "a",
        "b",
        "mu_s",
        "exp",
        "sin",
        "cos",
        "log",
        "sqrt",
        "tanh",
        "arcsinh",
    ],
    *[
        "import",
        "lambda",
        "__class__",
        "[",
        "]",
        "{",
        "}",
        "'",
        '"',
        "\\",
        ":",
        ";",
        "=",
        "==",
        "if",
        "else",
        "for",
        "x.y",
        "f()",
        "1e999",
        "nan",
        "inf",
        "-",
    ],
    "\n",
    "\x00",
    "é",
    "__import__('os').system('true')",
    "9" * 400,
    "(" * 50,
    "-" * 60,
)
GOOD = (
    "a + b*exp(-v/0.1)",
    "0.6 + 0.05*exp(-((u - 1)/0.1)**2)",
    "mu_s - a*tanh(u) + b/(1 + v)",
    "0.6 + 0.1*sin(5*u)*exp(-v)",
    "0.3 + a*(1 + v)**b",
)
SCENARIOS = [text(name) for name in names()]
TABLE = "slip,friction\n0,0.7\n0.1,0.62\n0.3,0.45\n1,0.4\n"
ODD = (
    "",
    "nan",
    "inf",
    "-1",
    "1e400",
    "0,5",
    '"',
    "#",
    "\t",
    ";",
    "\x00",
    "é",
    "=1+1",
    "x" * 5000,
    "0x10",
    "1_000",
    "km",
    "\n\n",
    "\r",
)


def expression(rng: random.Random) -> tuple[str, dict[str, float]]:
    """Return an expression of words in any order, or a good one with a few characters changed, and values of its parameters."""
    made_up = rng.random() < 0.5
    formula = " ".join(rng.choices(WORDS, k=rng.randint(1, 25))) if made_up else damaged(rng, rng.choice(GOOD))
    values = (0.0, 0.3, -1.0, 1e300, 1e-300, 17.0)
    return formula, {name: rng.choice(values) for name in ("a", "b", "mu_s") if name in formula or rng.random() < 0.1}


def damaged(rng: random.Random, good: str) -> str:
    """Return a text with a few pieces replaced, removed, doubled or exchanged."""
    for _ in range(rng.randint(1, 4)):
        start = rng.randrange(len(good) + 1)
        end = min(start + rng.choice((0, 1, 1, 2, 8, 40)), len(good))
        good = good[:start] + rng.choice(("", good[start:end] * 2, rng.choice(WORDS), rng.choice(ODD))) + good[end:]
    return good


def scenario(rng: random.Random) -> str:
    """Return the text of a bundled scenario or a template, damaged: in its characters, its numbers or the order of its lines."""
    good = rng.choice(SCENARIOS)
    lines, kind = good.splitlines(), rng.random()
    if kind < 0.4:
        return damaged(rng, good)
    if kind < 0.8:
        n = rng.choice([k for k, line in enumerate(lines) if "=" in line])
        key = lines[n].split("=")[0]
        numbers = ("-1", "0", "1e300", "true", "[1]", "{}", "5 km", "nan", "10 parsec", str(rng.gauss(0, 9)))
        lines[n] = f"{key}= {rng.choice((*ODD, *numbers))}"
        if rng.random() < 0.5:
            lines[n] = lines[n].replace("= ", '= "', 1) + '"'
    else:
        rng.shuffle(lines)
    return "\n".join(lines)


def refusal(read: Callable[[], object]) -> str:
    """Return "read", "refused", or what is wrong: another exception, a message that is not one short line, or too much time."""
    start = time.process_time()
    try:
        with gathered() as notes:
            read()
        said = next((f"no short line: {note[:80]!a}" for note in notes if not is_short_line(note)), "read")
    except InputError as error:
        line = str(error)
        said = "refused" if is_short_line(line) else f"no short line: {line[:80]!a}"
    except Exception as error:  # whatever else it is, it is the finding
        said = f"{type(error).__name__}: {str(error)[:80]!a}"
    took = time.process_time() - start
    return said if took <= LIMIT else f"took {took:.1f} s"


def is_short_line(text: str) -> bool:
    """Return True for a message that can be read at a glance."""
    return 0 < len(text) <= LONGEST_LINE and text.isprintable()


def tally(what: str, count: int, seed: int, one: Callable[[random.Random], str]) -> int:
    """Try so many, print how they ended, and the first of each kind of failure. Returns how many failed."""
    found: Counter[str] = Counter()
    first: dict[str, int] = {}
    for n in track(range(count), description=what, disable=not sys.stdout.isatty()):
        said = one(random.Random(f"{what} {seed} {n}"))
        found[said] += 1
        first.setdefault(said, n)
    bad = {said: times for said, times in found.items() if said not in ("read", "refused")}
    print(f"| {what} | {count} | {found['read']} | {found['refused']} | {sum(bad.values())} |")  # noqa: T201 - a script
    for said, times in sorted(bad.items(), key=lambda pair: -pair[1])[:20]:
        print(f"  {times} x {said} (first: number {first[said]})")  # noqa: T201
    return sum(bad.values())


def _expression(rng: random.Random) -> str:
    formula, values = expression(rng)
    return refusal(lambda: FromExpression(formula, values))


def _scenario(rng: random.Random, folder: Path) -> str:
    path = folder / "scenario.toml"
    path.write_text(scenario(rng), encoding="utf-8", newline="")
    return refusal(lambda: load_scenario(path))


def _table(rng: random.Random, folder: Path) -> str:
    (folder / "points.csv").write_text(damaged(rng, TABLE), encoding="utf-8", newline="")
    return refusal(lambda: load_scenario(folder / "table.toml"))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, count in (("expressions", 100_000), ("scenarios", 50_000), ("tables", 20_000)):
        parser.add_argument(f"--{name}", type=int, default=count)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    warnings.simplefilter("error")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        head, _, rest = text("fig5-slab-printed").partition("[friction]")
        tail = rest[rest.index("\n[") :]
        (folder / "table.toml").write_text(f'{head}[friction]\nkind = "table"\nfile = "points.csv"\n{tail}')
        print("| input | tried | read | refused | failed |\n| --- | --- | --- | --- | --- |")  # noqa: T201
        failed = tally("expressions", options.expressions, options.seed, _expression)
        failed += tally("scenarios", options.scenarios, options.seed, lambda rng: _scenario(rng, folder))
        failed += tally("tables", options.tables, options.seed, lambda rng: _table(rng, folder))
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
