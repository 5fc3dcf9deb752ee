"""The solver's answers against SciPy's linear_sum_assignment on the padded matrix of Eq. 5.

usage: assignment_scipy_test.py ASSIGNMENT_DUMP
"""
import subprocess
import sys

import numpy as np
from scipy.optimize import linear_sum_assignment


def check(sources, targets, threshold, energy, edges, target_of_source):
    size = max(sources, targets)
    padded = np.full((size, size), threshold, dtype=np.int64)
    for source, target, cost in edges:
        padded[source, target] = cost
    rows, columns = linear_sum_assignment(padded)
    # The padding adds size - sources rows, each at the threshold.
    least = int(padded[rows, columns].sum()) - threshold * (size - sources)
    assert energy == least, f"{sources} x {targets}: energy {energy}, SciPy {least}"

    cost_of = {(source, target): cost for source, target, cost in edges}
    matched = [(s, t) for s, t in enumerate(target_of_source) if t != -1]
    assert len({t for _, t in matched}) == len(matched), "a target is matched twice"
    spent = sum(cost_of[pair] for pair in matched) + threshold * (sources - len(matched))
    assert spent == energy, f"{sources} x {targets}: the matches cost {spent}, the energy says {energy}"


def main(dump):
    words = iter(map(int, subprocess.run([dump], check=True, capture_output=True, text=True).stdout.split()))
    problems = next(words)
    assert problems >= 200, f"only {problems} problems"
    all_edges = 0
    for _ in range(problems):
        sources, targets, edge_count, threshold, energy = (next(words) for _ in range(5))
        edges = [(next(words), next(words), next(words)) for _ in range(edge_count)]
        check(sources, targets, threshold, energy, edges, [next(words) for _ in range(sources)])
        all_edges += edge_count
    assert next(words, None) is None, "more output than problems"
    assert all_edges > 100_000, f"only {all_edges} edges"
    print(f"{problems} problems, {all_edges} edges: equal")


if __name__ == "__main__":
    main(sys.argv[1])
