"""What calls of the library raise."""
import re

DONE, NOT_CONVERGED, REFUSED, CANNOT_WRITE, NO_MEMORY, INTERRUPTED = 0, 1, 3, 4, 5, 75


class Error(Exception):
    """One sentence on what is wrong and what is allowed; status is the number of the library (DONE is 0)."""

    def __init__(self, sentence: str, status: int = REFUSED) -> None:
        super().__init__(sentence)
        self.status = status

    def __reduce__(self) -> "tuple[type[Error], tuple[str, int]]":
        return type(self), (str(self), self.status)


class SceneError(Error):
    """A scene, or what it is asked for, is refused: with file:line:column or the key."""


class NotConverged(Error):
    """Of calls with check=True, and of slender.torch: others leave it at the status of what they return."""


class SlenderWarning(UserWarning):
    """What is doubtful: of a scene, of a run, of OpenBLAS's kernels."""


def spoken(sentence: bytes) -> str:
    """A sentence of the library's, which speaks of the program's options, in words of this package."""
    text = re.sub(r"(?<![\w/.-])--(resume|force)\b", r"\1=True", sentence.decode(errors="replace"))
    return re.sub(r"(?<![\w/.-])--set (?=\S+=)", "set ", text)


def error_of(status: int, sentence: bytes, scene: bool = False) -> Error:
    kind = NotConverged if status == NOT_CONVERGED else SceneError if scene and status == REFUSED else Error
    return kind(spoken(sentence), status)
