"""Compile alike functions once for all tests of planar slabs in a process: the compiler would take most of their time."""

from __future__ import annotations

from collections.abc import Iterator

import jax
import pytest

from stickslip.planar.solver import functions_of


@pytest.fixture(scope="session", autouse=True)
def compiled_once(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    options = {
        "jax_compilation_cache_dir": str(tmp_path_factory.mktemp("compiled")),
        "jax_persistent_cache_min_compile_time_secs": 0.0,
        "jax_persistent_cache_min_entry_size_bytes": -1,
    }
    before = {name: getattr(jax.config, name) for name in options}
    for name, value in options.items():
        jax.config.update(name, value)
    yield
    for name, value in before.items():
        jax.config.update(name, value)


@pytest.fixture(autouse=True)
def patched_functions_are_compiled_anew(request: pytest.FixtureRequest) -> Iterator[None]:
    """Let what a test puts in place of a function of the solver come into its compiled code, and stay in no other test's."""
    patches = "monkeypatch" in request.fixturenames
    if patches:
        functions_of.cache_clear()
    yield
    if patches:
        functions_of.cache_clear()
