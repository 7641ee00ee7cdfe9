"""A formula of the user as the friction law of a setting. It is untrusted text, which only the package's own parser reads."""

from __future__ import annotations

import re

from stickslip.explorer.model.exchange import with_kind
from stickslip.explorer.model.setting import Setting
from stickslip.friction import FromExpression
from stickslip.friction.formula.parse import RESERVED

_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
"""A name in a formula; the e of 1e-3 is none."""


def with_expression(setting: Setting, text: str) -> Setting:
    """Return a setting whose friction law is a formula in u (slip, m), v (slip rate, m/s) and parameters.

    Parameters that the setting already has keep their values, new ones are 1, and those that the formula no longer names go.
    Whether the formula is allowed turns out when the scenario is read.
    """
    if setting.value("friction.kind") != FromExpression.kind:
        setting = with_kind(setting, "friction", FromExpression.kind)
    known = setting.value("friction.parameters") or {}
    names = dict.fromkeys(name for name in _NAME.findall(text) if name not in RESERVED)
    parameters = {name: known.get(name, 1.0) for name in names}
    return setting.with_value("friction.expression", text).with_value("friction.parameters", parameters or None)
