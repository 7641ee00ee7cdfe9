"""Show the results of inferences: numbers with their intervals, and laws beside each other."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from stickslip.cli.output.show import console, print_numbers, print_sentences, print_words, say, titled
from stickslip.extensions.inference.inference import ranking
from stickslip.foundation.show import clean, number

if TYPE_CHECKING:
    from stickslip.extensions.inference.inference import Inference
    from stickslip.problem.scenarios import Scenario

_ARGUMENT = re.compile(
    r"\b(by|each|held_out|loss|max_time|normal|observe|parts|profiles|samples|sensor|start|starts|trend|weight|windows)='?([\w.]*\w)'?"
)
"""An argument of `infer` as messages name it, with its value."""


def show_inference(scenario: Scenario, found: Inference) -> None:
    """Print the numbers with their intervals, and what the record does not determine."""
    screen = titled(scenario)
    say(screen, clean(f"{found.headline}\n"))
    print_words(screen, ("", "value", "unit and interval"), found.rows)
    screen.print()
    if not found.determined:
        print_sentences(screen, "the record determines none of these numbers")
    print_sentences(screen, *(as_options(clean(note)) for note in found.notes))


def as_options(text: str) -> str:
    """Return a text with the option of the command line in place of an argument of `infer` in Python, such as held_out=0.3."""
    return _ARGUMENT.sub(lambda one: f"--{one[1].replace('_', '-')}{'' if one[2] == 'True' else ' ' + one[2]}", text)


def show_ranking(*found: Inference) -> None:
    """Print a table of laws, the best prediction first."""
    screen = console()
    say(screen, "\nerrors in units of the noise: of the part that was fitted, and of the part that was left out\n")
    rows = [
        [str(row["law"]), str(row["free"]), number(row["fit"], 3), number(row["prediction"], 3), number(row["bic"], 8)]
        for row in ranking(*found).to_dict("records")
    ]
    print_numbers(screen, ("law", "free", "fit", "prediction", "BIC"), rows, text=1)
