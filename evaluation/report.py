"""Reports as Markdown, with tables as CSV and figures beside them."""

import os
import urllib.parse

from . import depth_scores, figures, files, pictures, record, results, stereo_run, tables
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
- **Plain** is COLMAP's own algorithm (method `plain`), **COLMAP** the same with COLMAP's
  numbers of iterations and samples (`colmap`); rays go through the centres of pixels in
  both. **TAPA** is `--PatchMatchStereo.tapa 1`
  (`tapa`), **paper's TAPA** is TAPA without completion and with COLMAP's numbers, as the
  paper describes it (`paper`).
- "-" is what nobody has run or what cannot be measured. It is not zero.
"""


class SetReport:
    """Tables, figures and pictures of one set, as Markdown.

    Runs with other options than the experiment's do not get into it, unless those
    are None.

    Tables go to csv_folder, too, and figures to image_folder; page_folder is
    where the page will stand, which links to them. Every block is "" where there
    is nothing to show.
    """

    def __init__(self, experiment, out, page_folder, image_folder, csv_folder=None):
        self.experiment = experiment
        self.by_method, self._others = _split(results.load_set(out, experiment.name), experiment)
        self._methods = experiment.shown_methods()
        self._runs = [run for method in self._methods for run in self.by_method.get(method, [])]
        self._page = page_folder
        self._images = image_folder
        self._csv = csv_folder

    def block(self, kind):
        """One of BLOCKS."""
        return BLOCKS[kind](self)

    def depth(self):
        return self._depth("depth", None)

    def low_texture(self):
        return self._depth("low_texture", depth_scores.LOW_TEXTURE)

    def _depth(self, name, bound):
        if not any(run.depth for run in self._runs):
            return ""
        return self._table(name, tables.depth_table(
            self.by_method, self._methods, self.experiment.shown_tolerances(), bound))

    def trade(self):
        """Against what COLMAP's own numbers of iterations and samples cost and score."""
        if not any(run.depth for run in self.by_method.get("colmap", [])):
            return ""
        return self._table("trade", tables.trade_table(
            self.by_method, self._methods, self.experiment.shown_tolerances()))

    def cost(self):
        return self._table("cost", tables.cost_table(self.by_method, self._methods))

    def clouds(self):
        """With the same thresholds for all methods, with COLMAP's own, and weighed."""
        text = []
        others = results.evaluators(self._runs) - {"evaluate_point_cloud"}
        if others:
            text.append("Points were scored by " + ", ".join(
                f"`{name}`" for name in sorted(others)) + ".\n")
        for name in stereo_run.FUSIONS:
            if any(name in run.clouds for run in self._runs):
                text.append(self._table("points_" + name, tables.cloud_table(
                    self.by_method, self._methods, self.experiment.tolerances, name)))
        return "\n".join(text)

    def ablation(self):
        """The paper's Table 2, of those families of methods that are shown."""
        text = []
        for family in (ABLATION, TAPA_ABLATION):
            if (not set(family[1:-1]).isdisjoint(self._methods)
                    and any("fused" in run.clouds for run in self._runs)):
                text.append(self._table("ablation_" + family[-1], paper_tables.table2(
                    [self.by_method], family, place=" on " + self.experiment.name)))
        return "\n".join(text)

    def errors(self):
        return self._figure("errors", figures.draw_errors)

    def textureness(self):
        return self._figure("textureness", figures.draw_textureness)

    def pictures(self):
        text = []
        for view in self.experiment.views:
            path = self._image(os.path.splitext(view)[0].replace(os.sep, "_") + ".jpg")
            try:
                caption = pictures.draw_comparison(
                    path, self.experiment.data, self.by_method, self._methods, view)
            except Failure as error:
                text.append(f"*There is no picture of {view}: {error}*\n")
                continue
            if caption:
                text.append(self._embed(path, caption))
        return "\n".join(text)

    def provenance(self):
        """Versions and machines of the runs, in one paragraph."""
        makers = [maker for run in self._runs for maker in run.record.makers() if maker]
        if not makers:
            return ""
        versions = sorted({maker.version for maker in makers})
        machines = sorted({_machine_text(maker.machine) for maker in makers})
        text = f"Run with {'; '.join(versions)} on {'; '.join(machines)}"
        gpus = {gpu for run in self._runs for gpu in run.record.stereo_gpus()}
        if gpus - {None}:
            text += ", stereo on " + "; ".join(sorted(gpu or "the CPU" for gpu in gpus))
        mixed = [f"{run.record.method}, seed {run.record.seed}" for run in self._runs
                 if run.record.is_mixed()]
        if mixed:
            text += (". Not made in one piece, by one version on one machine: "
                     + "; ".join(mixed))
        return text + ".\n"

    def missing(self):
        """What has no result, a line each."""
        name, lines = self.experiment.name, []
        for method in self.experiment.methods:
            runs = {run.record.seed: run for run in self.by_method.get(method, [])}
            for seed in self.experiment.seeds:
                fault = self._fault(runs.get(seed), (method, seed) in self._others)
                if fault:
                    lines.append(f"- {name}: {method}, seed {seed}: {fault}")
        for method in dict(self.experiment.compare):
            for run in self.by_method.get(method, []):
                views, photographs = run.record.views, run.record.photographs
                if run.failure:
                    lines.append(f"- {name}: {method}: {run.failure}")
                if views is not None and views < photographs:
                    lines.append(f"- {name}: {method}: maps of {views} of {photographs} "
                                 "photographs; its scores are of these alone")
        return lines

    @staticmethod
    def _fault(run, has_other):
        """What is missing of a run, None if nothing is."""
        if has_other:
            return "the results in OUT were made with other options or photographs"
        if run is None:
            return "not run"
        return run.failure or (None if "stereo" in run.record.done else "not finished")

    def _table(self, name, table):
        if self._csv:
            files.write_text(os.path.join(self._csv, f"{self.experiment.name}_{name}.csv"),
                             table.csv())
        return table.markdown()

    def _image(self, name):
        return os.path.join(self._images, f"{self.experiment.name}_{name}")

    def _figure(self, name, draw):
        path = self._image(name + ".png")
        caption = draw(path, self.by_method, figures.chosen_methods(self._methods),
                       self.experiment.name)
        return self._embed(path, caption) if caption else ""

    def _embed(self, path, caption):
        title = caption.split("**")[1].rstrip(".")
        return f"![{title}]({link_to(path, self._page)})\n\n{caption}\n"


def _split(by_method, experiment):
    """The runs that are those of an experiment, and the names of others."""
    kept, others = {}, set()
    for run in (run for runs in by_method.values() for run in runs):
        content = run.record
        if (experiment.options is None or isinstance(content, record.ComparisonRecord)
                or stereo_run.is_record_of(content, experiment.options, experiment.sources,
                                           experiment.every)):
            kept.setdefault(content.method, []).append(run)
        else:
            others.add((content.method, content.seed))
    return kept, others


def link_to(path, folder):
    """The address of a file on a page in a folder; names may have spaces."""
    return urllib.parse.quote(os.path.relpath(path, folder))


BLOCKS = {name: getattr(SetReport, name) for name in (
    "depth", "low_texture", "cost", "trade", "clouds", "ablation", "errors", "textureness",
    "pictures")}


def _machine_text(machine):
    """"AMD EPYC, 2 cores, 25 GB"; not the GPU, as only stereo uses it."""
    text = f"{machine.cpu}, {machine.cores} cores"
    return text + (f", {machine.memory_bytes / 1e9:.0f} GB" if machine.memory_bytes else "")


def _describe_set(experiment):
    """What was done to get the results of a set, in one paragraph."""
    text = f"Photographs of `{os.path.basename(os.path.normpath(experiment.data))}`"
    if experiment.every > 1:
        text += f", one in {experiment.every}"
    text += f", {experiment.sources} source views"
    if experiment.options:
        text += f", `{' '.join(experiment.options)}`"
    return text + ".\n"


def write_report(path, reports, failures=(), notes=()):
    """Writes a page with all blocks of all sets. Returns its text."""
    parts = ["# Evaluation of dense stereo\n", "How to read this page:\n", GLOSSARY]
    parts += [note + "\n" for note in notes]
    for part in reports:
        parts += [f"## {part.experiment.name}\n", _describe_set(part.experiment),
                  part.provenance(), *map(part.block, BLOCKS)]
    missing = [line for part in reports for line in part.missing()]
    known = "\n".join(missing)
    missing += [f"- {name}: {message}" for name, message in failures if message not in known]
    if missing:
        parts += ["## What is missing\n", "\n".join(missing) + "\n"]
    text = "\n".join(part for part in parts if part)
    files.write_text(path, text)
    return text
