"""A key of code changes with what is executed, and with nothing else: checkpoints and machine code outlive an edited comment."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from stickslip.engine.history.status import RUN_CODE, engine_key
from stickslip.foundation import code_key
from stickslip.foundation.code_key import PACKAGE, key_of, key_of_files, key_of_folders
from stickslip.foundation.sealed_files import read_sealed, write_sealed

TEXT = b'''"""Say what this is."""

WIDTH = 2.0
"""Width, m."""


def twice(x, y=1):
    """Return twice x."""
    assert y, "y is missing"
    for _ in (1, 2):
        if x and y:
            continue
    return WIDTH * x
'''


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (b"Return twice x.", b"Double x."),
        (b"Width, m.", b"Width."),
        (b"is.", b"was."),
        (b'    """Return twice x."""\n', b""),
        (b'"""Say what this is."""\n', b""),
        (b'"""Width, m."""\n', b""),
        (b"* x", b"* x  # why"),
        (b"\n\n\n", b"\n"),
        (b"(x, y=1)", b"(\n    x,\n    y=1,\n)"),
        (b"WIDTH * x", b"(\n        WIDTH\n        * x\n    )"),
        (b"if x and y:\n            continue", b"if (x and\n            y): continue"),
        (b"y is missing", b"where is y?"),
        (b"2.0", b"20e-1"),
    ],
)
def test_texts_and_layout_leave_the_key(before: bytes, after: bytes) -> None:
    changed = TEXT.replace(before, after)
    assert changed != TEXT
    assert key_of([changed], "") == key_of([TEXT], "")


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (b"2.0", b"2.5"),
        (b"WIDTH * x", b"x * WIDTH"),
        (b"twice(x", b"thrice(x"),
        (b"y=1", b"y=2"),
        (b"y=1", b"*, y=1"),
        (b"x and y", b"x or y"),
        (b"continue", b"break"),
        (b"(1, 2)", b"{1, 2}"),
        (b"2.0", b"2"),
    ],
)
def test_every_change_of_code_changes_the_key(before: bytes, after: bytes) -> None:
    changed = TEXT.replace(before, after)
    assert changed != TEXT
    assert key_of([changed], "") != key_of([TEXT], "")


def test_the_files_of_the_package_have_the_key_of_their_code_in_another_layout() -> None:
    """Python's compiler chooses some instructions by where lines end: in one file of ten that the tree of its code gives."""
    files = sorted(path for path in (PACKAGE / "engine").rglob("*.py"))[::4]
    assert len(files) > 20
    for path in files:
        text = path.read_text(encoding="utf-8")
        assert key_of([text.encode()], "") == key_of([ast.unparse(ast.parse(text)).encode()], ""), path


def test_code_that_moves_to_another_file_and_another_version_of_python_change_the_key() -> None:
    assert key_of([TEXT, b""], "") != key_of([b"", TEXT], "")
    assert key_of([TEXT], "3.11") != key_of([TEXT], "3.12")


def test_a_key_is_remembered_and_a_damaged_one_is_made_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path))
    (file := tmp_path / "code.py").write_bytes(TEXT)
    key = key_of([TEXT], "")
    assert key_of_files([file], "") == key
    (kept,) = (tmp_path / "keys").iterdir()
    write_sealed(kept, b"0" * len(key))
    assert key_of_files([file], "") == "0" * len(key)  # what is read is used
    with monkeypatch.context() as later:  # keys were made in another way when that one was kept
        later.setattr(code_key, "__file__", str(file))
        assert key_of_files([file], "") == key
    write_sealed(tmp_path / "keys" / "another", b"1" * len(key))
    for damaged in (b"\xff damaged", b"1" * len(key), (tmp_path / "keys" / "another").read_bytes()):
        kept.write_bytes(damaged)
        assert key_of_files([file], "") == key
        assert read_sealed(kept) == key.encode()
    file.write_bytes(TEXT.replace(b"2.0", b"2.5"))
    assert key_of_files([file], "") != key
    (tmp_path / "a file").touch()
    two = [tmp_path / "a.py", tmp_path / "b.py"]
    keys = set()
    for first, second in ((b"A = 1\nB = 2\n", b"C = 3\n"), (b"A = 1\n", b"B = 2\nC = 3\n")):
        for path, text in zip(two, (first, second), strict=True):
            path.write_bytes(text)
        keys.add(key_of_files(two, ""))
    assert len(keys) == 2
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path / "a file"))
    assert key_of_files([file], "") == key_of([TEXT.replace(b"2.0", b"2.5")], "")


# ---- which code decides a run --------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of one file of each folder that decides a run: to make the key of all takes a second."""
    package = tmp_path_factory.mktemp("copy") / "stickslip"
    for name in RUN_CODE:
        file = next(path for path in sorted((PACKAGE / name).rglob("*.py")) if b"def " in path.read_bytes())
        (package / file.relative_to(PACKAGE)).parent.mkdir(parents=True)
        shutil.copy(file, package / file.relative_to(PACKAGE))
    return package


EDITS: dict[str, tuple[Callable[[str], str], bool]] = {
    "a comment": (lambda text: text + "\n# why\n", False),
    "a docstring": (lambda text: text.replace('"""', '"""Now: ', 1), False),
    "another layout": (lambda text: ast.unparse(ast.parse(text)), False),
    "a statement": (lambda text: text + "\nprint()\n", True),
    "a constant": (lambda text: text + "\nMORE = 1.0\n", True),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("edit", EDITS)
@pytest.mark.parametrize("name", RUN_CODE)
def test_the_key_of_a_checkpoint_is_of_what_is_executed_in_every_folder_that_decides_a_run(
    copy: Path, name: str, edit: str
) -> None:
    before = key_of_folders(RUN_CODE, "", copy)
    (file,) = (copy / name).rglob("*.py")
    text = file.read_text(encoding="utf-8")
    change, changes_key = EDITS[edit]
    file.write_text(change(text), encoding="utf-8")
    try:
        assert file.read_text(encoding="utf-8") != text
        assert (key_of_folders(RUN_CODE, "", copy) != before) == changes_key
    finally:
        file.write_text(text, encoding="utf-8")


def test_a_checkpoint_has_the_key_of_all_these_folders_and_of_those_that_an_extension_adds() -> None:
    from stickslip.foundation.kernels.code import SOURCES

    assert engine_key() == key_of_folders(RUN_CODE, SOURCES)
    assert engine_key("foundation") == key_of_folders(["foundation"], engine_key()) != engine_key()
    assert all((PACKAGE / name).is_dir() for name in RUN_CODE)


@pytest.mark.slow
def test_a_run_is_resumed_after_an_edited_docstring_and_refused_after_an_edited_constant(tmp_path: Path) -> None:
    shutil.copytree(PACKAGE, tmp_path / "src" / "stickslip", ignore=shutil.ignore_patterns("__pycache__"))

    def python(code: str) -> str:
        settings = os.environ | {"PYTHONPATH": str(tmp_path / "src")}
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, env=settings)
        return done.stdout.strip() or done.stderr.splitlines()[-1]

    def edit(name: str, old: str, new: str) -> None:
        path = tmp_path / "src" / "stickslip" / name
        text = path.read_text(encoding="utf-8")
        assert text.count(old) == 1
        path.write_text(text.replace(old, new), encoding="utf-8")

    begun = "import stickslip as ss; print(ss.simulate('cycles-block', duration=30.0, checkpoint='run.nc').status.name)"
    resumed = "import stickslip as ss; print(ss.resume('run.nc', duration={}).status.name)"
    assert python(begun) == "finished"
    edit("contact/secant.py", '"""\n\nfrom __future__', ' Now."""\n\nfrom __future__')
    assert python(resumed.format(40.0)) == "finished"
    edit("contact/secant.py", "\nfrom __future__ import annotations\n", "\nfrom __future__ import annotations\n\nONE_MORE = 1.0\n")
    said = python(resumed.format(50.0))
    assert "run.nc: cannot be resumed: another version of stickslip's engine made it" in said
    assert said.endswith("run it again from the start")
