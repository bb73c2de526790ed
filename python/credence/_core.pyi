from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

class InputError(ValueError): ...
class Failure(RuntimeError): ...

class Judgement:
    @property
    def text(self) -> str: ...
    @property
    def json(self) -> str: ...
    @property
    def html(self) -> str: ...

def judge(
    arrays: Mapping[str, tuple[npt.NDArray[np.floating[Any]], float]],
    texts: Mapping[str, str],
    dimensions: Mapping[str, int],
    options: Mapping[str, str],
    name: str,
    progress: Callable[[int, int], object] | None,
) -> Judgement: ...
def judge_file(
    path: str, options: Mapping[str, str], progress: Callable[[int, int], object] | None
) -> Judgement: ...
def command(words: Sequence[str], progress: Callable[[int, int], object] | None) -> tuple[int, str, str]: ...
def program(arguments: Sequence[bytes]) -> int: ...
