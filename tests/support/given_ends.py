"""Identify by least squares alone: ends as the scene has them, orders as said or the lowest."""

from dataclasses import replace

import numpy as np

import ropedyn as rd


def fitted(scene, measured, unknown, **options):
    """Call `identify` with peaks that say which modes they are: the lowest, unless they do."""
    if "orders" not in options:
        many = isinstance(measured, list) and any(isinstance(one, rd.Peaks) for one in measured)
        measured = [_numbered(one) for one in measured] if many else _numbered(measured)
    return rd.identify(scene, measured, unknown, ends="given", **options)


def _numbered(peaks):
    peaks = peaks if isinstance(peaks, rd.Peaks) else rd.Peaks(peaks)
    if peaks.order is not None:
        return peaks
    order = np.argsort(np.argsort(peaks.frequency, kind="stable")) + 1
    return replace(peaks, order=order.tolist())
