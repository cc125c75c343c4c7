"""Drawing time of a picture in the page's player."""
from .words import number

_SMOOTH = 30  # pictures per second


def pictures(tables):
    canvas, webgl, hair = (tables.row("player", {"draw": draw, "colour": colour}) for draw, colour in
                           [("canvas", "strand"), ("webgl", "strand"), ("webgl", "hair")])

    def rate(row):
        return number(1000 / row["picture_ms"])

    enough = "at least" if canvas["picture_ms"] <= 1000 / _SMOOTH else "not"
    return (f"With software rendering, {number(canvas['hairs'])} hairs of {number(canvas['points'])} points at "
            f"{number(canvas['width'])} x {number(canvas['height'])} are drawn {rate(canvas)} times a second on the canvas "
            f"({enough} the {_SMOOTH} that look smooth), {rate(webgl)} times with WebGL, and {rate(hair)} times as hair in "
            "light, in headless Chromium.")
