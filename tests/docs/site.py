#!/usr/bin/env python3
"""deploy/site/build makes a site that has every page of the manual, and in which each link and anchor leads somewhere."""
import glob
import html.parser
import os
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

import pages


class Links(html.parser.HTMLParser):
    """The ids of a page, and where its links lead."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.links = set(), set()
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if "id" in attributes:
            self.ids.add(attributes["id"])
        for name in ("href", "src"):
            if tag in ("a", "img") and name in attributes:
                self.links.add(attributes[name])


def broken(folder):
    """Links within the site that lead nowhere, as texts."""
    found = {path: Links(path) for path in glob.glob(os.path.join(folder, "**", "*.html"), recursive=True)}
    for path, page in sorted(found.items()):
        if os.path.basename(path) == "404.html":
            continue
        for link in sorted(page.links):
            url = urllib.parse.urlparse(link)
            if url.scheme or url.netloc:
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(url.path))) if url.path else path
            if os.path.isdir(target):
                target = os.path.join(target, "index.html")
            if not os.path.exists(target) or (url.fragment and target in found and urllib.parse.unquote(url.fragment) not in found[target].ids):
                yield f"{os.path.relpath(path, folder)}: {link} leads nowhere"


def main():
    if not shutil.which("mkdocs"):
        print("mkdocs is not installed")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([os.path.join(pages.SOURCE, "deploy", "site", "build"), folder], check=True)
        missing = [page for page in pages.names() if page.startswith("docs/")
                   and not os.path.exists(os.path.join(folder, page[:-2] + "html"))]
        wrong = missing + list(broken(folder))
        with open(os.path.join(folder, "docs", "glossary.html"), "a", encoding="utf-8") as file:
            file.write('<a href="none.html">')
        if len(list(broken(folder))) != len(wrong) - len(missing) + 1:
            sys.exit("the check itself finds nothing")
        with open(os.path.join(pages.SOURCE, "deploy", "site", "mkdocs.yml"), encoding="utf-8") as file:
            navigation = file.read()
        wrong += [f"{page} is not in the navigation of deploy/site/mkdocs.yml" for page in pages.names()
                  if page != "README.md" and f"- {page}\n" not in navigation]
    print("\n".join(wrong) or f"a site of {len(pages.names())} pages, all links lead somewhere")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
