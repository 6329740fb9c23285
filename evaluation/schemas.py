"""Models of what files hold, so that a damaged one is told before it is used.

Values are not converted: a number that stands where a text should be is an error.
"""

import pydantic

from .processes import Failure

Text = pydantic.StrictStr
Integer = pydantic.StrictInt


class Model(pydantic.BaseModel):
    """An object with these keys; more keys do not matter, and are kept."""

    class Config:
        extra = "allow"


class Number(float):
    """A number, whole or not."""

    @classmethod
    def __get_validators__(cls):
        yield cls._check

    @classmethod
    def _check(cls, value):
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise TypeError("value is not a number")
        return value


class Positive(Number):
    """A number that a length or a percentage may have."""

    @classmethod
    def _check(cls, value):
        if not 0 < super()._check(value) < 1e9:
            raise ValueError("value is not positive")
        return value


def check(content, model, path, damaged="is damaged: {}; remove it to make it anew"):
    """The content of a file as a model.

    Raises Failure, which names the file and the key, if it is not of that kind.
    damaged: how to tell that, with {} for what is wrong.
    """
    try:
        if not isinstance(content, dict):
            raise Failure(f"{path} {damaged.format('it is not an object')}")
        return pydantic.parse_obj_as(model, content)
    except pydantic.ValidationError as error:
        raise Failure(f"{path} {damaged.format(_fault(error.errors()[0]))}") from error


def _fault(error):
    """What is wrong, from one of pydantic's errors."""
    *above, key = [str(part) for part in error["loc"] if part != "__root__"] or [""]
    where = ".".join(above) or "it"
    if error["type"] == "value_error.missing":
        return f"{where} has no key {key}"
    if error["type"] == "value_error.extra":
        return f"{where} has an unknown key {key}"
    return ": ".join(filter(None, (".".join([*above, key]), error["msg"])))
