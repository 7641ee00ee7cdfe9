"""What to say of words on the command line that no argument or option takes: which option they were probably meant for."""

from __future__ import annotations

from typing import Any

from stickslip.cli.options import is_data

QUOTES = 'put a text with spaces in quotes, as "480 years"'


def about_extra(words: str, context: Any, teach: str) -> str:
    """Return what to do with words that are too many, by what was typed beside them; `context` is that of the command."""
    return f"{ascii(words)[:60]} is not expected; {_cure(words, context)}; {teach}"


def _cure(words: str, context: Any) -> str:
    from stickslip.foundation.headings import is_number
    from stickslip.foundation.units import split_quantity
    from stickslip.problem.scenarios import library

    if "=" in words:
        return "--set NAME=VALUE replaces a value of the scenario"
    unfinished = [one for one in context.params.get("changes") or () if "=" not in one]
    if unfinished:
        return f"write --set {unfinished[-1]}={words.split()[0]}"
    if not any(one.param_type_name == "argument" for one in context.command.get_params(context)):
        return f"`{context.command_path}` takes options alone"
    if context.params.get("duration", "") is None and (is_number(words) or split_quantity(words)):
        return f'a duration is given as --duration "{words}"'
    if words in library.names() or words.endswith(".toml"):
        return "one scenario at a time; `stickslip compare ONE OTHER` compares two"
    if is_data(words):
        first = next((str(one) for one in context.params.values() if isinstance(one, str)), "SCENARIO")
        return f"to follow a record: `stickslip infer {first} {words} --free NAMES`"
    return QUOTES
