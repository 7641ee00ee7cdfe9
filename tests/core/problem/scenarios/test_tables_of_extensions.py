"""Tables that extensions add to scenario files: what follows from the class that is given."""

from dataclasses import dataclass  # no postponed annotations: a class may have its types as such

import pytest

from stickslip.problem.scenarios import ScenarioTable


@dataclass(frozen=True)
class WithTypes:
    """A class whose annotations are types."""

    blocks: int = 3
    others: int | None = None
    joint: float = 1.0
    name: str | None = None


@dataclass(frozen=True)
class WithTexts:
    """The same with annotations as texts, as in a module that postpones them."""

    blocks: "int" = 3
    others: "int | None" = None
    joint: "float" = 1.0
    name: "OnlyForCheckers | None" = None  # type: ignore[name-defined] # noqa: F821 # as if imported under TYPE_CHECKING


@pytest.mark.parametrize("kind", [WithTypes, WithTexts])
def test_whole_numbers_are_known_however_a_class_is_annotated(kind: type) -> None:
    assert ScenarioTable(kind).whole() == {"blocks", "others"}
