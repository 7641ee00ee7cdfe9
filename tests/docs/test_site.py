"""The sources of the site, without building it: `make site` builds it, and checks every link of what it has built."""

from __future__ import annotations

import ast
import pkgutil
import re
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import stickslip as ss
from tests.docs.pages import PAGES, ROOT

DOCS = ROOT / "docs"
SOURCES = [DOCS / "index.rst", DOCS / "theory" / "index.rst", *sorted((DOCS / "site").rglob("*.rst"))]
TOCTREE = re.compile(r"^\.\. toctree::\n((?:[ \t]+.*\n|\n)+)", re.MULTILINE)
NAMED_TEST = re.compile(r"`(test_\w+)`")


def entries() -> list[Path]:
    """Return what the tables of contents name, as paths without an ending."""
    found = []
    for source in SOURCES:
        for block in TOCTREE.findall(source.read_text(encoding="utf-8")):
            lines = [line.strip() for line in block.splitlines()]
            names = [re.sub(r".*<(.*)>", r"\1", line) for line in lines if line and not line.startswith(":")]
            found += [(source.parent / name).resolve() for name in names]
    return found


def test_every_page_is_in_one_table_of_contents() -> None:
    pages = {source.with_suffix("") for source in (*PAGES[1:], *SOURCES)} - {DOCS / "index"}
    pages |= {DOCS / "gallery" / name for name in ("index", "lesson", "second-lesson")}  # they are made from examples/
    assert sorted(entries()) == sorted(pages), "a new page of docs/ is named in docs/site/guide.rst or docs/site/development.rst"


def test_every_public_name_is_in_the_reference() -> None:
    reference = "\n".join(source.read_text(encoding="utf-8") for source in SOURCES)
    names = {f"stickslip.{name}" for name in ss.__all__ if name not in ("figures", "friction", "loading", "studies", "selection")}
    for package in ("figures", "friction", "loading", "studies"):
        names |= {f"stickslip.{package}.{name}" for name in getattr(ss, package).__all__}
    names |= {"stickslip.selection.register", "stickslip.selection.SelectionTable"}
    assert [
        name for name in sorted(names) if not re.search(rf"^\.\. \S+:: {re.escape(name)}(\(\))?$", reference, re.MULTILINE)
    ] == []


def test_every_member_that_the_reference_lists_exists() -> None:
    missing = []
    for source in SOURCES:
        for name, members in re.findall(r"^\.\. auto\w+:: ([\w.]+).*\n((?:   :.*\n)*)", source.read_text("utf-8"), re.MULTILINE):
            found = pkgutil.resolve_name(name)
            fields = {one for base in getattr(found, "__mro__", ()) for one in getattr(base, "__annotations__", {})}
            listed = re.findall(r"[\w.]+", "".join(re.findall(r":members:(.*)", members)))
            missing += [f"{source.stem}: {name}.{one}" for one in listed if not hasattr(found, one) and one not in fields]
    assert missing == []


UNDERLINE = re.compile(r"^(?:# )?(\S.*)\n(?:# )?(([=~^-])\3{2,})$", re.MULTILINE)


@pytest.mark.parametrize("source", [*SOURCES, *(ROOT / "examples").glob("*.*")], ids=lambda path: path.name)
def test_titles_are_underlined_in_full(source: Path) -> None:
    titles = UNDERLINE.findall(source.read_text("utf-8"))
    assert [title for title, line, _ in titles if len(line) < len(title)] == []


def test_pages_build_without_a_warning_where_sphinx_is_installed(tmp_path: Path) -> None:
    """The gallery is not run: `test_gallery.py` runs its scripts."""
    pytest.importorskip("sphinx_gallery", reason="needs the extra [site], which `make site` installs")
    asked = ["-b", "html", "-q", "--fail-on-warning", "--keep-going", "-D", "plot_gallery=0", "-d", str(tmp_path / "doctrees")]
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *asked, str(DOCS), str(tmp_path / "html")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_every_independent_solution_is_in_the_reference() -> None:
    """The page names all that a module of references defines, but for the parts that others return."""
    page = (DOCS / "site" / "api" / "reference.rst").read_text(encoding="utf-8")
    defined, package = set(), ROOT / "src" / "stickslip"
    for path in (*(package / "run" / "reference").rglob("*.py"), *package.glob("extensions/*/reference.py")):
        module = ".".join(path.relative_to(ROOT / "src").with_suffix("").parts)
        nodes = ast.parse(path.read_text(encoding="utf-8")).body
        defined |= {
            f"{module}.{node.name}" for node in nodes if isinstance(node, ast.ClassDef | ast.FunctionDef) and node.name[0] != "_"
        }
    documented = set(re.findall(r"^\.\. auto\w+:: ([\w.]+)", page, re.MULTILINE))
    assert documented == defined


@pytest.fixture(scope="module")
def tests_there_are() -> set[str]:
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    return {name for text in texts for name in re.findall(r"^def (test_\w+)\(", text, re.MULTILINE)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_test_that_a_page_names_exists(page: Path, tests_there_are: set[str]) -> None:
    assert set(NAMED_TEST.findall(page.read_text(encoding="utf-8"))) <= tests_there_are


def test_every_promise_names_a_test() -> None:
    lines = (DOCS / "guarantees.md").read_text(encoding="utf-8").splitlines()
    promises = [line for line in lines if line.startswith("| ") and not line.startswith(("| promise", "| ---"))]
    assert len(promises) > 20
    assert [line for line in promises if not NAMED_TEST.search(line)] == []


def test_the_diagram_of_the_loop_names_what_there_is() -> None:
    diagram = (DOCS / "figures" / "states-of-the-loop.svg").read_text(encoding="utf-8").partition("</defs>")[2]
    named = set(re.findall(r"\w+_\w+|\b[A-Z]{3,}\b", re.sub(r"<[^>]*>", " ", diagram)))
    source = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "src" / "stickslip").rglob("*.py"))
    assert {"next_piece", "approach_fold", "depart_from_fold", "PAUSED"} <= named
    assert [name for name in sorted(named) if not re.search(rf"^def {name}\(|^    {name} = ", source, re.MULTILINE)] == []


@pytest.fixture(scope="module")
def check_site() -> Any:
    return runpy.run_path(str(DOCS / "site" / "check_site.py"))["main"]


@pytest.mark.parametrize(
    ("body", "fault"),
    [
        ('<a href="b.html#there">b</a> <a href="https://example.org">elsewhere</a> <h1 id="x"></h1><a href="#x"></a>', ""),
        ('<a href="c.html">c</a>', "a.html: c.html is missing"),
        ('<a href="b.html#nowhere">b</a>', "a.html: b.html#nowhere has no such anchor"),
        ('<img src="https://example.org/a.png">', "a.html: loads https://example.org/a.png from another host"),
        ('<script src="//example.org/a.js"></script>', "a.html: loads //example.org/a.js from another host"),
        ('<link rel="stylesheet" href="https://example.org/a.css">', "a.html: loads https://example.org/a.css from another host"),
        ('<link rel="stylesheet" href="a.css">', "a.css: loads something from another host"),
    ],
)
def test_faults_of_a_built_site_are_found(
    body: str, fault: str, check_site: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.html").write_text(body, encoding="utf-8")
    (tmp_path / "b.html").write_text('<p id="there">', encoding="utf-8")
    if 'href="a.css"' in body:
        (tmp_path / "a.css").write_text('@import "https://example.org/b.css";', encoding="utf-8")
    assert check_site(tmp_path) == bool(fault)
    assert fault in capsys.readouterr().out.splitlines() or not fault
