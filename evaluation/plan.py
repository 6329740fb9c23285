"""A page made from text and results, as a TOML file describes it.

    page = "results.md"           # beside the plan
    images = "images/results"
    title = "Results"
    text = '''...'''

    [sets.NAME]                   # results in OUT/NAME/METHOD-SEED
    data = "office_entrance"      # in the folder of data sets, or in the repository; a scene
                                  # of examples/ is rendered first
    methods = ["plain", "tapa"]
    seeds = [0, 1, 2]             # and so on: see experiment.Settings
    num_views = 1                 # of pictures, where no views are named

    [[section]]
    title = "..."                 # level 2; left out: no heading
    text = '''...'''
    set = "NAME"                  # its tables and figures follow the text
    show = ["depth", "errors"]    # report.BLOCKS, in this order
    methods = ["plain", "tapa"]   # only these
    command = true                # with the command that runs the set
"""

import os
import re
import tomllib
from typing import Dict, List, Optional

import pydantic

from . import experiment, files, pictures, report, scenes, schemas
from .experiment import Count, Experiment, Settings, Tolerances, Whole
from .processes import Failure
from .schemas import Text


class PlannedSet(Settings):
    """[sets.NAME]."""
    num_views: Whole = 0


class Section(schemas.Model):
    """[[section]]."""

    class Config:
        extra = "forbid"

    title: Optional[Text]
    level: Count = 2
    text: Text = ""
    set: Optional[Text]
    show: List[Text] = ["depth", "low_texture", "cost"]
    command: pydantic.StrictBool = True
    methods: Optional[List[Text]]
    tolerances: Optional[Tolerances]
    relative_tolerances: Optional[Tolerances]

    _methods_are_known = experiment.methods_validator()

    @pydantic.validator("show", each_item=True)
    def _is_block(cls, name):
        if name not in report.BLOCKS:
            raise ValueError(f"there is no {name}; there are " + ", ".join(report.BLOCKS))
        return name

    def view_of(self, planned):
        """The part of a set that the section shows."""
        return planned.copy(update=self.dict(
            include={"methods", "tolerances", "relative_tolerances"}, exclude_none=True))


class Page(schemas.Model):
    """The file."""

    class Config:
        extra = "forbid"

    page: Text
    title: Text
    text: Text = ""
    images: Text = "images"
    sets: Dict[Text, PlannedSet] = {}
    section: List[Section] = []

    @pydantic.validator("sets")
    def _names_are_of_folders(cls, sets):
        for name in sets:
            if not re.fullmatch(r"[\w.+-]+", name):
                raise ValueError(f"the name {name} must be of letters, digits and _.+-")
        return sets

    @pydantic.validator("section", each_item=True)
    def _set_is_known(cls, section, values):
        if section.set is not None and section.set not in values.get("sets", [section.set]):
            raise ValueError(f"it shows the set {section.set}, which is not among the sets")
        return section


class Plan:
    """A plan, whose sets are Experiments by name."""

    def __init__(self, path, data_folder, root, out=""):
        """data_folder: of the data sets; root: the repository; out: of results."""
        self._folder = os.path.dirname(os.path.abspath(path))
        self._page = schemas.check(_read(path), Page, path, "is no plan: {}")
        self.sets = {}
        self.scenes = {}  # The folder of each set's scene, None for photographs that are there.
        for name, settings in self._page.sets.items():
            inside = os.path.join(data_folder or "", settings.data)
            if not (data_folder and os.path.isdir(inside)):
                inside = os.path.join(root, settings.data)
            values = settings.dict(exclude={"num_views"}, exclude_unset=True)
            self.scenes[name] = inside if scenes.is_scene(inside) else None
            self.sets[name] = Experiment(**{**values, "name": name,
                                            "data": scenes.rendered(inside, out)})
            self.choose_views(name)

    def choose_views(self, name):
        """Of a set, for pictures, unless the plan names them; once photographs are there."""
        planned = self.sets[name]
        if not planned.views and os.path.isdir(planned.data):
            planned.views = pictures.choose_views(planned.data, planned.every,
                                                  self._page.sets[name].num_views)

    def page_folder(self, out):
        """The plan's folder, or OUT as long as a set has no results at all."""
        return (self._folder if all(report.SetReport(planned, out, "", "").by_method
                                    for planned in self.sets.values()) else out)

    def write(self, out, only=None):
        """Writes the page from what is in OUT.

        only: names of sets; the page is about these alone, and goes to OUT.
        Returns its path, and what is missing.
        """
        folder = out if only else self.page_folder(out)
        path = os.path.join(folder, self._page.page)
        parts = [f"# {self._page.title}\n", self._page.text.strip() + "\n"]
        for section in self._page.section:
            if only and section.set not in only:
                continue
            if section.title is not None:
                parts.append("#" * section.level + f" {section.title}\n")
            parts.append(section.text.strip() and section.text.strip() + "\n")
            if section.set is not None:
                parts += self._results(section, out, folder)
        text = "\n".join(part for part in parts if part.strip())
        files.write_text(path, self._move_links(text, folder))
        return path, [line for name, planned in self.sets.items() if not only or name in only
                      for line in report.SetReport(planned, out, "", "").missing()]

    def _move_links(self, text, folder):
        """Links to pages beside the plan, for a page that stands elsewhere."""
        above = os.path.relpath(self._folder, folder).replace(os.sep, "/")
        return text if above == "." else re.sub(
            r"\]\(([\w./-]+\.(?:md|toml)[)#])", rf"]({above}/\1", text)

    def _results(self, section, out, folder):
        planned = self.sets[section.set]
        parts = [f"    {experiment.command_text(planned)}\n"] if section.command else []
        shown = report.SetReport(section.view_of(planned), out, folder,
                                 os.path.join(folder, self._page.images),
                                 os.path.join(out, "tables"))
        if not shown.by_method:
            return parts + [f"*`{planned.name}` has not been run.*\n"]
        parts += [shown.block(kind) for kind in section.show]
        return parts + ([shown.provenance()] if section.command else [])


def _read(path):
    try:
        with open(path, "rb") as file:
            return tomllib.load(file)
    except OSError as error:
        raise Failure(f"{path} cannot be read: {error.strerror}") from error
    except (RecursionError, ValueError) as error:  # Neither TOML nor even UTF-8.
        raise Failure(f"{path} is not TOML: {error}") from error
