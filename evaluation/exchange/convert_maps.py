"""Maps of a dense workspace as EXR, PFM, 16-bit PNG or NPY for other programs, and back.

export writes depth, normals and confidence of every view, as OUT/depth/NAME.exr and so on, with
OUT/maps.json, which says what they mean. import makes such files, also of other programs, maps
that stereo_fusion takes; depth is enough. docs/interchange.md explains both.
"""

import argparse

from .. import command_line, files
from . import confidences, exporting, formats, importing, sources


def _parse(words):
    parser = command_line.Parser(prog="convert_maps", description=__doc__,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_export(commands)
    _add_import(commands)
    return parser.parse_args(words)


def _add(commands, name, function, text):
    command = commands.add_parser(name, help=text)
    command.set_defaults(function=function)
    command.add_argument("--workspace_path", required=True, help="dense workspace of COLMAP")
    return command.add_argument


def _add_export(commands):
    add = _add(commands, "export", _export, "maps of all views into files of another format")
    add("--output_path", required=True, help="folder for them, which must not be there yet")
    add("--format", required=True, choices=[end[1:] for end in formats.EXTENSIONS])
    add("--input_type", choices=("geometric", "photometric"), default="geometric",
        help="which maps (%(default)s)")
    add("--depth_scale", type=command_line.positive_number,
        help="value of one unit of depth in a PNG (the largest of 1, 2 or 5 times a power of ten "
        "with which the largest depth fits into 16 bits)")
    add("--confidence", choices=confidences.KINDS,
        help="of the fused points that a pixel sees (DIR/fused*.ply), or the number of photographs "
        "that agree by consistency graphs (the first of them that there is)")


def _add_import(commands):
    add = _add(commands, "import", _import, "such files into geometric maps of a workspace")
    add("--input_path", required=True, help="folder with a file of depth per photograph, named "
        "like it, or with folders depth and normals of such")
    add("--depth_scale", type=command_line.positive_number,
        help="value of one unit of the sparse model in the files (for PNG what maps.json says, "
        "for other formats 1)")
    add("--resize", action="store_true", help="make maps smaller that are larger than their "
        "photograph, by taking the nearest pixels")
    add("--overwrite", action="store_true", help="replace maps that are there")


def _export(arguments):
    export = exporting.Export(arguments.workspace_path, arguments.input_type,
                              "." + arguments.format, arguments.depth_scale, arguments.confidence)
    with files.replacing_folder(arguments.output_path) as folder:
        text = export.write(folder)
    print(f"{arguments.output_path}: {text}")


def _import(arguments):
    target = importing.Target(arguments.workspace_path, arguments.overwrite)
    source = sources.Source(arguments.input_path, arguments.depth_scale, arguments.resize)
    print(f"{arguments.workspace_path}: {importing.import_maps(source, target)}")


def main(words=None):
    arguments = _parse(words)
    arguments.function(arguments)
    return 0
