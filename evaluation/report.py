"""Reports as Markdown, with tables as CSV and figures beside them."""

import os
import urllib.parse

from . import (depth_scores, figures, files, pictures, results,
               run_record, stereo_run, tables)
from .eth3d import paper_tables
from .methods import ABLATION, TAPA_ABLATION
from .processes import Failure

GLOSSARY = """\
- **Completeness**: share of what was measured that is reconstructed within the
  tolerance. **Accuracy**: share of what is reconstructed that is that close to the
  measurement. **F1**: their harmonic mean. Higher is better for all three. Of depth
  maps pixels are counted, of all views together; of points, voxels of 1 cm, as ETH3D
  does it.
- **Textureness** is 0.5 where a photograph is flat and tends to 1 where it has much
  texture. **Low texture**: below 0.75.
- **COLMAP** is COLMAP's own algorithm (method `plain`), **TAPA** is
  `--PatchMatchStereo.tapa 1` (`tapa`), **paper's TAPA** is TAPA without completion, as
  the paper describes it (`paper`).
- "-" is what nobody has run or what cannot be measured. It is not zero.
"""


class SetReport:
    """Tables, figures and pictures of one set, as Markdown.

    Runs with other options than the experiment's do not get into it, unless those
    are None.

    Tables go to csv_folder, too, and figures to image_folder; page_folder is
    where the page will stand, which links to them. Every method returns ""
    where there is nothing to show.
    """

    def __init__(self, experiment, out, page_folder, image_folder,
                 csv_folder=None, bin_dir=None):
        self.experiment = experiment
        self.found, self._others = _split(
            results.load_set(out, experiment.name), experiment)
        self._methods = experiment.shown_methods()
        self._page = page_folder
        self._images = image_folder
        self._csv = csv_folder
        self._bin_dir = bin_dir

    def block(self, kind):
        """One of BLOCKS."""
        return BLOCKS[kind](self)

    def depth(self):
        return self._depth("depth", None)

    def low_texture(self):
        return self._depth("low_texture", depth_scores.LOW_TEXTURE)

    def _depth(self, name, bound):
        if not self._any(lambda run: run.depth):
            return ""
        return self._table(name, tables.depth_table(
            self.found, self._methods, self.experiment.shown_tolerances(),
            bound))

    def cost(self):
        return self._table("cost", tables.cost_table(self.found, self._methods))

    def clouds(self):
        """With the same thresholds for all methods, and with COLMAP's own."""
        text = []
        others = results.evaluators(
            run for method in self._methods
            for run in self.found.get(method, [])) - {"evaluate_point_cloud"}
        if others:
            text.append("Points were scored by " + ", ".join(
                f"`{name}`" for name in sorted(others)) + ".\n")
        for name in ("fused", "fused_default"):
            if self._any(lambda run, name=name: name in run.clouds):
                text.append(self._table("points_" + name, tables.cloud_table(
                    self.found, self._methods, self.experiment.tolerances,
                    name)))
        return "\n".join(text)

    def ablation(self):
        """The paper's Table 2, of those families of methods that are shown."""
        text = []
        for family in (ABLATION, TAPA_ABLATION):
            if any(method in self._methods for method in family[1:-1]) and (
                    self._any(lambda run: "fused" in run.clouds)):
                text.append(self._table("ablation_" + family[-1],
                                        paper_tables.table2(
                    [self.found], family, place=" on " + self.experiment.name)))
        return "\n".join(text)

    def errors(self):
        return self._figure("errors", figures.draw_errors)

    def textureness(self):
        return self._figure("textureness", figures.draw_textureness)

    def pictures(self):
        text = []
        for view in self.experiment.views:
            stem = os.path.splitext(view)[0].replace(os.sep, "_")
            path = self._image(f"{stem}.jpg")
            try:
                caption = pictures.draw_comparison(
                    path, self.experiment.data, self.found, self._methods, view,
                    self._bin_dir)
            except Failure as error:
                text.append(f"*There is no picture of {view}: {error}*\n")
                continue
            if caption:
                text.append(self._embed(path, caption))
        return "\n".join(text)

    def provenance(self):
        """Versions and machines of the runs, in one paragraph."""
        runs = [run for method in self._methods
                for run in self.found.get(method, [])]
        parts = [part for run in runs for part in run_record.parts(run.record)
                 if part]
        if not parts:
            return ""
        versions = sorted({part["version"] for part in parts})
        machines = sorted({machine_text(part["machine"]) for part in parts})
        text = f"Run with {'; '.join(versions)} on {'; '.join(machines)}"
        gpus = set().union(*(run_record.stereo_gpus(run.record) for run in runs))
        if gpus - {None}:
            text += ", stereo on " + "; ".join(sorted(
                gpu or "the CPU" for gpu in gpus))
        mixed = [f"{run.method}, seed {run.record['seed']}" for run in runs
                 if run_record.is_mixed(run.record)]
        if mixed:
            text += (". Not made in one piece, by one version on one machine: "
                     + "; ".join(mixed))
        return text + ".\n"

    def missing(self):
        """What has no result, a line each."""
        lines = []
        for method in self.experiment.methods:
            runs = {run.record["seed"]: run
                    for run in self.found.get(method, [])}
            for seed in self.experiment.seeds:
                name = f"{self.experiment.name}: {method}, seed {seed}"
                if (method, seed) in self._others:
                    lines.append(f"- {name}: the results in OUT were made with "
                                 "other options or photographs")
                elif seed not in runs:
                    lines.append(f"- {name}: not run")
                elif runs[seed].failure:
                    lines.append(f"- {name}: {runs[seed].failure}")
                elif "stereo" not in runs[seed].record["done"]:
                    lines.append(f"- {name}: not finished")
        for method in dict(self.experiment.compare):
            for run in self.found.get(method, []):
                if run.failure:
                    lines.append(f"- {self.experiment.name}: {method}: "
                                 f"{run.failure}")
                views, all_views = (run.record[key] for key in (
                    "views", "photographs"))
                if views is not None and views < all_views:
                    lines.append(
                        f"- {self.experiment.name}: {method}: maps of {views} of "
                        f"{all_views} photographs; its scores are of these alone")
        return lines

    def _any(self, condition):
        return any(condition(run) for method in self._methods
                   for run in self.found.get(method, []))

    def _table(self, name, table):
        if self._csv:
            files.write_text(
                os.path.join(self._csv, f"{self.experiment.name}_{name}.csv"),
                table.csv())
        return table.markdown()

    def _image(self, name):
        return os.path.join(self._images, f"{self.experiment.name}_{name}")

    def _figure(self, name, draw):
        path = self._image(name + ".png")
        caption = draw(path, self.found,
                       figures.chosen_methods(self._methods),
                       self.experiment.name)
        return self._embed(path, caption) if caption else ""

    def _embed(self, path, caption):
        link = link_to(path, self._page)
        title = caption.split("**")[1].rstrip(".")
        return f"![{title}]({link})\n\n{caption}\n"


def _split(found, experiment):
    """The runs that are those of a experiment, and the names of others."""
    kept, others = {}, set()
    for method, runs in found.items():
        for run in runs:
            record = run.record
            if (experiment.options is None or "compare" in record
                    or stereo_run.is_record_of(
                        record, experiment.options, experiment.sources,
                        experiment.every)):
                kept.setdefault(method, []).append(run)
            else:
                others.add((method, record["seed"]))
    return kept, others


def link_to(path, folder):
    """The address of a file on a page in a folder; names may have spaces."""
    return urllib.parse.quote(os.path.relpath(path, folder))


BLOCKS = {"depth": SetReport.depth, "low_texture": SetReport.low_texture,
          "cost": SetReport.cost, "clouds": SetReport.clouds,
          "ablation": SetReport.ablation, "errors": SetReport.errors,
          "textureness": SetReport.textureness,
          "pictures": SetReport.pictures}


def machine_text(machine):
    """"AMD EPYC, 2 cores, 25 GB"; not the GPU, as only stereo uses it."""
    text = f"{machine['cpu']}, {machine['cores']} cores"
    if machine["memory_bytes"]:
        text += f", {machine['memory_bytes'] / 1e9:.0f} GB"
    return text


def describe_set(experiment):
    """What was done to get the results of a set, in one paragraph."""
    text = f"Photographs of `{os.path.basename(os.path.normpath(experiment.data))}`"
    if experiment.every > 1:
        text += f", one in {experiment.every}"
    text += f", {experiment.sources} source views"
    if experiment.options:
        text += f", `{' '.join(experiment.options)}`"
    return text + ".\n"


def write_report(path, reports, title, failures=(), notes=()):
    """Writes a page with all blocks of all sets."""
    parts = [f"# {title}\n", "How to read this page:\n", GLOSSARY]
    parts += [note + "\n" for note in notes]
    for one in reports:
        parts += [f"## {one.experiment.name}\n", describe_set(one.experiment),
                  one.provenance()]
        parts += [one.block(kind) for kind in BLOCKS]
    missing = [line for one in reports for line in one.missing()]
    known = "\n".join(missing)
    missing += [f"- {folder}: {message}" for folder, message in failures
                if message not in known]
    if missing:
        parts += ["## What is missing\n", "\n".join(missing) + "\n"]
    files.write_text(path, "\n".join(part for part in parts if part))
