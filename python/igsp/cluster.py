"""A Dask cluster that makes features and registers pairs; results pass by key, the client gets what it asks for."""

from __future__ import annotations

import contextlib
import importlib
import queue
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from types import TracebackType
from typing import Any

from igsp import _core
from igsp._core import Features, Result
from igsp.errors import EngineLost

Tick = Callable[[], object]
"""Called while a result is waited for; raises to stop."""

_POLL_S = 0.1
_CONNECT_S = 10
_THREADS_HOLD_S = 2.0  # workers come and go
_PAIRS_PER_THREAD = 4  # in flight: what a worker holds for them, and what the scheduler knows, is bounded by it

_METHOD_THERE = "__import__('igsp')._core.method_number()"  # what a worker without igsp can be asked, too


@dataclass(frozen=True)
class _Fault:
    """A result that says why there is none; trying again elsewhere would not help."""

    text: str


class Cluster:
    """The workers of a Dask scheduler. They must run this very igsp.

    Raises ImportError without the package distributed, OSError where no scheduler answers, ValueError for workers with
    another igsp; its functions EngineLost once the scheduler is gone, and OSError for a task that cannot be done. `warn`
    is told what keeps the work from going on.
    """

    def __init__(self, scheduler: str, warn: Callable[[str], object]) -> None:
        try:
            distributed: Any = importlib.import_module("distributed")  # its types are not complete
        except ImportError as error:
            raise ImportError("the engine dask needs the package 'distributed': pip install 'igsp[dask]'") from error
        try:
            distributed.comm.resolve_address(scheduler)  # a Client that is made in vain is slow to go
            self._client: Any = distributed.Client(scheduler, timeout=_CONNECT_S, set_as_default=False, name="igsp")
        except (OSError, ValueError, RuntimeError) as error:
            reason = " ".join(str(error).split()) or type(error).__name__
            raise OSError(f"no Dask scheduler answers at {scheduler}: {reason}") from error
        self._asked: dict[object, dict[int, Any]] = {}
        self._features: dict[int, Any] = {}
        self._threads, self._threads_known_at = 0, -_THREADS_HOLD_S
        self._warn, self._warned = warn, False
        try:
            self._check_workers()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Cluster:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """What is left to do is forgotten by the scheduler, as all results are."""
        self._features.clear()
        self._asked.clear()
        with contextlib.suppress(Exception):  # a scheduler that is gone has forgotten it already
            self._client.close(timeout=_CONNECT_S)

    def ask(self, function: Callable[..., Any], tasks: Mapping[int, tuple[Any, ...]], index: int, tick: Tick) -> Any:
        """function(*tasks[index]). The first question of a kind starts all tasks."""
        if function not in self._asked:
            self._asked[function] = {i: self._submit(function, *task) for i, task in tasks.items()}
        return self._value(self._asked[function][index], tick)

    def start_features(self, scan: int, function: Callable[..., Features], *arguments: Any) -> None:
        """Starts function(*arguments), unless it was before. The result stays with the workers."""
        if scan not in self._features:
            self._features[scan] = self._submit(function, *arguments)

    def features(self, scan: int, tick: Tick) -> Features:
        """What was started."""
        features: Features = self._value(self._features[scan], tick)
        return features

    def register_pairs(
        self, pairs: Sequence[tuple[int, int]], options: dict[str, Any], tick: Callable[[float], object]
    ) -> Iterator[tuple[tuple[int, int], Result]]:
        """Results in the order in which they come, of pairs of scans whose features were started.

        A pair that no worker could do is left out. `tick` gets the share done.
        """
        finished: queue.SimpleQueue[Any] = queue.SimpleQueue()
        waiting, running, done = iter(pairs), dict[str, tuple[int, int]](), 0
        while True:
            for pair in islice(waiting, max(0, self._window() - len(running))):
                future = self._submit(_register, *(self._features[scan] for scan in pair), options)
                running[future.key] = pair
                future.add_done_callback(finished.put)
            if not running:
                return
            future = self._next(finished, partial(tick, done / len(pairs)))
            pair = running.pop(future.key)
            done += 1
            try:
                yield pair, self._value(future, partial(tick, done / len(pairs)))
            except OSError:
                continue

    def _submit(self, function: Callable[..., Any], *arguments: Any) -> Any:
        # Not pure: two runs with one scheduler must not meet each other's results, files change.
        return self._client.submit(_on_worker, _core.method_number(), function, *arguments, pure=False)

    def _value(self, future: Any, tick: Tick) -> Any:
        finished: queue.SimpleQueue[Any] = queue.SimpleQueue()
        future.add_done_callback(finished.put)
        self._next(finished, tick)
        try:
            value = future.result()
        except Exception as error:
            self._check_connection()
            raise OSError(f"a Dask worker could not do it: {type(error).__name__}: {error}") from error
        if isinstance(value, _Fault):
            raise OSError(value.text)
        return value

    def _next(self, finished: queue.SimpleQueue[Any], tick: Tick) -> Any:
        while True:
            with contextlib.suppress(queue.Empty):
                return finished.get(timeout=_POLL_S)
            self._check_connection()
            self._check_there_are_workers()
            tick()

    def _check_connection(self) -> None:
        if self._client.status not in ("running", "connecting"):
            raise EngineLost("the connection to the Dask scheduler is lost")

    def _check_workers(self) -> None:
        for worker, answer in self._client.run(eval, _METHOD_THERE, on_error="return").items():
            if answer == _core.method_number():
                continue
            found = str(answer) if isinstance(answer, Exception) else "it has another version"
            raise ValueError(f"the Dask worker {worker} must have the igsp of the client: {found}")

    def _check_there_are_workers(self) -> None:
        if not self._warned and self._count_threads() == 0:
            self._warned = True
            self._warn("the Dask scheduler has no workers; waiting for them")

    def _count_threads(self) -> int:
        now = time.monotonic()
        if now - self._threads_known_at >= _THREADS_HOLD_S:
            with contextlib.suppress(OSError):  # on the way to a lost connection
                self._threads, self._threads_known_at = sum(self._client.nthreads().values()), now
        return self._threads

    def _window(self) -> int:
        return _PAIRS_PER_THREAD * max(1, self._count_threads())


def _on_worker(method: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """On a worker. Results pass between workers as they are; a fault is one, too, so that it is not tried again."""
    if method != _core.method_number():
        return _Fault("a Dask worker runs another version of igsp than the client")
    for argument in arguments:
        if isinstance(argument, _Fault):
            return argument
    try:
        return function(*arguments)
    except (OSError, ValueError, ImportError) as error:
        return _Fault(str(error))


def _register(source: Features, target: Features, options: dict[str, Any]) -> Result:
    return _core.register_pair(source, target, {**options, "threads": 1})
