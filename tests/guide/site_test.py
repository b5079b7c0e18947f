#!/usr/bin/env python3
"""The built site of the guide has no dead link, a search that finds, and no address of another machine for its own files.

    site_test.py FOLDER       FOLDER is what tools/build_guide.sh made
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.links, self.files, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors.update(given[key] for key in ("id", "name") if given.get(key))
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        for key in ("src", "href"):
            if tag in ("script", "img", "link") and given.get(key):
                self.files.append(given[key])


def check(folder):
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in folder.rglob("*.html")}
    faults = []
    for path, page in pages.items():
        where = path.relative_to(folder)
        for address in page.links + page.files:
            parts = urlsplit(address)
            if parts.scheme in ("http", "https") and address in page.files:
                faults.append(f"{where}: {address} is on another machine")
            if parts.scheme or parts.netloc or address.startswith("data:"):
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if target.is_dir():
                target = target / "index.html"
            if not target.exists():
                faults.append(f"{where}: {address} does not exist")
            elif parts.fragment and target.suffix == ".html" and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                faults.append(f"{where}: {address}: no such place")
    return pages, faults


def main():
    folder = Path(sys.argv[1]).resolve()
    pages, faults = check(folder)
    index = (folder / "searchindex.js").read_text(encoding="utf-8")
    # Words of the guide, of the C++ reference, and of the scene reference.
    for word in ("rollback", "add_bodi", "tear_strain"):
        if not re.search(rf'\b"?{word}"?:', index):
            faults.append(f"the search does not know {word}")
    for fault in sorted(set(faults))[:40]:
        print(fault)
    print(f"{len(pages)} pages, {sum(len(page.links) for page in pages.values())} links, {len(set(faults))} faults")
    return 1 if faults or len(pages) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
