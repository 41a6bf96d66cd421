"""Composition of isotropic tables as a NumPy user writes it. Usage: compose.py RINGS AZIMUTHS TABLES ROUNDS

TABLES: float64 file, two tables [ring][ring][azimuth 0 .. pi] and one weight for each ring.
Prints the median of the seconds of a composition, and the sum and the sum of squares of the result, as JSON.
"""
import json
import statistics
import sys
import time

import numpy as np


def orders(table):
    """Cosine transforms over azimuth as a stack of matrices, one contiguous matrix per order."""
    turn = np.concatenate([table, table[:, :, -2:0:-1]], axis=2)
    return np.ascontiguousarray(np.moveaxis(np.fft.rfft(turn).real, 2, 0))


def compose(a, b, weights, azimuths):
    product = (orders(a) * weights) @ orders(b) * (2 * np.pi / azimuths)
    return np.fft.irfft(np.moveaxis(product, 0, 2), azimuths)[:, :, :azimuths // 2 + 1]


def main():
    rings, azimuths, rounds = int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[4])
    size = rings * rings * (azimuths // 2 + 1)
    data = np.fromfile(sys.argv[3])
    a, b = data[:2 * size].reshape(2, rings, rings, -1)
    weights = data[2 * size:]
    seconds = []
    compose(a, b, weights, azimuths)
    for _ in range(rounds):
        start = time.perf_counter()
        c = compose(a, b, weights, azimuths)
        seconds.append(time.perf_counter() - start)
    print(json.dumps({"seconds": statistics.median(seconds), "sum": float(c.sum()), "squares": float((c * c).sum())}))


main()
