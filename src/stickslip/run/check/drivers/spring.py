"""The pulled end of the spring of a rigid body: nothing is sent to it, and no far stress acts on it."""

from __future__ import annotations

from stickslip.run.check.asked import CheckOfDriver

ANSWERS = CheckOfDriver()
