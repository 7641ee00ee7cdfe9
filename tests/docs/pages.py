"""Markdown pages as lists of fenced blocks, and how each kind of block is run.

Conventions of the pages (README.md and docs/*.md):

- ```python blocks of a page run in order in one namespace, in an empty folder. A ```text block right behind one is what it prints.
  A number in a comment behind a statement that prints is one that it prints, to the digits of the comment, or one of its code.
- ```toml blocks that begin with `# NAME.toml` are put into that folder under this name.
- ```console blocks: lines `$ stickslip ...` are run; the lines shown below one are all that it says, and "..." stands for lines
  that are left out. A shown line that begins with "stickslip: " is an error: exit code 2; otherwise the exit code is 0.
- Files beside the pages that a page offers (links to .csv and .toml) lie in that folder, as if the reader had downloaded them.
"""

from __future__ import annotations

import ast
import io
import operator
import re
import shlex
import shutil
import sys
import types
import warnings
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import matplotlib as mpl
from typer.main import get_command

import stickslip
from stickslip.cli.app import TyperException, app
from stickslip.cli.main import main

ROOT = Path(__file__).parents[2]
MADE = {"_build", "gallery"}
"""Folders of docs/ that hold what `make site` has made."""
PAGES = [ROOT / "README.md", *sorted(page for page in (ROOT / "docs").glob("**/*.md") if not MADE & set(page.parts))]
PAPER = ROOT / "docs" / "paper.md"
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, the number of the line it starts on, and what a ```text block behind it shows."""

    language: str
    text: str
    line: int
    shown: str | None = None


@dataclass(frozen=True)
class Command:
    """A line `$ stickslip ...` and the lines shown below it; `before` are the arguments of a command whose output it reads."""

    arguments: list[str]
    into: str | None
    shown: list[str]
    before: list[str] | None = None

    @property
    def code(self) -> int:
        return 2 if any(line.startswith("stickslip: ") for line in self.shown) else 0


def blocks_of(page: Path) -> list[Block]:
    """The fenced blocks of a page, in order."""
    text = page.read_text(encoding="utf-8")
    found, previous_end = [], -1
    for match in _FENCE.finditer(text):
        language, content = match.groups()
        if language == "text" and found and found[-1].language == "python" and not text[previous_end : match.start()].strip():
            last = found.pop()
            found.append(Block(last.language, last.text, last.line, content))
        else:
            found.append(Block(language, content, text.count("\n", 0, match.start()) + 2))
        previous_end = match.end()
    return found


def downloads_of(page: Path) -> list[Path]:
    """The files that a page offers to download."""
    links = LINK.findall(page.read_text(encoding="utf-8"))
    return [page.parent / link for link in links if "://" not in link and link.endswith((".csv", ".toml"))]


def commands_of(block: Block) -> Iterator[Command]:
    """The commands of a ```console block that call stickslip."""
    for part in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
        typed, *shown = part.splitlines()
        words = shlex.split(typed)
        if words[0] != "stickslip":
            continue
        into = None
        if ">" in words:
            into = words[words.index(">") + 1]
            words = words[: words.index(">")]
        before = None
        if "|" in words:
            before, words = words[1 : words.index("|")], words[words.index("|") + 1 :]
        yield Command(words[1:], into, [line.strip() for line in shown if line.strip()], before)


def run_command(command: Command) -> tuple[int, str]:
    """Exit code and everything that is said, on either stream."""
    out, err, given = io.StringIO(), io.StringIO(), ""
    if command.before is not None:
        given = run_command(Command(command.before, None, []))[1]
    code = 0
    with patch.object(sys, "stdin", io.TextIOWrapper(io.BytesIO(given.encode()))), redirect_stdout(out), redirect_stderr(err):
        try:
            main(command.arguments)
        except SystemExit as stop:
            code = int(stop.code or 0)
    if command.into is not None:
        Path(command.into).write_text(out.getvalue(), encoding="utf-8")
    return code, out.getvalue() + err.getvalue()


def missing_lines(shown: list[str], said: str) -> list[str]:
    """The shown lines that do not follow one another in what was said, from its first line to its last; blanks count once.

    Only a line "..." stands for lines that are not shown. If nothing is shown, nothing is missing.
    """
    rest = [words for line in said.splitlines() if (words := " ".join(line.split()))]
    missing, may_skip = [], False
    for line in shown:
        if line == "...":
            may_skip = True
            continue
        words = " ".join(line.split())
        place = rest.index(words) if words in rest else None
        if place is None or (place > 0 and not may_skip):
            missing.append(line)
        if place is not None:
            rest, may_skip = rest[place + 1 :], False
    return missing if may_skip or not shown else [*missing, *rest]


def comments_of(block: Block) -> Iterator[tuple[str, str]]:
    """Yield the statements of a ```python block, and with each the comment at the end of its last line."""
    rows = block.text.splitlines()
    for node in ast.parse(block.text).body:
        first = min([node.lineno, *(decorator.lineno for decorator in getattr(node, "decorator_list", []))])
        code = "\n" * (first - 1) + "\n".join(rows[first - 1 : node.end_lineno])
        behind = rows[(node.end_lineno or 1) - 1].encode()[node.end_col_offset :].decode()
        yield code, behind.partition("#")[2].strip()


def wrong_numbers(comment: str, code: str, said: str) -> list[str]:
    """The numbers of a comment that are neither printed, to its digits, nor in the code that it comments on."""
    number = r"(?<![\w.])-?\d+(?:\.\d+)?"
    printed = [float(one) for one in re.findall(number + r"(?:e[+-]?\d+)?", said)]
    given = re.findall(number, code)

    def is_right(text: str) -> bool:
        half_a_digit = 0.5 * 10.0 ** -len(text.partition(".")[2])
        return text in given or any(abs(one - float(text)) <= 1.001 * half_a_digit for one in printed)

    return [text for text in re.findall(number, comment) if not is_right(text)]


LONG = (
    '"10 years" --catalogue', '"35 mm/year"', "pull_rate=0.5)", "stickslip analogy --figure",
    "to=9.02, steps=1", "put(7.5), near", "collars = ss.studies.cycle", 'lyapunov(softer, "10 min")',
)  # fmt: skip
"""Texts in blocks that take several seconds each, and on which no other block depends: they are run with the slow tests."""


LONG_PAGES = {
    "block-or-slab", "chain", "drill-string", "energy", "fault-in-2d-and-3d", "have-a-record", "inside-the-slab", "large-faults",
    "laws-and-bodies", "long-runs", "measured-friction", "rate-law-on-a-fault",
    "reading-results", "teaching", "schemes", "schemes-at-a-jump", "stick-slip", "sweeps", "uniqueness", "which-rule",
}  # fmt: skip
"""Pages that take more than five seconds each: they are run with the slow tests, and what they type is read with the quick ones."""


def has_long_blocks(page: Path) -> bool:
    """Return True if the slow tests alone run the whole page."""
    text = page.read_text(encoding="utf-8")
    return page.stem in LONG_PAGES or any(one in text for one in LONG)


def unknown_to_python(page: Path) -> list[str]:
    """The names below `ss` of ```python blocks that the package does not have; a block that is no Python is an error."""
    found = []
    for block in blocks_of(page):
        for node in ast.walk(ast.parse(block.text)) if block.language == "python" else ():
            dotted = ast.unparse(node) if isinstance(node, ast.Attribute) else ""
            if re.fullmatch(r"ss(\.\w+)+", dotted) and not _is_known(dotted):
                found.append(f"{page.name}, line {block.line}: {dotted}")
    return found


def _is_known(dotted: str) -> bool:
    try:
        operator.attrgetter(dotted.removeprefix("ss."))(stickslip)
    except AttributeError:
        return False
    return True


def unknown_to_the_shell(page: Path) -> list[str]:
    """The commands of a page that cannot be read: a command or an option that there is not, or a value of the wrong type."""
    group, found = get_command(app), []
    for block in blocks_of(page):
        for command in commands_of(block) if block.language == "console" else ():
            for typed in (one for one in (command.before, command.arguments) if one and command.code == 0):
                if not typed[0].startswith("-"):
                    try:
                        group.get_command(None, typed[0]).make_context(typed[0], typed[1:])
                    except (AttributeError, TyperException) as error:
                        found.append(f"{page.name}, line {block.line}: {typed}: {error!r}")
    return found


def run_page(page: Path, *, whole: bool) -> None:
    """Run the blocks of a page in the present folder, and check that each does what the page shows."""
    mpl.use("agg")
    module = types.ModuleType(f"page_{page.stem.replace('-', '_')}")
    for download in downloads_of(page):
        shutil.copy(download, Path.cwd())
    sys.modules[module.__name__] = module  # where classes that a page defines look for their names
    try:
        for block in blocks_of(page):
            if not whole and any(one in block.text for one in LONG):
                continue
            _run_block(block, module, f"{page.name}, line {block.line}")
    finally:
        del sys.modules[module.__name__]


def _run_block(block: Block, module: types.ModuleType, where: str) -> None:
    if block.language == "python":
        said = _run_python(block, module, where)
        assert block.shown is None or _lines(said) == _lines(block.shown), where
    elif block.language == "toml":
        name = re.match(r"# (\S+\.toml)\n", block.text)
        if name:
            Path(name[1]).write_text(block.text, encoding="utf-8")
    elif block.language == "console":
        for command in commands_of(block):
            code, said = run_command(command)
            assert code == command.code, f"{where}: {command.arguments}: {said}"
            assert missing_lines(command.shown, said) == [], f"{where}: {command.arguments}: {said}"


def _run_python(block: Block, module: types.ModuleType, where: str) -> str:
    said = io.StringIO()
    with warnings.catch_warnings(), redirect_stdout(said):
        warnings.simplefilter("error")
        for code, comment in comments_of(block):
            before = len(said.getvalue())
            exec(compile(code, where, "exec"), module.__dict__)
            printed = said.getvalue()[before:]
            assert not printed or wrong_numbers(comment, code, printed) == [], f"{where}: {code.strip()}"
    return said.getvalue()


def _lines(text: str) -> list[str]:
    return [line.rstrip() for line in text.rstrip().splitlines()]
