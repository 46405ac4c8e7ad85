"""Medians, shares and goals: the arithmetic of the benchmarks, without any I/O. Times in seconds unless a name says otherwise."""
import collections
import math

Goal = collections.namedtuple('Goal', 'name value limit unit')
"""A figure that shall be at most `limit`; value None: not measured in this run."""


def percentile(values, share):
    """The smallest value that at least this share (0..1) of the values does not exceed (nearest rank); None of nothing."""
    if not values:
        return None
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def median(values):
    """The middle value, or the mean of the two in the middle; None of nothing."""
    if not values:
        return None
    ordered = sorted(values)
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else (ordered[middle - 1] + ordered[middle]) / 2.0


def mean(values):
    return sum(values) / len(values) if values else None


def summary(values):
    """What a table shows of many samples. Negative ones stand for something that never came, and are counted."""
    seen = [value for value in values if value >= 0.0]
    return {'count': len(values), 'missing': len(values) - len(seen), 'median': median(seen), 'mean': mean(seen),
            'p99': percentile(seen, 0.99), 'max': max(seen) if seen else None}


def histogram(values, width, bins):
    """How many values are in each of `bins` bins of this width from 0 on; what is beyond is in the last one."""
    counts = [0] * bins
    for value in values:
        if value >= 0.0:
            counts[min(bins - 1, int(value / width))] += 1
    return counts


def ratio(value, base):
    """value / base; None where either is missing."""
    return value / base if value is not None and base else None


def pair_ratios(values, bases):
    """Ratios of what was measured in alternation: each value against the base of the same round."""
    return [ratio(value, base) for value, base in zip(values, bases) if ratio(value, base) is not None]


def spread(values):
    """(least, most) of the values that there are; None of nothing."""
    present = [value for value in values if value is not None]
    return (min(present), max(present)) if present else None


def verdict(goal):
    """'met', 'MISSED' or 'not measured'."""
    if goal.value is None:
        return 'not measured'
    return 'met' if goal.value <= goal.limit else 'MISSED'
