"""Make the site: `make site` builds it in docs/_build/html, with warnings as errors.

The pages are those of this folder, as a code forge shows them. The rest is made here: the gallery from examples/, the page of the
lessons from their notebooks (site/lesson.py), the reference from docstrings (site/api), and the table of contents (index.rst,
site/*.rst). Nothing of the site is loaded from another host: formulas become MathML, which browsers draw themselves.
"""

import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "site"), str(HERE.parent / "src")]

import lesson  # noqa: E402  site/lesson.py

import stickslip  # noqa: E402  the package of this folder

project = "stickslip"
author = "the authors of stickslip"
version = release = stickslip.__version__

extensions = [
    "lesson",  # site/lesson.py
    "mathml",  # site/mathml.py
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
root_doc = "index"
exclude_patterns = ["_build", "index.md", "theory/index.md", "gallery/*.ipynb"]  # each index.rst includes the index.md beside it
highlight_language = "none"  # indented blocks of the pages are formulas
default_role = "py:obj"

myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4

autodoc_typehints = "none"  # the docstrings say what an argument is, with its unit
autodoc_member_order = "bysource"
autodoc_class_signature = "mixed"
toc_object_entries_show_parents = "hide"
napoleon_google_docstring = False
napoleon_attr_annotations = False
napoleon_use_ivar = True
napoleon_use_rtype = False
napoleon_preprocess_types = False

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"/\d\d_",
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "capture_repr": (),
    "image_scrapers": ("pictures",),  # site/pictures.py
    "download_all_examples": False,
    "min_reported_time": 1e9,
    "remove_config_comments": True,
    "show_signature": False,
    "write_computation_times": False,
    "image_srcset": ["2x"],
}

copybutton_prompt_text = "$ "

html_title = f"stickslip {release}"
html_theme = "pydata_sphinx_theme"
html_theme_options = {
    "header_links_before_dropdown": 7,
    "navbar_end": ["theme-switcher"],
    "navigation_with_keys": False,
    "show_nav_level": 2,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
suppress_warnings = ["ref.python"]  # a word in backticks that names attributes of several classes stays a word

html_sidebars = {"index": [], "first-run": []}
html_math_renderer = "mathml"
html_copy_source = False
html_show_search_summary = False  # a browser may not read other pages of a folder
html_context = {"default_mode": "auto"}
html_show_sourcelink = False
html_static_path = ["site/static"]
html_css_files = ["site.css"]
project_copyright = "the authors of stickslip, MIT licence"


COLON = "\ue000"
"""Stands for a colon where napoleon would take what is before it for a type: in the first line of an attribute's docstring."""


def before_napoleon(*event: Any) -> None:
    """Let |v| in a docstring be a magnitude and not a substitution, and hide the colons of attributes."""
    what, lines = event[1], event[-1]
    lines[:] = [line.replace("|", r"\|") for line in lines]
    if lines and what in ("attribute", "property"):
        lines[0] = lines[0].replace(": ", f"{COLON} ")


def after_napoleon(*event: Any) -> None:
    """Show the colons again."""
    event[-1][:] = [line.replace(COLON, ":") for line in event[-1]]


def link_to_gallery(*event: Any) -> None:
    """Let links to scripts of examples/ and to the notebooks lead to their pages in the gallery."""
    source = event[-1]
    for notebook, page in lesson.LESSONS.items():
        source[0] = source[0].replace(f"]({notebook})", f"](/{page})")
    source[0] = re.sub(r"\]\((?:\.\./)+examples/(\w+)\.py\)", r"](/gallery/\1.rst)", source[0])


def name_thumbnails(*event: Any) -> None:
    """Give the pictures of the gallery's index the titles below them as the texts that stand for them."""
    source = event[-1]
    below = r"(\n\n  :doc:`[^`]+`\n\n\.\. raw:: html\n\n +<div class=\"sphx-glr-thumbnail-title\">)(.*?)(</div>)"
    source[0] = re.sub(r":alt:" + below, r":alt: \2\1\2\3", source[0])


def setup(app: Any) -> None:
    """Register what the extensions lack."""
    app.connect("autodoc-process-docstring", before_napoleon, priority=400)
    app.connect("autodoc-process-docstring", after_napoleon, priority=600)
    app.connect("source-read", link_to_gallery)
    app.connect("source-read", name_thumbnails)
