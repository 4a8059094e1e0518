"""Sphinx' settings of the site, which `make docs` builds. The source folder is the project's: links in the documents lead from
file to file, on the site as in the repository."""

import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE), str(ROOT / "python" / "src")]

project = "stickslip"
author = copyright = "The stickslip developers"
release = version = re.search(r'^version = "(.*)"', (ROOT / "Cargo.toml").read_text(), re.M)[1]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "header"]
root_doc = "docs/site/index"
include_patterns = [
    "README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "SUPPORT.md", "docs/*.md", "docs/formulation/*.md", "docs/site/*.md", "docs/site/*.rst",
    "program/README.md", "c_examples/scenes/*.md", "hosts/README.md", "hosts/calculix/README.md", "python/README.md", "packaging/README.md", "packaging/xsdk.md",
    "benches/README.md", "studies/README.md", "tests/README.md", "tests/acceptance/README.md", "fuzz/README.md",
]
myst_heading_anchors = 4
myst_enable_extensions = ["fieldlist"]
autodoc_member_order = "bysource"
autodoc_typehints = "description"

html_theme = "furo"
html_extra_path = ["front"]  # index.html, which leads to the root document
html_title = f"stickslip {version}"
html_show_sourcelink = False
html_copy_source = False
