"""The two doors: `align` for clouds, `extract_features` and then `align` for clouds that are used more than once."""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from igsp import _core
from igsp._core import Diagnosis, Features, Result, SimilarityResult
from igsp.arrays import Points, matrix_array
from igsp.files import Parts
from igsp.progress import ProgressBar, ProgressFunction
from igsp.viewpoints import Viewpoint, load, settle

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from igsp.option_keywords import OptionKeywords

Progress = bool | ProgressFunction


def align(
    source: object,
    target: object,
    *,
    initial: npt.ArrayLike | None = None,
    source_viewpoint: Viewpoint = "auto",
    target_viewpoint: Viewpoint = "auto",
    progress: Progress = False,
    **options: Unpack[OptionKeywords],
) -> Result:
    """The rigid transformation that puts `source` onto `target`, without an initial guess, and whether to believe it.

    `source`, `target`: each a path, an (N, 3) array in one common unit of length, an Open3D, PyVista or laspy cloud, or
        the Features of one. A C-contiguous float64 array is not copied; do not change it while the call runs.
    `initial`: (4, 4) guess of target_from_source; it is checked and refined if it holds, there is no search.
    `source_viewpoint`, `target_viewpoint`: where the scanner stood, (3,) in the frame of its points (a far point: it
        looked along one direction); None: unknown, or of mixed scans; "auto": see `find_viewpoint`; "x,y,z!" is used even
        where the cloud contradicts it. Features keep theirs.
    `progress`: True draws bars on standard error; a function is called with stage and share done, see ProgressFunction.
    `options`: as `igsp.options()` lists them, such as voxel_size [units of the cloud], dof=4, preset="paper", threads.

    A pair that cannot be registered is a Result that says so. Raises ValueError (empty cloud, NaN, wrong shape, option
    out of range), TypeError (unknown option), OSError (a file), igsp.Cancelled. The interpreter lock is released, and
    Ctrl-C stops the run.
    """
    keywords = plain_options(options)
    guess = None if initial is None else matrix_array(initial, "initial")
    with progress_function(progress) as report:
        if not isinstance(source, Features) and not isinstance(target, Features):
            scans = _load_both(source, target, source_viewpoint, target_viewpoint)
            return _core.align_points(*scans, guess, keywords, report)
        _share_voxel_size(source, target, keywords)
        return _core.align_features(
            _features(source, "source", source_viewpoint, keywords, report),
            _features(target, "target", target_viewpoint, keywords, report),
            guess,
            keywords,
            report,
        )


def align_similarity(
    source: object,
    target: object,
    *,
    source_viewpoint: Viewpoint = "auto",
    target_viewpoint: Viewpoint = "auto",
    progress: Progress = False,
    **options: Unpack[OptionKeywords],
) -> SimilarityResult:
    """A rigid transformation and one factor of scale, where the clouds have no common unit of length: seven degrees of freedom.

    Parameters as for `align`, but no Features and no guess. `result.factor` is what `source` was multiplied by, whatever
    its size; `result.result` is the answer for it in the target's unit, `result.target_from_source` both in one (4, 4) matrix.
    Takes as long as several calls of `align`.
    """
    with progress_function(progress) as report:
        scans = _load_both(source, target, source_viewpoint, target_viewpoint)
        return _core.align_similarity(*scans, plain_options(options), report)


def diagnose(
    source: object,
    target: object,
    refused: Result,
    *,
    search: bool = True,
    source_viewpoint: Viewpoint = "auto",
    target_viewpoint: Viewpoint = "auto",
    progress: Progress = False,
) -> list[Diagnosis]:
    """Why `align` may have refused this pair: mirrored, flat or in another scale, degrees, coarse coordinates, few points.

    `source`, `target`, their viewpoints: as given to `align`, but no Features. `refused`: its answer, whose options are used again.
    `search`: False leaves out what is found by registration, the mirrored source and the one in another scale.

    Most likely first; empty if nothing was found, as for clouds that simply do not overlap, and for a registered pair.
    """
    with progress_function(progress) as report:
        scans = _load_both(source, target, source_viewpoint, target_viewpoint)
        return _core.diagnose(*scans, refused, search, report)


def extract_features(
    cloud: object, *, viewpoint: Viewpoint = "auto", progress: Progress = False, **options: Unpack[OptionKeywords]
) -> Features:
    """Everything that depends on one cloud alone, to align it several times. See `align` for the parameters.

    Clouds that shall meet must be extracted with the same options; `align` of a cloud and of Features takes the voxel
    size from the Features.
    """
    with progress_function(progress) as report:
        return _extract(cloud, "cloud", viewpoint, "viewpoint", plain_options(options), report)


def options(**options: Unpack[OptionKeywords]) -> dict[str, bool | int | float | str]:
    """All options with their values, after the preset and the given ones; `align(..., **options)` takes them."""
    return _core.resolve_options(plain_options(options))


def plain_options(options: OptionKeywords) -> dict[str, Any]:
    """Paths as strings, NumPy's numbers as Python's."""

    def plain(value: Any) -> Any:
        if isinstance(value, np.generic):
            return value.item()
        return os.fspath(value) if isinstance(value, os.PathLike) else value

    return {name: plain(value) for name, value in options.items()}


def _load_both(
    source: object, target: object, source_viewpoint: Viewpoint, target_viewpoint: Viewpoint
) -> tuple[Points, Points, Parts, Parts]:
    moving, fixed = load(source, "source"), load(target, "target")
    return (
        moving.points,
        fixed.points,
        settle(moving, source_viewpoint, "source_viewpoint"),
        settle(fixed, target_viewpoint, "target_viewpoint"),
    )


def _share_voxel_size(source: object, target: object, keywords: dict[str, Any]) -> None:
    features = source if isinstance(source, Features) else target
    assert isinstance(features, Features)
    given = _core.resolve_options(keywords)["voxel_size"]  # a file of options may say it, too
    if given and given != features.voxel_size:
        raise ValueError(f"voxel_size is {given}, but the features were extracted with {features.voxel_size}")
    keywords["voxel_size"] = features.voxel_size


def _features(
    cloud: object, name: str, viewpoint: Viewpoint, keywords: dict[str, Any], report: ProgressFunction | None
) -> Features:
    keyword = f"{name}_viewpoint"
    if not isinstance(cloud, Features):
        return _extract(cloud, name, viewpoint, keyword, keywords, report)
    if not (isinstance(viewpoint, str) and viewpoint == "auto"):
        raise ValueError(f"{keyword} is given, but {name} is Features, which keep theirs: say it to extract_features")
    return cloud


def _extract(
    cloud: object,
    name: str,
    viewpoint: Viewpoint,
    keyword: str,
    keywords: dict[str, Any],
    report: ProgressFunction | None,
) -> Features:
    loaded = load(cloud, name)
    return _core.extract_features(loaded.points, settle(loaded, viewpoint, keyword), keywords, report)


def progress_function(progress: Progress) -> contextlib.AbstractContextManager[ProgressFunction | None]:
    if callable(progress):
        return contextlib.nullcontext(progress)
    return ProgressBar() if progress else contextlib.nullcontext(None)
