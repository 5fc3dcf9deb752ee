"""Keywords are the command's flags: one list of options."""

import re
import subprocess

import numpy as np
import pytest

import igsp


def test_every_flag_is_a_keyword(cpp_command):
    helped = subprocess.run([cpp_command, "align", "--help"], check=True, capture_output=True, text=True).stdout
    method = helped[helped.index("Method:") :]
    flags = {flag for flag in re.findall(r"^  --([\w-]+)", method, re.MULTILINE) if not flag.startswith("no-")}
    assert {flag.replace("-", "_") for flag in flags} == set(igsp.options())


def test_keywords_reach_the_run(pair):
    result = igsp.align(
        *pair,
        preset="paper",
        voxel_size=0.4,
        dof=4,
        threads=1,
        refinement=False,
        max_iterations=7,
        threshold_rule="released",
    )
    expected = {
        **igsp.options(preset="paper"),
        "voxel_size": 0.4,
        "dof": 4,
        "threads": 1,
        "refinement": False,
        "max_iterations": 7,
        "threshold_rule": "released",
    }
    assert result.options == expected
    assert igsp.align(*pair, **result.options).options == expected


def test_a_file_of_options(tmp_path, pair):
    path = tmp_path / "igsp.toml"
    path.write_text("preset = 'paper'\n[scale]\nvoxel_size = 0.4\n")
    assert igsp.options(config=path, dof=4) == {**igsp.options(preset="paper"), "voxel_size": 0.4, "dof": 4}
    path.write_text("thread = 1\n")
    with pytest.raises(ValueError, match=r'igsp.toml:1:.*did you mean "threads"'):
        igsp.options(config=path)
    with pytest.raises(OSError, match="nowhere.toml"):
        igsp.options(config="nowhere.toml")
    with pytest.raises(ValueError, match="preset and config"):
        igsp.options(config=path, preset="paper")


def test_numbers_of_numpy():
    taken = igsp.options(voxel_size=np.float32(0.5), threads=np.int16(2), refinement=np.bool_(False))
    assert (taken["voxel_size"], taken["threads"], taken["refinement"]) == (0.5, 2, False)


@pytest.mark.parametrize(
    ("error", "words", "keywords"),
    [
        (TypeError, "unknown option voxel_sise; did you mean voxel_size?", {"voxel_sise": 1}),
        (TypeError, "unknown option degrees_of_freedom", {"degrees_of_freedom": 4}),
        (ValueError, "voxel_size .* is -1.0; it must be in \\[0, 1e\\+150\\]", {"voxel_size": -1}),
        (ValueError, "voxel_size .* is nan", {"voxel_size": float("nan")}),
        (ValueError, "dof.* is 5; it must be 4 or 6", {"dof": 5}),
        (ValueError, "threads.* takes an integer, not true", {"threads": True}),
        (ValueError, "threads.* takes an integer, not 1.5", {"threads": 1.5}),
        (ValueError, "dof.* takes an integer", {"dof": 2**40}),
        (ValueError, "search.* one of direct, hypotheses", {"search": "fast"}),
        (ValueError, 'unknown preset "papers"; did you mean "paper"', {"preset": "papers"}),
        (ValueError, "option voxel_size is None", {"voxel_size": None}),
        (ValueError, "option voxel_size is \\[1\\]", {"voxel_size": [1]}),
    ],
)
def test_mistakes_are_named_before_anything_runs(error, words, keywords):
    cloud = np.zeros((1, 3))
    for call in [igsp.align, lambda source, _, **options: igsp.extract_features(source, **options)]:
        with pytest.raises(error, match=words):
            call(cloud, cloud, **keywords)
