"""./tress package: Debian packages of the commit that is checked out."""

import os
import shutil
from pathlib import Path

from . import sundials
from .command import Command, read_words
from .counting import must
from .messages import INTERNAL_ERROR, ROWS_FAILED, Ended, Stopwatch, refuse, say
from .processes import quietly, read
from .scripts import COMPARE_ABI

LISTS = ("cmake/package_packages.txt", "cmake/python_packages.txt")
REPROTEST_LIST = "cmake/reprotest_packages.txt"
FOLDER = Path("build/packages")
AGAIN = Path("build/packages_again")
# All but the user, whose change needs sudo.
VARIATIONS = ("--variations=+all,-user_group",)
PROFILE = "pkg.tress.own-sundials"
# Without debug information, which takes a third of the time of a build.
USUAL = (("DEB_BUILD_OPTIONS", "nocheck noautodbgsym"), ("DEB_CXXFLAGS_STRIP", "-g"))


def _version():
    return Path("VERSION").read_text(encoding="utf-8").strip()


def _unpacked(folder):
    """Empties a folder. Returns the sources of HEAD in it, as an archive of a release has them."""
    tree = folder / f"tress-{_version()}"
    shutil.rmtree(folder, ignore_errors=True)
    tree.mkdir(parents=True)
    archive = folder / "tress.tar"
    must("git", "archive", "--output", archive, "HEAD")
    must("tar", "-x", "-f", archive, "-C", tree)
    archive.unlink()
    return tree


def _build_of(root):
    """Returns the command that builds packages in a tree, and its environment. The root is that
    of SUNDIALS."""
    date = read("git", "log", "-1", "--format=%ct").stdout.strip()
    environment = os.environ | {"SOURCE_DATE_EPOCH": date, "TRESS_SUNDIALS_ROOT": root or "",
                                **{name: os.environ.get(name, usual) for name, usual in USUAL}}
    return ("dpkg-buildpackage", "-b", "-us", "-uc", *([f"-P{PROFILE}"] if root else [])), environment


def packages():
    """Returns the packages that were built, in the order of their names."""
    return sorted(FOLDER.glob("*.deb"))


def build_packages(machine):
    """Builds the packages of HEAD, with their tests of a build left to ./tress test."""
    machine.ensure(*LISTS)
    if read("git", "diff", "--quiet", "HEAD").code != 0:
        say("package: changes that are not committed are left out")
    tree = _unpacked(FOLDER)
    command, environment = _build_of(sundials.root())
    log = FOLDER / "build.log"
    say(f"building packages of {_version()} (log: {log})")
    watch = Stopwatch()
    code = quietly(log, *command, cwd=tree, env=environment)
    if code != 0:
        raise Ended(INTERNAL_ERROR, f"package: the build failed; full log: {log}")
    watch.say("packages")
    for package in packages():
        say(f"  {package}")


def _lint():
    (changes,) = FOLDER.glob("*.changes")
    must("lintian", "--fail-on", "error,warning", "--tag-display-limit", "0", changes)
    say("lintian: no error and no warning")


def _are_of_head():
    """True if the last build is that of HEAD."""
    built = FOLDER / f"tress-{_version()}/cmake/commit.txt"
    head = read("git", "rev-parse", "HEAD").stdout
    return bool(packages()) and built.is_file() and built.read_text(encoding="utf-8") == head


def _reprotest(words, machine):
    """Builds the packages again with reprotest. The last build is the one to compare with."""
    machine.ensure(*LISTS, REPROTEST_LIST)
    if not _are_of_head():
        build_packages(machine)
    command, environment = _build_of(sundials.root())
    tree = _unpacked(AGAIN)
    first = AGAIN / "first"
    (first / "source-root").mkdir(parents=True)  # the layout of reprotest
    for package in packages():
        shutil.copy2(package, first)
    log, second = AGAIN / "build.log", AGAIN / "second"
    say(f"building packages again with reprotest (log: {log})")
    code = quietly(log, "reprotest", "-v", *(words or VARIATIONS), "--control-build", first.resolve(),
                   "--store-dir", second.resolve(), "-s", tree, " ".join(command), "../*.deb",
                   env=environment)
    if code != 0 and not any(second.glob("*.diff*")):
        raise Ended(INTERNAL_ERROR, f"reprotest: the build failed; full log: {log}")
    if code != 0:
        raise Ended(ROWS_FAILED, f"reprotest: packages differ; differences: end of {log}")
    say(f"reprotest: the bits of {len(packages())} packages are the same")


def _run(words, machine):
    read_ = read_words("package", words, flags=("--lint", "--reprotest"), valued=("--abi",), names=True,
                       hint=" (options of reprotest go after --)")
    if "--abi" in read_.options:
        if len(read_.names) != 1:
            refuse("package: --abi takes two packages tress: --abi OLD NEW")
        machine.ensure(*LISTS)
        return must(*COMPARE_ABI, read_.options["--abi"], read_.names[0])
    if "--reprotest" in read_.options:
        return _reprotest(read_.more, machine)
    if read_.names:
        refuse(f"package: unknown word '{read_.names[0]}'")
    if "--lint" not in read_.options or not packages():
        build_packages(machine)
    return _lint()


COMMAND = Command(
    "package", "[--lint]\n--reprotest [-- OPTIONS]\n--abi OLD NEW",
    "builds the Debian packages of the commit that is checked out, into build/packages, and runs "
    "lintian. docs/about/packages.md describes them. Installs cmake/package_packages.txt.",
    _run,
    example="./tress package",
    time="about half an hour on two cores.",
    options=(("--lint", "runs lintian on the packages of the last build"),
             ("--reprotest [-- OPTIONS]", "builds the packages again with reprotest, in another folder, "
              "at another time, in another locale, with files in another order, and compares the bits "
              "with those of the last build. Exit code 3 if they differ. Options of reprotest replace "
              "--variations=+all,-user_group. Installs cmake/reprotest_packages.txt"),
             ("--abi OLD NEW", "compares the shared libraries of two packages tress, or two files "
              "libtress.so, with abidiff: symbols, and types where both have debug information. Prints "
              "whether programs of NEW accept plug-ins of OLD. Exit code 3 if a change is incompatible")))
