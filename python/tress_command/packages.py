"""Packages of Debian that commands need: what is missing, and its installation."""

import contextlib
import fcntl
import os
import re
import shutil
from pathlib import Path

from . import place, sundials
from .command import Command, no_words
from .messages import INTERNAL_ERROR, INTERRUPTED, Ended, Stopwatch, echo, refuse, say
from .processes import quietly, read, run

BUILD_LIST = "cmake/build_packages.txt"
LIST = "cmake/packages.txt"
EVERYTHING = (BUILD_LIST, LIST)
OPTIONAL = "# optional"
NODE_MAJOR = 18
OLDER_CONFIGURATION = ("-o", "DPkg::Lock::Timeout=600", "-o", "Dpkg::Options::=--force-confold")


def names_in(file, optional=False):
    """Returns the packages that a list calls optional, or the others."""
    lines = Path(file).read_text(encoding="utf-8").splitlines()
    names = (line.partition("#")[0].strip() for line in lines if (OPTIONAL in line) == optional)
    return [name for name in names if name]


def _installed(names):
    """Returns those of the packages that dpkg calls installed."""
    if not names:
        return set()
    listed = read("dpkg-query", "-W", "-f=${db:Status-Status} ${Package}\\n", *names).stdout
    return {line.split()[1] for line in listed.splitlines() if line.startswith("installed ")}


def _has_node():
    """True if a Node from anywhere is recent enough."""
    found = shutil.which("node") and re.match(r"v(\d+)\.", read("node", "--version").stdout)
    return bool(found) and int(found[1]) >= NODE_MAJOR


def cache():
    """Returns the folder of logs, of the lock and of SUNDIALS, which it makes."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(os.environ.get("TRESS_CACHE") or Path(base) / "tress")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        refuse(f"cannot write {folder}; set TRESS_CACHE to another folder")
    return folder


class Machine:
    """This machine. Commands install on it what they need, if they may."""

    def __init__(self, may_install):
        self.may_install = may_install

    def missing_of(self, *lists):
        """Returns the packages of these lists that are not installed."""
        if not shutil.which("dpkg-query"):
            refuse("setup needs Debian's apt; elsewhere install what cmake/build_packages.txt "
                   "and cmake/packages.txt name, then: cmake --preset release")
        wanted = {name for file in lists for name in names_in(file)}
        if _has_node():
            wanted.discard("nodejs")
        if shutil.which("npm"):  # a Node from elsewhere brings its own
            wanted.discard("npm")
        return sorted(wanted - _installed(sorted(wanted)))

    def missing(self, *lists, base=EVERYTHING):
        """Returns the packages that are missing of `base` and of these lists."""
        # Debian's own SUNDIALS, once the source build has failed.
        spare = () if sundials.root() != "" else ("cmake/sundials_packages.txt",)
        return self.missing_of(*base, *lists, *spare)

    def missing_optional(self, file):
        """Returns the packages that a list calls optional and that are not installed."""
        names = names_in(file, optional=True)
        there = _installed(names)
        return [name for name in names if name not in there]

    def install(self, packages):
        """Installs packages with apt, as root or with sudo; ends the command if that fails."""
        install = ("apt-get", "install", "-y", "--no-install-recommends", *packages)
        if not self.may_install:
            refuse(f"--no-install: {len(packages)} packages are missing: {' '.join(packages)}")
        as_root, rights = (), "as root"
        if read("id", "-u").stdout.strip() != "0":
            if not shutil.which("sudo") or read("sudo", "-n", "true").code != 0:
                refuse("packages are missing and there is no password-free sudo; run: "
                       f"sudo apt-get update && sudo {' '.join(install)}")
            as_root, rights = ("sudo", "-n"), "with sudo"
        say(f"installing {len(packages)} packages by apt {rights}: {' '.join(packages)}")
        log = cache() / "packages.log"
        log.write_bytes(b"")
        if quietly(log, *as_root, "apt-get", "update") != 0:
            say(f"apt-get update reported problems ({log})")
        if quietly(log, *as_root, "env", "DEBIAN_FRONTEND=noninteractive", *install,
                   *OLDER_CONFIGURATION) != 0:
            lines = log.read_text(errors="replace").splitlines()
            for line in [line for line in lines if re.match("(E|W):", line)][-5:]:
                echo(line)
            raise Ended(INTERNAL_ERROR, f"apt-get failed; log: {log}")

    def tries(self, packages):
        """Installs packages that the command can do without. Returns false if that fails."""
        try:
            if packages:
                self.install(packages)
            return True
        except Ended as end:
            say(str(end))
            return False

    def setup(self, *lists, base=EVERYTHING):
        """Installs all packages of `base` and of these lists, and SUNDIALS. Prints the time of
        each of the two."""
        folder = cache()
        with (folder / "lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                say("another setup is running; waiting for it")
                fcntl.flock(lock, fcntl.LOCK_EX)
            watch = Stopwatch()
            if packages := self.missing(*lists, base=base):
                self.install(packages)
            optional = [name for file in base for name in self.missing_optional(file)]
            if not self.tries(optional):
                say(f"goes on without {' '.join(optional)}")
            watch.say(f"packages of {', '.join((*base, *lists))}")
            if not sundials.root():
                watch = Stopwatch()
                self._build_sundials(folder / "sundials.log")
                watch.say("SUNDIALS")
            say(sundials.in_use())

    def _build_sundials(self, log):
        say("building SUNDIALS in Release from Debian's source package, once (about a minute)")
        log.write_bytes(b"")
        code = quietly(log, sundials.SCRIPT, "build")
        if code >= 128:
            raise Ended(INTERRUPTED)
        if code != 0:
            say(f"WARNING: SUNDIALS could not be built from source; log: {log}")
            if packages := self.missing(base=(BUILD_LIST,)):
                self.install(packages)

    def ensure(self, *lists, base=EVERYTHING):
        """Runs the setup if something is missing. An installed tree has what it needs."""
        if place.INSTALLED:
            return
        if self.missing(*lists, base=base) or (found := sundials.root()) is None:
            self.setup(*lists, base=base)
        elif not found:
            say(sundials.in_use())


def npm_packages(folder):
    """Installs the packages of npm as a folder's lock file has them; npm keeps there a copy of
    the lock file that it last installed. Returns false if that fails."""
    lock = Path(folder) / "package-lock.json"
    kept = Path(folder) / "node_modules/.package-lock.json"
    with contextlib.suppress(FileNotFoundError):
        if kept.stat().st_mtime > lock.stat().st_mtime:
            return True
    return bool(shutil.which("npm")) and run("npm", "ci", "--silent", "--prefix", folder) == 0


def _setup(words, machine):
    no_words("setup", words)
    machine.setup()


COMMAND = Command(
    "setup", "",
    "installs what is missing: the packages of cmake/build_packages.txt and cmake/packages.txt "
    "by apt, and SUNDIALS in Release into ~/.cache/tress (TRESS_CACHE names another folder). "
    "Other commands do this first if something is missing; simulate needs no tests and tools.",
    _setup,
    example="./tress setup",
    time="minutes in a new Debian 12: the packages, then SUNDIALS in about a minute. A second if all "
         "is there.")
