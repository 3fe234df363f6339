#!/usr/bin/env python3
"""Compiles, without making anything of it, each source of hermesctl, hermes-gui and what they use for Windows: by MinGW-w64, with the
headers of this system's Qt 5 and OpenSSL, which are the same there. Whether all links and runs is not seen so (docs/windows.md)."""
import concurrent.futures
import glob
import os
import shutil
import subprocess
import sys
import tempfile

import walls

SKIPPED = 77
COMPILER = "x86_64-w64-mingw32-g++-posix"
ROOT = os.path.abspath(os.environ.get("HERMES_SOURCE") or os.path.join(os.path.dirname(__file__), "..", ".."))
# Libraries that are headers alone, or whose headers do not depend on the system; beside them in /usr/include stand those of its C library.
HEADERS = ("nlohmann", "openssl", "rapidjson", "SDL2", "valijson")
MODULES = ("QtCore", "QtDBus", "QtGui", "QtNetwork", "QtSerialPort", "QtSvg", "QtWidgets")


def sources():
    found = [path for folder in ("protocol", "gui") for path in glob.glob(f"{ROOT}/{folder}/**/*.cpp", recursive=True)]
    lists = []
    for folder, _, files in os.walk(os.path.join(ROOT, "common")):
        if "CMakeLists.txt" in files:
            with open(os.path.join(folder, "CMakeLists.txt"), encoding="utf-8") as text:
                lists.append((folder, text.read()))
    found += [path for path in walls.portable_sources(lists) if os.path.exists(path)]
    # hermes-vector is built as a whole: tests/gui/vector_windows.py. MCAP is for daemons alone.
    return sorted(path for path in found if not path.endswith("Posix.cpp") and "/gui/vector/" not in path and "/protocol/mcap/" not in path)


def link_headers(folder, qt):
    """A folder of links to the headers that are needed, and no others."""
    for name in HEADERS:
        os.mkdir(f"{folder}/{name}")
        for path in glob.glob(f"/usr/include/{name}/*") + glob.glob(f"{os.path.dirname(qt)}/{name}/*"):
            if not os.path.lexists(link := f"{folder}/{name}/{os.path.basename(path)}"):
                os.symlink(path, link)


def compile_one(path, options):
    done = subprocess.run([COMPILER, "-fsyntax-only", *options, path], cwd=ROOT, capture_output=True, text=True)
    return "" if done.returncode == 0 else "\n".join(line for line in done.stderr.splitlines() if "error" in line)


def main():
    qt = next(iter(glob.glob("/usr/include/*/qt5")), None)
    if not shutil.which(COMPILER) or not qt:
        print(f"skipped: {COMPILER} or the headers of Qt 5 are not here; Debian has g++-mingw-w64-x86-64-posix and qtbase5-dev")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        link_headers(folder, qt)
        options = ["-std=c++17", "-Wall", "-Wextra", "-Wshadow", "-Werror", "-DNOMINMAX", "-DWIN32_LEAN_AND_MEAN", "-D_WIN32_WINNT=0x0A00",
                   "-DQT_NO_KEYWORDS", "-DQT_NO_FOREACH", "-DQT_DEPRECATED_WARNINGS", "-DQT_NO_CAST_TO_ASCII", '-DHERMES_VERSION="0"',
                   f"-I{ROOT}", f"-I{ROOT}/vectorlib/include", "-isystem", "/usr/include/eigen3", "-isystem", folder, "-isystem", qt]
        for module in MODULES:
            options += ["-isystem", f"{qt}/{module}"]
        paths = sys.argv[1:] or sources()
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            errors = [text for text in pool.map(lambda path: compile_one(path, options), paths) if text]
    print("\n".join(errors) or f"{len(paths)} sources compile for Windows")
    return 1 if errors or not paths else 0


if __name__ == "__main__":
    sys.exit(main())
