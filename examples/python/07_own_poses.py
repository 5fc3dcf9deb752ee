"""Your own search, igsp's judgement: poses from elsewhere are refined and judged. 07_own_poses.py SOURCE TARGET"""

import sys

import numpy as np

import igsp

source, target = (igsp.extract_features(path, voxel_size=0.5) for path in sys.argv[1:])


def beside(pose: np.ndarray, degrees: float, shift: float) -> np.ndarray:
    angle = np.radians(degrees)
    turn = np.eye(4)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    guess = pose @ turn
    guess[0, 3] += shift
    return guess


# Stands for what you have: odometry, a floor plan, another program. Here: the answer, wrong by 3 degrees and 0.6 units,
# among poses that are far off.
right = igsp.align(source, target).target_from_source
guesses = [beside(right, 40 * i, 2 * i) for i in range(1, 9)] + [beside(right, 3, 0.6)]
results = [igsp.align(source, target, initial=guess) for guess in guesses]
for result in results:
    print(result)
best = max(results, key=lambda result: result.confidence).raise_if_not_registered()
print(best.target_from_source)
