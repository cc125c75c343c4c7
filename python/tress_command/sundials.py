"""The copy of SUNDIALS that programs are built with (cmake/sundials.sh)."""

from .processes import read

SCRIPT = "cmake/sundials.sh"
DEBIAN = ("WARNING: Debian's binary is in use, compiled at -O0, 3 to 7 times slower: do not "
          "compare timings; ./tress setup tries the source build again")


def root():
    """Returns the folder of the copy; "": Debian's binary, for the source build has failed;
    None: there is none yet."""
    done = read(SCRIPT, "root")
    return done.stdout.strip() if done.code == 0 else None


def in_use():
    """Returns what programs are built with, as a line."""
    return f"SUNDIALS: {root() or DEBIAN}"
