"""How the site is built: python -m sphinx -W --keep-going -n docs build/site."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

import ropedyn

project = "ropedyn"
author = "The ropedyn developers"
copyright = author
release = version = ropedyn.__version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "myst_nb",
    "command_help",
    "docstrings",
    "gallery_notebooks",
    "mathml",
]
templates_path = ["_templates"]

autosummary_ignore_module_all = False  # what a package takes from its files is its own
autodoc_typehints = "none"  # docstrings say them in words
# single backticks of docstrings link what has a page, and may be arguments and attributes too
default_role = "py:obj"
nitpick_ignore_regex = [("py:obj", ".*")]
numpydoc_show_class_members = False

myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 3
myst_update_mathjax = False
html_math_renderer = "mathml"
nb_execution_mode = "off"  # gallery_notebooks.py has executed them
nb_merge_streams = True

linkcheck_timeout = 20  # s
linkcheck_retries = 2
suppress_warnings = ["mystnb.mime_priority"]  # of figures, which a check of links does not show

html_theme = "pydata_sphinx_theme"
html_title = "ropedyn"
html_static_path = ["_static"]
html_css_files = ["site.css"]
# code of notebooks needs the width
html_theme_options = {"secondary_sidebar_items": {"gallery/*": [], "[!g]**": ["page-toc"]}}
# pages that have none below them need no list of these
html_sidebars = {path.stem: [] for path in Path(__file__).parent.glob("*.md")}
html_sidebars["tutorials/*"] = []  # code needs the width
html_copy_source = False
html_show_sourcelink = False
