"""The report on ETH3D: the tables and figures of the TAPA-MVS paper."""

import os

from .. import experiment, figures, files, links, report, results
from . import paper_tables, published
from . import scenes as eth3d_scenes
from ..methods import ABLATION, TAPA_ABLATION

_TOLERANCES = published.TABLE2_TOLERANCES
_PAPER_SCENES = "ETH3D's 13 training scenes of high resolution"


def groups_of(runs):
    """The results of all scenes of ETH3D, by the groups of Table 1."""
    groups = {name: [] for name in published.GROUPS}
    for scene in eth3d_scenes.all_scenes():
        found = results.load_set(runs, scene.set_name)
        groups[scene.split].append(found)
        groups[f"{scene.split} {scene.resolution}-res"].append(found)
    return groups


def write(folder, runs, sets, scenes, methods, seeds=(0,), bin_dir=None):
    """Writes FOLDER/report.md, figures, tables, and a page per scene.

    runs: has SET/METHOD-SEED; sets: the prepared scenes; scenes: those of
    eth3d_scenes that the report is about. Returns the path of the report.
    """
    scenes = list(scenes)
    found = {scene: results.load_set(runs, scene.set_name) for scene in scenes}
    parts = ["# ETH3D\n", "How to read this page:\n", report.GLOSSARY]
    parts += _settings(found)
    parts += _tables(folder, runs, scenes, found)
    parts += _figures(folder, scenes, found, methods)
    parts += ["## Scenes\n"]
    missing = []
    for scene in scenes:
        page, lines = _scene_page(folder, runs, sets, scene, methods, seeds,
                                  bin_dir)
        missing += lines
        parts.append(f"- [{scene.set_name}]({report.link_to(page, '.')}), {scene.split}")
    if missing:
        parts += ["\n## What is missing\n"] + missing
    path = os.path.join(folder, "report.md")
    files.write_text(path, "\n".join(parts) + "\n")
    return path


def _settings(found):
    """How every method was run, and whether it was the same on all scenes."""
    scenes = {}  # By method and options.
    for scene, one in found.items():
        for run in (run for kind in one.values() for run in kind):
            # The first two are the seed.
            words = [f"{run.record['sources']} source views", *run.record["options"][2:]]
            scenes.setdefault((run.method, " ".join(words)), set()).add(scene.set_name)
    if not scenes:
        return ["No scene has been run.\n"]
    methods = [method for method, _ in scenes]
    parts = ["## How it was run\n"]
    for (method, words), names in sorted(scenes.items()):
        parts.append(f"- `{method}`: {words}" + (
            f"; **other scenes with other options:** this is {', '.join(sorted(names))}"
            if methods.count(method) > 1 else ""))
    evaluators = results.evaluators(run for one in found.values()
                                    for kind in one.values() for run in kind)
    if evaluators:
        parts.append("\nPoints were scored by " + ", ".join(sorted(evaluators)) + ".")
    return parts + [""]


def _tables(folder, runs, scenes, found):
    parts = ["## Table 1\n", _table(folder, "table1",
                                    paper_tables.table1(groups_of(runs)))]
    judged = [scene for scene in scenes if scene.split == "training"]
    high = [scene for scene in judged if scene.resolution == "high"] or judged
    names = ", ".join(scene.set_name for scene in high)
    parts += ["## Table 2\n", f"Means over {names}; the published figures are "
              f"for {_PAPER_SCENES}. The paper does not say with which thresholds it "
              "fused COLMAP's maps; its F1 at 2 cm is that of Table 1.\n"]
    for family in (ABLATION, TAPA_ABLATION):
        for cloud in ("fused", "fused_default"):
            thresholds = (", TAPA's thresholds" if cloud == "fused"
                          else ", COLMAP's own thresholds")
            if cloud == "fused" or any("fused_default" in run.clouds
                                       for one in found.values()
                                       for kind in one.values()
                                       for run in kind):
                parts.append(_table(
                    folder, f"table2_{family[-1]}_{cloud}", paper_tables.table2(
                        [found[scene] for scene in high], family, cloud,
                        thresholds, with_published=cloud == "fused")))
    return parts


def _table(folder, name, table):
    files.write_text(os.path.join(folder, "tables", name + ".csv"), table.csv())
    return table.markdown()


def _figures(folder, scenes, found, methods):
    """Of the scenes with measured depth, high resolution where there is some."""
    judged = [scene for scene in scenes
              if any(run.depth for runs in found[scene].values()
                     for run in runs)]
    high = [scene for scene in judged if scene.resolution == "high"] or judged
    pooled = results.pool(found[scene] for scene in high)
    parts = ["## Errors of depth maps\n"]
    if not high:
        return parts + ["No depth maps have been scored.\n"]
    parts.append("Means over " + ", ".join(scene.set_name for scene in high)
                 + "; the paper's figures are for " + _PAPER_SCENES + ".\n")
    title = "ETH3D" if len(high) > 1 else high[0].set_name
    for name, draw in (("errors", figures.draw_errors),
                       ("textureness", figures.draw_textureness)):
        caption = draw(os.path.join(folder, "figures", name + ".png"), pooled,
                       figures.chosen_methods(methods), title)
        if caption:
            parts.append(f"![{name}](figures/{name}.png)\n\n{caption}\n")
    return parts


def _scene_page(folder, runs, sets, scene, methods, seeds, bin_dir):
    """Writes the page of a scene. Returns its path and what is missing."""
    data = os.path.join(sets, scene.set_name)
    views = links.photographs(data)
    one = experiment.Experiment(
        name=scene.set_name, data=data, methods=list(methods),
        seeds=list(seeds), options=None, tolerances=list(_TOLERANCES),
        views=views[len(views) // 2:][:1])
    made = report.SetReport(
        one, runs, folder, os.path.join(folder, "figures"),
        os.path.join(folder, "tables"), bin_dir)
    parts = [f"# {scene.set_name}\n", made.provenance()]
    parts += [made.block(kind) for kind in report.BLOCKS]
    page = f"{scene.set_name}.md"
    files.write_text(os.path.join(folder, page),
                     "\n".join(part for part in parts if part))
    return page, made.missing()
