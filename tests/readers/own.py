"""What a run wrote for tress: its page, its time series, its .hair files."""
import base64
import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy


class Unreadable(Exception):
    pass


@dataclass
class Channel:
    title: str  # as in the exported files
    name: str
    quantum: float
    frames: numpy.ndarray  # frames x points


@dataclass
class Own:
    """The page has positions in 16 bits of their box and channels in 8 bits of their range, radii
    and times in full; the series has the tip, of strands the mean one, in full."""
    times: numpy.ndarray
    counts: list  # points of each line
    ids: list | None  # strand of each line; None for a tree
    radii: numpy.ndarray | None  # m, of each line
    frames: numpy.ndarray  # frames x points x 3
    quantum: numpy.ndarray  # of x, y, z
    channels: list
    knots: list | None = None  # of each frame, strands x points x 3: every strand's own points
    tips: numpy.ndarray | None = None  # frames x 3

    def per_point(self, of_lines):
        return numpy.repeat(of_lines, self.counts)


def read_own(stem, head_frames=None):
    """Reads the files that begin with `stem`. `head_frames`: the points in the file of a head."""
    page = json.loads(Path(f"{stem}.json").read_text(encoding="utf-8"))
    shape = (len(page["times_s"]), sum(page["strand_points"]))
    low, high = numpy.array(page["low"]), numpy.array(page["high"])
    quantum = (high - low) / 65535
    places = numpy.frombuffer(base64.b64decode(page["positions"]), "<u2")
    if places.size != 3 * shape[0] * shape[1]:
        raise Unreadable(f"{stem}.json: thinned frames")
    channels = []
    for channel in page["channels"]:
        step = (channel["high"] - channel["low"]) / 255
        values = numpy.frombuffer(base64.b64decode(channel["values"]), "u1").reshape(shape)
        channels.append(Channel(f"{channel['name']} [{channel['unit']}]", channel["name"], step,
                                channel["low"] + values * step))
    radii = page.get("radius_m")
    own = Own(numpy.array(page["times_s"]), page["strand_points"], page.get("strand_ids"),
              None if radii is None else numpy.array(radii), low + places.reshape(*shape, 3) * quantum, quantum,
              channels, head_frames)
    if head_frames is None:
        own.tips = numpy.loadtxt(f"{stem}.csv", delimiter=",", skiprows=1, usecols=(1, 2, 3), ndmin=2)
    return own


@dataclass
class HairFrame:
    file: str
    time: float
    counts: list
    points: numpy.ndarray
    thickness: numpy.ndarray


def read_frame(path):
    """Reads a .hair file after its description by Yuksel; there is no other reader to install."""
    data = path.read_bytes()
    strands, points, arrays, usual_segments = numpy.frombuffer(data, "<u4", 4, 4).tolist()
    if data[:4] != b"HAIR" or not arrays & 2 or arrays & 24:
        raise Unreadable(f"{path.name}: not a .hair file with points and without colours")
    segments = numpy.full(strands, usual_segments)
    at = 128
    if arrays & 1:
        segments = numpy.frombuffer(data, "<u2", strands, at)
        at += 2 * strands
    if len(data) != at + 4 * points * (4 if arrays & 4 else 3):
        raise Unreadable(f"{path.name}: its size")
    places = numpy.frombuffer(data, "<f4", 3 * points, at).reshape(-1, 3).astype(float)
    thickness = numpy.full(points, numpy.frombuffer(data, "<f4", 1, 20))
    if arrays & 4:
        thickness = numpy.frombuffer(data, "<f4", points, at + 12 * points)
    said = re.search(rb"tress: (\S+) s, m, z up", data[40:128])
    time = float(said[1]) if said else numpy.nan
    return HairFrame(path.name, time, (segments.astype(int) + 1).tolist(), places, thickness.astype(float))


def read_hair(folder):
    return [read_frame(path) for path in sorted(folder.iterdir())]
