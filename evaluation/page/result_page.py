"""Makes one HTML file that shows a dense workspace of COLMAP, to be opened in a browser.

It has the points to turn and zoom, the cameras, each photograph with depth, normals, confidence
and the origin of its depth, what was left out and why, times and options, as far as the
workspace has them, and needs no network. What a workspace lacks is said on the page.

Times come from logs (*.log) in the workspace or, if features are kept in a database.db in one
of the two folders above, beside that. The origin of depths is what patch_match_stereo with
--PatchMatchStereo.tapa_debug WORKSPACE/tapa_debug draws.
"""

import math
import os

from .. import command_line
from . import confidence, html, left_out, maps, scene
from .logs import Logs
from .thinning import thin
from .workspace import Workspace

_WIDTH = 480  # Of pictures, in pixels, as long as there are no more photographs than these.
_PHOTOGRAPHS = 100
_LEAST_WIDTH = 96
_PROJECTED = 1_000_000  # Points, at most, that are drawn into every photograph.


def _parse(words):
    parser = command_line.Parser(prog="result_page", description=__doc__.splitlines()[0])
    parser.add_argument("workspace", metavar="WORKSPACE",
                        help="a dense workspace, such as DIR/dense, or DIR/dense/0 of "
                        "automatic_reconstructor")
    parser.add_argument("--out", help="the page (WORKSPACE/result.html)")
    parser.add_argument("--points", type=command_line.whole_number(1), default=300_000,
                        help="how many points it has at most (%(default)s)")
    parser.add_argument("--tapa_debug", help="the folder that PatchMatchStereo.tapa_debug named "
                        "(WORKSPACE/tapa_debug)")
    arguments = parser.parse_args(words)
    arguments.out = arguments.out or os.path.join(arguments.workspace, "result.html")
    arguments.tapa_debug = (arguments.tapa_debug
                            or os.path.join(arguments.workspace, "tapa_debug"))
    return arguments


def main(words=None):
    arguments = _parse(words)
    html.check_libraries()
    workspace = Workspace(arguments.workspace)
    logs = Logs([workspace.folder, workspace.project or workspace.folder])
    viewer = scene.Scene(list(workspace.views.values()))
    clouds = scene.add_files(viewer, workspace.clouds, arguments.points, confidence.of_points)
    painter = maps.Painter(workspace, _width(len(workspace.maps)), arguments.tapa_debug,
                           _to_project(clouds))
    photographs = list(map(painter.paint, workspace.maps))
    _add_times(photographs, logs)
    passes, options = workspace.options()
    html.write(
        arguments.out, "result.html", title=_title(workspace), summary=_summary(workspace, clouds),
        scene=viewer.json({photograph.name: photograph.distance for photograph in photographs}),
        left_out=left_out.find(workspace, logs), photographs=photographs, titles=painter.titles,
        absent=_absent(workspace, painter.titles), normals_legend=maps.normals_legend(),
        origins=maps.ORIGINS, steps=logs.steps, passes=passes, options=options)
    print(f"Page: {arguments.out}")
    return 0


def _width(num_photographs):
    """Of pictures: where photographs are many the page stays as large."""
    share = math.sqrt(_PHOTOGRAPHS / max(num_photographs, _PHOTOGRAPHS))
    return max(_LEAST_WIDTH, round(_WIDTH * share))


def _to_project(clouds):
    """Points and confidence of the first cloud that has it, None if there is none."""
    for cloud, values in clouds:
        if values is not None and len(values):
            chosen = thin(cloud.points, _PROJECTED)
            return cloud.points[chosen], values[chosen]
    return None


def _add_times(photographs, logs):
    for photograph in photographs:
        if photograph.name in logs.view_seconds:
            photograph.facts.append(f"stereo took {logs.view_seconds[photograph.name]:.1f} s")


def _title(workspace):
    """The name of the folder that a user chose: not dense, and not its number."""
    path = os.path.abspath(workspace.project or workspace.folder)
    return os.path.basename(path) or path


def _summary(workspace, clouds):
    text = (f"{len(workspace.views)} photographs with a pose, {len(workspace.maps)} of them with "
            f"{workspace.kind} maps" if workspace.maps
            else f"{len(workspace.views)} photographs with a pose, none of them with maps")
    for path, (cloud, _) in zip(workspace.clouds, clouds):
        text += f"; {len(cloud.points):,} points in {os.path.basename(path)}"
    return text + "."


def _absent(workspace, titles):
    """What the page would show if the workspace had it."""
    lines = []
    if not workspace.clouds:
        lines.append("There are no points (fused*.ply): run stereo_fusion.")
    if not workspace.maps:
        return lines + ["There are no maps: run patch_match_stereo."]
    if "normals" not in titles:
        lines.append("There are no normals (stereo/normal_maps).")
    if "confidence of points" not in titles:
        lines.append("The confidence of points is not known: no points have it, or a list of "
                     "views (.vis) beside them.")
    if "origin of depth" not in titles:
        lines.append("Where depths come from is not recorded: patch_match_stereo does so with "
                     "--PatchMatchStereo.tapa 1 and --PatchMatchStereo.tapa_debug "
                     "WORKSPACE/tapa_debug.")
    if not workspace.database:
        lines.append("Whether photographs found no pose at all is not known: there is no "
                     "database.db in the two folders above the workspace.")
    return lines
