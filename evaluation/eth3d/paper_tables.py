"""The tables of the TAPA-MVS paper, with its published figures beside ours."""

from .. import results
from ..methods import ABLATION, label
from ..tables import Table
from ..texts import number, percent, tolerance_text
from . import published


def table1(groups):
    """Table 1: F1 at 2 cm, means over the scenes of each group.

    groups: by the names in published.GROUPS, a list with the results
    (results.load_set) of every scene of the group; a cell of ours is "-"
    unless all of them have a score.
    """
    text, data = [], []
    for name, method, cloud in ((label("tapa"), "tapa", "fused"),
                                (label("paper"), "paper", "fused"),
                                ("COLMAP, TAPA's thresholds", "colmap", "fused"),
                                ("COLMAP, its own thresholds", "colmap", "fused_default")):
        scores = [results.mean_over_sets(groups.get(group, []), method, 0.02, cloud)
                  for group in published.GROUPS]
        cells = [score and score.f1 for score in scores]
        text.append([name, "this program", *(percent(cell, 2) for cell in cells)])
        data.append([name, "own", *cells])
    for name, cells in published.TABLE1.items():
        text.append([name, "published", *(number(cell, 2) for cell in cells)])
        data.append([name, "published", *(cell / 100 for cell in cells)])
    return Table(
        "**Table 1: F1 in per cent on ETH3D at a tolerance of 2 cm.** The means over the "
        f"scenes. Rows marked \"published\" are from {published.SOURCE}; those of this program "
        "are \"-\" until every scene of the group has been run.",
        ["method", "figures", *published.GROUPS], text,
        ["method", "figures", *published.GROUPS], data)


def _own_cells(sets, method, tolerance, cloud):
    score = results.mean_over_sets(sets, method, tolerance, cloud)
    return score and [getattr(score, key) for key in results.KEYS]


def _published_cells(method, index):
    """What the paper has for a method or its counterpart here, or None."""
    column = published.TABLE2.get(method.replace("tapa", "paper"))
    return column and [value / 100 for value in column[index]]


def table2(sets, methods=None, cloud="fused", place="", with_published=False):
    """Table 2: completeness, accuracy and F1 with parts of TAPA left out.

    sets: the results (results.load_set) of every scene, whose mean is taken.
    place: where it was measured. with_published: the paper's figures, too,
    which are for ETH3D's training scenes of high resolution.
    """
    methods, tolerances = methods or ABLATION, published.TABLE2_TOLERANCES
    kinds = [("own", "", lambda method, i: _own_cells(sets, method, tolerances[i], cloud))]
    caption = (f"**Table 2: the parts of TAPA{place}.** Completeness / accuracy / F1 of the "
               "points in per cent.")
    if with_published:
        kinds.append(("published", ", published", _published_cells))
        caption += f" Rows marked \"published\" are from {published.SOURCE}."
    rows, data = [], []
    for figures, suffix, cells_of in kinds:
        for i, value in enumerate(tolerances):
            cells = {method: cells_of(method, i) for method in methods}
            rows.append([tolerance_text(value) + suffix, *(
                " / ".join(percent(share, 2) for share in three) if three else "-"
                for three in cells.values())])
            data += [[method, figures, value, *(three or [None] * 3)]
                     for method, three in cells.items()]
    return Table(caption, ["tolerance", *map(label, methods)], rows,
                 ["method", "figures", "tolerance", *results.KEYS], data)
