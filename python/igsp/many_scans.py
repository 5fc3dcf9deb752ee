"""Many scans into one frame."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from igsp import _core
from igsp._core import Features, Network
from igsp.arrays import Points, matrix_array
from igsp.registration import Progress, plain_options, progress_function
from igsp.viewpoints import Viewpoint, load, settle

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from igsp.option_keywords import OptionKeywords

Pairs = Literal["all", "auto"] | Iterable[tuple[int, int]]
Viewpoints = Sequence[Viewpoint] | Mapping[str, Viewpoint]


@dataclass(frozen=True)
class Control:
    """Where a scan is known to lie in the world, as a soft prior for `network`.

    `scan`: its index. `position`: (3,) of the scanner in the world, where that is unknown of the origin of the scan's
        frame. `sigma`: standard deviation of the position per axis [units of the cloud], > 0.
    `rotation`: (3, 3) of world_from_scan, if known, with its standard deviation `rotation_sigma` per axis [rad], > 0.
    """

    scan: int
    position: npt.ArrayLike
    sigma: float
    rotation: npt.ArrayLike | None = None
    rotation_sigma: float = 0.0


def network(
    scans: Iterable[object] | str | os.PathLike[str],
    *,
    viewpoints: Viewpoints | None = None,
    pairs: Pairs = "all",
    fixed_scan: int | None = None,
    control: Sequence[Control] = (),
    min_unconfirmed_confidence: float = 0.95,
    min_unconfirmed_matches: int = 35,
    progress: Progress = False,
    **options: Unpack[OptionKeywords],
) -> Network:
    """Many scans in one frame, without initial poses, and which pairs to trust.

    `scans`: each a path, an (N, 3) array or another cloud that `align` takes, or Features, all in one unit of length; or
        one folder. A folder stands for the point clouds in it; an E57 or PTX file of several scans for each of them,
        named FILE#0, FILE#1, ... Files are read one at a time, twice unless voxel_size is given.
    `viewpoints`: where scanners stood, see `align`: one a scan, or by name (as in NetworkScan.name, or the file's name
        with or without its extension); "auto" for those that are not named. Features keep theirs.
    `pairs`: "all"; "auto", the likeliest first until every scan has enough confirmed links or nothing is likely; or pairs
        of indices, after folders and files of several scans have become one input a scan.
    `fixed_scan`: index of the scan whose frame is the world of its component; by default the first.
    `control`: where scans are known to lie in the world, see Control. dof=4 says that the scans are levelled: z is up in
        all of them and in the world.
    `min_unconfirmed_confidence`, `min_unconfirmed_matches`: a link in no loop joins scans only with at least these.
    `progress`, `options`: as in `align`.

    A scan that cannot be read is a NetworkScan with a `problem`, one that cannot be placed a component of its own.
    Raises ValueError (fewer than two scans, one given twice, option out of range), OSError (a folder), TypeError (unknown
    option), igsp.Cancelled.
    """
    inputs = _with_viewpoints(list(_inputs(scans)), viewpoints)
    if len(inputs) < 2:
        raise ValueError("a network needs at least two scans")
    keywords = plain_options(options)
    with progress_function(progress) as report:
        _choose_voxel_size(inputs, keywords, report)

        def features(index: int) -> Features:
            one = inputs[index]
            if isinstance(one.cloud, Features):
                return one.cloud
            loaded = load(one.cloud, one.name)
            return _core.extract_features(
                loaded.points, settle(loaded, one.viewpoint, f"viewpoint of {one.name}"), keywords, None
            )

        result = _core.register_network(
            len(inputs),
            features,
            keywords,
            min_unconfirmed_confidence,
            min_unconfirmed_matches,
            pairs if isinstance(pairs, str) else [(int(a), int(b)) for a, b in pairs],
            fixed_scan,
            [_control_in(one) for one in control],
            report,
        )
    for scan, one in zip(result.scans, inputs, strict=True):
        scan.name = one.name
    return result


def _control_in(one: Control) -> tuple[int, Points, float, Points | None, float]:
    position = np.require(np.asarray(one.position, np.float64), requirements=["C_CONTIGUOUS", "ALIGNED"])
    if position.shape != (3,):
        raise ValueError(f"control of scan {one.scan}: position has shape {position.shape}; expected (3,)")
    if one.rotation is None:
        return int(one.scan), position, float(one.sigma), None, 0.0
    rotation = np.asarray(one.rotation, np.float64)
    if rotation.shape != (3, 3):
        raise ValueError(f"control of scan {one.scan}: rotation has shape {rotation.shape}; expected (3, 3)")
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix = matrix_array(matrix, f"rotation of the control of scan {one.scan}")
    return int(one.scan), position, float(one.sigma), matrix, float(one.rotation_sigma)


@dataclass(frozen=True)
class _Input:
    name: str
    cloud: object  # a name that igsp.read_points takes, or a cloud in memory
    viewpoint: Viewpoint = "auto"


def _inputs(scans: Iterable[object] | str | os.PathLike[str]) -> Iterator[_Input]:
    given = [scans] if isinstance(scans, (str, os.PathLike)) else list(scans)
    files = [os.fspath(one) for one in given if isinstance(one, (str, os.PathLike))]
    _core.scan_files(files)  # the whole list: one that is given twice is an error
    for number, one in enumerate(given):
        if isinstance(one, (str, os.PathLike)):
            for file in _core.scan_files([os.fspath(one)]):
                yield from (_Input(name, name) for name in _scan_names(file))
        else:
            yield _Input(f"scan {number}", one)


def _scan_names(file: str) -> list[str]:
    from igsp import formats  # not before it is needed

    try:
        return formats.scan_names(file) if formats.is_supported(file) else [file]
    except (OSError, ImportError):
        return [file]  # reading it says why


def _with_viewpoints(inputs: list[_Input], viewpoints: Viewpoints | None) -> list[_Input]:
    if viewpoints is None:
        return inputs
    if not isinstance(viewpoints, Mapping):
        if len(viewpoints) != len(inputs):
            raise ValueError(f"{len(viewpoints)} viewpoints for {len(inputs)} scans")
        return [_Input(one.name, one.cloud, place) for one, place in zip(inputs, viewpoints, strict=True)]
    known = {alias: i for i, one in reversed(list(enumerate(inputs))) for alias in _aliases(one.name)}
    places: dict[int, Viewpoint] = {}
    for name, place in viewpoints.items():
        if os.fspath(name) not in known:
            raise ValueError(f"viewpoints: {os.fspath(name)!r} is none of the scans")
        places[known[os.fspath(name)]] = place
    return [_Input(one.name, one.cloud, places.get(i, "auto")) for i, one in enumerate(inputs)]


def _aliases(name: str) -> tuple[str, ...]:
    base = os.path.basename(name)
    return name, base, os.path.splitext(base)[0]


def _choose_voxel_size(inputs: list[_Input], keywords: dict[str, Any], report: Any) -> None:
    """One for all scans: that of features, else the median of what the clouds would have alone."""
    if _core.resolve_options(keywords)["voxel_size"]:
        return
    own = []
    for number, one in enumerate(inputs):
        if isinstance(one.cloud, Features):
            keywords["voxel_size"] = one.cloud.voxel_size
            return
        if report is not None and report("scale", number / len(inputs)) is False:
            raise _core.Cancelled
        try:
            own.append(_core.own_voxel_size(load(one.cloud, one.name).points, keywords))
        except (ValueError, OSError, ImportError):
            continue  # said again where its features are asked for
    keywords["voxel_size"] = _core.common_voxel_size(own)
