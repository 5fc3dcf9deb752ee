"""small_gicp: generalised ICP from a guess. Its defaults are for voxels of 0.25 m; lengths grow with the voxel."""

from collections.abc import Iterator
from importlib.metadata import version

import numpy as np
import small_gicp

VERSION = version("small_gicp")
USUAL_VOXEL, USUAL_DISTANCE, USUAL_EPSILON = 0.25, 1.0, 1e-3  # [m]


def register(method: str, source: np.ndarray, target: np.ndarray, voxel_size: float, seed: int, threads: int,
             guess: np.ndarray) -> Iterator[dict]:
    scale = voxel_size / USUAL_VOXEL
    result = small_gicp.align(target, source, guess, registration_type="GICP", downsampling_resolution=voxel_size,
                              max_correspondence_distance=USUAL_DISTANCE * scale, num_threads=threads,
                              translation_epsilon=USUAL_EPSILON * scale)
    yield {"label": "", "target_from_source": result.T_target_source, "score": int(result.num_inliers),
           "converged": bool(result.converged)}
