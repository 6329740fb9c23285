"""Options of stereo and fusion, by the names that they have on the command line."""

import difflib
import numbers
import os

from . import _engine

_KINDS = {bool: "True or False", int: "a whole number", float: "a number", str: "text"}


def stereo_options():
    """Defaults by name; on the command line the names stand behind "--PatchMatchStereo."."""
    return _engine.stereo_defaults()


def fusion_options():
    """Defaults by name; on the command line the names stand behind "--StereoFusion."."""
    return _engine.fusion_defaults()


def checked(options, defaults):
    """The same, of exactly the types that the defaults have, text as bytes.

    Raises ValueError for a name and TypeError for a value that cannot be used. Whether a number
    is within its range is for stereo to say.
    """
    return {name: _checked(name, value, defaults) for name, value in dict(options or {}).items()}


def _checked(name, value, defaults):
    if name not in defaults:
        near = difflib.get_close_matches(str(name).rpartition(".")[2], defaults, 1)
        raise ValueError(f"there is no option {name!r}"
                         + (f"; did you mean {near[0]!r}?" if near else ""))
    kind = type(defaults[name])
    try:
        return _converted(value, kind)
    except (TypeError, OverflowError):
        raise TypeError(f"the option {name!r} is {value!r}, but must be "
                        f"{_KINDS[kind]}") from None


def _converted(value, kind):
    is_boolean = type(value).__name__ in ("bool", "bool_")  # Of Python or numpy.
    if kind is str:
        return os.fsencode(value)
    if kind is bool and (is_boolean or (isinstance(value, int) and value in (0, 1))):
        return bool(value)
    if kind is int and isinstance(value, numbers.Integral) and not is_boolean:
        value = int(value)
        if -2**31 <= value < 2**31:
            return value
    if kind is float and isinstance(value, numbers.Real) and not is_boolean:
        return float(value)
    raise TypeError
