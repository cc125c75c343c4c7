"""Results of one scene: each file has a folder of its own, for two may have one name."""

import os
import subprocess

from .messages import refuse
from .place import shipped


def existing(scene):
    """Returns the scene file of this name, else the shipped one of an installed tree."""
    there = shipped(scene)
    return there if not os.path.exists(scene) and os.path.isfile(there) else scene


def scene_folder(verb, words):
    """Checks the scene file that stands first. Returns the folder of its results."""
    scene = words[0] if words else ""
    if not scene or scene.startswith("-"):
        refuse(f"{verb}: give one scene file first, as in ./tress {verb} scenes/cantilever.toml")
    scene = existing(scene)
    if os.path.isdir(scene):
        refuse(f"{verb}: '{scene}' is a folder; give a scene file")
    if not os.path.isfile(scene):
        refuse(f"{verb}: no file '{scene}'; paths are relative to {os.getcwd()}")
    if "," in scene:
        refuse(f"{verb}: '{scene}' has a comma, which stands between scenes here; rename it, or "
               "its folder")
    name = scene.rpartition("/")[2].removesuffix(".toml")
    name = "".join(c if c.isalnum() or c in "._-" else "_" for c in name)
    path = os.fsencode(os.path.realpath(scene) + "\n")
    checksum = subprocess.run(["cksum"], input=path, capture_output=True, check=True).stdout
    return f"results/{verb}/{name}-{checksum.split()[0].decode()}"
