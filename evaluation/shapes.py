"""What a JSON file must hold, so that a damaged one is told before it is used.

A shape is written like the value that it describes:

    str, bool, int, float       a value of this type; float takes whole numbers, too
    None                        null
    (None, float)               one of these
    [shape]                     a list of such values
    {"key": shape, "other?": shape}
                                an object with these keys, the second maybe
                                missing; more keys do not matter
    {str: shape}                an object with any keys
"""

from .processes import Failure

_NAMES = {str: "a text", bool: "true or false", int: "a whole number",
          float: "a number", None: "null", list: "a list", dict: "an object"}


def check(path, value, shape):
    """Raises Failure, which names the file and the key, if a value is not of a shape."""
    fault = _fault(value, shape, "it")
    if fault:
        raise Failure(f"{path} is damaged: {fault}; remove it to make it anew")


def _fault(value, shape, where):
    """What is wrong with a value, "" if nothing is."""
    if isinstance(shape, tuple):
        faults = [_fault(value, one, where) for one in shape]
        return "" if "" in faults else faults[-1]
    kind = type(shape) if isinstance(shape, (list, dict)) else shape
    if not _is(value, kind):
        return f"{where} is not {_NAMES[kind]}"
    if kind is list:
        return _first(_fault(one, shape[0], f"{where}[{i}]")
                      for i, one in enumerate(value))
    if kind is dict:
        return _first(_fault_of_key(value, key, part, where)
                      for key, part in shape.items())
    return ""


def _fault_of_key(value, key, shape, where):
    if key is str:
        return _first(_fault(part, shape, name) for name, part in value.items())
    name = key.removesuffix("?")
    if name in value:
        return _fault(value[name], shape, name)
    return "" if name != key else f"{where} has no key {name}"


def _is(value, kind):
    if kind is None or isinstance(value, bool):
        return value is None if kind is None else kind is bool
    return isinstance(value, (int, float) if kind is float else kind)


def _first(faults):
    return next(filter(None, faults), "")
