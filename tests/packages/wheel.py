"""wheel.py: builds the wheel of this clone, as docs/about/packages.md does, installs it in a new
Debian system, and there imports the module, runs a shipped scene and an example, without the
clone and without a network. The system gets the packages of cmake/wheel_packages.txt and no
others. Needs root, for mounts."""

import subprocess
import sys
import tempfile
from pathlib import Path

from clean_system import fill, in_system, install, make_system
from debian_tests import ROOT, report

LIST = ROOT / "cmake/wheel_packages.txt"
FILES = (ROOT / "scenes/cantilever.toml", ROOT / "python/examples/first_run.py",
         ROOT / "tests/packages/use_wheel.py")  # fmt: skip
PYTHON = "/environment/bin/python"
# What a user types in the new system.
STEPS = {
    "environment": ("python3", "-m", "venv", "--system-site-packages", "/environment"),
    "installation": ("sh", "-c", f"{PYTHON} -m pip install -q --no-index --no-deps /wheel/*.whl"),
    "shipped scene": (PYTHON, "/files/use_wheel.py", "/files/cantilever.toml"),
    "example": (PYTHON, "/files/first_run.py"),
}


def build(folder):
    """Builds the wheel of the clone in a folder. Returns its path."""
    subprocess.run(["/usr/bin/python3", "-m", "pip", "wheel", "-q", "--no-build-isolation", "--no-deps",
                    "-w", folder, ROOT], check=True)  # fmt: skip
    (wheel,) = Path(folder).glob("tress-*.whl")
    return wheel


def main():
    lines = (line.partition("#")[0].strip() for line in LIST.read_text(encoding="utf-8").splitlines())
    packages = [line for line in lines if line]
    with tempfile.TemporaryDirectory(prefix="tress-wheel-") as folder:
        wheel = build(folder)
        print(f"wheel: {wheel.name}, {wheel.stat().st_size / 1e6:.1f} MB", flush=True)
        system = Path(folder) / "root"
        make_system(system, "--mode=root")
        fill(system, wheel=[wheel], files=FILES)
        if install(system, *packages) != 0:
            sys.exit("wheel: the packages of cmake/wheel_packages.txt cannot be installed")
        failed = []
        for step, command in STEPS.items():
            # A step needs those before it.
            if failed or in_system(system, *command, network=False) != 0:
                failed.append(step)
    return report("wheel", STEPS, failed)


if __name__ == "__main__":
    sys.exit(main())
