# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of Sphinx for the documentation site; build_site.py writes the sources and runs it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from docsite.cpp_api import XML  # noqa: E402
from docsite.docstrings import to_rest  # noqa: E402

project = "franka_ros for Debian"
author = "the franka_ros for Debian authors"
copyright = f"2026 {author}"
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx_copybutton"]
source_suffix = {".md": "markdown"}
root_doc = "index"
highlight_language = "text"
smartquotes = False  # texts of messages stay as programs print them

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "deflist"]

breathe_projects = {"franka_ros": str(XML)}
breathe_default_project = "franka_ros"
breathe_show_include = False  # the pages name the headers as programs include them
cpp_maximum_signature_line_length = 80
cpp_index_common_prefix = ["franka::", "franka_hw::", "hardware_interface::"]

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
python_maximum_signature_line_length = 80

nitpick_ignore_regex = [
    # Types of the standard library, of Eigen, ROS and Boost, of template parameters, and of private headers.
    (r"cpp:.*", r".*"),
    # Types of Python and of other packages, of which no list is at hand without a network.
    (r"py:.*", r".*"),
    # Breathe's links to members that no page shows.
    (r"ref", r".*_8h|(class|struct|union|namespace).*"),
]
# A namespace stands in each header that adds to it.
# Default arguments that are lambdas are shown as they are written.
suppress_warnings = ["duplicate_declaration.cpp", "source_code_parser.cpp"]

# Tables of contents name headings only: those with every function are long, and slow to make for each page.
toc_object_entries = False

html_theme = "furo"
html_title = "franka_ros for Debian"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_search_scorer = str(Path(__file__).with_name("search_scores.js"))
html_show_sourcelink = False
html_show_sphinx = False
# Excerpts are parts of other pages, which browsers do not read for pages from files.
html_show_search_summary = False
html_theme_options = {"navigation_with_keys": True}
# Only the prompts, which readers do not type.
copybutton_prompt_text = r"\$ |>>> |\.\.\. "
copybutton_prompt_is_regexp = True


def read_docstring(app, what, name, value, options, lines):
    """Docstrings are plain text with indented code."""
    lines[:] = to_rest(lines)


def setup(app):
    app.connect("autodoc-process-docstring", read_docstring)
