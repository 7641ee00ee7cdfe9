"""A function of a record is called with the arguments of the record, and says what they mean."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from inspect import signature

import pytest

from stickslip.extensions.inference.of_record import takes_fields
from stickslip.foundation.errors import InputError
from stickslip.foundation.takes import Said


@dataclass(frozen=True)
class Pull:
    force: float
    _: KW_ONLY
    often: int = 2


@takes_fields({"force": Said("float", "How hard."), "often": Said("int", "How often.", "At least once.")}, Pull)
def pull(asked: Pull) -> float:
    """Pull.

    Parameters
    ----------
    {options}

    """
    return asked.force * asked.often


def test_it_is_called_with_the_arguments_of_the_record() -> None:
    assert (pull(3.0), pull(3.0, often=5), pull(force=1.0)) == (6.0, 15.0, 2.0)


def test_signature_and_docstring_are_made_of_the_record_and_of_what_is_said() -> None:
    assert str(signature(pull)) == "(force: 'float', *, often: 'int' = 2) -> 'float'"
    said = "    force : float\n        How hard.\n    often : int\n        How often. At least once.\n"
    assert said in (pull.__doc__ or "")


def test_an_argument_that_the_record_does_not_have_is_refused_with_the_nearest() -> None:
    with pytest.raises(InputError, match="pull: unknown argument 'oftn'; did you mean 'often'"):
        pull(3.0, oftn=5)  # type: ignore[call-arg] # type checkers refuse it, too
    with pytest.raises(InputError, match="pull: force must be given"):
        pull()  # type: ignore[call-arg]
