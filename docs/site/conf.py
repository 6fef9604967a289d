"""Settings of Sphinx for the site that scripts/site makes."""

import os
import pathlib
import re
import shutil
import sys

from docutils import nodes

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from equations import NotAnEquation, typeset, typeset_prose  # noqa: E402

project = "Samara"
extensions = ["myst_parser"]
root_doc = "index"
exclude_patterns = ["site"]
myst_heading_anchors = 5
suppress_warnings = ["myst.header"]  # sections of the fourth level below those of the second
highlight_language = "none"
html_theme = "alabaster"
html_title = "Samara"
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_sidebars = {"**": ["about.html", "searchbox.html", "navigation.html"]}
html_theme_options = {
    "description": "Rotor dynamics of horizontal-axis wind turbines",
    "fixed_sidebar": True,
    "page_width": "1240px",
    "sidebar_width": "230px",
    "show_powered_by": False,
    "font_family": "sans-serif",
    "head_font_family": "sans-serif",
}

EQUATIONS = "theory"  # the page whose indented blocks are equations


ROOT = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"]).resolve()
OUTSIDE = re.compile(r"\[([^\]]*)\]\(\.\./([^)#]+)\)")


def complete_page(app, page, text):
    """Files outside docs that a page links to come with the site; a folder becomes plain text. The first page lists all."""

    def replace(match):
        words, name = match.groups()
        file = (ROOT / "docs" / page).parent / ".." / name
        if not file.exists():
            raise SystemExit(f"{page}.md: no such file: ../{name}")
        file = file.resolve()
        if file.is_relative_to(ROOT / "docs"):
            return match[0]
        name = file.relative_to(ROOT).as_posix()
        if file.is_dir():
            return words
        copy = pathlib.Path(app.srcdir) / "tree" / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, copy)
        return f"[{words}]({'../' * page.count('/')}tree/{name})"

    text[0] = OUTSIDE.sub(replace, text[0])
    if page == root_doc:
        source = pathlib.Path(app.srcdir)
        pages = {path.relative_to(source).with_suffix("").as_posix()
                 for folder in (source, source / "examples") for path in folder.glob("*.md")}
        others = pages - set(text[0].split()) - {root_doc}
        text[0] = text[0].replace("OTHERS", "\n".join(sorted(others)))


def typeset_equations(app, document, page):
    """Replaces the indented blocks of the theory by MathML."""
    if page != EQUATIONS:
        return
    blocks = list(document.findall(nodes.literal_block))
    for block in blocks:
        try:
            block.replace_self(nodes.raw("", typeset(block.astext()), format="html"))
        except NotAnEquation as error:
            raise SystemExit(f"{page}.md: not understood as an equation ({error}):\n{block.astext()}") from error
    if len(blocks) < 50:
        raise SystemExit(f"{page}.md: only {len(blocks)} blocks of equations")
    for text in list(document.findall(nodes.Text)):
        if isinstance(text.parent, (nodes.literal, nodes.title, nodes.raw, nodes.reference)):
            continue
        parts = typeset_prose(text.astext())
        if any(is_formula for is_formula, _ in parts):
            text.parent.replace(text, [nodes.raw("", part, format="html") if is_formula else nodes.Text(part)
                                       for is_formula, part in parts])


def setup(app):
    app.connect("source-read", complete_page)
    app.connect("doctree-resolved", typeset_equations)
