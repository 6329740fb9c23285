"""The report of scripts/evaluate as one HTML file, with the points of each method to turn."""

import base64
import mimetypes
import os
import re
import urllib.parse

from .. import binary_model, files, methods, pictures, processes
from ..processes import Failure
from . import confidence, html, scene

_POINTS = 1_000_000  # Of all sets together.
_CLOUDS = ("fused_agreement", "fused", "fused_default")  # The first that there is, of a method.
_REPORT_LINK = re.compile(r"\]\(([^():]*)\.md\)")
_IMAGE = re.compile(r'src="([^"]*)"')
_LINK = re.compile(r'href="([^"]*)"')
_PLAIN_LINK = re.compile(r"https?://.*|[#\w./%-]*")  # No other scheme, such as javascript.


def write_beside(path, markdown, reports):
    """Writes the page of the report at path beside it. Returns its path, "" if there is none.

    A page has nothing that its report does not have, but points to turn: without it there is
    a warning. Links to other reports lead to their pages.
    """
    page = os.path.splitext(path)[0] + ".html"
    try:
        write(page, _REPORT_LINK.sub(r"](\1.html)", markdown), reports)
    except Failure as error:
        processes.say(f"WARNING: there is no page {page}: {error}")
        return ""
    return page


def write(path, markdown, reports):
    """markdown: of the page beside it, whose pictures are taken in; reports: report.SetReport."""
    html.check_libraries("markdown")
    paths = {part.experiment.name: _clouds(part) for part in reports}
    count = _POINTS // max(1, sum(map(len, paths.values())))
    html.write(path, "report.html", title=_title(markdown),
               body=_take_in_pictures(_to_html(markdown), os.path.dirname(path)),
               viewers=[(part.experiment.name, _scene(part, paths[part.experiment.name], count))
                        for part in reports if paths[part.experiment.name]])


def _title(markdown):
    return markdown.partition("\n")[0].removeprefix("# ")


def _to_html(text):
    """Markdown as HTML, in which HTML of its own is text like any other."""
    import markdown  # Only reports need it.

    converter = markdown.Markdown(extensions=["tables"])
    converter.preprocessors.deregister("html_block")
    converter.inlinePatterns.deregister("html")
    return _LINK.sub(lambda match: match[0] if _PLAIN_LINK.fullmatch(match[1]) else 'href="#"',
                     converter.convert(text.partition("\n")[2]))


def _take_in_pictures(page, folder):
    """Replaces addresses of files in or below a folder by what these hold."""
    def data_of(match):
        path = os.path.join(folder, urllib.parse.unquote(match[1].replace("&amp;", "&")))
        # A report has names of files of strangers, and its page may be passed on.
        if not os.path.realpath(path).startswith(os.path.join(os.path.realpath(folder), "")):
            raise Failure(f"the report shows a picture that is not beside it, {path}")
        kind = mimetypes.guess_type(path)[0] or "application/octet-stream"
        data = base64.b64encode(files.read_bytes(path)).decode("ascii")
        return f'src="data:{kind};base64,{data}"'

    return _IMAGE.sub(data_of, page)


def _clouds(part):
    """Paths of one cloud of each method that pictures show, by its label."""
    found = {}
    for method in pictures.chosen_methods(part.experiment.shown_methods()):
        for run in part.by_method.get(method, [])[:1]:
            candidates = [os.path.join(run.folder, name + ".ply") for name in _CLOUDS]
            path = next(filter(os.path.exists, candidates), None)
            if path:
                found[methods.label(method)] = path
    return found


def _scene(part, paths, count):
    viewer = scene.Scene(binary_model.read_any(os.path.join(part.experiment.data, "sparse")))
    labels = {path: label for label, path in paths.items()}
    scene.add_files(viewer, list(labels), count * len(labels), confidence.of_points,
                    lambda path: f"{labels[path]} ({os.path.basename(path)})")
    return viewer.json()
