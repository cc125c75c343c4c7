"""One number of one file changed at a time, each of which the test must find."""
import json
import re
import struct
from collections.abc import Callable
from dataclasses import dataclass

import numpy


@dataclass(frozen=True)
class Spoil:
    kind: str  # of files: vtk, usd, hair, gltf
    what: str
    file: str
    said: str  # a pattern of what must be said of it
    change: Callable  # of the bytes of the file


def half(data):
    return data[:len(data) // 2]


def more(number, part):
    return repr(float(number) * (1 + part)).encode()


def replaced(pattern, by):
    """Changes the only group of a pattern of text, its first match."""

    def change(data):
        found = re.search(pattern, data)
        if not found:
            raise ValueError(f"nothing to spoil: {pattern}")
        return data[:found.start(1)] + by(found[1]) + data[found.end(1):]

    return change


def number(form, at, by):
    """Changes the number of this format of struct at a place of the file."""

    def change(data):
        made = bytearray(data)
        place = at(data) if callable(at) else at
        struct.pack_into(form, made, place, by(*struct.unpack_from(form, made, place)))
        return bytes(made)

    return change


def appended(array):
    """Returns the place of the first number of an array in the appended part of a .vtp file."""

    def place(data):
        offset = int(re.search(array + rb'[^>]* offset="(\d+)"', data)[1])
        start = b'<AppendedData encoding="raw">\n_'
        return data.index(start) + len(start) + offset + 4

    return place


class Glb:
    """A .glb file: its description, and its arrays as numbers that can be changed."""

    def __init__(self, data):
        (size,) = struct.unpack_from("<I", data, 12)
        self.head, self.chunk = data[:20], data[20 + size:28 + size]
        self.about = json.loads(data[20:20 + size])
        self.arrays = bytearray(data[28 + size:])

    def array(self, accessor, form):
        view = self.about["bufferViews"][self.about["accessors"][accessor]["bufferView"]]
        return numpy.frombuffer(self.arrays, form, view["byteLength"] // numpy.dtype(form).itemsize, view["byteOffset"])

    def floats(self, accessor):
        return self.array(accessor, "<f4")

    def bound(self, accessor, width):
        """Makes the bounds that an accessor of `width` numbers each states those that it has."""
        values = self.floats(accessor).reshape(-1, width)
        self.about["accessors"][accessor]["min"] = values.min(axis=0).tolist()
        self.about["accessors"][accessor]["max"] = values.max(axis=0).tolist()

    @property
    def lines(self):
        return self.about["meshes"][0]["primitives"][0]

    @property
    def sampler(self):
        return self.about["animations"][0]["samplers"][0]

    def bytes(self):
        text = json.dumps(self.about).encode()
        text += b" " * (-len(text) % 4)
        sizes = struct.pack("<II", 28 + len(text) + len(self.arrays), len(text))
        return self.head[:8] + sizes + self.head[16:] + text + self.chunk + self.arrays


def of_gltf(away):
    """Returns what is spoilt of a .glb file, what must be said of it, and how it is spoilt."""

    def coordinate(glb):
        position = glb.lines["targets"][0]["POSITION"]
        glb.floats(position)[0] += away
        glb.bound(position, 3)

    def strand(glb):
        glb.floats(glb.lines["attributes"]["_STRAND"])[0] += 1

    def radius(glb):
        glb.floats(glb.lines["attributes"]["_RADIUS"])[0] *= 1 + 1e-5

    def channel(glb):
        glb.floats(glb.lines["targets"][0]["_CURVATURE"])[0] += 1e3

    def end(glb):
        glb.about["accessors"][glb.lines["indices"]]["count"] -= 2

    def time(glb):
        glb.floats(glb.sampler["input"])[1] *= 1 + 1e-6
        glb.bound(glb.sampler["input"], 1)

    def weight(glb):
        glb.array(glb.sampler["output"], "u1")[len(glb.lines["targets"])] = 0

    def up(glb):
        del glb.about["nodes"][0]["rotation"]

    def bound(glb):
        glb.about["accessors"][glb.lines["attributes"]["POSITION"]]["max"][0] += 1e-3

    return (
        ("a coordinate", r"\.glb by three\.js, frame 1: point 0 of strand \d+ is .* off the run's own", coordinate),
        ("a strand", r"\.glb by three\.js: strand: 1 instead of 0", strand),
        ("a radius", r"\.glb by three\.js: radius: ", radius),
        ("a channel of a later frame", r"\.glb by glTF-Transform, frame 1: curvature: ", channel),
        ("the end of a line", r"\.glb by three\.js: points of lines: ", end),
        ("a time", r"\.glb by three\.js: times: ", time),
        ("a weight", r"\.glb by three\.js, frame 1: point \d+ is .* off the page's", weight),
        ("the axis that is up", r"\.glb by three\.js, frame 0: point 0 ", up),
        ("a bound", r"\.glb: ACCESSOR_MAX_MISMATCH", bound),
    )


def described(change):
    def changed(data):
        glb = Glb(data)
        change(glb)
        return glb.bytes()

    return changed


def spoils(name, away):
    """Returns what is spoilt in the files of a run. `away`: twice the tolerance of a coordinate, in m."""

    def farther(x):
        return repr(float(x) + away).encode()

    vtp, pvd, usda, hair, glb = (f"{name}{end}" for end in ("_00001.vtp", ".pvd", ".usda", "_00001.hair", ".glb"))
    return (
        Spoil("vtk", "a coordinate", vtp, r"_00001\.vtp: point 0 of strand \d+ is .* off the run's own",
              number("<f", appended(rb"<Points>\n<DataArray"), lambda x: x + away)),
        Spoil("vtk", "a strand", vtp, r"_00001\.vtp: strand: 1 instead of 0",
              number("<i", appended(b'Name="strand"'), lambda _: 1)),
        Spoil("vtk", "a radius", vtp, r"_00001\.vtp: radius: ",
              number("<f", appended(b'Name="radius .m."'), lambda r: r * (1 + 1e-5))),
        Spoil("vtk", "the end of a line", vtp, r"_00001\.vtp: points of lines: ",
              number("<i", appended(b'Name="offsets"'), lambda end: end - 1)),
        Spoil("vtk", "the time of a frame", vtp, r"_00001\.vtp: time: ",
              replaced(rb'format="ascii">([^<]+)', lambda t: more(t, 1e-6))),
        Spoil("vtk", "half of the file", vtp, r"_00001\.vtp: VTK cannot read it", half),
        Spoil("vtk", "a time of the list", pvd, r"\.pvd: times: ",
              replaced(rb'timestep="(0\.\d+)"', lambda t: more(t, 1e-6))),
        Spoil("usd", "a coordinate", usda,
              r"\.usda by TinyUSDZ, frame 0: point 0 of strand \d+ is .* off the run's own",
              replaced(rb"points\.timeSamples = \{\s+0: \[\(([^,]+)", farther)),
        # TinyUSDZ writes six digits of a time.
        Spoil("usd", "a time", usda, r"\.usda: three\.js finds other times for extent than points",
              replaced(rb"points\.timeSamples = \{\s+.*\n\s+([^:]+)", lambda t: more(t, 1e-6))),
        Spoil("usd", "frames a second", usda, r"\.usda by TinyUSDZ: times: ",
              replaced(rb"timeCodesPerSecond = (30)", lambda _: b"31")),
        Spoil("usd", "a width", usda, r"\.usda by TinyUSDZ: widths: ",
              replaced(rb"widths = \[([^,]+)", lambda width: more(width, 1e-5))),
        Spoil("usd", "a strand", usda, r"\.usda by TinyUSDZ: strand: 1 instead of 0",
              replaced(rb"primvars:strand = \[(0),", lambda _: b"1")),
        Spoil("usd", "an extent", usda, r"\.usda by TinyUSDZ, frame 0: extent: ",
              replaced(rb"extent\.timeSamples = \{\s+0: \[\(([^,]+)", farther)),
        Spoil("usd", "half of the file", usda, r"\.usda: TinyUSDZ cannot read it", half),
        Spoil("hair", "a coordinate", hair, r"_00001\.hair: point 0 of strand \d+ is .* off the run's own",
              number("<f", lambda data: 128 + 2 * struct.unpack_from("<I", data, 4)[0], lambda x: x + away)),
        Spoil("hair", "the thickness", hair, r"_00001\.hair: thickness: ",
              number("<f", 20, lambda width: width * (1 + 1e-5))),
        *(Spoil("gltf", what, glb, said, described(change)) for what, said, change in of_gltf(away)),
        Spoil("gltf", "half of the file", glb, r"\.glb: GLB_", half),
    )
