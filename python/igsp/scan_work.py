"""Who reads the scans of a network, makes their features and registers pairs: this process, or a Dask cluster."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Any

from igsp import _core
from igsp._core import Features, Result
from igsp.cluster import Cluster
from igsp.progress import ProgressFunction
from igsp.viewpoints import Viewpoint, load, settle


@dataclass(frozen=True)
class ScanInput:
    name: str
    cloud: object  # a name that igsp.read_points takes, or a cloud in memory
    viewpoint: Viewpoint = "auto"


class LocalWork:
    """`options` may get their voxel size later, before the first features."""

    def __init__(self, inputs: Sequence[ScanInput], options: dict[str, Any]) -> None:
        self._inputs, self._options = inputs, options

    def own_voxel_size(self, scan: int) -> float:
        return _own_voxel_size(self._inputs[scan], self._options)

    def features(self, scan: int) -> Features:
        return _features(self._inputs[scan], self._options)


class ClusterWork(LocalWork):
    """Files are read by the workers. What is in memory stays here: only its features go to them."""

    def __init__(
        self, inputs: Sequence[ScanInput], options: dict[str, Any], report: ProgressFunction | None, scheduler: str
    ) -> None:
        super().__init__(inputs, options)
        self._report = report
        self._files = {i: _seen_from_afar(one) for i, one in enumerate(inputs) if isinstance(one.cloud, str)}
        self._cluster = Cluster(scheduler, lambda text: warnings.warn(text, stacklevel=2))

    def __enter__(self) -> ClusterWork:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._cluster.close()

    def own_voxel_size(self, scan: int) -> float:
        if scan not in self._files:
            return super().own_voxel_size(scan)
        options = _core.resolve_options(self._options)
        tasks = {i: (one, options) for i, one in self._files.items()}
        tick = self._tick("scale", scan)
        return float(self._named(scan, lambda: self._cluster.ask(_own_voxel_size, tasks, scan, tick)))

    def features(self, scan: int) -> Features:
        options = {**_core.resolve_options(self._options), "threads": 1}
        for i, one in self._files.items():
            self._cluster.start_features(i, _features, one, options)  # all of them, the first time
        if scan in self._files:
            features: Features = self._named(scan, lambda: self._cluster.features(scan, self._tick("features", scan)))
            return features
        made = super().features(scan)
        self._cluster.start_features(scan, _same, made)
        return made

    def register_pairs(
        self, pairs: list[tuple[int, int]], report: Callable[[float], None]
    ) -> Iterator[tuple[tuple[int, int], Result]]:
        return self._cluster.register_pairs(pairs, _core.resolve_options(self._options), report)

    def _tick(self, stage: str, scan: int) -> Callable[[], None]:
        def tick() -> None:
            if self._report is not None and self._report(stage, scan / len(self._inputs)) is False:
                raise _core.Cancelled

        return tick

    def _named(self, scan: int, answer: Callable[[], Any]) -> Any:
        try:
            return answer()
        except OSError as error:
            name = self._inputs[scan].name
            raise OSError(str(error).replace(os.path.abspath(name), name)) from error


def _own_voxel_size(one: ScanInput, options: dict[str, Any]) -> float:
    return _core.own_voxel_size(load(one.cloud, one.name).points, options)


def _features(one: ScanInput, options: dict[str, Any]) -> Features:
    if isinstance(one.cloud, Features):
        return one.cloud
    loaded = load(one.cloud, one.name)
    return _core.extract_features(
        loaded.points, settle(loaded, one.viewpoint, f"viewpoint of {one.name}"), options, None
    )


def _same(features: Features) -> Features:
    return features


def _seen_from_afar(one: ScanInput) -> ScanInput:
    """Under a name that another process finds."""
    assert isinstance(one.cloud, str)
    path = os.path.abspath(one.cloud)
    return ScanInput(path, path, one.viewpoint)
