"""Ratios of paired timings, judged by their order, without a model of their noise."""

import math
from statistics import median


def _rank(n, confidence):
    """Returns the order statistic, counted from 0, that with its mirror encloses the median
    with at least this confidence, whatever the distribution: each value is above the median
    with probability 1/2. -1: there are too few values."""
    # Twice the probability that at most k of n fair coins show heads, term by term; its
    # logarithm, for 2^-n may be too small for a number.
    log_term = (1 - n) * math.log(2)
    total = math.exp(log_term)
    k = -1
    while total <= 1 - confidence and k < n:
        k += 1
        log_term += math.log((n - k) / (k + 1))
        total += math.exp(log_term)
    return k


def fewest(confidence):
    """Returns the smallest number of values that have an interval of this confidence."""
    n = 1
    while _rank(n, confidence) < 0:
        n += 1
    return n


def spread(values, confidence):
    """Returns the median and its interval; [0, infinity] if there are too few values."""
    values = sorted(values)
    k = _rank(len(values), confidence)
    return {
        "ratio": median(values),
        "low": 0 if k < 0 else values[k],
        "high": math.inf if k < 0 else values[-1 - k],
    }


def verdict(interval, threshold):
    """Returns "slower" or "faster" if the ratio is beyond the threshold (1.05: by 5 %) and its
    interval excludes 1, else "same"."""
    if interval["ratio"] > threshold and interval["low"] > 1:
        return "slower"
    if interval["ratio"] < 1 / threshold and interval["high"] < 1:
        return "faster"
    return "same"
