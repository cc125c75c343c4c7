"""run.py [--system FOLDER] PACKAGE.deb...: installs the packages in a new Debian system, which mmdebstrap makes
from the package sources of this machine, and runs debian/tests there, without the clone. Needs
root, for mounts. --system keeps the system in a folder, and uses one that is there."""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "debian/tests"


def stanzas():
    """Returns the tests of debian/tests/control with the packages that each needs."""
    text = (TESTS / "control").read_text(encoding="utf-8")
    return re.findall(r"^Tests: (\S+)\nDepends: (.+)$", text, re.MULTILINE)


def sources():
    """Returns the files that name the package sources of this machine."""
    files = [*Path("/etc/apt/sources.list.d").glob("*.sources"), Path("/etc/apt/sources.list"),
             *Path("/etc/apt/sources.list.d").glob("*.list")]  # fmt: skip
    return [str(file) for file in files if file.is_file() and "deb" in file.read_text()]


def in_system(system, *command):
    """Runs a command in the system, with /proc and /dev. Returns its exit code."""
    mounts = 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && exec chroot "$0" "$@"'
    return subprocess.run(["unshare", "-m", "sh", "-c", mounts, system, *command], check=False,
                          env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8",
                               "DEBIAN_FRONTEND": "noninteractive"}).returncode  # fmt: skip


def run_tests(system, packages):
    """Runs each test in its own turn, after its packages are installed. Returns the failed."""
    failed = []
    names = {Path(package).name.partition("_")[0]: f"/packages/{Path(package).name}" for package in packages}
    for test, depends in stanzas():
        wanted = [names.get(one.strip(), one.strip()) for one in depends.split(",")]
        # Packages of ours that those need come from the folder, too.
        wanted += [names["tress"]] if names["tress"] not in wanted else []
        install = ["apt-get", "install", "-y", "-q", "--no-install-recommends", *wanted]
        if in_system(system, *install) != 0:
            failed.append(f"{test} (packages)")
        elif in_system(system, f"/tests/{test}") != 0:
            failed.append(test)
        else:
            print(f"packages: {test}: ok", flush=True)
    return failed


def make_system(system):
    """Makes a new Debian system, which reaches the package sources as this machine does."""
    if not shutil.which("mmdebstrap"):
        sys.exit("packages: mmdebstrap is missing; install cmake/package_packages.txt")
    subprocess.run(["mmdebstrap", "--variant=apt", "--mode=root", "bookworm", system, *sources()],
                   check=True)  # fmt: skip


def fill(system, packages):
    """Copies packages, tests and the settings of apt into a system, and updates its lists."""
    for name in ("etc/resolv.conf", "etc/hosts"):
        shutil.copy(f"/{name}", system / name)
    for name in ("etc/apt/apt.conf.d", "etc/apt/auth.conf.d"):
        if Path(f"/{name}").is_dir():
            shutil.copytree(f"/{name}", system / name, dirs_exist_ok=True)
    for name, files in (("packages", packages), ("tests", TESTS.iterdir())):
        shutil.rmtree(system / name, ignore_errors=True)
        (system / name).mkdir()
        for file in files:
            shutil.copy(file, system / name)
    if in_system(system, "apt-get", "update", "-q") != 0:
        sys.exit("packages: the package sources cannot be reached from the new system")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--system", type=Path)
    parser.add_argument("packages", nargs="+", metavar="PACKAGE.deb")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tress-system-") as folder:
        system = options.system or Path(folder) / "root"
        if not system.exists():
            make_system(system)
        fill(system, options.packages)
        failed = run_tests(system, options.packages)
    print(f"packages: {len(stanzas()) - len(failed)} of {len(stanzas())} tests passed"
          + (f"; failed: {', '.join(failed)}" if failed else ""))  # fmt: skip
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
