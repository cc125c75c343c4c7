"""run.py PACKAGE.deb...: installs the packages in a new Debian system, which mmdebstrap makes
from the package sources of this machine, and runs debian/tests there, without the clone. Needs root, for mounts."""

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


def main():
    packages = sys.argv[1:] or sys.exit(__doc__)
    if not shutil.which("mmdebstrap"):
        sys.exit("packages: mmdebstrap is missing; install cmake/package_packages.txt")
    with tempfile.TemporaryDirectory(prefix="tress-system-") as folder:
        system = f"{folder}/root"
        subprocess.run(["mmdebstrap", "--variant=apt", "--mode=root", "bookworm", system, *sources()],
                       check=True)  # fmt: skip
        # How this machine reaches the sources.
        for name in ("etc/resolv.conf", "etc/hosts"):
            shutil.copy(f"/{name}", f"{system}/{name}")
        for name in ("etc/apt/apt.conf.d", "etc/apt/auth.conf.d"):
            shutil.copytree(f"/{name}", f"{system}/{name}", dirs_exist_ok=True)
        for name, files in (("packages", packages), ("tests", TESTS.iterdir())):
            (Path(system) / name).mkdir()
            for file in files:
                shutil.copy(file, Path(system) / name)
        failed = run_tests(system, packages)
    print(f"packages: {len(stanzas()) - len(failed)} of {len(stanzas())} tests passed"
          + (f"; failed: {', '.join(failed)}" if failed else ""))  # fmt: skip
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
