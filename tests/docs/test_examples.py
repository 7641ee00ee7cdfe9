"""Everything that the pages show is run: examples, commands, messages, numbers, links."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import stickslip
from stickslip.problem.scenarios.library import names
from stickslip.problem.selection_rule import registered
from tests.docs.pages import (
    LINK,
    LONG_PAGES,
    PAGES,
    PAPER,
    ROOT,
    blocks_of,
    has_long_blocks,
    run_page,
    unknown_to_python,
    unknown_to_the_shell,
    wrong_numbers,
)


def page_name(page: Path) -> str:
    return page.relative_to(ROOT).with_suffix("").as_posix()


@pytest.fixture(autouse=True)
def _forget_rules() -> Iterator[None]:
    """What an example registers is not known to the next test."""
    yield
    registered.clear()


QUICK = [page for page in PAGES if page != PAPER and page.stem not in LONG_PAGES]  # tests/extensions/paper runs that page


@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.parametrize("page", QUICK, ids=page_name)
def test_every_example_does_what_its_page_shows(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All but the pages and the blocks that take long, for which there are the next two tests."""
    monkeypatch.chdir(tmp_path)
    run_page(page, whole=False)


@pytest.mark.parametrize("page", [page for page in PAGES if page.stem in LONG_PAGES], ids=page_name)
def test_what_a_long_page_types_can_be_read(page: Path) -> None:
    assert unknown_to_python(page) == []
    assert unknown_to_the_shell(page) == []


def test_what_cannot_be_read_is_noticed(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("```python\nss.simulate(ss.friction.Colomb())\n```\n```console\n$ stickslip run a.toml --duraton 3\n```\n")
    assert [one.partition(": ")[2] for one in unknown_to_python(page)] == ["ss.friction.Colomb"]
    (line,) = unknown_to_the_shell(page)
    assert "No such option" in line


@pytest.mark.slow
@pytest.mark.parametrize("page", [page for page in PAGES if has_long_blocks(page)], ids=page_name)
def test_every_example_of_a_page_does_what_it_shows(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_page(page, whole=True)


@pytest.mark.parametrize(
    ("comment", "wrong"),
    [
        ("4.102 m/s after 0", []),
        ("4.1 at 70 MPa", []),
        ("4.103 m/s", ["4.103"]),
        ("three in 80 MPa, 4.2", ["80", "4.2"]),
        ("-4.102", ["-4.102"]),
    ],
)
def test_numbers_in_comments_are_those_printed(comment: str, wrong: list[str]) -> None:
    assert wrong_numbers(comment, "print(rate(70e6))", "0.0 4.1020408\n") == wrong


@pytest.mark.parametrize("page", [*PAGES, ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"], ids=page_name)
def test_every_link_has_its_target(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"\]\([^)\s]+\n", text), f"{page.name}: a link is broken into two lines, and leads nowhere"
    for target in LINK.findall(text):
        if re.match(r"[a-z]+://|mailto:", target):
            continue
        path, _, anchor = target.partition("#")
        aim = (page.parent / path).resolve() if path else page
        assert aim.exists(), f"{page.name}: {target}"
        assert aim.suffix != ".md" or page.parent == ROOT or ROOT / "docs" in aim.parents, f"{page.name}: {target} leaves the site"
        if anchor:
            assert anchor in headings(aim), f"{page.name}: {target}"


def headings(page: Path) -> list[str]:
    """Anchors of a page's headings, as GitHub and most renderers make them."""
    found = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in found]


def test_no_page_is_lost() -> None:
    for page in PAGES[1:]:
        index = (page.parent / "index.md").read_text(encoding="utf-8")
        assert page.stem == "index" or f"({page.name})" in index


def test_pages_hold_no_html() -> None:
    for page in PAGES[1:]:
        prose = re.sub(r"^```.*?^```$|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        assert not re.search(r"</?[a-zA-Z][^>]*>|<!--", prose), page.name


def test_the_table_of_laws_agrees_with_the_laws() -> None:
    made = subprocess.run(
        [sys.executable, str(ROOT / "docs" / "law_table.py"), "--check"], capture_output=True, text=True, check=False
    )
    assert made.returncode == 0, made.stdout + made.stderr


def test_every_bundled_scenario_is_described() -> None:
    text = (ROOT / "docs" / "scenarios.md").read_text(encoding="utf-8")
    assert [name for name in names() if f"`{name}`" not in text] == []


TWO_COMMANDS = """
from stickslip.cli.main import main

for arguments in (["check", "mine.toml"], ["new", "slab"]):
    try:
        main(arguments)
    except SystemExit as ended:
        assert not ended.code
    print("and then")
"""


@pytest.mark.slow
def test_a_law_is_one_file_and_its_line_in_laws(tmp_path: Path) -> None:
    """The worked example of adding-a-law.md, in a copy of the package: file, line in LAWS, and the scenario that uses it."""
    page = ROOT / "docs" / "adding-a-law.md"
    package = tmp_path / "stickslip"
    shutil.copytree(Path(stickslip.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    blocks = [block for block in blocks_of(page) if block.language in ("python", "toml")]
    law = next(block.text for block in blocks if "class TwoDistanceWeakening" in block.text)
    scenario = next(block.text for block in blocks if block.language == "toml")
    (package / "friction" / "laws" / "two_distance_weakening.py").write_text(law, encoding="utf-8")
    listing = package / "friction" / "register.py"
    text = listing.read_text(encoding="utf-8")
    place = '        "two-distance-weakening": "laws.two_distance_weakening.TwoDistanceWeakening",\n'
    listing.write_text(re.sub(r"(\n    \"stickslip.friction\",\n    \{\n)", rf"\1{place}", text), encoding="utf-8")
    (tmp_path / "mine.toml").write_text(scenario, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", TWO_COMMANDS],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    checked, template, _ = done.stdout.split("and then")
    assert "TwoDistanceWeakening: regular" in checked
    assert "two-distance-weakening" in template
