"""The text that is generated for formulas changes on purpose only."""

import json

from tests.core.engine.formula_texts import KEPT, hashes


def test_the_generated_text_of_all_laws_and_of_random_trees_is_kept_to_the_character():
    """To change it on purpose, run `python -m tests.core.engine.formula_texts` and say why in the commit."""
    kept, found = json.loads(KEPT.read_text(encoding="utf-8")), hashes()
    assert [name for name in {*kept, *found} if kept.get(name) != found.get(name)] == []
