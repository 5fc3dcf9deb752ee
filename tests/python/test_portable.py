"""Features, results and what they hold pass from one process to another, into files and back, bit for bit."""

import copy
import pickle
import subprocess
import sys

import numpy as np
import pytest

import igsp


@pytest.fixture(scope="module")
def features(pair):
    return [igsp.extract_features(cloud, voxel_size=0.5) for cloud in pair]


def values(thing):
    """Everything that can be seen of an object of the extension, as bytes where it is an array."""
    names = [name for name in dir(type(thing)) if not name.startswith("_")]
    return {name: plain(getattr(thing, name)) for name in names if not callable(getattr(thing, name))}


def plain(value):
    if isinstance(value, np.ndarray):
        return value.dtype, value.shape, value.tobytes()
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return values(value) if type(value).__module__ == "igsp._core" else value


def bound_things(pair, features, result, truth):
    last = result.iterations[-1]
    quality = igsp.match_quality(last.correspondences, result.source_keypoints, result.target_keypoints, truth, 0.5)
    yield from [features[0], result, result.evidence, result.precision, result.source, last, quality]
    yield igsp.find_viewpoint(pair[0], [0, 0, 0])
    yield from [igsp.pose_error(truth, np.eye(4), [1, 2, 3]), igsp.simulate("object", points=2000)[0]]
    plane = np.random.default_rng(0).uniform(size=(20000, 3)) * [1, 1, 0]
    flat = igsp.align(plane, plane)
    yield from [flat, *flat.precision.free_directions, *igsp.diagnose(plane, plane, flat)]
    if result.runner_up:
        yield result.runner_up
    site = igsp.simulate("park", stations=3, points=20000, station_distance=8, seed=3)
    network = igsp.network(site, target_points=3000)
    yield igsp.align_similarity(*pair)
    yield from [network, network.scans[1], network.links[0], network.cycles[0]]
    yield igsp.network(
        with_a_lorry(site), viewpoints=[scan.viewpoint for scan in site], target_points=3000
    ).contradictions[0]


def with_a_lorry(site):
    """In the second scan, where the first one's scanner saw through."""
    first, second = site[0].world_from_scanner, site[1].world_from_scanner
    lorry = np.random.default_rng(0).uniform(-2.5, 2.5, size=(3000, 3)) + [3, 0, 0]
    second_from_first = np.linalg.inv(second) @ first
    seen = igsp.transform_points(lorry, second_from_first)
    return [site[0].points, np.vstack([site[1].points, seen]), site[2].points]


CLASSES = {name for name in igsp.__all__ if getattr(getattr(igsp, name), "__module__", "") == "igsp._core"}
CLASSES = {name for name in CLASSES if isinstance(getattr(igsp, name), type)} - {"Cancelled"}


def test_every_class_comes_back_bit_for_bit(pair, features, result, truth):
    met = set()
    for thing in bound_things(pair, features, result, truth):
        met.add(type(thing).__name__)
        seen = values(thing)
        assert len(seen) >= 2
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            assert values(pickle.loads(pickle.dumps(thing, protocol))) == seen
        for copied in (copy.copy(thing), copy.deepcopy(thing), copy.deepcopy([thing])[0]):
            assert copied is not thing and values(copied) == seen
    assert met >= CLASSES - {"RunnerUp"}


def test_a_copy_is_its_own(result):
    copied = copy.copy(result)
    copied.source_keypoints[0] = 7
    assert (result.source_keypoints[0] != 7).all()


ELSEWHERE = """
import pickle, sys, igsp
source, target = pickle.load(open(sys.argv[1], "rb"))
result = igsp.align(source, target, threads=3)
igsp.write_result(sys.argv[2], result)
pickle.dump(result, open(sys.argv[3], "wb"))
"""


def answer(result):
    """All of it but the clock."""
    seen = values(result)
    del seen["timings_s"]
    seen["options"] = {name: value for name, value in seen["options"].items() if name != "threads"}
    for record in seen["iterations"]:
        del record["seconds"]
    return seen


def test_another_process_gives_the_same_answer(features, tmp_path):
    """Pickled features there, the result back, pickled and as a file: as if all had been done here."""
    (tmp_path / "features").write_bytes(pickle.dumps(features))
    names = [str(tmp_path / name) for name in ("features", "result", "pickled")]
    subprocess.run([sys.executable, "-c", ELSEWHERE, *names], check=True)
    here = answer(igsp.align(*features))
    assert here["registered"]
    assert answer(igsp.read_result(tmp_path / "result")) == here
    assert answer(pickle.loads((tmp_path / "pickled").read_bytes())) == here


def test_files_give_back_what_was_written(features, result, tmp_path):
    igsp.write_features(tmp_path / "features", features[0])
    assert values(igsp.read_features(tmp_path / "features")) == values(features[0])
    igsp.write_result(str(tmp_path / "result"), result)
    assert values(igsp.read_result(str(tmp_path / "result"))) == values(result)


def test_broken_files_are_refused_with_path_and_reason(features, tmp_path):
    path = tmp_path / "features"
    igsp.write_features(path, features[0])
    whole = path.read_bytes()
    middle = len(whole) // 2
    for content, reason in [
        (whole[:-1], "cut off"),
        (whole[:middle], "cut off"),
        (whole + b"x", "more was appended"),
        (whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :], "changed since it was written"),
        (whole[:8] + b"\2" + whole[9:], "written by igsp .* in form 2"),
        (b"x 1 2 3\n", "no features or results"),
        (b"", "empty"),
    ]:
        path.write_bytes(content)
        with pytest.raises(OSError, match=f"{path}.*{reason}"):
            igsp.read_features(path)
    with pytest.raises(OSError, match="no such file"):
        igsp.read_features(tmp_path / "nowhere")
    path.write_bytes(whole)
    with pytest.raises(OSError, match="it holds Features, not Result"):
        igsp.read_result(path)


def test_broken_pickles_are_refused(features):
    state = features[0].__getstate__()
    for broken in (state[:-1], b"", state[:100] + b"?" + state[101:], igsp.align(*features).__getstate__()):
        fresh = igsp.Features.__new__(igsp.Features)
        with pytest.raises(ValueError, match="pickled Features: "):
            fresh.__setstate__(broken)


def test_a_refusal_passes_between_processes(pair):
    noise = np.random.default_rng(0).uniform(size=(5000, 3))
    with pytest.raises(igsp.NotRegistered) as caught:
        igsp.align(noise, pair[1]).raise_if_not_registered()
    back = pickle.loads(pickle.dumps(caught.value))
    assert str(back) == str(caught.value) and values(back.result) == values(caught.value.result)
