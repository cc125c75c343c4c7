"""Settings of Sphinx for the documentation site; build.py sets the environment."""
import os
import re
from pathlib import Path

from docutils import nodes

root = Path(__file__).resolve().parents[2]
project = "tress"
author = copyright = "The tress authors"
version = release = (root / "VERSION").read_text().strip()

extensions = ["myst_parser", "sphinx.ext.mathjax", "sphinx_copybutton", "breathe"]
root_doc = "index"
source_suffix = {".md": "markdown"}
exclude_patterns = ["files/**"]
language = "en"
highlight_language = "text"

myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
mathjax_path = "mathjax/tex-svg.js"

breathe_projects = {"tress": os.environ["TRESS_DOXYGEN"]}
breathe_default_project = "tress"
breathe_default_members = ("members",)
breathe_show_include = True
primary_domain = "cpp"
# C++ types without a page are plain text; a page of a class that is gone is an error.
nitpick_ignore_regex = [("cpp:identifier", ".*")]

html_theme = "furo"
html_title = f"tress {version}"
html_static_path = [os.environ["TRESS_STATIC"], str(Path(__file__).parent / "static")]
html_css_files = ["tress.css"]
html_show_sphinx = False
html_copy_source = False
pygments_style, pygments_dark_style = "friendly", "monokai"
blue, light_blue = "#0b5fa5", "#7cc0ff"
html_theme_options = {
    "light_css_variables": {"color-brand-primary": blue, "color-brand-content": blue},
    "dark_css_variables": {"color-brand-primary": light_blue, "color-brand-content": light_blue},
}


def plain_text(app, environment, node, content):
    """Returns the text of Doxygen's links to what has no page here."""
    doxygens = r"(class|struct|union|namespace)tress.*|.*_8h(_.*)?|md_.*"
    return content if node["reftype"] == "ref" and re.fullmatch(doxygens, node["reftarget"]) else None


def no_file_links(app, doctree):
    """Makes text of what docutils takes for an address: "file:line:column" in a comment."""
    for node in list(doctree.findall(nodes.reference)):
        if node.get("refuri", "").startswith("file:"):
            node.replace_self(node.children)


def setup(app):
    app.connect("doctree-read", no_file_links)
    app.connect("missing-reference", plain_text)
