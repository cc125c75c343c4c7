"""Text of values on pages: numbers of few digits, shares, times, ranges, tables."""
import math
import numbers
import re
from decimal import ROUND_HALF_UP, Decimal

import pandas as pd

from .tables import InputError


def is_number(x):
    return isinstance(x, numbers.Real) and math.isfinite(x)


def exponential(decimal):
    """Returns a Decimal as "1.5e-7"."""
    first, *rest = map(str, decimal.normalize().as_tuple().digits)
    fraction = "." + "".join(rest) if rest else ""
    return f"{'-' if decimal < 0 else ''}{first}{fraction}e{decimal.adjusted()}"


def plain(x):
    """Returns the shortest decimal that reads back as x; "": x is no number."""
    if not is_number(x):
        return ""
    if float(x).is_integer():
        return str(int(x))
    text = repr(float(x))
    return exponential(Decimal(text)) if "e" in text else text


def _rounded(x, digits):
    """Returns x with this number of significant digits, ties away from zero."""
    exact = Decimal(float(x))
    return exact.quantize(Decimal(1).scaleb(exact.adjusted() - digits + 1), ROUND_HALF_UP)


def number(x, digits=2):
    """Returns x with this number of significant digits; powers of ten from 1e4 on and below 1e-3."""
    if not is_number(x):
        return ""
    if x == 0:
        return "0"
    size = abs(x)
    if 1e-3 <= size < 1e4:
        return plain(float(_rounded(x, max(digits, math.ceil(math.log10(size))))))
    return exponential(_rounded(x, digits))


def percent(x, digits=2):
    return f"{number(100 * x, digits)} %" if is_number(x) else ""


def signed_percent(x):
    return f"{'+' if is_number(x) and x > 0 else ''}{percent(x)}"


def duration(seconds, digits=2):
    """Returns a time in s, ms or µs; "": it is not positive."""
    if not is_number(seconds) or seconds <= 0:
        return ""
    if seconds >= 1:
        return f"{number(seconds, digits)} s"
    if seconds >= 1e-3:
        return f"{number(1e3 * seconds, digits)} ms"
    return f"{number(1e6 * seconds, digits)} µs"


def step(seconds):
    """Returns a time step, which has more digits than a measured time."""
    return duration(seconds, 3)


def span(values, text=number):
    """Returns the least and the largest of the values: "1 to 3", or one text if both print the same."""
    values = [x for x in values if is_number(x)]
    if not values:
        return ""
    ends = [text(min(values)), text(max(values))]
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def counted(count, noun):
    """Returns "1 thread", "2 threads"."""
    return f"{count} {noun if count == 1 else noun + 's'}"


def spaced(name):
    return name.replace("_", " ")


def code(names):
    """Returns names as code: "`der`, `corde`"."""
    return ", ".join(f"`{name}`" for name in names)


# Code and targets of links stay; "der" before a capital is German: "van der Heijden".
_IDS = re.compile(r'`[^`]*`|\]\([^)]*\)|(?<![\w./"])([a-z]\w*_\w+(?:\.csv)?|der(?! [A-Z])|corde|xpbd|vbd|rk4|bdf2|radau5|rodas5p|esdirk43|'
                  r"newmark)(?![\w/])", re.ASCII)


def coded(text):
    """Returns a text of a table with the ids of models, integrators and columns as code."""
    return _IDS.sub(lambda found: f"`{found[1]}`" if found[1] else found[0], text)


def is_set(flag):
    return str(flag).lower() in ("1", "true", "yes")


def must(condition, sentence):
    """Returns the sentence, which must not be printed if its condition is false."""
    if not condition:
        raise InputError(f'no longer true; rewrite the sentence: "{sentence}"')
    return sentence


def table(head, rows):
    """Returns a table as pages print it: a DataFrame of texts and numbers."""
    return pd.DataFrame([list(row) for row in rows], columns=head, dtype=object)


def bullets(sentences):
    return "\n".join(f"- {text}" for text in sentences)


def _cell(value):
    if value is None:
        return ""
    text = plain(value) if isinstance(value, numbers.Real) else coded(str(value))
    return text.replace("|", "\\|")


def markdown(frame):
    def line(cells):
        return f"| {' | '.join(map(_cell, cells))} |"

    return "\n".join([line(frame.columns), "|" + "---|" * len(frame.columns),
                      *(line(row) for row in frame.itertuples(index=False))])
