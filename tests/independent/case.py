"""What a case is."""

import dataclasses
import typing

import numpy


def plain(value):
    """The same in the types of JSON: arrays are lists, and numbers that are compared with a tolerance are floats."""
    if isinstance(value, dict):
        return {str(key): plain(inside) for key, inside in value.items()}
    if isinstance(value, (list, tuple, numpy.ndarray)):
        return [plain(inside) for inside in value]
    if isinstance(value, numpy.generic):
        return value.item()
    return value


@dataclasses.dataclass
class Case:
    """A question to `measure` and the answer that it should give.

    Floats of `expected` are compared with `relative` or `absolute`, whichever allows more; all else must be equal. Keys
    that the answer has and `expected` has not are not looked at. `of` makes of the answer what is compared.
    """

    name: str
    call: str
    given: dict
    expected: typing.Any
    relative: float = 1e-10
    absolute: float = 1e-13
    of: typing.Callable | None = None

    def __post_init__(self):
        self.given, self.expected = plain(self.given), plain(self.expected)

    def equal(self, found, expected):
        return abs(found - expected) <= max(self.absolute, self.relative * abs(expected))

    def broken(self, found):
        """A number that is wrong: by three times what is allowed."""
        return found + 3.0 * max(self.absolute, self.relative * abs(found))
