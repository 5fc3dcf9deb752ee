"""What igsp network --engine dask asks of a cluster, see python/src/dask_engine.cpp."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

from igsp import _core, survey_formats
from igsp._core import Features, Result
from igsp.cluster import Cluster

ScanSource = tuple[str, Sequence[float] | None, Sequence[str], bool, int]
"""Absolute name of a scan, where its scanner is said to have stood, columns, keep_noise, max_points."""
Tick = Callable[[float], object]
Keep = Callable[[tuple[int, int], Result], None]
Options = dict[str, Any]


class CommandEngine:
    """Scans are indices into `sources`; `names` are those that the user knows them by. Workers read the files."""

    def __init__(
        self, scheduler: str, sources: list[ScanSource], names: list[str], warn: Callable[[str], object]
    ) -> None:
        self._cluster = Cluster(scheduler, warn)
        for name in ("distributed", "distributed.client"):
            logging.getLogger(name).setLevel(logging.CRITICAL)  # what matters of it, the command says itself
        self._sources, self._names = sources, names

    def close(self) -> None:
        self._cluster.close()

    def look(self, scan: int, options: Options, tick: Tick) -> tuple[float, float]:
        """Its own voxel size and its extent [units of the cloud]."""
        size, extent = self._ask(_look, [(source, options) for source in self._sources], scan, tick)
        return float(size), float(extent)

    def fingerprint(self, scan: int, tick: Tick) -> str:
        return str(self._ask(_fingerprint, [(source,) for source in self._sources], scan, tick))

    def expect(self, scans: Sequence[int], options: Options) -> None:
        for scan in scans:
            self._cluster.start_features(scan, _features, self._sources[scan], options)

    def features(self, scan: int, options: Options, tick: Tick) -> Features:
        self.expect([scan], options)
        try:
            return self._cluster.features(scan, lambda: tick(scan / len(self._sources)))
        except OSError as error:
            raise OSError(self._as_known(str(error), scan)) from error

    def register_pairs(self, pairs: list[tuple[int, int]], options: Options, keep: Keep, tick: Tick) -> None:
        for pair in pairs:
            self.expect(pair, options)  # those that an earlier run kept are not with the workers yet
        for pair, result in self._cluster.register_pairs(pairs, options, tick):
            keep(pair, result)

    def _ask(self, function: Callable[..., Any], tasks: list[tuple[Any, ...]], scan: int, tick: Tick) -> Any:
        try:
            return self._cluster.ask(function, dict(enumerate(tasks)), scan, lambda: tick(scan / len(self._sources)))
        except OSError as error:
            raise OSError(self._as_known(str(error), scan)) from error

    def _as_known(self, text: str, scan: int) -> str:
        return text.replace(self._sources[scan][0], self._names[scan])


def _look(source: ScanSource, options: Options) -> tuple[float, float]:
    return _core.look_at_scan(source, options, survey_formats)


def _fingerprint(source: ScanSource) -> str:
    return _core.fingerprint_of_scan(source)


def _features(source: ScanSource, options: Options) -> Features:
    return _core.features_of_scan(source, {**options, "threads": 1}, survey_formats)
