"""Write formulas as MathML, which browsers draw without a script: the site stays readable offline."""

from __future__ import annotations

from typing import Any

from docutils.nodes import SkipNode, math, math_block
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError


def mathml(tex: str, *, as_block: bool) -> str:
    """Return a formula of LaTeX as MathML.

    Raises
    ------
    ExtensionError
        If the formula has a command that is not known.
    """
    try:
        written = str(tex2mathml(tex, as_block=as_block))
    except Exception as error:  # each kind of fault has an exception of its own
        raise ExtensionError(f"formula {tex!r}: {error}") from error
    for brace in "{}":  # those of \\{ and \\} keep their size, as in LaTeX
        written = written.replace(f"<mo>{brace}</mo>", f'<mo stretchy="false">{brace}</mo>')
    return written


def visit_inline(writer: Any, node: math) -> None:
    """Write a formula within a line."""
    writer.body.append(mathml(node.astext(), as_block=False))
    raise SkipNode


def visit_block(writer: Any, node: math_block) -> None:
    """Write a formula on a line of its own."""
    writer.body.append(f'<div class="math">{mathml(node.astext(), as_block=True)}</div>')
    raise SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer; conf.py chooses it."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
