"""KISS-Matcher with its own settings, then the same ICP as after Open3D's methods."""

from collections.abc import Iterator

import kiss_matcher
import numpy as np
import open3d_peer

VERSION = kiss_matcher.__version__
SMALLEST_VOXEL, USUAL_VOXEL = 5e-3, 0.3  # it refuses smaller ones; its default
ACCEPTED_INLIERS = 5  # what its example calls a success


def register(method: str, source: np.ndarray, target: np.ndarray, voxel_size: float, seed: int, threads: int,
             guess: np.ndarray | None) -> Iterator[dict]:
    # Normals are turned to the origin and computed in floats, so both clouds go there; small scenes are enlarged.
    scale = 1.0 if voxel_size >= SMALLEST_VOXEL else USUAL_VOXEL / voxel_size
    centroids = [points.mean(axis=0) for points in (source, target)]
    clouds = [list(((points - centroid) * scale).astype(np.float32))
              for points, centroid in zip((source, target), centroids, strict=True)]
    matcher = kiss_matcher.KISSMatcher(kiss_matcher.KISSMatcherConfig(voxel_size * scale))
    solution = matcher.estimate(*clouds)
    inliers = matcher.get_num_final_inliers()
    accepted = bool(solution.valid) and inliers >= ACCEPTED_INLIERS
    coarse = np.eye(4)
    coarse[:3, :3] = solution.rotation
    coarse[:3, 3] = np.ravel(solution.translation) / scale + centroids[1] - coarse[:3, :3] @ centroids[0]
    yield {"label": "", "target_from_source": coarse, "score": inliers, "converged": accepted}
    filtered = [open3d_peer.prepare(points, voxel_size) for points in (source, target)]
    fine = open3d_peer.icp_after(*filtered, voxel_size, coarse)
    yield {"label": "icp", "target_from_source": fine, "score": inliers, "converged": accepted}
