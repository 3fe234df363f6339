#!/usr/bin/env python3
"""deploy/site/build makes one site: every page of the manual, of the programs, of vectorlib's classes and of the Python examples is
there, in the navigation and in the search, and each link and anchor leads somewhere. A run that fails leaves an earlier site whole."""
import glob
import html.parser
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.parse

import pages

BUILD = os.path.join(pages.SOURCE, "deploy", "site", "build")
BINARIES = os.environ.get("HERMES_BIN", os.path.join(pages.SOURCE, "build", "release", "bin"))


def read(*path):
    with open(os.path.join(pages.SOURCE, *path), encoding="utf-8") as file:
        return file.read()


def programs():
    """All programs of the packages."""
    installed = "".join(read("deploy", "debian", name) for name in os.listdir(os.path.join(pages.SOURCE, "deploy", "debian"))
                        if name.endswith(".install"))
    return re.findall(r"^usr/bin/(\S+)$", installed, re.MULTILINE)


def help_of(program):
    return subprocess.run([os.path.join(BINARIES, program), "--help"], env={**os.environ, "QT_QPA_PLATFORM": "offscreen"},
                          capture_output=True, text=True, check=True).stdout


def classes():
    """(folder, name) of all classes of vectorlib that do not need the instructions of one processor."""
    for path in glob.glob(os.path.join(pages.SOURCE, "vectorlib", "include", "vectorlib", "*", "*.h")):
        text = re.sub(r"^#if defined\(VECTORLIB_SIMD.*?^#endif", "", read(path), flags=re.MULTILINE | re.DOTALL)
        for name in re.findall(r"^(?:class|struct) (\w+)[^;]*\{", text, re.MULTILINE):
            yield os.path.basename(os.path.dirname(path)), name


class Page(html.parser.HTMLParser):
    """The ids of a page, where its links lead, those of its navigation, and its text."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.links, self.navigation, self.text = set(), set(), set(), ""
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if "id" in attributes:
            self.ids.add(attributes["id"])
        for name in ("href", "src"):
            if tag in ("a", "img", "link", "script") and name in attributes:
                self.links.add(attributes[name])
                if "md-nav__link" in attributes.get("class", ""):
                    self.navigation.add(attributes[name])

    def handle_data(self, data):
        self.text += data


def broken(site, found):
    """Links within the site that lead nowhere, as texts; `found` are its pages by path."""
    for path, page in sorted(found.items()):
        for link in sorted(page.links):
            url = urllib.parse.urlparse(link)
            if url.scheme or url.netloc or path == "404.html":
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(url.path))) if url.path else path
            if os.path.isdir(os.path.join(site, target)):
                target = os.path.join(target, "index.html")
            if not os.path.exists(os.path.join(site, target)) or (
                    url.fragment and target in found and urllib.parse.unquote(url.fragment) not in found[target].ids):
                yield f"{path}: {link} leads nowhere"


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        cls.addClassCleanup(folder.cleanup)
        cls.site = os.path.join(folder.name, "site")
        subprocess.run([BUILD, cls.site], check=True, stdout=subprocess.DEVNULL)
        cls.pages = {path: Page(os.path.join(cls.site, path)) for path in glob.glob("**/*.html", root_dir=cls.site, recursive=True)}

    def test_all_links_lead_somewhere(self):
        self.assertEqual(list(broken(self.site, self.pages)), [])
        self.pages["docs/glossary.html"].links |= {"none.html", "glossary.html#none"}
        self.assertEqual(len(list(broken(self.site, self.pages))), 2, "the check itself finds nothing")
        self.pages["docs/glossary.html"].links -= {"none.html", "glossary.html#none"}

    def test_every_page_of_the_manual_is_in_the_navigation(self):
        wanted = {"index.html" if page == "README.md" else page[:-2] + "html" for page in pages.names()}
        self.assertEqual(wanted - self.pages["python.html"].navigation, set(), "missing in deploy/site/mkdocs.yml")

    def test_every_page_of_the_site_is_in_the_navigation_and_has_text(self):
        self.assertEqual(set(self.pages) - {"404.html"} - self.pages["python.html"].navigation - {"python.html"}, set())
        bare = len(self.pages["404.html"].text)
        self.assertEqual([path for path, page in self.pages.items() if len(page.text) < bare + 200 and path != "404.html"], [])

    def test_every_program_has_a_page(self):
        names = programs()
        commands = re.findall(r"^ {2}([a-z][a-z-]*) ", help_of("hermes-vector").split("Subcommands:")[1], re.MULTILINE)
        self.assertGreater(len(commands), 10)
        for name in names + [f"hermes-vector-{command}" for command in commands]:
            with self.subTest(name):
                self.assertIn("SYNOPSIS", self.pages[f"programs/{name}.html"].text)
                self.assertIn(f"programs/{name}.html", self.pages["programs.html"].links)

    def test_every_setting_of_a_daemon_has_an_anchor(self):
        for name in programs():
            settings = set(re.findall(r"^ {2}([a-z][\w.]*) = ", help_of(name), re.MULTILINE))
            with self.subTest(name):
                self.assertEqual(settings - self.pages[f"programs/{name}.html"].ids, set())

    def test_every_class_of_the_library_has_an_entry(self):
        found = list(classes())
        self.assertGreater(len(found), 200)
        self.assertEqual([(folder, name) for folder, name in found
                          if not {name, f"simd-{name}", f"detail-{name}"} & self.pages[f"library/{folder}.html"].ids], [])

    def test_every_example_in_python_has_an_entry(self):
        for path in glob.glob("docs/examples/*.py", root_dir=pages.SOURCE):
            self.assertIn(os.path.basename(path)[:-3], self.pages["python.html"].ids)

    def test_the_search_finds_classes_and_settings(self):
        with open(os.path.join(self.site, "search", "search_index.json"), encoding="utf-8") as file:
            entries = {entry["location"]: entry["text"] for entry in json.load(file)["docs"]}
        self.assertIn("thesis figure 3.1", entries["library/mapping.html#MapBuilder"])
        self.assertIn("log.records = 1000", entries["programs/hermes-supervisor.html"])
        self.assertIn("A connection to one daemon", entries["python.html#hermes.Daemon"])


class FailingRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.site = os.path.join(self.folder, "site")
        os.makedirs(os.path.join(self.site, "search"))
        for name in ("index.html", "search/search_index.json"):
            self.write(os.path.join("site", name), "earlier")

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def run_with(self, doxygen=None, **options):
        """A started run; instead of doxygen, a script."""
        environment = {**os.environ, **options.pop("env", {})}
        if doxygen:
            os.chmod(self.write("doxygen", f"#!/bin/sh\n{doxygen}\n"), 0o755)
            environment["PATH"] = self.folder + ":" + environment["PATH"]
        return subprocess.Popen([BUILD, self.site], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                start_new_session=True, **options)

    def assert_whole(self):
        names = sorted(glob.glob("**", root_dir=self.site, recursive=True))
        self.assertEqual(names, ["index.html", "search", "search/search_index.json"])
        with open(os.path.join(self.site, "index.html"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "earlier")

    def assert_fails(self, run, *messages):
        output = run.communicate(timeout=100)[1]
        self.assertNotEqual(run.returncode, 0)
        for message in messages:
            self.assertIn(message, output)
        self.assert_whole()

    def test_a_program_that_is_not_built_is_named_with_what_builds_it(self):
        self.assert_fails(self.run_with(env={"HERMES_BIN": self.folder}), "hermes-supervisor", "cmake --build --preset release --target")

    def unfinished(self):
        """Where a run makes the new site."""
        return os.path.join(os.path.dirname(self.site), f".{os.path.basename(self.site)}.hermes-site")

    def test_what_lies_beside_the_site_stays(self):
        beside = os.path.join(self.site + ".new", "thesis.txt")
        os.mkdir(self.site + ".new")
        with open(beside, "w", encoding="utf-8") as file:
            file.write("precious")
        self.assert_fails(self.run_with(doxygen="exit 1"), "is as it was")
        self.assertTrue(os.path.exists(beside))

    def test_a_tool_that_fails(self):
        self.assert_fails(self.run_with(doxygen="echo no memory >&2; exit 1"), "no memory", f"failed; {self.site} is as it was")
        self.assertFalse(os.path.exists(self.unfinished()))

    def test_a_disk_that_is_full(self):
        limit = 100_000  # bytes of a file: pictures have more

        self.assert_fails(self.run_with(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))),
                          f"failed; {self.site} is as it was")

    def test_a_run_that_is_killed_and_one_beside_it(self):
        run = self.run_with(doxygen=f"touch {self.folder}/begun; exec sleep 100")
        try:
            for _ in range(1000):
                if os.path.exists(os.path.join(self.folder, "begun")):
                    break
                time.sleep(0.1)
            self.assert_fails(self.run_with(), "another run makes a site")
        finally:
            os.killpg(run.pid, signal.SIGKILL)
        run.communicate()
        self.assert_whole()
        self.assertTrue(os.path.exists(self.unfinished()))
        self.assert_fails(self.run_with(doxygen="exit 1"), "is as it was")
        self.assertFalse(os.path.exists(self.unfinished()), "what the killed run left stays")

    def test_a_folder_that_is_no_site_is_left_alone(self):
        os.remove(os.path.join(self.site, "search", "search_index.json"))
        run = self.run_with()
        self.assertIn("neither empty nor a site", run.communicate(timeout=100)[1])
        self.assertNotEqual(run.returncode, 0)
        self.assertTrue(os.path.exists(os.path.join(self.site, "index.html")))


if __name__ == "__main__":
    PACKAGES = '. deploy/bootstrap.sh; dpkg-query -W "${hermes_site_packages[@]}"'
    if subprocess.run(["bash", "-c", PACKAGES], cwd=pages.SOURCE, capture_output=True, check=False).returncode:
        print("not all of mkdocs, doxygen and the other packages of deploy/site/build are installed")
        sys.exit(77)
    if not all(os.path.exists(os.path.join(BINARIES, name)) for name in programs()):
        print("not all programs are built, whose pages would be made")
        sys.exit(77)
    unittest.main()
