#!/usr/bin/env python3
"""Every link and picture of HTML pages leads to a file that is there, and to a place that is on it; no network is asked.

    check_links.py FOLDER      with the exit code 1 and one line for each that does not
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The places of a page, and what it leads to."""

    def __init__(self, path):
        super().__init__()
        self.places, self.targets = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (name == "name" and tag == "a"):
                self.places.add(value)
            elif name in ("href", "src") and value:
                self.targets.append(value)


def broken(folder):
    """(page, target) of each that leads nowhere, and how many lead somewhere."""
    pages = {path.resolve(): Page(path) for path in sorted(folder.rglob("*.html"))}
    found, good = [], 0
    for path, page in pages.items():
        for target in page.targets:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            to = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            place = unquote(parts.fragment)
            known = pages[to].places if to in pages else None
            if not to.exists() or (place and known is not None and place not in known):
                found.append((path.relative_to(folder.resolve()), target))
            else:
                good += 1
    return found, good


def main():
    found, good = broken(Path(sys.argv[1]))
    for page, target in found:
        print(f"FAILED  {page}: {target}")
    print(f"{good} links lead somewhere, {len(found)} do not")
    return 1 if found or not good else 0


if __name__ == "__main__":
    sys.exit(main())
