"""Write the notebooks of the lessons as pages, with what their cells print and draw. The notebooks are kept without results."""

from __future__ import annotations

import io
import json
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib import pyplot
from matplotlib.figure import Figure
from sphinx.application import Sphinx

from pictures import in_words  # site/pictures.py

LESSONS = {
    "../examples/lessons/stick-slip-lesson.ipynb": "gallery/lesson.md",
    "../examples/lessons/rate-and-state-lesson.ipynb": "gallery/second-lesson.md",
}
"""The notebooks, from the folder of the pages, and the page made of each, in a folder that holds nothing but what is made."""
NOTE = """
```{note}
This page shows what a notebook program shows when all cells are run before any question is answered.
{download}`Download the notebook <../%s>` to answer them. It needs a notebook program, such as JupyterLab, and this package.
```
"""


def picture(figure: Figure, path: Path) -> str:
    """Save a figure, and return the lines of Markdown that show it, with words that stand for it."""
    figure.savefig(path, dpi=200)
    shown = f"{path.parent.name}/{path.name}"
    return f"```{{image}} {shown}\n:alt: {in_words(figure)}\n:width: {figure.get_figwidth() * 100:.0f}px\n```"


def run_cell(source: str, names: dict[str, Any], pictures: Path) -> list[str]:
    """Run a cell of code, and return the blocks of Markdown that show it: its code, what it prints and what it draws."""
    said = io.StringIO()
    with redirect_stdout(said):
        exec(compile(source, "lesson", "exec"), names)
    blocks = [f"```python\n{source}\n```"]
    if said.getvalue():
        blocks.append(f"```{{code-block}} none\n:class: sphx-glr-script-out\n\n{said.getvalue()}```")
    for figure in map(pyplot.figure, pyplot.get_fignums()):
        path = pictures / f"{len(list(pictures.iterdir()))}.png"
        blocks.append(picture(figure, path))
    pyplot.close("all")
    return blocks


def write_lessons(app: Sphinx) -> None:
    """Run the cells of each notebook in order, and write its page."""
    mpl.use("agg")
    for notebook, page in LESSONS.items():
        write_lesson(notebook, Path(app.srcdir) / notebook, Path(app.srcdir) / page)


def write_lesson(name: str, notebook: Path, page: Path) -> None:
    """Run the cells of one notebook, and write its page; `name` is its path from the folder of the pages."""
    pictures = page.with_suffix("")
    pictures.mkdir(parents=True, exist_ok=True)
    for old in pictures.iterdir():
        old.unlink()
    book = json.loads(notebook.read_text(encoding="utf-8"))
    names: dict[str, Any] = {"__name__": "__main__"}
    blocks = []
    for cell in book["cells"]:
        source = "".join(cell["source"])
        blocks += run_cell(source, names, pictures) if cell["cell_type"] == "code" else [source]
    blocks.insert(1, NOTE % name)
    page.write_text("\n\n".join(blocks) + "\n", encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before pages are looked for."""
    app.connect("builder-inited", write_lessons)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
