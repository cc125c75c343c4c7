"""./tress package: Debian packages of the commit that is checked out."""

import os
import shutil
from pathlib import Path

from . import sundials
from .command import Command, read_words
from .counting import must
from .messages import INTERNAL_ERROR, Ended, Stopwatch, refuse, say
from .processes import quietly, read
from .scripts import COMPARE_ABI

LISTS = ("cmake/package_packages.txt", "cmake/python_packages.txt")
FOLDER = Path("build/packages")
PROFILE = "pkg.tress.own-sundials"
# Without debug information, which takes a third of the time of a build.
USUAL = (("DEB_BUILD_OPTIONS", "nocheck noautodbgsym"), ("DEB_CXXFLAGS_STRIP", "-g"))


def _unpacked(commit, version):
    """Returns a new folder with the sources of a commit, as an archive of a release has them."""
    tree = FOLDER / f"tress-{version}"
    shutil.rmtree(FOLDER, ignore_errors=True)
    tree.mkdir(parents=True)
    archive = FOLDER / "tress.tar"
    must("git", "archive", "--output", archive, commit)
    must("tar", "-x", "-f", archive, "-C", tree)
    archive.unlink()
    return tree


def packages():
    """Returns the packages that were built, in the order of their names."""
    return sorted(FOLDER.glob("*.deb"))


def build_packages(machine):
    """Builds the packages of HEAD, with their tests of a build left to ./tress test."""
    machine.ensure(*LISTS)
    if read("git", "diff", "--quiet", "HEAD").code != 0:
        say("package: changes that are not committed are left out")
    version = Path("VERSION").read_text(encoding="utf-8").strip()
    tree = _unpacked("HEAD", version)
    root = sundials.root()
    date = read("git", "log", "-1", "--format=%ct").stdout.strip()
    environment = os.environ | {"SOURCE_DATE_EPOCH": date, "TRESS_SUNDIALS_ROOT": root or "",
                                **{name: os.environ.get(name, usual) for name, usual in USUAL}}
    log = FOLDER / "build.log"
    say(f"building packages of {version} (log: {log})")
    watch = Stopwatch()
    code = quietly(log, "dpkg-buildpackage", "-b", "-us", "-uc", *([f"-P{PROFILE}"] if root else []),
                   cwd=tree, env=environment)
    if code != 0:
        raise Ended(INTERNAL_ERROR, f"package: the build failed; full log: {log}")
    watch.say("packages")
    for package in packages():
        say(f"  {package}")


def _lint():
    (changes,) = FOLDER.glob("*.changes")
    must("lintian", "--fail-on", "error,warning", "--tag-display-limit", "0", changes)
    say("lintian: no error and no warning")


def _run(words, machine):
    read_ = read_words("package", words, flags=("--lint",), valued=("--abi",), names=True)
    if "--abi" in read_.options:
        if len(read_.names) != 1:
            refuse("package: --abi takes two packages of tress: --abi OLD.deb NEW.deb")
        machine.ensure(*LISTS)
        return must(*COMPARE_ABI, read_.options["--abi"], read_.names[0])
    if read_.names:
        refuse(f"package: unknown word '{read_.names[0]}'")
    if "--lint" not in read_.options or not packages():
        build_packages(machine)
    return _lint()


COMMAND = Command(
    "package", "[--lint]\n--abi OLD.deb NEW.deb",
    "builds the Debian packages of the commit that is checked out, into build/packages, and runs "
    "lintian. docs/about/packages.md describes them. Installs cmake/package_packages.txt.",
    _run,
    example="./tress package",
    time="about half an hour on two cores.",
    options=(("--lint", "runs lintian on the packages of the last build"),
             ("--abi OLD.deb NEW.deb", "compares the shared libraries of two packages tress with "
              "abidiff. Exit code 3 if a change is incompatible")))
