"""What Python hands to machine code is what the machine code was made for, or is refused before it is read."""

from __future__ import annotations

import ast
from collections import Counter
from ctypes import c_double, c_int64
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from numba import types

from stickslip.engine import build
from stickslip.engine.series.polynomial import crossings, restrict
from stickslip.foundation.arrays import Flags1, Floats1, Floats2, Integers1
from stickslip.foundation.code_key import PACKAGE
from stickslip.foundation.kernels.compiler import objects
from stickslip.foundation.kernels.kernels import Entry
from stickslip.foundation.kernels.signature import ArrayOf, Fields, Ready, flattened, signature_of

build.entries()
ENTRIES = dict(Entry.known)
"""All entries of the package."""
IN_C = {types.float64: c_double, types.int64: c_int64, types.void: None}
"""What C makes of numba's numbers."""
DTYPES: dict[Any, Any] = {types.float64: np.float64, types.int64: np.int64, types.boolean: np.bool_}


def decorated(path: Path) -> list[str]:
    """Return the names of all functions in a file that are entries, as their machine code is named."""
    text = path.read_text(encoding="utf-8")
    functions = [one for one in ast.walk(ast.parse(text if "entry\n" in text else "")) if isinstance(one, ast.FunctionDef)]
    return [
        f"{path.stem}.{function.name}"
        for function in functions
        if any(isinstance(one, ast.Name) and one.id in ("entry", "exact_entry") for one in function.decorator_list)
    ]


def test_every_function_that_is_decorated_as_an_entry_is_known_to_the_builder_by_a_name_of_its_own() -> None:
    names = [name for path in PACKAGE.rglob("*.py") for name in decorated(path)]
    assert [name for name, count in Counter(names).items() if count > 1] == []
    assert set(names) == {name for name, one in ENTRIES.items() if one.__module__.startswith("stickslip.")}
    assert len(names) > 20


def test_entries_that_take_longest_are_entries() -> None:
    assert set(build.LARGE) <= set(ENTRIES)


@pytest.mark.parametrize("name", [name for name, one in ENTRIES.items() if one.__module__.startswith("stickslip.")])
def test_python_hands_over_what_numba_compiles_for(name: str) -> None:
    """Number by number: floats as floats, whole numbers and what is true or false as 64 bits, arrays as address and shape."""
    declared = signature_of(ENTRIES[name].__wrapped__)
    result, arguments = declared.in_c
    _, signature = objects.in_c(ENTRIES[name], declared)
    assert [c_int64 if isinstance(one, types.CPointer) else IN_C[one] for one in signature.args] == arguments
    assert IN_C[signature.return_type] == result
    arrays = [one for kind in declared.kinds for one in arrays_in(kind)]
    pointers = [one for one in signature.args if isinstance(one, types.CPointer)]
    assert [np.dtype(str(one.dtype)) if one.dtype != types.boolean else np.dtype(bool) for one in pointers] == [
        a.of for a in arrays
    ]


def arrays_in(kind: Any) -> list[ArrayOf]:
    if isinstance(kind, Fields):
        return [one for each in kind.kinds for one in arrays_in(each)]
    return [kind] if isinstance(kind, ArrayOf) else []


class Pair(NamedTuple):
    """A named tuple of arrays and a number."""

    values: Floats2
    count: int


def declared(a: Floats1, b: Integers1, c: Flags1, pair: Pair, x: float, n: int, yes: bool) -> float:
    """Have a parameter of every kind."""
    return 0.0


SOUND: tuple[Any, ...] = (np.zeros(3), np.zeros(2, np.int64), np.zeros(4, bool), Pair(np.zeros((2, 5)), 7), 1, 2.0, 1)


def test_arguments_become_numbers_and_addresses_in_their_order() -> None:
    kinds = signature_of(declared).kinds
    a, b, c, pair, *_ = SOUND
    flat = flattened(kinds, SOUND)
    assert flat == [a.ctypes.data, 3, b.ctypes.data, 2, c.ctypes.data, 4, pair.values.ctypes.data, 2, 5, 7, 1.0, 2, True]
    assert [type(one) for one in flat[-3:]] == [float, int, bool]
    assert len(signature_of(declared).in_c[1]) == len(flat)


def test_arrays_that_are_empty_or_cannot_be_written_have_addresses_too() -> None:
    kinds, (_, *rest) = signature_of(declared).kinds, SOUND
    fixed = np.zeros(3)
    fixed.flags.writeable = False
    for one in (np.zeros(0), fixed):
        assert flattened(kinds, (one, *rest))[:2] == [one.ctypes.data, len(one)]


@pytest.mark.parametrize(
    ("place", "wrong", "said"),
    [
        (0, np.zeros(3, np.float32), r"ArrayOf\(of=dtype\('float64'\), dimensions=1\), not float32 of shape \(3,\)"),
        (0, np.zeros(3, np.int64), "not int64"),
        (0, np.zeros(3, ">f8"), "not >f8"),
        (0, np.zeros((3, 1)), r"shape \(3, 1\)"),
        (0, np.zeros(6)[::2], r"strides \(16,\)"),
        (0, np.array(1.0), r"shape \(\)"),
        (1, np.zeros(3), r"ArrayOf\(of=dtype\('int64'\), dimensions=1\), not float64"),
        (1, np.zeros(3, np.int32), "not int32"),
        (2, np.zeros(3, np.int8), r"ArrayOf\(of=dtype\('bool'\), dimensions=1\), not int8"),
        (3, Pair(np.zeros((2, 5)).T, 7), r"dimensions=2\), not float64 of shape \(5, 2\) and strides \(8, 40\)"),
        (3, Pair(np.zeros(5), 7), r"shape \(5,\)"),
    ],
)
def test_an_array_that_machine_code_would_misread_is_refused(place: int, wrong: Any, said: str) -> None:
    given = [*SOUND]
    given[place] = wrong
    with pytest.raises(TypeError, match=said):
        flattened(signature_of(declared).kinds, tuple(given))


def test_an_array_that_was_looked_up_before_is_taken_as_it_is_and_refused_where_another_kind_is_wanted() -> None:
    kinds, (a, *rest) = signature_of(declared).kinds, SOUND
    assert flattened(kinds, (Ready(a), *rest)) == flattened(kinds, SOUND)
    for wrong in (np.zeros(3, np.int64), np.zeros((3, 1))):
        with pytest.raises(TypeError, match="machine code takes"):
            flattened(kinds, (Ready(wrong), *rest))
    with pytest.raises(TypeError, match=r"strides \(16,\)"):
        Ready(np.zeros(6)[::2])


def test_a_call_with_too_few_or_too_many_arguments_is_refused() -> None:
    for given in (SOUND[:-1], (*SOUND, 1.0)):
        with pytest.raises(ValueError, match="zip"):
            flattened(signature_of(declared).kinds, given)


def test_an_entry_refuses_before_machine_code_reads() -> None:
    c, out, part = np.zeros(27), np.zeros(3), np.zeros(27)
    with pytest.raises(TypeError, match=r"machine code takes .*float64.*, not float32"):
        crossings(c.astype(np.float32), out, part)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"dimensions=1\), not float64 of shape \(27, 1\)"):
        restrict(c, 0.0, 1.0, part[:, None])
