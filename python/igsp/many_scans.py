"""Many scans into one frame."""

from __future__ import annotations

import contextlib
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
from igsp.progress import ProgressFunction
from igsp.scan_work import ClusterWork, LocalWork, ScanInput
from igsp.viewpoints import Viewpoint

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
    engine: Literal["local", "dask"] = "local",
    scheduler: str | None = None,
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
    `engine`: "dask" for the workers of the Dask cluster whose scheduler has the address `scheduler`, as in
        "tcp://127.0.0.1:8786". They read files under the same, absolute names and run the same igsp; features of what is
        in memory here are made here. The answer has the same bits as that of "local", this process.
    `progress`, `options`: as in `align`.

    A scan that cannot be read is a NetworkScan with a `problem`, one that cannot be placed a component of its own.
    Raises ValueError (fewer than two scans, one given twice, option out of range), OSError (a folder), TypeError (unknown
    option), igsp.Cancelled; with "dask" also ImportError (package distributed), OSError (no scheduler there),
    igsp.EngineLost.
    """
    if engine not in ("local", "dask"):
        raise ValueError(f"engine is {engine}; it must be local or dask")
    if (engine == "dask") != (scheduler is not None):
        raise ValueError("engine='dask' and scheduler=ADDRESS belong together: give both, or neither")
    inputs = _with_viewpoints(list(_inputs(scans)), viewpoints)
    if len(inputs) < 2:
        raise ValueError("a network needs at least two scans")
    keywords = plain_options(options)
    with contextlib.ExitStack() as stack:
        report = stack.enter_context(progress_function(progress))
        work = LocalWork(inputs, keywords)
        if scheduler is not None:
            work = stack.enter_context(ClusterWork(inputs, keywords, report, scheduler))
        _choose_voxel_size(inputs, keywords, work, report)
        result = _core.register_network(
            len(inputs),
            work.features,
            work.register_pairs if isinstance(work, ClusterWork) else None,
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


def _inputs(scans: Iterable[object] | str | os.PathLike[str]) -> Iterator[ScanInput]:
    given = [scans] if isinstance(scans, (str, os.PathLike)) else list(scans)
    files = [os.fspath(one) for one in given if isinstance(one, (str, os.PathLike))]
    _core.scan_files(files)  # the whole list: one that is given twice is an error
    for number, one in enumerate(given):
        if isinstance(one, (str, os.PathLike)):
            for file in _core.scan_files([os.fspath(one)]):
                yield from (ScanInput(name, name) for name in _scan_names(file))
        else:
            yield ScanInput(f"scan {number}", one)


def _scan_names(file: str) -> list[str]:
    from igsp import formats  # not before it is needed

    try:
        return formats.scan_names(file) if formats.is_supported(file) else [file]
    except (OSError, ImportError):
        return [file]  # reading it says why


def _with_viewpoints(inputs: list[ScanInput], viewpoints: Viewpoints | None) -> list[ScanInput]:
    if viewpoints is None:
        return inputs
    if not isinstance(viewpoints, Mapping):
        if len(viewpoints) != len(inputs):
            raise ValueError(f"{len(viewpoints)} viewpoints for {len(inputs)} scans")
        return [ScanInput(one.name, one.cloud, place) for one, place in zip(inputs, viewpoints, strict=True)]
    known = {alias: i for i, one in reversed(list(enumerate(inputs))) for alias in _aliases(one.name)}
    places: dict[int, Viewpoint] = {}
    for name, place in viewpoints.items():
        if os.fspath(name) not in known:
            raise ValueError(f"viewpoints: {os.fspath(name)!r} is none of the scans")
        places[known[os.fspath(name)]] = place
    return [ScanInput(one.name, one.cloud, places.get(i, "auto")) for i, one in enumerate(inputs)]


def _aliases(name: str) -> tuple[str, ...]:
    base = os.path.basename(name)
    return name, base, os.path.splitext(base)[0]


def _choose_voxel_size(
    inputs: list[ScanInput], keywords: dict[str, Any], work: LocalWork, report: ProgressFunction | None
) -> None:
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
            own.append(work.own_voxel_size(number))
        except (ValueError, OSError, ImportError):
            continue  # said again where its features are asked for
    keywords["voxel_size"] = _core.common_voxel_size(own)
