"""Clouds of different units of length."""

import numpy as np
import pytest

import igsp


def test_the_factor_is_found_with_the_pose(scans):
    source, target = (igsp.read_points(scans / f"indoor/station_{i}.ply") for i in (1, 0))
    feet = source / 0.3048
    found = igsp.align_similarity(feet, target)
    assert found and found.result.registered
    assert found.factor == pytest.approx(0.3048, rel=1e-3)
    assert 0 < found.sigma < 1e-3
    truth = np.loadtxt(scans / "indoor/station_1_to_0.txt")
    moved = feet @ found.target_from_source[:3, :3].T + found.target_from_source[:3, 3]
    np.testing.assert_allclose(moved, source @ truth[:3, :3].T + truth[:3, 3], atol=0.05)
    assert "registered" in repr(found)

    [cause] = igsp.diagnose(feet, target, igsp.align(feet, target))
    assert cause.cause == "scale" and "feet into metres" in cause.description


def test_a_wrong_option_is_named(pair):
    with pytest.raises(ValueError, match="voxel_size"):
        igsp.align_similarity(*pair, voxel_size=-1)
