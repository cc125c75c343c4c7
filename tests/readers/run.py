"""Reads the files that tress writes for other programs, by readers of other makers.

    run.py SIMULATE     the program that runs scenes

Scenes of the repository, shortened: a curl, a head, strands of two radii, a tree. Their .vtp and
.pvd files are read by VTK, their .usda by TinyUSDZ and by the parser of three.js, their .glb by
Khronos' validator, three.js and glTF-Transform, and by Blender where that is installed, which
draws one; the .h5 of the head by h5py; .hair files, which no other reader reads, after their
description. All must have the points of the run within 1e-6 of the longest line, its times,
widths and strands. Then one number of one file is spoilt at a time: is it found? Needs Debian's
python3-vtk9 and python3-h5py, and npm ci in this folder. Exit codes: 0 all is well, 2 usage,
3 something differs."""
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from check import check, check_drawn, longest
from own import Unreadable, read_hair, read_own
from read_vtk import read_h5, read_pvd
from spoils import spoils

HERE = Path(__file__).resolve().parent
THIN_M = 30e-6


@dataclass(frozen=True)
class Scene:
    name: str
    changes: dict  # pattern of a line -> the line in its place
    head: bool = False
    thin: Callable | None = None  # of a strand: whether its radius is THIN_M
    blender: bool = False


# A last frame between two frames' times, and a head of which every second strand is shown.
SCENES = (
    Scene("curly_clump_oscillation", {"^duration_s = .*$": "duration_s = 0.0251"}),
    Scene("full_head", {"^duration_s = .*$": "duration_s = 0.035", "^count = .*$": "count = 2000"}, head=True),
    Scene("stiff_and_soft", {"^duration_s = .*$": "duration_s = 0.02", "^youngs_modulus_pa = .*$": "radius_m = 30e-6"},
          thin=lambda strand: strand >= 50, blender=True),
    Scene("willow", {"^duration_s = .*$": "duration_s = 0.05"}),
)


def run(simulate, scene, work):
    text = (HERE / "../../scenes" / f"{scene.name}.toml").read_text(encoding="utf-8")
    for line, by in scene.changes.items():
        text, changed = re.subn(line, by, text, count=1, flags=re.M)
        if not changed:
            raise ValueError(f"{scene.name}.toml: no line {line}")
    file = work / f"{scene.name}.toml"
    file.write_text(text, encoding="utf-8")
    made = subprocess.run([simulate, file, "--out", work, "--export", "vtk,usd,hair,gltf", "--progress", "none"],
                          capture_output=True, text=True)
    if made.returncode:
        raise RuntimeError(made.stderr)


def attempt(read, path):
    """Returns what is read, or the reason why nothing is."""
    try:
        return read(path)
    except Unreadable as problem:
        return problem


def read_in_node(files):
    """Returns, for each file, a reading by each reader that is an npm package, or why there is none."""
    made = subprocess.run(["node", HERE / "read_in_node.mjs", *files], stdout=subprocess.PIPE, text=True, check=True)
    found = [json.loads(line) for line in made.stdout.splitlines()]
    return [Unreadable(each["error"]) if "error" in each else each for each in found]


def read_blender(name, work, radius):
    """Returns what Blender finds in a .glb, and how much its picture shows; None where it is not
    installed."""
    if not shutil.which("blender"):
        return None
    made = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                           HERE / "read_blender.py", "--", work / f"{name}.glb", str(radius), work / f"{name}.png"],
                          capture_output=True, text=True)
    found = dict(re.findall("^(found|covered) (.*)$", made.stdout, re.M))
    if made.returncode or len(found) < 2:
        raise RuntimeError(f"read_blender.py: {made.stderr}")
    return {"file": f"{name}.glb", "covered": float(found["covered"]), **json.loads(found["found"])}


def size(path):
    files = path.iterdir() if path.is_dir() else [path]
    return f"{sum(file.stat().st_size for file in files) / 1000:.0f} kB"


def read_back(scene, work):
    """Returns complaints about the files of one scene, and what was read."""
    stem = work / scene.name
    folders = {kind: Path(f"{stem}_{kind}") for kind in ("vtk", "hair")}
    usda, glb = Path(f"{stem}.usda"), Path(f"{stem}.glb")
    usd, gltf = read_in_node([usda, glb])
    readings = {
        "own": read_own(stem, read_h5(Path(f"{stem}.h5")) if scene.head else None),
        "vtk": attempt(read_pvd, folders["vtk"] / f"{scene.name}.pvd"),
        "hair": attempt(read_hair, folders["hair"]),
        "usd": usd,
        "gltf": gltf,
    }
    complaints, figures = check(**readings)
    own = readings["own"]
    print(f"{scene.name}: {len(own.times)} frames of {len(own.counts)} lines; .vtp {size(folders['vtk'])}, "
          f".usda {size(usda)}, .hair {size(folders['hair'])}, .glb {size(glb)}; off the run's own {figures.own:.1e}, "
          f"between readers {figures.readers:.1e} of the longest line, off the page's {figures.page:.3f} of its steps")
    if scene.thin and any(scene.thin(strand) != (radius == THIN_M) for strand, radius in zip(own.ids, own.radii)):
        complaints.append(f"{scene.name}: radii that the scene does not give")
    return complaints, readings


def drawn_by_blender(name, work, readings):
    """Returns complaints about what Blender finds and draws; none where it is not installed."""
    width = 2e-3  # of the longest line: a tube is seen
    own = readings["own"]
    found = read_blender(name, work, width * longest(own.counts, own.frames[0]))
    if found is None:
        print("Blender is not installed: its test is left out")
        return []
    complaints, off = check_drawn(found, readings["gltf"][0], own)
    print(f"Blender: {len(found['counts'])} lines, off three.js {off:.1e} of the longest, "
          f"{100 * found['covered']:.2f} % of its picture covered")
    return complaints


def spoilt_copy(spoil, name, work, folder):
    """Writes the files of a kind into a folder, one of them spoilt; returns its path."""
    folder.mkdir()
    alone = spoil.kind in ("usd", "gltf")  # one file of all frames
    source = work if alone else work / f"{name}_{spoil.kind}"
    if not alone:
        shutil.copytree(source, folder, dirs_exist_ok=True)
    (folder / spoil.file).write_bytes(spoil.change((source / spoil.file).read_bytes()))
    return folder / spoil.file


def not_found(name, readings, work):
    """Returns the number of spoilt files, and a line for each that the test does not find."""
    own = readings["own"]
    all_spoils = spoils(name, 2e-6 * longest(own.counts, own.frames[0]))
    files = [spoilt_copy(spoil, name, work, work / f"spoilt_{i}") for i, spoil in enumerate(all_spoils)]
    in_node = [file for spoil, file in zip(all_spoils, files) if spoil.kind in ("usd", "gltf")]
    by_node = dict(zip(in_node, read_in_node(in_node), strict=True))
    missed = []
    for spoil, file in zip(all_spoils, files):
        if spoil.kind == "vtk":
            read = attempt(read_pvd, file.with_name(f"{name}.pvd"))
        elif spoil.kind == "hair":
            read = attempt(read_hair, file.parent)
        else:
            read = by_node[file]
        complaints, _ = check(**{**readings, spoil.kind: read})
        if not any(re.search(spoil.said, complaint) for complaint in complaints):
            missed.append(f"{spoil.file}: {spoil.what} was spoilt, which is not found "
                          f"({'; '.join(complaints) or 'nothing said'})")
    return len(all_spoils), missed


def main(simulate):
    failures = []
    with tempfile.TemporaryDirectory(prefix="tress-readers-") as work:
        work = Path(work)
        for scene in SCENES:
            since = time.monotonic()
            run(Path(simulate).resolve(), scene, work)
            complaints, readings = read_back(scene, work)
            if scene.blender and not complaints:
                complaints += drawn_by_blender(scene.name, work, readings)
            if scene.head and not complaints:
                count, missed = not_found(scene.name, readings, work)
                print(f"spoilt files: {count - len(missed)} of {count} found")
                complaints += missed
            print(f"{scene.name}: {time.monotonic() - since:.1f} s", flush=True)
            failures += complaints
    for failure in failures:
        print(f"FAILED: {failure}")
    return 3 if failures else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print("usage: run.py SIMULATE", file=sys.stderr)
        sys.exit(2)
    sys.exit(main(sys.argv[1]))
