"""The point Gram and distance matrices as a NumPy user writes them. Usage: gram.py NODES LOBES

NODES: float64 file, 8 rows (cos_i cos_o cos_h cos_d tan2_h log_cos_h log_rv factor) of nodes.
LOBES: text, a line "model c0 c1 c2 c3" per lobe.
Prints seconds of evaluation, of products and of distances, and the trace and the sum of the Gram matrix for
comparison, as JSON.
"""
import json
import sys
import time

import numpy as np

MODELS = {
    "lambert": lambda g, c: np.full_like(g[0], c[0]),
    "blinn": lambda g, c: c[0] * np.exp(c[1] * g[5]),
    "phong": lambda g, c: c[0] * np.exp(c[1] * g[6]),
    "ward": lambda g, c: c[0] * np.exp(c[1] * g[4]) / np.sqrt(g[0] * g[1]),
    "cook_torrance": lambda g, c: c[0] * np.exp(c[1] * g[4] - 4 * g[5])
    * np.minimum(1, 2 * g[2] * np.minimum(g[0], g[1]) / g[3])
    * (c[2] + c[3] * (1 - g[3]) ** 5) / (g[0] * g[1]),
    "lafortune": lambda g, c: c[0] * np.exp(c[3] * np.log(np.maximum(
        c[1] * (2 * g[3] ** 2 - 1 - g[0] * g[1]) + c[2] * g[0] * g[1], 1e-30))),
    "metal_phong": lambda g, c: c[0] * np.exp(c[1] * g[6]) / np.maximum(g[0], g[1]),
    "minnaert": lambda g, c: c[0] * (g[0] * g[1]) ** c[1],
    "oren_nayar": lambda g, c: c[0] + c[1] * np.maximum(0, 2 * g[3] ** 2 - 1 - g[0] * g[1]) / np.maximum(g[0], g[1]),
    "exponential_patch": lambda g, c: c[0] * np.exp(2 * c[1] * g[3] * g[2] * np.sqrt(g[4])),
}


def main():
    nodes = np.fromfile(sys.argv[1]).reshape(8, -1)
    lobes = [(line.split()[0], [float(x) for x in line.split()[1:]]) for line in open(sys.argv[2])]
    gram = np.zeros((len(lobes), len(lobes)))
    evaluate = products = 0.0
    chunk = 4096
    with np.errstate(under="ignore"):
        for first in range(0, nodes.shape[1], chunk):
            start = time.perf_counter()
            g = nodes[:, first:first + chunk]
            samples = np.stack([MODELS[model](g, c) * g[7] for model, c in lobes])
            middle = time.perf_counter()
            gram += samples @ samples.T
            end = time.perf_counter()
            evaluate += middle - start
            products += end - middle
    start = time.perf_counter()
    squares = np.diag(gram)
    distance = np.sqrt(np.maximum(squares[:, None] - 2 * gram + squares, 0))
    distances = time.perf_counter() - start
    assert np.isfinite(distance).all()
    print(json.dumps({"evaluate": evaluate, "products": products, "distances": distances,
                      "trace": float(np.trace(gram)), "sum": float(gram.sum())}))


main()
