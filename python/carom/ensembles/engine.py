"""Sends runs in batches to anything that has `submit` of concurrent.futures, and takes what comes back."""

from __future__ import annotations

import contextlib
import math
import os
import queue
import signal
import time
from collections import deque
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Optional

if TYPE_CHECKING:  # an import of carom would pay for them
    from concurrent.futures import Future, ProcessPoolExecutor

import numpy

from .points import Points
from .task import Failure, Results, Task, message_of, run_message

_BATCH_TIME, _OF_WORKER = 0.2, 4e-3  # of a batch, and for each worker, if that is more [s]: a message costs two milliseconds
_GRACE = 1.0  # for batches that are under way when the user ends it [s]
_MOST_RUNS, _MOST_BYTES = 20000, 2e6  # in a batch, of its results
_BYTES_SENT = 256e6  # of results of all batches that are under way
_ASKS = 1.0  # from one question to the next, how many workers Dask has [s]
_GROWTH = 8  # of batches, from one to the next, until their time is known


class SerialExecutor:
    """Runs everything here, at once: an executor for debugging, and the one process of comparisons."""

    def submit(self, function: Any, /, *arguments: Any, **named: Any) -> Future[Any]:
        """The result of a call, which is made now."""
        from concurrent.futures import Future

        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments, **named))
        except BaseException as error:  # noqa: BLE001: it comes out where the result is asked for
            future.set_exception(error)
        return future


def _ignore_interrupts() -> None:
    """Ctrl-C reaches all processes of a terminal; the one that has the others ends them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def runs_of_batch(seconds: float, row: float, workers: int) -> int:
    """How many runs are sent together. seconds: of a run. row: bytes of its results."""
    by_time = max(_BATCH_TIME, _OF_WORKER * workers) / seconds
    by_size = min(_MOST_BYTES, _BYTES_SENT / (2 * workers + 2)) / max(row, 1.0)
    return max(1, int(min(by_time, by_size, _MOST_RUNS)))


class Engine:
    """An executor, its own processes if none is given, and the batches that it has."""

    def __init__(self, executor: Any, task: Task, points: Points) -> None:
        """executor: with submit(); a number of processes; None: as many processes as the machine has cores."""
        self._task, self._points = task, points
        self._processes = executor if isinstance(executor, int) else None if executor is not None else _cores()
        if self._processes is not None and self._processes < 1:
            raise ValueError(f"ensemble: executor is {executor} processes; allowed: one at least")
        self._executor = self._own() if self._processes is not None else executor
        self._workers = self._processes or getattr(executor, "_max_workers", None) or _cores()
        self._client: Any = getattr(executor, "_client", None)  # of Dask
        self._asked = -math.inf
        self._finished: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self._seconds_of_run: Optional[float] = None
        self._size = 1
        self.interrupted = False

    def _own(self) -> ProcessPoolExecutor:
        from concurrent.futures import ProcessPoolExecutor

        return ProcessPoolExecutor(self._processes, initializer=_ignore_interrupts)

    def results(self, runs: Iterator[int]) -> Iterator[Results]:
        """Rows of all runs, as they come. Ends early, `interrupted`, on Ctrl-C."""
        waiting: deque[list[int]] = deque()
        sent: dict[Future[Any], list[int]] = {}
        batch: Optional[list[int]]
        try:
            while True:
                # Of runs that ended a process it shows which did where each is alone.
                most = self._most_sent()
                while len(sent) < (1 if waiting else most):
                    batch = waiting.popleft() if waiting else self._next(runs)
                    if not batch:
                        break
                    self._send(batch, sent, waiting)
                if not sent:
                    return
                for future in self._done():
                    batch = sent.pop(future, None)
                    if batch is None:  # lost with its process, and waiting already
                        continue
                    rows = self._taken(future, batch, sent, waiting)
                    if rows is None:
                        continue
                    self._learn(rows)
                    yield rows
                    if rows.interrupted:
                        raise KeyboardInterrupt
        except KeyboardInterrupt:
            self.interrupted = True
            yield from self._rest(sent)
        finally:
            self._end(sent)

    def _most_sent(self) -> int:
        """Batches that are under way at once: two for each worker, so that none waits; of a serial executor each is done when
        it is sent.
        """
        if isinstance(self._executor, SerialExecutor):
            return 1
        if hasattr(self._client, "ncores") and time.monotonic() - self._asked > _ASKS:  # they come and go
            self._workers = max(1, sum(self._client.ncores().values()))
            self._asked = time.monotonic()
        return 2 * self._workers + 2

    def _done(self) -> list[Future[Any]]:
        """What has come, one at least. Of thousands under way none is looked at that has not."""
        done = [self._finished.get()]
        with contextlib.suppress(queue.Empty):
            while True:
                done.append(self._finished.get_nowait())
        return done

    def _end(self, sent: dict[Any, list[int]]) -> None:
        """Ends what is still under way, and the processes of its own."""
        for future in sent:
            future.cancel()
        if self._processes is None:
            return
        running = list((getattr(self._executor, "_processes", None) or {}).values()) if sent else []
        self._executor.shutdown(wait=False, cancel_futures=True)
        for process in running:  # they ignore Ctrl-C, and a run may take hours
            process.terminate()

    def _send(self, batch: list[int], sent: dict[Any, list[int]], waiting: deque[list[int]]) -> None:
        from concurrent.futures.process import BrokenProcessPool

        message = message_of(batch, [self._points[run] for run in batch])
        try:
            future = self._executor.submit(run_message, self._task, message)
        except BrokenProcessPool:
            if self._processes is None:
                raise
            self._executor = self._own()
            waiting.appendleft(batch)
        else:
            sent[future] = batch
            future.add_done_callback(self._finished.put)

    def _next(self, runs: Iterator[int]) -> list[int]:
        size = self._size
        batch = []
        for run in runs:
            batch.append(run)
            if len(batch) == size:
                break
        return batch

    def _learn(self, rows: Results) -> None:
        """Chooses how many runs take the time of a batch."""
        if len(rows.runs) == 0:
            return
        of_run = max(rows.seconds / len(rows.runs), 1e-7)
        # Runs differ; of the slower ones a batch may last longer.
        before = self._seconds_of_run
        self._seconds_of_run = of_run if before is None else 0.8 * before + 0.2 * of_run
        of_row = sum(column.nbytes for column in rows.values) / len(rows.runs)
        self._size = min(runs_of_batch(self._seconds_of_run, of_row, self._workers), _GROWTH * self._size)

    def _taken(
        self, future: Any, batch: list[int], sent: dict[Any, list[int]], waiting: deque[list[int]]
    ) -> Optional[Results]:
        """Rows of a batch; None where its process ended and it is sent again."""
        from concurrent.futures.process import BrokenProcessPool

        try:
            rows: Results = future.result()
            return rows
        except BrokenProcessPool:
            if self._processes is None:
                raise
            # Every batch that was under way is lost, and made again run by run.
            if len(batch) == 1 and not sent:
                point = dict(zip(self._points.names, self._points[batch[0]]))
                failure = Failure(
                    batch[0], point, "its process ended", "BrokenProcessPool", [], float("nan")
                )
                self._executor = self._own()
                return Results(numpy.array(batch), [], [failure], 0.0, False)
            lost = [batch, *sent.values()]
            sent.clear()
            self._executor = self._own()
            waiting.extend([run] for runs in lost for run in runs)
            return None

    def _rest(self, sent: dict[Any, list[int]]) -> Iterator[Results]:
        """What is done of what was sent when the user ended it, or soon after."""
        from concurrent import futures

        for future in list(sent):
            future.cancel()
        futures.wait(sent, timeout=_GRACE)
        for future in list(sent):
            if future.done() and not future.cancelled() and future.exception() is None:
                yield future.result()
                del sent[future]


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
