#!/usr/bin/env python3
"""Draws the pictures of scenes on the pages again, from runs of this build:

    python3 experiments/report/pictures.py [NAME...]     default: all

Runs scenes/NAME.toml with build/release/experiments/simulate, or with the program in build/first
where there is none, and writes results/NAME.png. Needs chromium and chromedriver."""
import argparse
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = [ROOT / f"build/{preset}/experiments/simulate" for preset in ("release", "first")]


@dataclass(frozen=True)
class Picture:
    time_s: float
    size: str  # WIDTH,HEIGHT, pixels
    address: str = ""  # what is seen, as in the address of the page
    options: tuple[str, ...] = ()  # of simulate


PICTURES = {
    "hair_under_wind": Picture(2.4, "900,700", "view=-60,15,1.5", ("--hairs", "400")),
}


def draw(name, picture, program):
    with tempfile.TemporaryDirectory(prefix="tress-picture-") as work:
        subprocess.run([program, ROOT / f"scenes/{name}.toml", "--out", work, *picture.options], check=True)
        film = Path(work) / "film"
        time = str(picture.time_s)
        subprocess.run(["node", ROOT / "experiments/report/dist/film.mjs", Path(work) / f"{name}.json", picture.address, film,
                        "--size", picture.size, "--from", time, "--to", time], check=True)
        shutil.copyfile(film / "00000.png", ROOT / f"results/{name}.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"scenes: {', '.join(PICTURES)}")
    names = parser.parse_args().names or list(PICTURES)
    if unknown := [name for name in names if name not in PICTURES]:
        parser.error(f"no picture of '{unknown[0]}'; there are {', '.join(PICTURES)}")
    program = next((one for one in PROGRAMS if one.is_file()), None)
    if program is None:
        parser.error("simulate is not built; run: ./tress build simulate")
    for name in names:
        try:
            draw(name, PICTURES[name], program)
        except subprocess.CalledProcessError as error:
            sys.exit(f"pictures: {name}: {Path(error.cmd[0]).name} ended with exit code {error.returncode}")
        print(f"results/{name}.png")


if __name__ == "__main__":
    main()
