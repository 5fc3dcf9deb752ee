"""Points that your program holds, and what the answer says of them."""

import numpy as np

import igsp

# Any (N, 3) array will do, an Open3D, PyVista or laspy cloud as well; here two scans of a made-up room.
target, source = (scan.points for scan in igsp.simulate("indoor", points=60000, seed=1))

result = igsp.align(source, target)
print("registered" if result.registered else "not registered", result.confidence, result.overlap, result.rmse)
result.raise_if_not_registered()
igsp.write_points("aligned.ply", igsp.transform_points(source, result.target_from_source))

# How well the surfaces fix the pose: standard deviations of a small motion in the target's frame.
print(np.sqrt(np.diag(result.precision.covariance)))
