"""Makes a fresh Debian, as new as this one, in a folder: for tests that begin where a user does."""
import os
import platform
import shutil
import subprocess


class Missing(Exception):
    """What this machine lacks for it."""


def mirror():
    """The first mirror of Debian that apt of this computer knows."""
    listed = subprocess.run(["apt-get", "indextargets", "--format", "$(REPO_URI)"], capture_output=True, text=True, check=True)
    uris = [uri for uri in listed.stdout.split() if uri.rstrip("/").endswith("/debian")]
    if not uris:
        raise Missing("apt of this computer knows no mirror of Debian: expected one in sources.list")
    return uris[0].rstrip("/")


def need(*programs):
    """Raises Missing when this is not root or a program is absent."""
    if os.geteuid() != 0:
        raise Missing("needs root")
    for program in ("debootstrap", *programs):
        if not shutil.which(program):
            raise Missing(f"needs {program}")


def make(folder, like, packages):
    """A fresh Debian of this machine's release in the folder with these packages, or a copy of the one in the folder `like`."""
    if like:
        subprocess.run(["cp", "-a", like + "/.", folder], check=True)
        return
    release = platform.freedesktop_os_release()["VERSION_CODENAME"]
    made = subprocess.run(["debootstrap", "--variant=minbase", "--include=" + ",".join(packages), release, folder, mirror()],
                          capture_output=True, text=True, check=False)
    if made.returncode != 0:
        raise RuntimeError(f"debootstrap ended with status {made.returncode}: {(made.stdout + made.stderr)[-1500:]}")
