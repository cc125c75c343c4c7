"""Drawing time of a picture in the page's player."""
from .words import number

_SMOOTH = 30  # pictures per second


def pictures(tables):
    canvas, webgl, hair = (tables.row("player", {"draw": draw, "colour": colour}) for draw, colour in
                           [("canvas", "strand"), ("webgl", "strand"), ("webgl", "hair")])

    def rate(row):
        return number(1000 / row["picture_ms"])

    enough = "at least" if canvas["picture_ms"] <= 1000 / _SMOOTH else "not"
    return (f"Headless Chromium with software rendering draws {number(canvas['hairs'])} hairs of {number(canvas['points'])} points at "
            f"{number(canvas['width'])} x {number(canvas['height'])}. The canvas draws {rate(canvas)} pictures per second, {enough} the "
            f"{_SMOOTH} that look smooth. WebGL draws {rate(webgl)}, and {rate(hair)} with hair in light.")
