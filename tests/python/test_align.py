"""`align` and `extract_features` as a user of the package meets them."""

import numpy as np
import pytest

import igsp


def test_the_answer_is_right_and_says_so(pair, truth, result):
    assert result.registered and result.has_estimate
    error = igsp.pose_error(result.target_from_source, truth, pair[0].mean(axis=0))
    assert error.rotation_rad < np.radians(0.5) and error.centroid_displacement < 0.3
    assert str(result) == (
        f"registered (confidence {result.confidence:.3f}), overlap {result.overlap:.2f}, "
        f"rmse {result.rmse:.2g}, {len(result.iterations)} iterations"
    )
    assert result.raise_if_not_registered() is result


def test_everything_of_the_result_is_there(pair, result):
    assert result.target_from_source.shape == (4, 4) and result.target_from_source.dtype == np.float64
    assert result.overlap == min(result.overlap_source, result.overlap_target)
    assert (result.source.points, result.target.points) == (len(pair[0]), len(pair[1]))
    assert result.source_keypoints.shape == (result.source.keypoints, 3)
    assert result.target_keypoints.shape == (result.target.keypoints, 3)
    assert result.termination in ("converged", "max_iterations") and "mutual matches" in result.reason
    assert result.evidence.agreeing_matches <= result.evidence.mutual_matches
    assert result.runner_up is None or 0 <= result.runner_up.share <= 1
    assert result.precision.centre.shape == (3,)
    identity = result.precision.information @ result.precision.covariance
    np.testing.assert_allclose(identity, np.eye(6), atol=1e-6)
    assert result.options["voxel_size"] == result.voxel_size and result.options["dof"] == 6
    assert {"screening", "loop", "verdict"} <= {stage for stage, _ in result.timings_s}


def test_iterations_and_their_correspondences(result, truth):
    assert len(result.iterations) > 3
    for record in result.iterations:
        assert record.correspondences.shape == (record.matches, 2) and record.correspondences.dtype == np.uint32
        assert record.energy > 0 and record.t_cd > 0 and record.w_fd + record.w_ed == pytest.approx(1)
    last = result.iterations[-1]
    source = result.source_keypoints[last.correspondences[:, 0]]
    target = result.target_keypoints[last.correspondences[:, 1]]
    moved = igsp.transform_points(source, truth)
    assert result.loop_voxel_size / result.voxel_size in (1, 2, 4, 8)
    assert np.median(np.linalg.norm(moved - target, axis=1)) < result.loop_voxel_size
    radius = result.options["suppression_radius"] * result.loop_voxel_size / 3
    quality = igsp.match_quality(last.correspondences, result.source_keypoints, result.target_keypoints, truth, radius)
    near = np.linalg.norm(moved - target, axis=1) < radius
    assert (quality.correct, quality.matched) == (np.count_nonzero(near), len(near))
    assert quality.precision == quality.correct / quality.matched and 0 < quality.recall <= 1


def test_arrays_outlive_the_object_that_they_look_into(pair):
    result = igsp.align(*pair, preset="paper")
    keypoints, correspondences = result.source_keypoints, result.iterations[0].correspondences
    copies = keypoints.copy(), correspondences.copy()
    del result
    np.zeros(1_000_000)  # would take the memory if it were free
    np.testing.assert_array_equal(keypoints, copies[0])
    np.testing.assert_array_equal(correspondences, copies[1])


def test_features_cannot_be_changed(pair):
    """They are trusted when they come in again."""
    features = igsp.extract_features(pair[0], voxel_size=0.5)
    for name in ["origin", "points", "curvature", "normals", "fine_points", "keypoints", "frames", "descriptors"]:
        assert not getattr(features, name).flags.writeable, name


def test_a_pair_that_cannot_be_registered_is_an_answer(pair):
    noise = np.random.default_rng(0).uniform(size=(5000, 3))
    result = igsp.align(noise, pair[1])
    assert not result.registered
    assert str(result).startswith("not registered (confidence 0.")
    with pytest.raises(igsp.NotRegistered) as caught:
        result.raise_if_not_registered()
    assert str(caught.value) == result.reason and caught.value.result is result


def test_a_guess_replaces_the_search(pair, truth):
    result = igsp.align(*pair, initial=truth)
    assert result.registered
    assert igsp.pose_error(result.target_from_source, truth, pair[0].mean(axis=0)).centroid_displacement < 0.3
    wrong = truth.copy()
    wrong[:3, 3] += 1000
    assert not igsp.align(*pair, initial=wrong).registered


def test_staged_is_the_same_as_at_once(pair, result, tmp_path):
    source, target = (igsp.extract_features(cloud, voxel_size=result.voxel_size) for cloud in pair)
    for answer in [igsp.align(source, target), igsp.align(pair[0], target), igsp.align(source, pair[1])]:
        np.testing.assert_array_equal(answer.target_from_source, result.target_from_source)
    assert target.points.shape == target.normals.shape == (len(target.curvature), 3)
    assert target.descriptors.shape == (len(target.keypoints), 7) and target.descriptors.dtype == np.uint64
    determinants = np.linalg.det(target.frames)
    np.testing.assert_allclose(determinants, 1, atol=1e-9)
    assert len(target.keypoints) > 100
    with pytest.raises(ValueError, match="voxel_size is 1.0, but the features were extracted with"):
        igsp.align(pair[0], target, voxel_size=1.0)
    (tmp_path / "igsp.toml").write_text("[scale]\nvoxel_size = 1.0\n")
    with pytest.raises(ValueError, match="voxel_size is 1.0, but the features were extracted with"):
        igsp.align(pair[0], target, config=tmp_path / "igsp.toml")


def test_frames_are_columns_x_y_n(pair, result):
    """Their third column is along the normal of the local principal component analysis at the keypoint."""
    features = igsp.extract_features(pair[1], voxel_size=result.voxel_size)
    along = np.abs(np.einsum("ki,ki->k", features.frames[:, :, 2], features.normals[features.keypoints]))
    across = np.abs(np.einsum("ki,ki->k", features.frames[:, 2, :], features.normals[features.keypoints]))
    assert np.median(along) > 0.9 > np.median(across)


def test_progress_function_sees_every_stage_and_may_stop(pair):
    seen = []
    igsp.align(*pair, progress=lambda stage, fraction: seen.append((stage, fraction)))
    assert {"voxel grid", "common frame", "screening", "loop", "verdict"} <= {stage for stage, _ in seen}
    assert all(0 <= fraction <= 1 for _, fraction in seen)
    with pytest.raises(igsp.Cancelled):
        igsp.align(*pair, progress=lambda stage, fraction: stage != "loop")


def test_what_a_progress_function_raises_reaches_the_caller(pair):
    def fail(stage, fraction):
        raise LookupError(stage)

    with pytest.raises(LookupError, match="scale"):
        igsp.align(*pair, progress=fail)


def test_progress_bars(pair, capsys):
    igsp.align(*pair, progress=True)
    lines = capsys.readouterr().err.rstrip("\n").split("\n")
    assert len(lines) > 8 and all("100%" in line.split("\r")[-1] for line in lines)
    igsp.align(*pair)
    assert capsys.readouterr().err == ""


def test_a_left_handed_source_is_diagnosed(scans):
    source, target = (igsp.read_points(scans / f"indoor/station_{i}.ply") for i in (1, 0))
    reflection = np.diag([1.0, -1, 1, 1])
    left_handed = source @ reflection[:3, :3]
    refused = igsp.align(left_handed, target)
    [mirrored] = igsp.diagnose(left_handed, target, refused)
    assert mirrored.cause == "mirrored" and "left-handed" in str(mirrored)
    truth = np.loadtxt(scans / "indoor/station_1_to_0.txt") @ reflection
    np.testing.assert_allclose(mirrored.target_from_source, truth, atol=0.05)
    assert igsp.diagnose(left_handed, target, refused, search=False) == []


def test_flat_clouds_are_diagnosed_and_registered_ones_are_not(pair, result):
    flat = pair[0] * [1, 1, 0]
    [found] = igsp.diagnose(flat, pair[1], igsp.align(flat, pair[1]))
    assert found.cause == "flat" and found.target_from_source is None and "z is 0" in found.description
    assert igsp.diagnose(*pair, result) == []
