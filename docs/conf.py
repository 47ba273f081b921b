"""The documentation site: `sphinx-build -W docs build/site`, as `.ci/docs` calls it.

Nothing is fetched from a network, neither by the build nor by the pages.
"""

from __future__ import annotations

import os
import sys
from importlib.metadata import version as version_of
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extensions"))
# Examples print the same columns wherever they run.
os.environ["COLUMNS"] = "100"

project = "birdmb"
author = "the birdmb developers"
project_copyright = author
version = release = version_of("birdmb")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "command_line",
    "flying_bird",
    "mathml",
    "public_names",
]
exclude_patterns = ["_extensions", "**.ipynb", "gallery/README.rst"]
suppress_warnings = ["config.cache"]  # the gallery's settings hold functions
nitpicky = True
nitpick_ignore_regex = [
    ("py:.*", r"(?!birdmb\.).*"),  # other packages' names, whose pages are on the network
    ("py:class", r"birdmb\.\w+\.\w+\..*"),  # types of annotations that no room hands out
    ("py:obj", r"(?s).*"),  # code in single backquotes: a link where it is a name, else code
]

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_type_aliases = {
    "npt.ArrayLike": "ArrayLike",
    "FloatArray": "FloatArray",
    "ComplexArray": "ComplexArray",
    "IntArray": "IntArray",
    "BoolArray": "BoolArray",
}
python_use_unqualified_type_names = True
napoleon_numpy_docstring = False
napoleon_use_ivar = True
# Docstrings are read in terminals too: a single backquote stands for code.
default_role = "py:obj"

html_theme = "pydata_sphinx_theme"
smartquotes_action = "qe"  # two hyphens before an option are two
highlight_language = "none"
html_title = f"birdmb {version}"
html_static_path = ["_static"]
html_css_files = ["birdmb.css"]
html_show_sourcelink = False
html_copy_source = False
html_sidebars = {"index": [], "tutorial": []}
html_theme_options = {
    "logo": {"text": "birdmb"},
    "navbar_end": ["theme-switcher"],
    "secondary_sidebar_items": ["page-toc"],
    "show_prev_next": False,
    "footer_start": ["copyright"],
    "footer_end": [],
    "navigation_with_keys": False,
}
copybutton_exclude = ".linenos, .gp, .go"

# Those with a command line of their own are run by tests/test_examples.py.
COMMANDS = [
    path.stem
    for path in sorted((HERE.parent / "examples").glob("*.py"))
    if '__name__ == "__main__"' in path.read_text(encoding="utf-8")
]
sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "ignore_pattern": rf"/studies/|\b({'|'.join(COMMANDS)})\.py$",
    "within_subsection_order": "gallery_order.reading_order",
    "image_scrapers": ("gallery_figures.unmanaged_figures", "matplotlib"),
    "ignore_repr_types": r".*(figure|axes|text|container)",
    "doc_module": ("birdmb",),
    "backreferences_dir": "gallery/of",
    "download_all_examples": False,
    "notebook_images": False,
    "remove_config_comments": True,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 10_000,
    "write_computation_times": False,
    "plot_gallery": True,
}
