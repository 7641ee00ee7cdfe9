"""Stores that somebody else has changed, with checksums that fit: one line in reasonable time, and no traceback."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

import stickslip as ss
from stickslip.cli.main import main
from stickslip.extensions.sweeps.results.layout import SWEEP_FORMAT
from stickslip.extensions.sweeps.results.store import open_store
from stickslip.extensions.sweeps.sweep import SweepProgress
from tests.extensions.sweeps.stores import VARY, files, sweep


@pytest.fixture(scope="module")
def half(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The store of a sweep that was stopped after half of its members."""

    def stop(report: SweepProgress) -> None:
        if report.done >= 6:
            raise KeyboardInterrupt

    path = tmp_path_factory.mktemp("half") / "map.zarr"
    sweep(path, progress=stop)
    return path


@pytest.fixture
def store(half: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(half, tmp_path / "map.zarr"))


def vouch_again(store: Path) -> None:
    """Give the attributes a checksum that fits, and each array's own file what the gathered metadata say of it."""
    with suppress(ValueError, RecursionError, KeyError, TypeError):
        about = json.loads((store / "zarr.json").read_text())
        about["attributes"]["digest"] = SWEEP_FORMAT.digest_of(about["attributes"])
        (store / "zarr.json").write_text(json.dumps(about))
        for name, known in about["consolidated_metadata"]["metadata"].items():
            (store / name / "zarr.json").write_text(json.dumps(known))


def refused(act: Callable[[], object], *words: str) -> None:
    with pytest.raises(ss.InputError) as told:
        act()
    assert str(told.value).isprintable()
    assert all(word in str(told.value) for word in words), str(told.value)


def shows(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Check that the command refuses a store in one line."""
    with pytest.raises(SystemExit) as ended:
        main(["show", str(path)])
    said = capsys.readouterr().err
    assert (ended.value.code, said.count("\n")) == (2, 1)
    assert said.startswith("stickslip: ")


KEYS = list(VARY)
DESIGNS: list[Any] = [
    None,
    5,
    "x",
    "[]",
    "[" * 100_000,
    json.dumps({"design": "grid", "keys": 5, "chunk": [2, 6]}),
    json.dumps({"design": "a\nb", "keys": KEYS, "chunk": [2, 6]}),
    *(json.dumps({"design": "grid", "keys": KEYS, "chunk": chunk}) for chunk in ([0, -1], [1e300, 1], [2], ["a", 1], [10**30, 1])),
]


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("design", DESIGNS)
def test_a_design_that_no_sweep_has_is_refused_in_one_line(store: Path, design: Any) -> None:
    about = json.loads((store / "zarr.json").read_text())
    about["attributes"]["design"] = design
    (store / "zarr.json").write_text(json.dumps(about))
    vouch_again(store)
    refused(lambda: sweep(store), f"{store}: ")


FORMS: dict[str, Any] = {
    "attributes": {},
    "data_type": "complex128",
    "dimension_names": ["a", "a"],
    "shape": [10**12, 10**12],
    "node_type": "group",
}


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("variable", ["slip", "status", "body.thickness"])
@pytest.mark.parametrize("key", [None, *FORMS])
def test_a_variable_of_another_form_is_refused_in_one_line(store: Path, variable: str, key: str | None) -> None:
    about = json.loads((store / "zarr.json").read_text())
    variables = about["consolidated_metadata"]["metadata"]
    if key is None:
        variables.pop(variable)
    else:
        variables[variable][key] = FORMS[key]
    (store / "zarr.json").write_text(json.dumps(about))
    vouch_again(store)
    refused(lambda: sweep(store), f"{store}: ")


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("text", ["[]", "NaN", "[" * 200_000, "\x00"])
def test_metadata_of_another_form_are_refused_in_one_line(store: Path, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    (store / "zarr.json").write_text(text)
    vouch_again(store)
    for act in (lambda: sweep(store), lambda: open_store(store)):
        refused(act, f"{store}: ")
    shows(store, capsys)


@pytest.mark.slow
def test_a_store_whose_metadata_are_not_gathered_is_refused_in_one_line(store: Path) -> None:
    about = json.loads((store / "zarr.json").read_text())
    about.pop("consolidated_metadata")
    (store / "zarr.json").write_text(json.dumps(about))
    vouch_again(store)
    refused(lambda: sweep(store), f"{store}: ")


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("unit", [5, "Pa\n\x1b[31m", None])
def test_a_unit_that_is_no_text_is_not_shown(store: Path, unit: Any, capsys: pytest.CaptureFixture[str]) -> None:
    about = json.loads((store / "zarr.json").read_text())
    about["consolidated_metadata"]["metadata"]["slip"]["attributes"]["units"] = unit
    (store / "zarr.json").write_text(json.dumps(about))
    vouch_again(store)
    refused(lambda: open_store(store), "slip")
    shows(store, capsys)


@pytest.mark.skipif(os.name != "posix", reason="needs pipes")
def test_a_pipe_in_place_of_a_chunk_is_not_waited_for(store: Path) -> None:
    (store / "slip" / "c.0.0").unlink()
    os.mkfifo(store / "slip" / "c.0.0")
    refused(lambda: open_store(store), f"{store}: slip/c.0.0: not an ordinary file: remove {store / 'status' / 'c.0.0'}")


@pytest.mark.parametrize("name", ["slip", "status", "status/zarr.json"])
def test_no_sweep_is_continued_through_a_link_inside_its_store(store: Path, name: str, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    (store / name).rename(elsewhere)
    (store / name).symlink_to(elsewhere)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    refused(lambda: sweep(store), f"{name} in it is a link: put the folder or the file itself there")
    assert before == {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}


def test_a_folder_with_the_name_of_a_draft_is_left_alone(store: Path) -> None:
    for name in ("x.partial", "status/c.0.partial"):
        (store / name / "mine.partial").mkdir(parents=True)
    sweep(store)
    assert (store / "x.partial" / "mine.partial").is_dir()


@pytest.mark.parametrize(
    ("name", "said"),
    [("status/c.0.2", "status/c.0.2: Is a directory: remove "), ("slip/c.0.2", "cannot be written: Is a directory")],
)
def test_a_folder_with_the_name_of_a_chunk_is_named(half: Path, tmp_path: Path, name: str, said: str) -> None:
    store = tmp_path / "other.zarr"
    shutil.copytree(half, store)
    for file in (store / name.replace("slip", "status"), store / name):
        file.unlink(missing_ok=True)
    (store / name).mkdir()
    before = files(store)
    refused(lambda: sweep(store), f"{store}", said)
    assert before.items() <= files(store).items()
