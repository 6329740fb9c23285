"""A page made from text and results, as a TOML file describes it.

    page = "results.md"           # beside the plan
    images = "images/results"
    title = "Results"
    text = '''...'''

    [sets.NAME]                   # results in OUT/NAME/METHOD-SEED
    data = "office_entrance"      # in the folder of data sets, or in the repository
    methods = ["plain", "tapa"]
    seeds = [0, 1, 2]             # and so on: see experiment.Experiment
    num_views = 1                 # of pictures, where no views are named

    [[section]]
    title = "..."                 # level 2; left out: no heading
    text = '''...'''
    set = "NAME"                  # its tables and figures follow the text
    show = ["depth", "errors"]    # report.BLOCKS, in this order
    methods = ["plain", "tapa"]   # only these
    command = true                # with the command that runs the set
"""

import dataclasses
import os
import re
import tomllib

from . import experiment, files, pictures, report
from .methods import METHODS
from .processes import Failure



def _is_text(value):
    return isinstance(value, str)


def _is_whole(value):
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_count(value):
    return _is_whole(value) and value > 0


def _is_positive(value):
    return (isinstance(value, (int, float)) and not isinstance(value, bool)
            and 0 < value < 1e9)


def _list_of(check):
    return lambda value: isinstance(value, list) and value != [] and all(
        check(one) for one in value)


# By key: what its value must be, and how to say that.
_TEXT = (_is_text, "a text")
_TEXTS = (_list_of(_is_text), "a list of texts")
_COUNT = (_is_count, "a positive whole number")
_WHOLE = (_is_whole, "a whole number")
_NUMBERS = (_list_of(_is_positive), "a list of positive numbers")
_PAGE_KEYS = {"page": _TEXT, "images": _TEXT, "title": _TEXT, "text": _TEXT,
              "sets": (lambda value: isinstance(value, dict), "tables [sets.NAME]"),
              "section": (_list_of(lambda one: isinstance(one, dict)),
                          "tables [[section]]")}
_SET_KEYS = {"data": _TEXT, "methods": _TEXTS,
             "seeds": (_list_of(_is_whole), "a list of whole numbers"),
             "options": _TEXTS, "sources": _COUNT, "every": _COUNT,
             "tolerances": _NUMBERS, "relative_tolerances": _NUMBERS,
             "views": _TEXTS, "num_views": _WHOLE}
_SECTION_KEYS = {"title": _TEXT, "text": _TEXT, "set": _TEXT, "show": _TEXTS,
                 "methods": _TEXTS, "tolerances": _NUMBERS,
                 "relative_tolerances": _NUMBERS, "level": _COUNT,
                 "command": (lambda value: isinstance(value, bool), "true or false")}


class Plan:
    """A plan, whose sets are Benchmarks by name."""

    def __init__(self, path, data_folder, root):
        """data_folder: of the data sets; root: the repository."""
        self._folder = os.path.dirname(os.path.abspath(path))
        content = _read(path)
        self._content = content
        self.sets = {}
        for name, values in content.get("sets", {}).items():
            _check_set(path, name, values)
            values = dict(values, data=_find_data(values["data"], data_folder,
                                                  root))
            count = values.pop("num_views", 0)
            self.sets[name] = one = experiment.Experiment(name=name, **values)
            if not one.views and os.path.isdir(one.data):
                one.views = pictures.choose_views(one.data, one.every, count)
        for section in content.get("section", []):
            _check_section(path, section, self.sets)

    def page_folder(self, out):
        """The plan's folder, or OUT as long as a set has no results at all."""
        return (self._folder
                if all(report.SetReport(one, out, "", "").found
                       for one in self.sets.values()) else out)

    def write(self, out, bin_dir=None, only=None):
        """Writes the page from what is in OUT.

        only: names of sets; the page is about these alone, and goes to OUT.
        Returns its path, and what is missing.
        """
        folder = out if only else self.page_folder(out)
        page = os.path.join(folder, self._content["page"])
        parts = [f"# {self._content['title']}\n",
                 self._content.get("text", "").strip() + "\n"]
        for section in self._content.get("section", []):
            if only and section.get("set") not in only:
                continue
            if "title" in section:
                parts.append("#" * section.get("level", 2)
                             + f" {section['title']}\n")
            if "text" in section:
                parts.append(section["text"].strip() + "\n")
            if "set" in section:
                parts += self._results(section, out, folder, bin_dir)
        text = "\n".join(part for part in parts if part.strip())
        files.write_text(page, self._move_links(text, folder))
        return page, [line for name, one in self.sets.items()
                      if not only or name in only
                      for line in report.SetReport(one, out, "", "").missing()]

    def _move_links(self, text, folder):
        """Links to pages beside the plan, for a page that stands elsewhere."""
        above = os.path.relpath(self._folder, folder).replace(os.sep, "/")
        return text if above == "." else re.sub(
            r"\]\(([\w./-]+\.(?:md|toml)[)#])", rf"]({above}/\1", text)

    def _results(self, section, out, folder, bin_dir):
        one = dataclasses.replace(
            self.sets[section["set"]],
            **{key: section[key] for key in (
                "methods", "tolerances", "relative_tolerances")
               if key in section})
        made = report.SetReport(
            one, out, folder,
            os.path.join(folder, self._content.get("images", "images")),
            os.path.join(out, "tables"), bin_dir)
        with_command = section.get("command", True)
        parts = [f"    {experiment.command_text(self.sets[one.name])}\n"
                 ] if with_command else []
        if not made.found:
            return parts + [f"*`{one.name}` has not been run.*\n"]
        parts += [made.block(kind) for kind in section["show"]]
        return parts + ([made.provenance()] if with_command else [])


def _read(path):
    try:
        with open(path, "rb") as file:
            content = tomllib.load(file)
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error
    except ValueError as error:  # Neither TOML nor even UTF-8.
        raise Failure(f"{path} is not TOML: {error}") from error
    for key in ("page", "title"):
        if key not in content:
            raise Failure(f"{path} has no {key}")
    _check_keys(path, "the page", content, _PAGE_KEYS)
    return content


def _check_keys(path, where, values, known):
    for key, value in values.items():
        if key not in known:
            raise Failure(f"{path}: {where} has an unknown key {key}; there are "
                          + ", ".join(sorted(known)))
        is_right, kind = known[key]
        if not is_right(value):
            raise Failure(f"{path}: {key} of {where} must be {kind}")


def _check_set(path, name, values):
    if not re.fullmatch(r"[\w.+-]+", name) or not isinstance(values, dict):
        raise Failure(f"{path}: sets.{name} must be a table, and its name of letters, "
                      "digits and _.+-")
    _check_keys(path, f"sets.{name}", values, _SET_KEYS)
    if "data" not in values:
        raise Failure(f"{path}: sets.{name} has no data")
    _check_methods(path, f"sets.{name}", values)


def _check_methods(path, where, values):
    for method in values.get("methods", []):
        if method not in METHODS:
            raise Failure(f"{path}: {where} has an unknown method {method}; there are "
                          + ", ".join(METHODS))


def _check_section(path, section, sets):
    _check_keys(path, "a section", section, _SECTION_KEYS)
    _check_methods(path, "a section", section)
    if "set" not in section:
        return
    if section["set"] not in sets:
        raise Failure(f"{path}: a section shows the set {section['set']}, which "
                      "is not among its sets")
    for kind in section.get("show", []):
        if kind not in report.BLOCKS:
            raise Failure(f"{path}: a section shows {kind}; there are "
                          + ", ".join(report.BLOCKS))
    section.setdefault("show", ["depth", "low_texture", "cost"])


def _find_data(name, data_folder, root):
    """A set in the folder of data sets, or else in the repository."""
    if data_folder and os.path.isdir(os.path.join(data_folder, name)):
        return os.path.join(data_folder, name)
    return os.path.join(root, name)
