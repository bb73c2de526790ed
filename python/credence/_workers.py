"""Tasks on executors: those of `concurrent.futures`, and whatever has their `submit`, such as Dask's and mpi4py's."""

from __future__ import annotations

import contextlib
import ctypes
import multiprocessing
import os
import pickle
import signal
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Generic, TypeVar

from credence import Failure, InputError

Payload = TypeVar("Payload")

TRIES = 3  # of a task whose worker is lost
PR_SET_PDEATHSIG = 1
_cannot_be_sent = (pickle.PicklingError, AttributeError, TypeError, ImportError)

BREAKS = 30  # of the pool, after which a task that it never began is given up as well

_shared: Any = None  # in a process of our own: what all tasks share, which a fork need not pickle
_is_at_work: Any = None  # likewise: whether a task is being done, for the process that waits


def _begin(shared: object, is_at_work: Any) -> None:
    """Begin a process of our own. Ctrl-C is for the process that waits, at whose death this one ends as well."""
    global _shared, _is_at_work
    _shared, _is_at_work = shared, is_at_work
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with contextlib.suppress(OSError, AttributeError):  # Linux
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _call_shared(function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    _is_at_work.value = 1
    result = function(_shared, *arguments)
    _is_at_work.value = 0
    return result


class _Here:
    """This process as an executor: a task is done when it is submitted."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(function(*arguments))
        return future


def _own_processes(count: int, shared: object, is_at_work: Any) -> ProcessPoolExecutor:
    """Processes that are forks of this one, so that the function of a notebook or a closure will do."""
    kind = "fork" if "fork" in multiprocessing.get_all_start_methods() else None
    return ProcessPoolExecutor(count, multiprocessing.get_context(kind), _begin, (shared, is_at_work))


def _another(broken: Any) -> Any:
    """A pool in place of one of the standard library that was broken; None for executors of another kind."""
    if type(broken) is not ProcessPoolExecutor:
        return None
    made: Any = broken
    return ProcessPoolExecutor(made._max_workers, made._mp_context, made._initializer, made._initargs)


def _end(pool: ProcessPoolExecutor) -> None:
    """End a pool at once, whatever its processes do."""
    processes = list((pool._processes or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.kill()
    for process in processes:
        process.join()


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
        if isinstance(executor, _Here):
            raise
        raise InputError(f"invalid executor of {type(executor).__name__} ({error}). Give one that is open.") from error


@dataclass
class Task(Generic[Payload]):
    """What a worker has to do, whether nothing is done beside it, and how often it was lost so."""

    payload: Payload
    is_alone: bool = False
    lost: int = 0  # while it was being done
    breaks: int = 0  # in all


class Workers(Generic[Payload]):
    """Runs ``function(shared, *arguments(payload))`` for payloads, on an executor.

    Parameters
    ----------
    executor : None, int, or object with ``submit``
        None is this process, a number that many processes of our own.
    function, shared
        What is called, and its first argument; both are pickled, but for processes of our own.
    """

    def __init__(self, executor: Any, function: Callable[..., Any], shared: object) -> None:
        self.function, self.shared = function, shared
        self.own = isinstance(executor, int) and not isinstance(executor, bool)
        if self.own and executor < 1:
            raise InputError(f"invalid executor={executor} (must be at least 1 process). Give their number.")
        if executor is not None and not self.own and not callable(getattr(executor, "submit", None)):
            what = f"invalid executor of {type(executor).__name__} (it has no submit)"
            raise InputError(f"{what}. Give a number of processes, or an executor of concurrent.futures.")
        with _refusals(self.own, executor):
            self._is_at_work: Any = multiprocessing.RawValue("q", 0) if self.own else SimpleNamespace(value=0)
        self.replaced = False  # whether the executor in use is one of ours in place of a broken one
        self.executor: Any = _Here() if executor is None else executor
        self.count = 1 if executor is None else executor if self.own else _workers_of(executor)
        self.window = 1 if executor is None else 2 * self.count + 1  # tasks that wait or run
        if self.own:
            with _refusals(self.own, executor):
                self.executor = _own_processes(self.count, shared, self._is_at_work)

    def submit(self, arguments: tuple[Any, ...]) -> Future[Any]:
        if self.own:
            return self._sent(_call_shared, self.function, arguments)
        return self._sent(self.function, self.shared, *arguments)

    def _sent(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        try:
            with _refusals(self.own, self.executor):
                future: Future[Any] = self.executor.submit(function, *arguments)
        except BrokenExecutor as error:
            future = Future()
            future.set_exception(error)
        return future

    def _replace(self) -> None:
        """A pool of processes is broken as a whole when one of them is lost: go on with another."""
        broken = self.executor
        self._is_at_work.value = 0
        self.executor = _own_processes(self.count, self.shared, self._is_at_work) if self.own else _another(broken)
        if self.executor is None:
            self.executor = broken
            kind = type(broken).__name__
            raise Failure(f"a worker was lost, and with it the {kind}. What was done is kept: resume with a new one.")
        if self.own or self.replaced:
            _end(broken)
        self.replaced = True

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
                done, _ = wait(running, return_when=FIRST_COMPLETED)
                is_broken = False
                for future in list(running) if self._is_broken(done) else done:
                    task = running.pop(future)
                    try:
                        result = future.result()
                    except BrokenExecutor:
                        is_broken = True
                    except _cannot_be_sent as error:
                        said = " ".join(str(error).split())[:300]
                        remedy = "Define it in a module that the workers can import, or give a number of processes"
                        raise InputError(f"a task cannot be sent to the executor ({said}). {remedy}.") from error
                    except (InputError, Failure):
                        raise
                    except Exception:  # such as distributed's KilledWorker
                        pass
                    else:
                        yield task.payload, result
                        continue
                    if not task.is_alone:
                        again.extend(Task(part, True) for part in parts(task.payload))
                        continue
                    task.lost += 1 if not self.own or self._is_at_work.value else 0
                    task.breaks += 1
                    if task.lost < TRIES and task.breaks < BREAKS:
                        again.append(task)
                    else:
                        yield task.payload, None
                if is_broken:
                    self._replace()
        finally:
            for future in running:
                future.cancel()

    @staticmethod
    def _is_broken(done: set[Future[Any]]) -> bool:
        return any(isinstance(future.exception(), BrokenExecutor) for future in done if not future.cancelled())

    def close(self) -> None:
        """End the processes that are ours; an executor that was given stays as it is."""
        if self.own or self.replaced:
            _end(self.executor)
