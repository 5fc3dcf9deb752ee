"""Rigid motions of igsp.formats: quaternions and matrices say the same."""

from __future__ import annotations

import numpy as np
import pytest
from igsp.formats import _motion


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.6, 0, -0.8), (-1, -1, -1)])
@pytest.mark.parametrize("angle", [0, 1e-9, 0.5, np.pi / 2, np.pi - 1e-9, np.pi, 4.0, 2 * np.pi - 1e-3])
def test_quaternion_of_every_angle(axis: tuple[float, ...], angle: float) -> None:
    unit = np.array(axis) / np.linalg.norm(axis)
    quaternion = np.array([np.cos(angle / 2), *np.sin(angle / 2) * unit])
    matrix = _motion.from_quaternion(quaternion, (1, 2, 3))
    np.testing.assert_allclose(matrix[:3, :3] @ unit, unit, rtol=0, atol=4e-15)
    assert np.trace(matrix[:3, :3]) == pytest.approx(1 + 2 * np.cos(angle), abs=1e-14)
    again = _motion.to_quaternion(matrix)
    assert again[0] >= 0
    assert abs(again @ quaternion) == pytest.approx(1, abs=1e-15)
    np.testing.assert_allclose(_motion.from_quaternion(again, (1, 2, 3)), matrix, rtol=0, atol=4e-15)


def test_rounded_rotation_becomes_the_nearest_quaternion() -> None:
    exact = _motion.from_quaternion((0.9, 0.1, -0.2, 0.3), (5e6, 1, 2))
    rounded = _motion.as_rigid(np.round(exact, 6), "pose")
    np.testing.assert_array_equal(rounded, np.round(exact, 6))
    left, _, right = np.linalg.svd(rounded[:3, :3])
    again = _motion.from_quaternion(_motion.to_quaternion(rounded), exact[:3, 3])
    np.testing.assert_allclose(again[:3, :3], left @ right, rtol=0, atol=1e-11)
