"""Show the result of an inference, and how several laws predict what was left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.cli.output.show import console, print_numbers, print_sentences, print_words, say, titled
from stickslip.foundation.formatting import clean, number

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario
    from stickslip.studies.inference.inference import Inference


def show_inference(scenario: Scenario, found: Inference) -> None:
    """Print the numbers with their intervals, and what the record does not determine."""
    screen = titled(scenario)
    say(screen, clean(f"{found.headline}\n"))
    print_words(screen, ("", "value", "unit and interval"), found.rows)
    screen.print()
    print_sentences(screen, *(clean(note) for note in found.notes))


def show_ranking(*found: Inference) -> None:
    """Print a table of laws, the best prediction first."""
    from stickslip.studies.inference.infer import ranking

    screen = console()
    say(screen, "\nerrors in units of the noise: of the part that was fitted, and of the part that was left out\n")
    rows = [
        [str(row["law"]), str(row["free"]), number(row["fit"], 3), number(row["prediction"], 3), number(row["bic"], 8)]
        for row in ranking(*found).to_dict("records")
    ]
    print_numbers(screen, ("law", "free", "fit", "prediction", "BIC"), rows, text=1)
