"""What scripts/site depends on: the links of docs, the equations of docs/theory.md as formulas, and the check of the pages."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import markdown_it

SOURCE = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])
DOCS = SOURCE / "docs"
sys.path.insert(0, str(DOCS / "site"))
sys.dont_write_bytecode = True
import check  # noqa: E402
import equations  # noqa: E402


def parse(text):
    return markdown_it.MarkdownIt("commonmark").enable("table").parse(text)


def slugs_of(text):
    """Anchors of the headings, as GitHub makes them."""
    tokens, slugs = parse(text), {}
    for opening, inline in zip(tokens, tokens[1:]):
        if opening.type == "heading_open":
            words = "".join(child.content for child in inline.children)
            slug = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
            count = slugs.setdefault(slug, 0)
            slugs[slug] += 1
            if count:
                slugs[f"{slug}-{count}"] = 1
    return set(slugs)


def find_dead_links(pages, exists):
    """Links of pages, name: text, to files that do not exist or to headings that are not there."""
    anchors = {name: slugs_of(text) for name, text in pages.items()}
    dead = []
    for name, text in pages.items():
        for token in parse(text):
            for child in token.children or []:
                url = child.attrs.get("href") or child.attrs.get("src")
                if not url or re.match(r"[a-z]+:", url):
                    continue
                path, _, anchor = url.partition("#")
                if path and not exists(path) or anchor and anchor not in anchors.get(path or name, {anchor}):
                    dead.append(f"{name}: {url}")
    return dead


def text_of(formula):
    """A formula as text, with the parts of fractions and scripts in brackets."""
    formula = re.sub(r"<mover[^>]*>(.*?)<mo[^>]*>(.)</mo></mover>", r"\1\2", formula)
    formula = re.sub(r"<(mfrac|msub|msup|munder)>", r"<\1>\1[", formula)
    formula = re.sub(r"</(mfrac|msub|msup|munder)>", "]", formula)
    return re.sub(r"\s+", " ", re.sub(r"<mspace[^>]*></mspace>", " ", re.sub(r"<(?!mspace|/mspace)[^>]*>", "", formula)))


class Links(unittest.TestCase):
    def test_no_link_of_docs_is_dead(self):
        pages = {path.name: path.read_text(encoding="utf-8") for path in sorted(DOCS.glob("*.md"))}
        self.assertGreater(len(pages), 10)
        self.assertEqual(find_dead_links(pages, lambda path: (DOCS / path).exists()), [])

    def test_what_is_found(self):
        pages = {"a.md": "# One two\n\n[x](b.md#three) [y](#one-two) [z](b.md#four) [u](c.md) [v](#one)\n", "b.md": "## Three\n"}
        self.assertEqual(find_dead_links(pages, pages.__contains__), ["a.md: b.md#four", "a.md: c.md", "a.md: #one"])


class Equations(unittest.TestCase):
    def test_all_blocks_of_the_theory_are_understood(self):
        text = (DOCS / "theory.md").read_text(encoding="utf-8")
        blocks = [token.content for token in parse(text) if token.type in ("code_block", "fence")]
        self.assertGreater(len(blocks), 80)
        for block in blocks:
            formulas = re.findall(r"<math.*?</math>", equations.typeset(block))
            self.assertGreater(len(formulas), 0, block)
            for formula in formulas:
                self.assertNotRegex(re.sub(r"<[^>]*>", "", formula), r"[_^\\]", block)

    def test_meaning(self):
        for text, expected in (
                ("C_ab kappa", "msub[Cab] κ"),
                ("Omega x P", "Ω×P"),
                ("1 + x/2", "1+mfrac[x2]"),
                ("Q^-1 u", "msup[Q−1] u"),
                ("q_y_dot", "msub[q˙y]"),
                ("dr/dz_dot", "mfrac[drdz˙]"),
                ("theta.theta/4", "mfrac[θ·θ4]"),
                ("a b / (2 T)", "mfrac[a b2 T]"),
                ("sum_j w_j f", "munder[∑j]msub[wj] f"),
                ("(-1)^min(r, m)", "msup[(−1)min(r,m)]"),
                ("w_i+1 - w_i", "msub[wi+1]−msub[wi]"),
                ("|x| <= 1", "|x|≤1"),
                ("2 e1 at a point", "2 msub[e1] at a point")):
            self.assertEqual(text_of(equations.convert_inner(text)).replace("\u00a0", " ").replace("  ", " "), expected, text)
        for text in ("a $ b", "f(x", "x)"):
            with self.assertRaises(equations.NotAnEquation, msg=text):
                equations.convert_inner(text)

    def test_running_text(self):
        parts = equations.typeset_prose("so that C_ab and theta, not mass_damping or beta-test, give f/omega^2.")
        self.assertEqual([re.sub("<[^>]*>", "", part) for is_formula, part in parts if is_formula][:2], ["Cab", "θ"])
        self.assertIn("mass_damping", "".join(part for is_formula, part in parts if not is_formula))
        self.assertNotIn("^", "".join(part for _, part in parts))


class Pages(unittest.TestCase):
    PAGES = {
        "index.html": '<h1 id="top">x</h1><a href="a.html#one">a</a><a href="https://example.org">far</a><link rel="stylesheet" href="s.css">',
        "a.html": '<p id="one"></p><a href="index.html">up</a><math><msub><mi>C</mi><mi>ab</mi></msub></math>',
        "s.css": "body { color: black }",
    }

    def check(self, **changes):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**self.PAGES, **{key.replace("_", "."): text for key, text in changes.items()}}.items():
                (pathlib.Path(folder) / name).write_text(text, encoding="utf-8")
            found = check.find_faults(pathlib.Path(folder))[0]
            run = subprocess.run([sys.executable, DOCS / "site/check.py", folder], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 1 if found else 0)
        return found

    def test_good_pages(self):
        self.assertEqual(self.check(), [])

    def test_faults(self):
        for name, text, fault in (
                ("a_html", '<p id="two">', "no such anchor"),
                ("a_html", '<p id="one"><a href="b.html">', "no such file"),
                ("a_html", '<p id="one"><a href="../b.html">', "leads out of the site"),
                ("a_html", '<p id="one"><script src="https://example.org/x.js"></script>', "loads"),
                ("a_html", '<p id="one"><img src="//example.org/x.png">', "loads"),
                ("s_css", '@import "https://example.org/f.css";', "loads"),
                ("s_css", "@font-face { src: url(http://example.org/f.otf) }", "loads"),
                ("a_html", '<p id="one">\\frac{a}{b}', "raw TeX"),
                ("a_html", '<p id="one"><math><mtext>C_ab</mtext></math>', "not typeset")):
            found = self.check(**{name: text})
            self.assertEqual(len(found), 1, (text, found))
            self.assertIn(fault, found[0])


if __name__ == "__main__":
    unittest.main()
