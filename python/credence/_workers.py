"""Tasks on executors: those of `concurrent.futures`, and whatever has their `submit`, such as Dask's and mpi4py's."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import multiprocessing
import os
import pickle
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.connection import wait as wait_for_pipes
from typing import Any, Generic, TypeVar

from credence import Failure, InputError

Payload = TypeVar("Payload")

TRIES = 3  # of a task whose worker is lost
PATIENCE = 1.0  # seconds after which it is looked whether a process has ended without a word
PR_SET_PDEATHSIG = 1
_cannot_be_sent = (pickle.PicklingError, AttributeError, TypeError, ImportError)


class _Lost(Exception):
    """The process that did a task has ended."""


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Signals that raise an exception in this thread do so afterwards: no process is left behind by Ctrl-C."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    found: dict[int, Any] = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    handlers = {number: handler for number, handler in found.items() if callable(handler)}
    noted: list[tuple[int, Any]] = []
    try:
        for number in handlers:
            signal.signal(number, lambda *given: noted.append(given))
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number, frame in noted[:1]:
            handlers[number](number, frame)


def _serve(
    pipe: Connection, parent: int, others: list[Any], begin: Any, function: Callable[..., Any], shared: object
) -> None:
    """Do tasks in a process of our own. Ctrl-C is for the process that waits, at whose death this one ends as well."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    for other in others:  # ends of pipes that a fork has, too: what the parent alone has ends with it
        other.close()
    with contextlib.suppress(OSError, AttributeError):  # Linux
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if others and os.getppid() != parent:
        return
    begin()
    with contextlib.suppress(EOFError, OSError):  # the parent has ended
        while True:
            task = pipe.recv()
            try:
                answer = (True, function(shared, *task))
            except Exception as error:
                answer = (False, error)
            pipe.send(answer)


class _Processes:
    """Processes of our own, each with a pipe of its own: one that is killed, whenever it is, breaks only that pipe.

    They are forked where the system can fork, so that the function of a notebook or a closure will do.

    Parameters
    ----------
    count : int
    function, shared
        A task is ``function(shared, *arguments)``.
    like : ProcessPoolExecutor
        One that is broken, whose kind of processes these have.
    """

    def __init__(self, count: int, function: Callable[..., Any], shared: object, like: Any = None) -> None:
        kind = "fork" if "fork" in multiprocessing.get_all_start_methods() else None
        self._context: Any = multiprocessing.get_context(kind) if like is None else like._mp_context
        is_set = like is not None and like._initializer is not None
        begin = functools.partial(like._initializer, *like._initargs) if is_set else int
        self._given, self._left = (begin, function, shared), count
        self._idle: list[tuple[Any, Any]] = []
        self._busy: dict[Any, tuple[Any, Future[Any]]] = {}

    def submit(self, arguments: tuple[Any, ...]) -> Future[Any]:
        while not self._idle and self._left == 0:
            self.wait()
        future: Future[Any] = Future()
        with _uninterrupted():
            for process, pipe in self._idle:
                if not process.is_alive():
                    self._end(process, pipe)
            alive = [one for one in self._idle if one[0].exitcode is None]
            self._idle, self._left = alive, self._left + len(self._idle) - len(alive)
            process, pipe = self._idle.pop() if self._idle else self._another()
            self._busy[pipe] = (process, future)
        with contextlib.suppress(OSError):  # it has ended, which is noticed in the next line but one
            pipe.send(arguments)
        return future

    def _another(self) -> tuple[Any, Any]:
        mine, its = self._context.Pipe()
        is_fork = self._context.get_start_method() == "fork"
        others = [mine, *self._busy, *(pipe for _, pipe in self._idle)] if is_fork else []
        process = self._context.Process(target=_serve, args=(its, os.getpid(), others, *self._given))
        process.start()
        its.close()
        self._left -= 1
        return process, mine

    def wait(self) -> None:
        """Wait until a task is done, or its process has ended."""
        ready: list[Any] = wait_for_pipes(list(self._busy), PATIENCE)
        ended = [pipe for pipe, (process, _) in self._busy.items() if pipe not in ready and not process.is_alive()]
        for pipe in [*ready, *ended]:
            process, future = self._busy[pipe]
            try:
                is_done, answer = pipe.recv() if pipe in ready else (False, _Lost())
            except (EOFError, OSError):
                is_done, answer = False, _Lost()
            with _uninterrupted():
                del self._busy[pipe]
                if isinstance(answer, _Lost):
                    self._left += 1
                    self._end(process, pipe)
                else:
                    self._idle.append((process, pipe))
            if future.set_running_or_notify_cancel():
                (future.set_result if is_done else future.set_exception)(answer)

    @staticmethod
    def _end(process: Any, pipe: Connection) -> None:
        process.kill()
        process.join()
        pipe.close()

    def close(self) -> None:
        """End them all, whatever they do."""
        with _uninterrupted():
            left = [*self._idle, *((process, pipe) for pipe, (process, _) in self._busy.items())]
            self._idle, self._busy = [], {}
            for process, _ in left:
                process.kill()
            for process, pipe in left:
                self._end(process, pipe)


def _has_lost_one(pool: ProcessPoolExecutor) -> bool:
    """Whether a process has ended: in the middle of a result, which the pool then waits for until all have."""
    processes = list((pool._processes or {}).values())
    if all(process.exitcode is None for process in processes):
        return False
    for process in processes:
        process.kill()
    with contextlib.suppress(AttributeError, OSError):
        pool._result_queue._writer.close()  # type: ignore[attr-defined]  # the pool's own end of the pipe
    return True


def _workers_of(executor: Any) -> int:
    """How many tasks an executor can run at once."""
    for name in ("_max_workers", "num_workers"):
        count = getattr(executor, name, None)
        if isinstance(count, int) and count > 0:
            return count
    with contextlib.suppress(Exception):  # dask.distributed
        return max(1, int(sum(executor._client.ncores().values())))
    return os.cpu_count() or 1


@contextlib.contextmanager
def _refusals(own: bool, executor: Any) -> Iterator[None]:
    """Say why an executor takes no tasks."""
    try:
        yield
    except (BrokenExecutor, InputError, Failure):
        raise
    except OSError as error:
        if not own:
            raise
        why = "Let processes and memory in /dev/shm be made, or leave executor out"
        raise Failure(f"cannot start processes ({error.strerror or error}). {why}.") from error
    except RuntimeError as error:
        if own or isinstance(executor, _Here):
            raise
        raise InputError(f"invalid executor of {type(executor).__name__} ({error}). Give one that is open.") from error


class _Here:
    """This process as an executor: a task is done when it is submitted."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(function(*arguments))
        return future


@dataclass
class Task(Generic[Payload]):
    """What a worker has to do, whether nothing is done beside it, and how often it was lost so."""

    payload: Payload
    is_alone: bool = False
    lost: int = 0


class Workers(Generic[Payload]):
    """Runs ``function(shared, *arguments(payload))`` for payloads, on an executor.

    Parameters
    ----------
    executor : None, int, or object with ``submit``
        None is this process, a number that many processes of our own.
    function, shared
        What is called, and its first argument; both are pickled, but for processes of our own.
    is_whole : function
        Whether a result came as it was sent. A task whose result did not is lost.
    """

    def __init__(
        self,
        executor: Any,
        function: Callable[..., Any],
        shared: object,
        is_whole: Callable[[Any], bool] = lambda result: True,
    ) -> None:
        self.function, self.shared, self.is_whole = function, shared, is_whole
        is_number = isinstance(executor, int) and not isinstance(executor, bool)
        self.executor: Any = _Here() if executor is None else executor
        self.count = 1 if executor is None else executor if is_number else _workers_of(executor)
        self.window = 1 if executor is None else self.count if is_number else 2 * self.count + 1  # tasks at once
        self.own = _Processes(self.count, function, shared) if is_number else None

    def submit(self, arguments: tuple[Any, ...]) -> Future[Any]:
        if self.own:
            with _refusals(True, None):
                return self.own.submit(arguments)
        try:
            with _refusals(False, self.executor):
                future: Future[Any] = self.executor.submit(self.function, self.shared, *arguments)
        except BrokenExecutor as error:
            future = Future()
            future.set_exception(error)
        return future

    def _wait(self, running: dict[Future[Any], Task[Payload]]) -> list[Future[Any]]:
        """Those that are done, one at least; all where an executor is broken."""
        if self.own:
            self.own.wait()
            return [future for future in running if future.done()]
        done = wait(running, PATIENCE if type(self.executor) is ProcessPoolExecutor else None, FIRST_COMPLETED).done
        while not done and not _has_lost_one(self.executor):
            done = wait(running, PATIENCE, FIRST_COMPLETED).done
        if done and not any(isinstance(one.exception(), BrokenExecutor) for one in done if not one.cancelled()):
            return list(done)
        self._replace()
        return list(running)

    def _replace(self) -> None:
        """A pool of processes is broken as a whole when one of them is lost: go on with processes of our own."""
        if type(self.executor) is not ProcessPoolExecutor:
            kind = type(self.executor).__name__
            raise Failure(f"a worker was lost, and with it the {kind}. What was done is kept: resume with a new one.")
        self.own, self.window = _Processes(self.count, self.function, self.shared, self.executor), self.count

    def results(
        self,
        take: Callable[[], Payload | None],
        arguments: Callable[[Payload], tuple[Any, ...]],
        parts: Callable[[Payload], list[Payload]] = lambda payload: [payload],
    ) -> Iterator[tuple[Payload, Any]]:
        """Yield payloads with their results as they come, in any order; None where a worker was lost too often.

        A task whose worker is lost runs again in its `parts`, one by one and nothing beside them, so that a part that
        ends its worker is told from those that only were beside it: the part that is lost three times is given up.

        Parameters
        ----------
        take : function
            Gives the next payload, or None if there is none.
        arguments : function
            Gives the arguments of a payload.
        parts : function
            Gives the parts of a payload.
        """
        again: deque[Task[Payload]] = deque()
        running: dict[Future[Any], Task[Payload]] = {}
        try:
            while True:
                while len(running) < self.window and not any(task.is_alone for task in running.values()):
                    if again and running:
                        break
                    if again:
                        task = again.popleft()
                    else:
                        payload = take()
                        if payload is None:
                            break
                        task = Task(payload)
                    running[self.submit(arguments(task.payload))] = task
                if not running:
                    return
                for future in self._wait(running):
                    task = running.pop(future)
                    try:
                        result = future.result(0)
                        if self.is_whole(result):
                            yield task.payload, result
                            continue
                    except _cannot_be_sent as error:
                        said = " ".join(str(error).split())[:300]
                        remedy = "Define it in a module that the workers can import, or give a number of processes"
                        raise InputError(f"a task cannot be sent to the executor ({said}). {remedy}.") from error
                    except (InputError, Failure):
                        raise
                    except Exception:  # its worker was lost: BrokenExecutor, distributed's KilledWorker
                        pass
                    if not task.is_alone:
                        again.extend(Task(part, True) for part in parts(task.payload))
                        continue
                    task.lost += 1
                    if task.lost < TRIES:
                        again.append(task)
                    else:
                        yield task.payload, None
        finally:
            for future in running:
                future.cancel()

    def close(self) -> None:
        """End the processes that are ours; an executor that was given stays as it is."""
        if self.own:
            self.own.close()
