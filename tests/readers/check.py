"""Compares what readers find in the files of one run with each other and with the run's own."""
from dataclasses import dataclass

import numpy
from own import Unreadable

TOLERANCE = 1e-6  # of the longest line
# Of a channel: half a step of the page, and the rounding of differences of floats.
STEP = 0.5 + 1e-4


def longest(counts, points):
    lengths = numpy.linalg.norm(numpy.diff(points, axis=0, append=points[-1:]), axis=1)
    lengths[numpy.cumsum(counts) - 1] = 0  # from one line to the next
    return numpy.add.reduceat(lengths, numpy.cumsum([0, *counts[:-1]])).max()


def exactly(a, b):
    return a == b


def within(bound):
    return lambda a, b: abs(a - b) <= bound


def close(a, b):
    return abs(a - b) <= TOLERANCE * abs(b)


@dataclass
class Figures:
    """The largest distances over the longest line: between readers, from the run's own points;
    from the page's in its steps."""
    readers: float = 0
    own: float = 0
    page: float = 0


class Check:
    """Complaints about the readings of a run, and figures."""

    def __init__(self, own, hair):
        self.own, self.hair = own, hair
        self.complaints, self.figures = [], Figures()
        self.scale = longest(own.counts, own.frames[0])
        self.same_time = within(1e-9 * own.times[-1])

    def say(self, file, what):
        self.complaints.append(f"{file}: {what}")

    def expect(self, file, name, found, wanted, like):
        found = numpy.array([] if found is None else found, dtype=float).ravel()
        wanted = numpy.array(wanted, dtype=float).ravel()
        if found.size != wanted.size:
            self.say(file, f"{name}: {found.size} instead of {wanted.size} numbers")
            return
        unlike = numpy.flatnonzero(~like(found, wanted))
        if unlike.size:
            i = unlike[0]
            self.say(file, f"{name}: {found[i]:.15g} instead of {wanted[i]:.15g} (number {i})")

    def points(self, file, frame, x):
        """Compares the points of one frame with the page's, the run's own and another reader's."""
        own = self.own
        paged = own.frames[frame]
        if x.shape != paged.shape:
            self.say(file, f"{len(x)} points, not {len(paged)}")
            return
        away = abs(x - paged)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            steps = away / own.quantum
        self.figures.page = max(self.figures.page, steps.max(initial=0, where=~numpy.isnan(steps)))
        off = numpy.argwhere(~(away <= own.quantum / 2 + TOLERANCE * self.scale))
        if off.size:
            i, c = off[0]
            self.say(file, f"point {i} is {away[i, c] / self.scale:.3g} of the length off the page's")
            return
        if own.knots is not None:
            self.knots(file, frame, x)
        if own.tips is not None:
            self.tip(file, frame, x)
        base = self.hair[frame]
        away = numpy.linalg.norm(x - base.points, axis=1) / self.scale
        self.figures.readers = max(self.figures.readers, away.max())
        off = numpy.flatnonzero(~(away <= TOLERANCE))
        if off.size:
            self.say(file, f"point {off[0]} is {away[off[0]]:.3g} of the length off {base.file}")

    def tip(self, file, frame, x):
        ends = x[numpy.cumsum(self.own.counts) - 1]
        if self.own.ids is not None:  # the mean one; of a tree it is the end of a line
            ends = ends.mean(axis=0, keepdims=True)
        away = numpy.linalg.norm(ends - self.own.tips[frame], axis=1).min() / self.scale
        self.figures.own = max(self.figures.own, away)
        if not away <= TOLERANCE:
            self.say(file, f"its tip is {away:.3g} of the length off the series'")

    def knots(self, file, frame, x):
        """The run's own points lie in this order on each exported line, its ends are theirs."""
        counts = numpy.array(self.own.counts)
        lines = numpy.full((len(counts), counts.max(), 3), numpy.inf)
        inside = numpy.arange(counts.max()) < counts[:, None]
        lines[inside] = x
        strands = self.own.knots[frame][self.own.ids]
        last = strands.shape[1] - 1
        nearest = numpy.empty(strands.shape[:2])
        place = numpy.zeros(len(counts), dtype=int)  # of the knot before, on its line
        for knot in range(last + 1):
            away = numpy.linalg.norm(lines - strands[:, None, knot], axis=2) / self.scale
            order = numpy.arange(counts.max())
            ahead = order >= place[:, None]
            if knot in (0, last):
                ahead = order == (place if knot == 0 else counts - 1)[:, None]
            away[~ahead] = numpy.inf
            found = away <= TOLERANCE
            place = numpy.where(found.any(axis=1), found.argmax(axis=1), away.argmin(axis=1))
            nearest[:, knot] = away[numpy.arange(len(counts)), place]
        self.figures.own = max(self.figures.own, nearest.max())
        off = numpy.argwhere(~(nearest <= TOLERANCE))
        if off.size:
            line, knot = off[0]
            self.say(file, f"point {knot} of strand {self.own.ids[line]} is {nearest[line, knot]:.3g} "
                           "of the length off the run's own")

    def of_hair(self):
        own = self.own
        for f, frame in enumerate(self.hair[:len(own.times)]):
            self.expect(frame.file, "points of lines", frame.counts, own.counts, exactly)
            self.expect(frame.file, "time", [frame.time], [own.times[f]], self.same_time)
            if own.radii is not None:
                self.expect(frame.file, "thickness", frame.thickness, own.per_point(2 * own.radii), close)
            self.points(frame.file, f, frame.points)
        if len(self.hair) != len(own.times):
            self.say(".hair files", f"{len(self.hair)} frames")

    def of_vtk(self, reading):
        own = self.own
        self.expect(reading.file, "times", reading.times, own.times, self.same_time)
        for f, frame in enumerate(reading.frames[:len(own.times)]):
            self.expect(frame.file, "points of lines", frame.counts, own.counts, exactly)
            self.expect(frame.file, "time", [frame.time], [own.times[f]], self.same_time)
            self.points(frame.file, f, frame.points)
            if own.radii is not None:
                self.expect(frame.file, "radius", frame.arrays.get("radius [m]"), own.per_point(own.radii), close)
                self.expect(frame.file, "strand", frame.arrays.get("strand"), own.per_point(own.ids), exactly)
            for channel in own.channels:
                self.expect(frame.file, channel.name, frame.arrays.get(channel.title), channel.frames[f],
                            within(channel.quantum * STEP))

    def of_usd(self, reading):
        own, file = self.own, f"{reading['file']} by {reading['reader']}"
        self.expect(file, "times", reading["times"], own.times, self.same_time)
        self.expect(file, "endTimeCode", [reading["ends"]], [own.times[-1]], self.same_time)
        self.expect(file, "curveVertexCounts", reading["counts"], own.counts, exactly)
        if not reading["upright"]:
            self.say(file, "upAxis or metersPerUnit")
        if reading["interpolation"] != ("constant" if own.radii is None else "uniform"):
            self.say(file, f"interpolation {reading['interpolation']} of widths")
        widths = [0.002] if own.radii is None else 2 * own.radii
        self.expect(file, "widths", reading["widths"], widths, close)
        if own.radii is not None:
            self.expect(file, "strand", reading.get("ids"), own.ids, exactly)
        margin = max(widths) / 2
        for f, frame in enumerate(reading["frames"][:len(own.times)]):
            x = as_points(frame)
            self.points(f"{file}, frame {f}", f, x)
            box = [*(x.min(axis=0) - margin), *(x.max(axis=0) + margin)]
            self.expect(f"{file}, frame {f}", "extent", frame["extent"], box, within(TOLERANCE * self.scale))

    def of_gltf(self, reading):
        own, file = self.own, f"{reading['file']} by {reading['reader']}"
        self.expect(file, "times", reading["times"], own.times.astype(numpy.float32), exactly)
        self.expect(file, "points of lines", reading["counts"], own.counts, exactly)
        if own.radii is not None:
            self.expect(file, "radius", reading.get("radius"), own.per_point(own.radii), close)
            self.expect(file, "strand", reading.get("strand"), own.per_point(own.ids), exactly)
        for f, frame in enumerate(reading["frames"][:len(own.times)]):
            self.points(f"{file}, frame {f}", f, as_points(frame))
        if "channels" not in reading:  # a reader that drops them
            return
        for channel in own.channels:
            frames = reading["channels"].get(channel.title, [])
            for f, wanted in enumerate(channel.frames):
                self.expect(f"{file}, frame {f}", channel.name, frames[f] if f < len(frames) else None, wanted,
                            within(channel.quantum * STEP))


def as_points(frame):
    return numpy.array(frame["points"], dtype=float).reshape(-1, 3)


def check(own, hair, vtk, usd, gltf):
    """Returns complaints about the readings of a run, and figures. A reading may be the reason
    why there is none."""
    failed = [str(part) for part in (vtk, usd, hair, gltf) if isinstance(part, Unreadable)]
    if failed:
        return failed, Figures()
    made = Check(own, hair)
    made.of_hair()
    if not made.complaints:  # the others are compared with it
        made.of_vtk(vtk)
        for reading in usd:
            made.of_usd(reading)
        for reading in gltf:
            made.of_gltf(reading)
    return made.complaints, made.figures


def check_drawn(found, other, own):
    """Returns complaints about what Blender found, compared with another reading of the same
    file, and the largest distance over the longest line. Blender keeps times as frames of its own
    rate, in floats, and neither radii nor strands of points."""
    complaints = []

    def say(what):
        complaints.append(f"{found['file']} by Blender: {what}")

    if found["counts"] != own.counts:
        say("points of lines")
    times = numpy.array(found["times"])
    if times.shape != own.times.shape or not (abs(times - own.times) <= 2 * 2**-23 * own.times[-1]).all():
        say(f"times {found['times']}")
    off = 0
    for f, (frame, wanted) in enumerate(zip(found["frames"], other["frames"])):
        x, y = as_points(frame), as_points(wanted)
        if x.shape != y.shape:
            say(f"frame {f}: {len(x)} points")
        else:
            off = max(off, abs(x - y).max() / longest(own.counts, own.frames[0]))
    if not off <= TOLERANCE:
        say(f"a point is {off} of the length off {other['reader']}'s")
    if not 1e-3 < found["covered"] < 0.9:
        say("its picture shows no lines")
    return complaints, off
