"""Compares the depth maps of a COLMAP workspace with measured depth, and draws them."""

import collections
import os

from . import command_line, depth_maps, files, workspaces
from .depth_map_score import Tolerance
from .processes import Failure
from .textureness import MIN_TEXTURENESS
from .workspace_score import WorkspaceScorer


def parse(words=None):
    """Options from words, or of the command line."""
    parser = command_line.Parser(prog="evaluate_depth_maps", description=__doc__)
    add = parser.add_argument
    add("--workspace_path", required=True, help="dense workspace of COLMAP")
    add("--ground_truth_path",
        help="folder with one depth map per photograph, named like it: a 16-bit PNG, 0 where "
        "nothing was measured, or a COLMAP map (.bin). May be missing if only pictures are wanted")
    add("--input_type", choices=("geometric", "photometric"), default="geometric",
        help="which maps (%(default)s)")
    add("--tolerances", type=command_line.positive_numbers, default="0.01,0.02,0.05,0.1,0.2",
        help="absolute errors that are tolerated, in metres (%(default)s)")
    add("--relative_tolerances", type=command_line.positive_numbers, default="0.5,1,2",
        help="relative errors that are tolerated, in per cent of the true depth (%(default)s)")
    add("--depth_scale", type=command_line.positive_number,
        default=depth_maps.PNG_STEPS_PER_METRE,
        help="value of one metre in a ground-truth PNG (%(default)s)")
    add("--max_textureness", type=command_line.positive_numbers, default=[],
        help="also score the pixels whose textureness is below each of these bounds. Textureness "
        "is 0.5 where a photograph is flat and tends to 1 where it has much texture")
    add("--json", help="file for all scores, of each view and overall")
    add("--pictures", help="folder for one PNG per view")
    arguments = parser.parse_args(words)
    _check(parser, arguments)
    return arguments


def _check(parser, arguments):
    if not all(MIN_TEXTURENESS < bound <= 1 for bound in arguments.max_textureness):
        parser.error("--max_textureness must be above 0.5 and at most 1")
    if not arguments.ground_truth_path:
        if not arguments.pictures:
            parser.error("--ground_truth_path is required, unless --pictures is given")
        if arguments.json or arguments.max_textureness:
            parser.error("--json and --max_textureness need --ground_truth_path")
    # Pictures are named like the files in these folders.
    for source in (os.path.join(arguments.workspace_path, "images"), arguments.ground_truth_path):
        if arguments.pictures and source and os.path.exists(arguments.pictures) \
                and os.path.exists(source) and os.path.samefile(arguments.pictures, source):
            parser.error(f"--pictures would overwrite the files in {source}")


def _count_truth(folder):
    if not os.path.isdir(folder):
        raise Failure(f"no folder of ground truth at {folder}")
    return sum(name.endswith((".png", ".bin")) for name in files.names_below(folder))


def _picture_names(names):
    """Names of the views' pictures: with the photograph's extension where there are others."""
    stems = collections.Counter(os.path.splitext(name)[0] for name in names)
    return {name: (name if stems[os.path.splitext(name)[0]] > 1 else os.path.splitext(name)[0])
            + ".png" for name in names}


def _print_remarks(overall, num_maps, num_truth):
    def remark(count, what, text):
        if count > 0:
            print(f"{count} {what}{'' if count == 1 else 's'} {text}.")

    remark(num_maps - overall.num_maps, "depth map", "without ground truth: not scored")
    remark(num_truth - overall.num_maps, "ground truth map", "without depth map: not scored")
    remark(overall.num_invalid, "pixel", "with a negative or not finite depth: counted as without "
           "estimate")


def evaluate(arguments):
    """Prints scores and draws pictures. Returns all scores, None where there is no truth."""
    truth_folder = arguments.ground_truth_path
    views = workspaces.list_views(arguments.workspace_path, arguments.input_type)
    num_truth = _count_truth(truth_folder) if truth_folder else 0
    scorer = WorkspaceScorer([Tolerance(value, "m") for value in arguments.tolerances]
                             + [Tolerance(value, "%") for value in arguments.relative_tolerances],
                             arguments.max_textureness)
    names = [view.name for view in views]
    truths = depth_maps.find_all(truth_folder, names) if truth_folder else {}
    pictures = _picture_names(names)
    for view in views:
        path = truths.get(view.name)
        if not (path or arguments.pictures):
            continue
        depth = depth_maps.read_map(view.depth)
        truth = depth_maps.read(path, arguments.depth_scale) if path else None
        if path:
            scorer.add(view, depth, truth)
        if arguments.pictures:
            from . import view_picture  # Takes a second.
            picture = os.path.join(arguments.pictures, pictures[view.name])
            view_picture.draw(picture, view, depth, truth)
    if not truth_folder:
        return None
    if not scorer.scores:
        raise Failure(f"no ground truth in {truth_folder} has the name of a depth map")
    print(scorer.text(), end="")
    _print_remarks(scorer.overall(), len(views), num_truth)
    return {**scorer.json(), "workspace_path": arguments.workspace_path,
            "ground_truth_path": truth_folder, "input_type": arguments.input_type}


def main(words=None):
    arguments = parse(words)
    scores = evaluate(arguments)
    if arguments.json:
        files.write_json(arguments.json, scores)
    return 0
