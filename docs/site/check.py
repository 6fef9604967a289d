#!/usr/bin/env python3
"""Checks a folder of pages: every relative link and anchor exists, and no page loads anything from a network.

    docs/site/check.py FOLDER    # exit code 1 where something is found
"""

import html.parser
import pathlib
import re
import sys
import urllib.parse

LOADED = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src", "embed": "src",
          "object": "data", "audio": "src", "video": "src", "use": "href", "image": "href"}
# `rel` of what a browser does not load.
NOT_LOADED = {"author", "canonical", "search", "index", "genindex", "next", "prev", "up", "top", "copyright", "contents",
              "help", "license"}
REMOTE = re.compile(r"^(?:[a-z][a-z0-9+.-]*:)?//", re.I)
STYLE_URL = re.compile(r"""url\(\s*['"]?([^'")]+)|@import\s+['"]([^'"]+)""")
RAW_TEX = re.compile(r"\$\$|\\\(|\\\[|\\(?:frac|begin|mathrm|omega|theta|lambda)\b")


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.anchors, self.links, self.loads, self.styles, self.formulas = set(), [], [], [], []
        self._inside = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        for key in ("id", "name"):
            if values.get(key):
                self.anchors.add(values[key])
        if tag in ("a", "area") and values.get("href"):
            self.links.append(values["href"])
        relation = set((values.get("rel") or "").lower().split())
        key = LOADED.get(tag)
        if key and values.get(key):
            if tag == "link" and relation & NOT_LOADED:
                self.links.append(values[key])
            else:
                self.loads.append(values[key])
        if values.get("style"):
            self.styles.append(values["style"])
        if tag in ("style", "script", "math", "code", "pre"):
            self._inside.append(tag)
            if tag == "math":
                self.formulas.append("")

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if self._inside and self._inside[-1] == tag:
            self._inside.pop()

    def handle_endtag(self, tag):
        if self._inside and self._inside[-1] == tag:
            self._inside.pop()

    def handle_data(self, data):
        if self._inside and self._inside[-1] == "style":
            self.styles.append(data)
        elif "math" in self._inside:
            self.formulas[-1] += data
        elif not self._inside:
            self.text += data


def urls_of(style):
    return [match[1] or match[2] for match in STYLE_URL.finditer(style)]


def find_faults(folder):
    """Faults as `page: fault`, and the numbers of pages, links and formulas."""
    folder = folder.resolve()
    pages = {path: Page(path.read_text(encoding="utf-8", errors="replace")) for path in sorted(folder.rglob("*.html"))}
    faults, links, formulas = [], 0, 0

    def check(path, url, is_load):
        nonlocal links
        links += 1
        where = path.relative_to(folder)
        if REMOTE.match(url):
            if is_load:
                faults.append(f"{where}: loads {url}")
            return
        parts = urllib.parse.urlsplit(url)
        if parts.scheme:
            return
        target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
        if target.is_dir():
            target /= "index.html"
        if not target.is_relative_to(folder):
            faults.append(f"{where}: leads out of the site: {url}")
        elif not target.exists():
            faults.append(f"{where}: no such file: {url}")
        elif parts.fragment and target in pages and not is_load:
            if urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                faults.append(f"{where}: no such anchor: {url}")

    for path, page in pages.items():
        for url in page.links:
            check(path, url, False)
        for url in [*page.loads, *(url for style in page.styles for url in urls_of(style))]:
            check(path, url, True)
        if RAW_TEX.search(page.text):
            faults.append(f"{path.relative_to(folder)}: raw TeX: {RAW_TEX.search(page.text)[0]}")
        for formula in page.formulas:
            if re.search(r"[_\\$^]", formula):
                faults.append(f"{path.relative_to(folder)}: not typeset: {formula}")
        formulas += len(page.formulas)
    for path in sorted(folder.rglob("*.css")):
        for url in urls_of(path.read_text(encoding="utf-8", errors="replace")):
            if not url.startswith("data:"):
                check(path, url, True)
    return faults, len(pages), links, formulas


def main():
    folder = pathlib.Path(sys.argv[1])
    faults, pages, links, formulas = find_faults(folder)
    if not pages:
        sys.exit(f"{folder}: no pages")
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{pages} pages, {links} links, {formulas} formulas, {len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
