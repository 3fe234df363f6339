#!/usr/bin/env python3
"""docs/protocol-reference.md is what the daemons tell, on whichever computer, for whichever user."""
import os
import subprocess
import sys
import tempfile

from support import BINARIES, SOURCE, put, text_of


def main():
    with tempfile.TemporaryDirectory() as home:
        elsewhere = {"HERMES_BIN": BINARIES, "PATH": os.environ["PATH"], "HOME": home, "TZ": "Asia/Kolkata", "LC_ALL": "C"}
        sanitizers = {name: value for name, value in os.environ.items() if name.endswith("SAN_OPTIONS")}
        script = os.path.join(SOURCE, "deploy", "protocol-reference")
        done = subprocess.run([script, "--check"], env={**elsewhere, **sanitizers}, cwd=home, timeout=120)
        if done.returncode != 0:
            sys.exit("docs/protocol-reference.md is not what the daemons tell; this renews it: deploy/protocol-reference")
        other = os.path.join(home, "page.md")
        page = text_of(os.path.join(SOURCE, "docs", "protocol-reference.md"))
        put(other, page.replace("motor.estop", "motor.halt"))
        stale = subprocess.run([script, "--check", "--out", other], env={**elsewhere, **sanitizers}, stdout=subprocess.PIPE,
                               encoding="utf-8", timeout=120)
        assert stale.returncode == 1 and "this renews it: deploy/protocol-reference" in stale.stdout, stale
    headings = {line.lstrip("#").strip() for line in page.splitlines() if line.startswith("#")}
    anchors = {"".join(c for c in heading.lower().replace(" ", "-") if c.isalnum() or c in "-_") for heading in headings}
    links = [part.split(")")[0] for part in page.split("](#")[1:]]
    assert links and not set(links) - anchors, set(links) - anchors
    print(f"{len(links)} commands, topics and settings are described as the daemons tell them")


if __name__ == "__main__":
    main()
