"""Export the friction laws of the contact; each is imported when it is first used.

To add a law, add a class to `laws` (docs/adding-a-law.md), its place to `register.LAWS`, and its import and name to `__init__.pyi`,
the page of all names. `FromExpression`, `FromFunction` and `FromTable` make laws from formulas, functions and measured points of
users; `smooth` and `fit`, of an extension, make laws from noisy points.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
