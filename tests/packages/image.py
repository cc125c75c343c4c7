"""image.py PACKAGE.deb...: builds the image of packaging/Containerfile from the packages and runs
it without a network: debian/tests of the packages that it has, and a scene in a mounted folder.
Its base is a new Debian system of mmdebstrap in place of debian:12-slim, so that no registry
is needed. Needs buildah and podman, and no root where the user has subordinate ids. Options for
podman of this machine stand in the file that CONTAINERS_CONF names."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from clean_system import make_system
from debian_tests import ROOT, TESTS, report, stanzas

BASE, IMAGE = "localhost/tress-base", "localhost/tress-test"
SCENE = "scenes/cantilever.toml"  # shipped, named by its short path


def build(folder, packages):
    """Builds the image from copies of the packages in a folder, as docs/about/packages.md does."""
    make_system(f"{folder}/base.tar")
    subprocess.run(["podman", "import", "-q", f"{folder}/base.tar", BASE], check=True)
    context = Path(folder) / "packages"
    context.mkdir()
    for package in packages:
        (context / Path(package).name).write_bytes(Path(package).read_bytes())
    # Isolation by chroot needs no container runtime.
    subprocess.run(["buildah", "build", "--pull-never", "--build-arg", f"BASE={BASE}",
                    "-f", ROOT / "packaging/Containerfile", "-t", IMAGE, context],
                   check=True, env={"BUILDAH_ISOLATION": "chroot", **os.environ})  # fmt: skip


def in_image(*words):
    """Runs the image without a network. Returns the exit code."""
    return subprocess.run(["podman", "run", "--rm", "--network=none", *words], check=False).returncode


def run_scene(folder):
    """Runs a scene as a user does, and looks for its results in the mounted folder."""
    code = in_image("--volume", f"{folder}:/data", IMAGE, "simulate", SCENE)
    return code == 0 and any(Path(folder).glob("results/simulate/*/report.html"))


def main():
    packages = sys.argv[1:] or sys.exit(__doc__)
    with tempfile.TemporaryDirectory(prefix="tress-image-") as folder:
        build(folder, packages)
        data = Path(folder) / "data"
        data.mkdir()
        passed = {"mounted folder": run_scene(data)}
        for test, depends in stanzas():
            if set(depends) <= {"tress", "python3-tress"}:
                passed[test] = in_image("--volume", f"{TESTS}:/tests:ro", "--entrypoint", f"/tests/{test}",
                                        IMAGE) == 0  # fmt: skip
    subprocess.run(["podman", "rmi", "-f", IMAGE, BASE], check=False, stdout=subprocess.DEVNULL)
    return report("image", passed, [name for name, good in passed.items() if not good])


if __name__ == "__main__":
    sys.exit(main())
