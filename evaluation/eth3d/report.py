"""The report on ETH3D: the tables and figures of the TAPA-MVS paper."""

import os

from .. import figures, files, report, results, workspaces
from ..experiment import Experiment
from ..methods import ABLATION, TAPA_ABLATION
from ..page import report_page
from . import paper_tables, published
from .scenes import all_scenes

_PAPER_SCENES = "ETH3D's 13 training scenes of high resolution"


def groups_of(runs):
    """The results of all scenes of ETH3D, by the groups of Table 1."""
    groups = {name: [] for name in published.GROUPS}
    for scene in all_scenes():
        by_method = results.load_set(runs, scene.set_name)
        groups[scene.split].append(by_method)
        groups[f"{scene.split} {scene.resolution}-res"].append(by_method)
    return groups


def _high(scenes):
    """Those of high resolution, or all where there is none."""
    return [scene for scene in scenes if scene.resolution == "high"] or scenes


def _names(scenes):
    return ", ".join(scene.set_name for scene in scenes)


class Eth3dReport:
    """FOLDER/report.md, figures, tables, and a page per scene; all pages in HTML, too."""

    def __init__(self, folder, runs, sets, scenes, methods, seeds=(0,)):
        """runs: has SET/METHOD-SEED; sets: the prepared scenes; scenes: what it is about."""
        self.folder = folder
        self._runs_folder = runs
        self._sets = sets
        self._methods = methods
        self._seeds = seeds
        self._by_scene = {scene: results.load_set(runs, scene.set_name) for scene in scenes}

    def write(self):
        """Returns the path of the report."""
        parts = ["# ETH3D\n", "How to read this page:\n", report.GLOSSARY, *self._settings(),
                 *self._tables(), *self._figures(), "## Scenes\n"]
        missing = []
        for scene in self._by_scene:
            page, lines = self._write_scene(scene)
            missing += lines
            parts.append(f"- [{scene.set_name}]({report.link_to(page, '.')}), {scene.split}")
        if missing:
            parts += ["\n## What is missing\n", *missing]
        return self._write_page("report.md", "\n".join(parts) + "\n", [])

    def _runs(self):
        """(scene, run) of all."""
        return [(scene, run) for scene, by_method in self._by_scene.items()
                for runs in by_method.values() for run in runs]

    def _settings(self):
        """How every method was run, and whether it was the same on all scenes."""
        scenes = {}  # By method and options.
        for scene, run in self._runs():
            # The first two are the seed.
            words = [f"{run.record.sources} source views", *run.record.options[2:]]
            scenes.setdefault((run.record.method, " ".join(words)), set()).add(scene.set_name)
        if not scenes:
            return ["No scene has been run.\n"]
        methods = [method for method, _ in scenes]
        parts = ["## How it was run\n"]
        for (method, words), names in sorted(scenes.items()):
            parts.append(f"- `{method}`: {words}" + (
                f"; **other scenes with other options:** this is {', '.join(sorted(names))}"
                if methods.count(method) > 1 else ""))
        evaluators = results.evaluators(run for _, run in self._runs())
        if evaluators:
            parts.append("\nPoints were scored by " + ", ".join(sorted(evaluators)) + ".")
        return parts + [""]

    def _tables(self):
        high = _high([scene for scene in self._by_scene if scene.split == "training"])
        parts = ["## Table 1\n",
                 self._table("table1", paper_tables.table1(groups_of(self._runs_folder))),
                 "## Table 2\n", f"Means over {_names(high)}; the published figures are for "
                 f"{_PAPER_SCENES}. The paper does not say with which thresholds it fused "
                 "COLMAP's maps; its F1 at 2 cm is that of Table 1.\n"]
        clouds = {"fused": ", TAPA's thresholds"}
        if any("fused_default" in run.clouds for _, run in self._runs()):
            clouds["fused_default"] = ", COLMAP's own thresholds"
        for family in (ABLATION, TAPA_ABLATION):
            for cloud, thresholds in clouds.items():
                parts.append(self._table(f"table2_{family[-1]}_{cloud}", paper_tables.table2(
                    [self._by_scene[scene] for scene in high], family, cloud, thresholds,
                    with_published=cloud == "fused")))
        return parts

    def _table(self, name, table):
        files.write_text(os.path.join(self.folder, "tables", name + ".csv"), table.csv())
        return table.markdown()

    def _figures(self):
        """Of the scenes with scores of depth maps."""
        high = _high(list(dict.fromkeys(scene for scene, run in self._runs() if run.depth)))
        parts = ["## Errors of depth maps\n"]
        if not high:
            return parts + ["No depth maps have been scored.\n"]
        pooled = results.pool(self._by_scene[scene] for scene in high)
        parts.append(f"Means over {_names(high)}; the paper's figures are for {_PAPER_SCENES}.\n")
        title = "ETH3D" if len(high) > 1 else high[0].set_name
        for name, draw in (("errors", figures.draw_errors),
                           ("textureness", figures.draw_textureness)):
            caption = draw(os.path.join(self.folder, "figures", name + ".png"), pooled,
                           figures.chosen_methods(self._methods), title)
            if caption:
                parts.append(f"![{name}](figures/{name}.png)\n\n{caption}\n")
        return parts

    def _write_scene(self, scene):
        """Writes the page of a scene. Returns its name and what is missing."""
        data = os.path.join(self._sets, scene.set_name)
        views = workspaces.photographs(data)
        shown = report.SetReport(
            Experiment(name=scene.set_name, data=data, methods=self._methods,
                       seeds=list(self._seeds), options=None,
                       tolerances=published.TABLE2_TOLERANCES, views=views[len(views) // 2:][:1]),
            self._runs_folder, self.folder, os.path.join(self.folder, "figures"),
            os.path.join(self.folder, "tables"))
        parts = [f"# {scene.set_name}\n", shown.provenance(), *map(shown.block, report.BLOCKS)]
        page = f"{scene.set_name}.md"
        self._write_page(page, "\n".join(part for part in parts if part), [shown])
        return page, shown.missing()

    def _write_page(self, name, text, reports):
        """Writes a page, and the same in HTML beside it. Returns its path."""
        path = os.path.join(self.folder, name)
        files.write_text(path, text)
        report_page.write_beside(path, text, reports)
        return path
