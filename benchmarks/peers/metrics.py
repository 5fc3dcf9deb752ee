"""Errors of a transformation, as `igsp benchmark` computes them; the driver's test holds the two against each other."""

import numpy as np


def rotation_angle_rad(rotation: np.ndarray) -> float:
    """Angle of a 3x3 rotation, in [0, pi]. By the quaternion's half angle, which loses no digits near 0 nor near pi."""
    xx, yy, zz = np.diag(rotation)
    squares = np.array([1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz])
    a = rotation
    outer = np.array([[squares[0], a[2, 1] - a[1, 2], a[0, 2] - a[2, 0], a[1, 0] - a[0, 1]],
                      [a[2, 1] - a[1, 2], squares[1], a[0, 1] + a[1, 0], a[0, 2] + a[2, 0]],
                      [a[0, 2] - a[2, 0], a[0, 1] + a[1, 0], squares[2], a[1, 2] + a[2, 1]],
                      [a[1, 0] - a[0, 1], a[0, 2] + a[2, 0], a[1, 2] + a[2, 1], squares[3]]])
    quaternion = outer[np.argmax(squares)]  # a multiple of (w, x, y, z), from its largest component
    return float(2 * np.arctan2(np.linalg.norm(quaternion[1:]), abs(quaternion[0])))


def check_rigid(transformation: np.ndarray) -> None:
    rotation = transformation[:3, :3]
    if not np.isfinite(transformation).all() or np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-3:
        raise ValueError("not a rigid motion")
    if np.linalg.det(rotation) < 0:
        raise ValueError("a reflection, not a rotation")


def pose_errors(estimate: np.ndarray, truth: np.ndarray, source_centroid: np.ndarray) -> dict[str, float]:
    """Both 4x4, target_from_source. e_r and e_t are those of estimate * truth^-1 (the paper's Eq. 12-13); the
    displacement is that of the source's centroid, which no choice of the origin changes."""
    check_rigid(estimate)
    rotation = estimate[:3, :3] @ truth[:3, :3].T
    moved = [t[:3, :3] @ source_centroid + t[:3, 3] for t in (estimate, truth)]
    return {"e_r_deg": float(np.degrees(rotation_angle_rad(rotation))),
            "e_t": float(np.linalg.norm(estimate[:3, 3] - rotation @ truth[:3, 3])),
            "centroid_displacement": float(np.linalg.norm(moved[0] - moved[1]))}


def is_right(errors: dict[str, float], max_rotation_error_deg: float, max_displacement: float) -> bool:
    return errors["e_r_deg"] < max_rotation_error_deg and errors["centroid_displacement"] < max_displacement
