"""A page made from text and results, as a TOML file describes it.

    page = "results.md"           # beside the plan
    images = "images/results"
    title = "Results"
    text = '''...'''

    [sets.NAME]                   # results in OUT/NAME/METHOD-SEED
    data = "office_entrance"      # in the folder of data sets, or in the repository
    methods = ["plain", "tapa"]
    seeds = [0, 1, 2]             # and so on: see benchmark.Benchmark

    [[section]]
    title = "..."                 # level 2; left out: no heading
    text = '''...'''
    set = "NAME"                  # its tables and figures follow the text
    show = ["depth", "errors"]    # report.BLOCKS, in this order
    methods = ["plain", "tapa"]   # only these
"""

import dataclasses
import os
import tomllib

from . import benchmark, files, report
from .processes import Failure

_SET_KEYS = {field.name for field in dataclasses.fields(benchmark.Benchmark)}
_SECTION_KEYS = {"title", "text", "set", "show", "methods", "tolerances",
                 "relative_tolerances", "level"}


class Plan:
    """A plan, whose sets are Benchmarks by name."""

    def __init__(self, path, data_folder, root):
        """data_folder: of the data sets; root: the repository."""
        self._folder = os.path.dirname(os.path.abspath(path))
        content = _read(path)
        self._content = content
        self.sets = {}
        for name, values in content.get("sets", {}).items():
            _check_keys(path, f"sets.{name}", values, _SET_KEYS - {"name"})
            if "data" not in values:
                raise Failure(f"{path}: sets.{name} has no data")
            values = dict(values, data=_find_data(values["data"], data_folder,
                                                  root))
            self.sets[name] = benchmark.Benchmark(name=name, **values)
        for section in content.get("section", []):
            _check_keys(path, "a section", section, _SECTION_KEYS)
            _check_section(path, section, self.sets)

    def page_path(self):
        return os.path.join(self._folder, self._content["page"])

    def write(self, out, bin_dir=None):
        """Writes the page from what is in OUT. Returns what is missing."""
        images = os.path.join(self._folder,
                              self._content.get("images", "images"))
        parts = [f"# {self._content['title']}\n",
                 self._content.get("text", "").strip() + "\n"]
        for section in self._content.get("section", []):
            if "title" in section:
                parts.append("#" * section.get("level", 2)
                             + f" {section['title']}\n")
            if "text" in section:
                parts.append(section["text"].strip() + "\n")
            if "set" in section:
                parts += self._results(section, out, images, bin_dir)
        files.write_text(self.page_path(), "\n".join(
            part for part in parts if part.strip()))
        return [line for one in self.sets.values()
                for line in report.SetReport(one, out, "", "").missing()]

    def _results(self, section, out, images, bin_dir):
        one = dataclasses.replace(
            self.sets[section["set"]],
            **{key: section[key] for key in (
                "methods", "tolerances", "relative_tolerances")
               if key in section})
        made = report.SetReport(one, out, self._folder, images,
                                os.path.join(out, "tables"), bin_dir)
        blocks = [made.block(kind) for kind in section["show"]]
        if not any(blocks) or not made.found:
            return [f"*`{one.name}` has not been run.*\n"]
        return blocks + [made.provenance()]


def _read(path):
    try:
        with open(path, "rb") as file:
            content = tomllib.load(file)
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error
    except tomllib.TOMLDecodeError as error:
        raise Failure(f"{path} is not TOML: {error}") from error
    for key in ("page", "title"):
        if key not in content:
            raise Failure(f"{path} has no {key}")
    return content


def _check_keys(path, where, values, known):
    for key in values:
        if key not in known:
            raise Failure(f"{path}: {where} has an unknown key {key}; there are "
                          + ", ".join(sorted(known)))


def _check_section(path, section, sets):
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
