#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Every link of the documents leads somewhere: files and headings in the Markdown, and in the drawn site where there is one.

Usage: check_links.py ROOT [SITE]
Addresses on the network are left alone: a test must not need one.
"""

import html.parser
import pathlib
import re
import sys
import urllib.parse

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+\s+(.*)$", re.M)
# Doxygen 1.9 links to this heading in pages that have none.
DOXYGENS_OWN = {"nested-classes"}
FENCE = re.compile(r"^```.*?^```", re.M | re.S)


def anchors_of(page):
    """Headings as GitHub names them."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in HEADING.findall(text)}


def check_markdown(root, problem):
    pages = [*root.glob("*.md"), *root.glob("docs/**/*.md")]
    for page in pages:
        for target in LINK.findall(FENCE.sub("", page.read_text(encoding="utf-8"))):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            where = (page.parent / path) if path else page
            if not where.exists():
                problem(f"{page.relative_to(root)}: {target}: no such file")
            elif anchor and where.suffix == ".md" and anchor not in anchors_of(where):
                problem(f"{page.relative_to(root)}: {target}: no such heading")
    return len(pages)


class site_page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.names = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("href", "src") and value:
                self.links.append(value)
            if key in ("id", "name") and value:
                self.names.add(value)


def check_site(site, problem):
    pages = {path.name: site_page(path.read_text(encoding="utf-8")) for path in site.glob("*.html")}
    for name, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            path = path or name
            if not (site / path).exists():
                problem(f"site: {name}: {link}: no such file")
            elif anchor and anchor not in DOXYGENS_OWN and path in pages and anchor not in pages[path].names:
                problem(f"site: {name}: {link}: no such place")
    return len(pages)


def main():
    root = pathlib.Path(sys.argv[1])
    problems = []
    pages = check_markdown(root, problems.append)
    if len(sys.argv) > 2 and pathlib.Path(sys.argv[2]).is_dir():
        pages += check_site(pathlib.Path(sys.argv[2]), problems.append)
    print("\n".join(problems))
    print(f"{pages} pages, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
