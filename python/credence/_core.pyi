from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

class Said:
    def __init__(self, name: str, arguments: Sequence[str], options: Mapping[str, object]) -> None: ...
    def in_format(self, format: str) -> str: ...

class Told:
    step: int
    reach: float
    def trial(self) -> npt.NDArray[np.int64]: ...
    def mean(self) -> npt.NDArray[np.float64]: ...
    def covariance(self) -> npt.NDArray[np.float64]: ...
    def known(self) -> npt.NDArray[np.uint8]: ...
    def cells(self) -> npt.NDArray[np.uint8]: ...
    def candidates(self) -> npt.NDArray[np.float64]: ...
    def uniform(self, count: int) -> npt.NDArray[np.float64]: ...
    def prospects(self) -> list[npt.NDArray[np.float64]]: ...

def judge(
    arrays: Mapping[str, tuple[npt.NDArray[np.floating[Any]], float]],
    texts: Mapping[str, str],
    lists: Mapping[str, Sequence[Sequence[str]]],
    dimensions: Mapping[str, int],
    options: Mapping[str, object],
    name: bytes,
    progress: Callable[[int, int], object] | None,
) -> Said: ...
def check(
    arrays: Mapping[str, tuple[npt.NDArray[np.floating[Any]], float]],
    texts: Mapping[str, str],
    lists: Mapping[str, Sequence[Sequence[str]]],
    dimensions: Mapping[str, int],
) -> None: ...
def write_results_of(records: Sequence[bytes], seed: int, output: bytes) -> None: ...
def judge_file(
    path: bytes, options: Mapping[str, object], progress: Callable[[int, int], object] | None
) -> Said: ...
def budget(
    errors: Sequence[npt.NDArray[np.float64]],
    sources: Sequence[str],
    components: Sequence[tuple[str, str]],
    groups: Sequence[tuple[str, Sequence[int]]],
    variance: Sequence[float],
    left_out: int,
    seed: int,
    at: str,
    of: str,
    counted: Sequence[tuple[str, Sequence[float]]],
) -> Said: ...
def command(
    name: str,
    arguments: Sequence[str],
    options: Mapping[str, object],
    progress: Callable[[int, int], object] | None,
    planners: Mapping[str, tuple[str, Callable[[Told], npt.NDArray[np.float64] | str]]] = ...,
) -> tuple[int, str, str]: ...
def speak_of_options(options: bool) -> None: ...
def program(arguments: Sequence[bytes]) -> int: ...
