"""The tables of the TAPA-MVS paper, with its published figures beside ours."""

from .. import results
from ..methods import ABLATION, label
from . import published
from ..tables import Table, percent, tolerance_text


def _own_cell(sets, method, cloud):
    score = results.mean_over_sets(sets, method, 0.02, cloud)
    return None if score is None else score.f1


def table1(groups, rows=None):
    """Table 1: F1 at 2 cm, means over the scenes of each group.

    groups: by the names in published.GROUPS, a list with the results
    (results.load_set) of every scene of the group; a cell of ours is "-"
    unless all of them have a score. rows: (name, method, cloud) of ours.
    """
    rows = rows or [(label("tapa"), "tapa", "fused"),
                    (label("paper"), "paper", "fused"),
                    ("COLMAP, TAPA's thresholds", "plain", "fused"),
                    ("COLMAP, its own thresholds", "plain", "fused_default")]
    text, data = [], []
    for name, method, cloud in rows:
        cells = [_own_cell(groups.get(group, []), method, cloud)
                 for group in published.GROUPS]
        text.append([name, "this program"] + [percent(cell, 2)
                                              for cell in cells])
        data.append([name, "own"] + cells)
    for name, cells in published.TABLE1.items():
        text.append([name, "published"] + [f"{cell:.2f}" for cell in cells])
        data.append([name, "published"] + [cell / 100 for cell in cells])
    return Table(
        "**Table 1: F1 in per cent on ETH3D at a tolerance of 2 cm.** The means "
        "over the scenes. Rows marked \"published\" are from "
        f"{published.SOURCE}; those of this program are \"-\" until every scene "
        "of the group has been run.",
        ["method", "figures"] + published.GROUPS, text,
        ["method", "figures"] + published.GROUPS, data)


def _published_cells(method, index):
    """What the paper has for a method or its counterpart here, or None."""
    column = published.TABLE2.get(method.replace("tapa", "paper"))
    return column and column[index]


def table2(sets, methods=None, cloud="fused", place="", with_published=False):
    """Table 2: completeness, accuracy and F1 with parts of TAPA left out.

    sets: the results (results.load_set) of every scene, whose mean is taken.
    place: where it was measured. with_published: the paper's figures, too,
    which are for ETH3D's training scenes of high resolution.
    """
    methods = methods or ABLATION
    columns = [(method, "", {
        value: results.mean_over_sets(sets, method, value, cloud)
        for value in published.TABLE2_TOLERANCES}) for method in methods]
    header = ["tolerance"] + [label(method) for method in methods]
    rows, data = [], []
    for i, value in enumerate(published.TABLE2_TOLERANCES):
        row = [tolerance_text(value)]
        for method, _, scores in columns:
            score = scores[value]
            row.append("-" if score is None else " / ".join(
                percent(getattr(score, key), 2) for key in results.KEYS))
            data.append([method, "own", value] + (
                [None] * 3 if score is None
                else [getattr(score, key) for key in results.KEYS]))
        rows.append(row)
    if with_published:
        for i, value in enumerate(published.TABLE2_TOLERANCES):
            cells = [_published_cells(method, i) for method in methods]
            rows.append([tolerance_text(value) + ", published"] + [
                " / ".join(f"{cell:.2f}" for cell in three) if three else "-"
                for three in cells])
            data += [[method, "published", value]
                     + [cell / 100 for cell in three]
                     for method, three in zip(methods, cells) if three]
    caption = (f"**Table 2: the parts of TAPA{place}.** Completeness / accuracy "
               "/ F1 of the points in per cent.")
    if with_published:
        caption += f" Rows marked \"published\" are from {published.SOURCE}."
    return Table(caption, header, rows,
                 ["method", "figures", "tolerance", *results.KEYS], data)
