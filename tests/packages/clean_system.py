"""A new Debian system without the clone, which mmdebstrap makes from the package sources of this
machine. Commands in it need root, for mounts."""

import shutil
import subprocess
import sys
from pathlib import Path


def sources():
    """Returns the files that name the package sources of this machine."""
    files = [*Path("/etc/apt/sources.list.d").glob("*.sources"), Path("/etc/apt/sources.list"),
             *Path("/etc/apt/sources.list.d").glob("*.list")]  # fmt: skip
    return [str(file) for file in files if file.is_file() and "deb" in file.read_text()]


def make_system(target, *options):
    """Makes a new system as a folder or, where the name ends in .tar, as an archive. It reaches
    the package sources as this machine does."""
    if not shutil.which("mmdebstrap"):
        sys.exit("packages: mmdebstrap is missing; install cmake/clean_system_packages.txt")
    subprocess.run(["mmdebstrap", "--variant=apt", *options, "bookworm", target, *sources()],
                   check=True)  # fmt: skip


def fill(system, **folders):
    """Copies files into folders of a system, with the settings of apt, and updates its lists."""
    for name in ("etc/resolv.conf", "etc/hosts"):
        shutil.copy(f"/{name}", system / name)
    for name in ("etc/apt/apt.conf.d", "etc/apt/auth.conf.d"):
        if Path(f"/{name}").is_dir():
            shutil.copytree(f"/{name}", system / name, dirs_exist_ok=True)
    for name, files in folders.items():
        shutil.rmtree(system / name, ignore_errors=True)
        (system / name).mkdir()
        for file in files:
            shutil.copy(file, system / name)
    if in_system(system, "apt-get", "update", "-q") != 0:
        sys.exit("packages: the package sources cannot be reached from the new system")


def in_system(system, *command, network=True):
    """Runs a command in the system, with /proc and /dev. Returns its exit code."""
    mounts = 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && exec chroot "$0" "$@"'
    new = ["unshare", "-m"] if network else ["unshare", "-m", "-n"]
    return subprocess.run([*new, "sh", "-c", mounts, system, *command], check=False,
                          env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8",
                               "DEBIAN_FRONTEND": "noninteractive"}).returncode  # fmt: skip


def install(system, *packages):
    """Installs packages in the system. Returns the exit code of apt-get."""
    return in_system(system, "apt-get", "install", "-y", "-q", "--no-install-recommends", *packages)
