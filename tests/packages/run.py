"""run.py [--system FOLDER] PACKAGE.deb...: installs the packages in a new Debian system and runs
debian/tests there, without the clone and without a network. Needs root, for mounts. --system
keeps the system in a folder, and uses one that is there."""

import argparse
import sys
import tempfile
from pathlib import Path

from clean_system import fill, in_system, install, make_system
from debian_tests import TESTS, report, stanzas


def run_tests(system, packages):
    """Runs each test in its own turn, after its packages are installed. Returns the failed."""
    failed = []
    names = {Path(package).name.partition("_")[0]: f"/packages/{Path(package).name}" for package in packages}
    for test, depends in stanzas():
        wanted = [names.get(one, one) for one in depends]
        # Packages of ours that those need come from the folder, too.
        wanted += [names["tress"]] if names["tress"] not in wanted else []
        if install(system, *wanted) != 0:
            failed.append(f"{test} (packages)")
        elif in_system(system, f"/tests/{test}", network=False) != 0:
            failed.append(test)
        else:
            print(f"packages: {test}: ok", flush=True)
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--system", type=Path)
    parser.add_argument("packages", nargs="+", metavar="PACKAGE.deb")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tress-system-") as folder:
        system = options.system or Path(folder) / "root"
        if not system.exists():
            make_system(system, "--mode=root")
        fill(system, packages=options.packages, tests=TESTS.iterdir())
        failed = run_tests(system, options.packages)
    return report("packages", stanzas(), failed)


if __name__ == "__main__":
    sys.exit(main())
