"""Numbers as tables and pages print them: 0.00001 and 100000 have no exponent, 1e-7 has."""

SMALLEST_EXPONENT = -6


def precise(value, digits):
    """Returns a number with so many significant digits."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    exponent = int(exponent)
    if SMALLEST_EXPONENT <= exponent < digits:
        return f"{value:.{digits - 1 - exponent}f}"
    return f"{mantissa}e{exponent:+d}"


def shortest(value):
    """Returns the shortest text that reads back as the same number."""
    if value == int(value) and abs(value) < 1e21:
        return str(int(value))
    mantissa, _, exponent = repr(float(value)).partition("e")
    if not exponent:
        return mantissa
    if SMALLEST_EXPONENT <= (exponent := int(exponent)) < 0:
        digits = len(mantissa.lstrip("-").replace(".", ""))
        return f"{value:.{digits - 1 - exponent}f}"
    return f"{mantissa}e{exponent:+d}"


def rounded(value, digits):
    """Returns the shortest text of a number that is rounded to so many significant digits."""
    return shortest(float(f"{value:.{digits}g}"))
