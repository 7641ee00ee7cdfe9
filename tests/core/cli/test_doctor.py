"""`stickslip doctor` finds each fault that an installation can have, and says in one line how to cure it."""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Callable
from importlib import metadata
from pathlib import Path

import pytest

from stickslip.cli import installation
from stickslip.cli.main import main
from stickslip.foundation.kernels.processor import PROCESSOR
from stickslip.problem.scenarios.templates import template
from tests.command_line import Command, Outcome
from tests.core.foundation.kernels.fresh import COMMAND, python


def versions(monkeypatch: pytest.MonkeyPatch, **replaced: str | None) -> None:
    """Let some libraries have other versions, or none."""
    version = metadata.version

    def find(name: str) -> str:
        found = replaced.get(name, "") if name in replaced else version(name)
        if found is None:
            raise metadata.PackageNotFoundError(name)
        return found

    monkeypatch.setattr(metadata, "version", find)


EXACT = 0.5e8 / 9.8e6 - 1.0
"""Slip rate (m/s) that the self-test compares with."""


def answering(monkeypatch: pytest.MonkeyPatch, rate: float = EXACT) -> None:
    """Let the run of the self-test have this answer, without a run."""
    monkeypatch.setattr(installation, "_slip_rate_after_onset", lambda: rate)


def fault(found: Outcome) -> str:
    """Return the one fault that was said, without its beginning."""
    assert found.code == 1
    assert "All is well" not in found.out
    (line,) = found.err.splitlines()
    return line.removeprefix("stickslip: doctor: ")


def test_a_sound_installation_is_well(command: Command) -> None:
    found = command("doctor")
    assert (found.code, found.err) == (0, "")
    assert "slip rate of a slab 4.102040816 m/s, closed form 4.102040816 m/s" in found.out
    for name in ("numba", "numpy", "llvmlite"):
        assert f"{name} {metadata.version(name)}" in found.out
    assert found.out.endswith("\nAll is well.\n")


NOTED = """
import sys
from stickslip.foundation.kernels import code
names, load = set(), code.address_of_entry
def noted(entry):
    names.add(entry.name)
    return load(entry)
code.address_of_entry = noted
from stickslip.cli.main import main
try:
    main(sys.argv[1:])
finally:
    print(*sorted(names), file=sys.stderr)
"""
"""Runs a command, and lists on standard error the entries whose machine code it loads, or makes."""


def entries_of(folder: Path, *arguments: str) -> set[str]:
    """Return the names of the entries that a command in a new process needs."""
    done = subprocess.run([sys.executable, "-c", NOTED, *arguments], cwd=folder, capture_output=True, text=True, check=True)
    return set(done.stderr.splitlines()[-1].split())


@pytest.mark.slow
def test_the_self_test_loads_what_a_first_run_needs(tmp_path: Path) -> None:
    first = entries_of(tmp_path, "run", "fig6-slab", "--figure", "first.png")
    assert len(first) > 5
    assert first - entries_of(tmp_path, "doctor") == set()


def test_an_extra_that_is_missing_is_told_and_no_fault(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    versions(monkeypatch, pyarrow=None)
    answering(monkeypatch)
    found = command("doctor")
    assert found.code == 0
    assert "pip install 'stickslip[parquet]'" in found.out
    versions(monkeypatch, pyarrow="99.0")
    assert "pyarrow 99.0" in command("doctor").out


@pytest.mark.parametrize(("version", "said"), [(None, "llvmlite is not installed"), ("0.1", "llvmlite 0.1 does not suit")])
def test_a_library_that_is_missing_or_too_old_is_a_fault(
    command: Command, monkeypatch: pytest.MonkeyPatch, version: str | None, said: str
) -> None:
    versions(monkeypatch, llvmlite=version)
    answering(monkeypatch)
    found = command("doctor")
    assert fault(found).startswith(f"{said}: pip install 'llvmlite")
    assert ("self-test" in found.out) == (version is not None)


def test_a_package_without_metadata_is_a_fault(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(name: str) -> None:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "requires", none)
    found = command("doctor")
    assert fault(found) == "No package metadata was found for stickslip: pip install --force-reinstall stickslip"
    assert "python" in found.out


def file_in_place(folder: Path) -> Path:
    (folder / "file").touch()
    return folder / "file"


def open_to_all(folder: Path) -> Path:
    (folder / "open").mkdir()
    (folder / "open").chmod(0o777)
    return folder / "open"


@pytest.mark.parametrize(("made", "said"), [(file_in_place, "File exists"), (open_to_all, "other users can write into")])
def test_a_cache_that_cannot_be_used_is_a_fault(
    command: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, made: Callable[[Path], Path], said: str
) -> None:
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(made(tmp_path)))
    answering(monkeypatch)
    text = fault(command("doctor"))
    assert said in text
    assert text.endswith("set STICKSLIP_CACHE_DIR to a folder that you own")


def test_a_full_disk_is_a_fault(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("only Linux has a disk that is always full")
    with Path("/dev/full").open("wb", buffering=0) as full:
        monkeypatch.setattr("tempfile.TemporaryFile", lambda dir: full)
        assert "(No space left on device)" in installation.compiled_code(tmp_path, "compiled-1").fault


def test_a_title_that_the_terminal_cannot_show_is_written_with_escapes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine.toml").write_text(template("slab").replace('title = ""', 'title = "ä and α"'), encoding="utf-8")
    shown = io.TextIOWrapper(io.BytesIO(), encoding="latin-1")
    monkeypatch.setattr("sys.stdout", shown)
    with pytest.raises(SystemExit, match="0"):
        main(["run", str(tmp_path / "mine.toml")])
    assert shown.buffer.getvalue().decode("latin-1").startswith("ä and \\u03b1\n")  # type: ignore[attr-defined]


def test_an_answer_off_the_closed_form_is_a_fault(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    answering(monkeypatch, EXACT * (1.0 + 0.9e-9))
    assert command("doctor").code == 0
    for rate in (EXACT * (1.0 + 1.1e-9), float("nan")):
        answering(monkeypatch, rate)
        said = fault(command("doctor"))
        assert said.startswith(f"slip rate of a slab {rate:.10g} m/s, closed form 4.102040816 m/s: remove the cache")


def test_a_run_that_cannot_be_made_is_a_fault(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> float:
        raise OSError("libLLVM.so:\ncannot be opened")

    monkeypatch.setattr(installation, "_slip_rate_after_onset", broken)
    text = fault(command("doctor"))
    assert text == "the engine cannot run (OSError: libLLVM.so: cannot be opened): pip install --force-reinstall stickslip"


def test_an_engine_that_is_not_compiled_is_a_fault(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.foundation.kernels.uncompiled.UNCOMPILED", True)
    answering(monkeypatch)
    assert fault(command("doctor")).endswith("unset it")


@pytest.mark.parametrize(
    ("numba", "fault"),
    [("0.68", ""), (None, "did not come with the package, and nothing compiles it: pip install 'stickslip[compiler]'")],
)
def test_machine_code_that_did_not_come_is_a_fault_only_without_the_compiler(
    command: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, numba: str | None, fault: str
) -> None:
    answering(monkeypatch)
    assert "machine code" in (found := command("doctor").out)
    assert f"for {PROCESSOR.name}, " in found
    assert "files that came with the package" in found
    versions(monkeypatch, numba=numba)
    monkeypatch.setattr(metadata, "requires", lambda name: ["numba>=0.62; extra == 'compiler'"])
    monkeypatch.setattr("stickslip.foundation.code_key.SHIPPED", tmp_path / "nothing")
    monkeypatch.setattr("stickslip.foundation.kernels.code.SHIPPED", tmp_path / "nothing")
    shown = command("doctor")
    assert f"compiled here by numba {numba or '(missing)'}: machine code for this processor" in shown.out
    assert (shown.code, shown.err.count("\n")) == ((1, 1) if fault else (0, 0))
    assert shown.err.endswith(f"{fault}\n" if fault else "")


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(
    ("there", "said"), [(True, ""), (False, "NUMBA_DISABLE_JIT is set, so that nothing compiles it: unset it\n")]
)
def test_a_compiler_that_is_switched_off_is_one_line_for_a_run_that_needs_it(tmp_path: Path, there: bool, said: str) -> None:
    code = COMMAND.format(arguments=["run", "fig6-slab"])
    done = python(code, tmp_path, None if there else tmp_path / "nothing", NUMBA_DISABLE_JIT="1")
    assert done.stdout.splitlines()[-1] == f"False {0 if there else 2}"
    assert done.stderr.count("\n") == (not there)
    assert done.stderr.endswith(said)
