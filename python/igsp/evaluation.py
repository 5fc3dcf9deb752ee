"""Answers against the truth, and transformations at work."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from igsp import _core
from igsp._core import MatchQuality, PoseError
from igsp.arrays import Points, matrix_array, points_array


def pose_error(estimate: npt.ArrayLike, truth: npt.ArrayLike, source_centroid: npt.ArrayLike) -> PoseError:
    """Error of a (4, 4) target_from_source against the true one (Eq. 12-13).

    `source_centroid`: (3,), in the source's frame.
    """
    centroid = np.require(np.asarray(source_centroid, np.float64), requirements=["C_CONTIGUOUS", "ALIGNED"])
    if centroid.shape != (3,):
        raise ValueError(f"source_centroid has shape {centroid.shape}; expected (3,)")
    return _core.pose_error(matrix_array(estimate, "estimate"), matrix_array(truth, "truth"), centroid)


def match_quality(
    correspondences: npt.ArrayLike,
    source_keypoints: object,
    target_keypoints: object,
    truth: npt.ArrayLike,
    radius: float,
) -> MatchQuality:
    """Precision and recall of (M, 2) correspondences at the true target_from_source (Eq. 14).

    `correspondences` are indices into the (K, 3) keypoints, as `IterationRecord.correspondences` into those of the
    `Result`. `radius` in the unit of the cloud, > 0; the usual choice is a third of the suppression radius.
    """
    matches = np.asarray(correspondences)
    if matches.ndim != 2 or matches.shape[1] != 2 or matches.dtype.kind not in "iu":
        raise ValueError(
            f"correspondences has shape {matches.shape} and dtype {matches.dtype}; expected (M, 2) integers"
        )
    source, target = (
        points_array(source_keypoints, "source_keypoints"),
        points_array(target_keypoints, "target_keypoints"),
    )
    if matches.size and (matches.min() < 0 or (matches >= [len(source), len(target)]).any()):
        raise ValueError(
            f"correspondences has an index outside of {len(source)} source_keypoints and {len(target)} target_keypoints"
        )
    matches = np.require(matches, np.uint32, ["C_CONTIGUOUS", "ALIGNED"])
    return _core.match_quality(matches, source, target, matrix_array(truth, "truth"), radius)


def transform_points(points: object, target_from_source: npt.ArrayLike) -> Points:
    """The (N, 3) float64 points moved by a (4, 4) transformation: p_target = target_from_source * p_source."""
    return _core.transform_points(
        points_array(points, "points"), matrix_array(target_from_source, "target_from_source")
    )
