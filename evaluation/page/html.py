"""Pages from templates, with three.js and everything else inside."""

import importlib.util
import os

from .. import files
from ..processes import Failure

_TEMPLATES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "templates")
_THREE = "/usr/share/javascript/three"  # Of Debian's package libjs-three.
_SCRIPTS = ("three.min.js", "examples/js/controls/OrbitControls.js")


def check_libraries(*modules):
    """Raises Failure if a page cannot be made here."""
    missing = [f"python3-{name}" for name in ("jinja2", *modules)
               if importlib.util.find_spec(name) is None]
    missing += [f"{path} (of libjs-three)" for path in map(_script_path, _SCRIPTS)
                if not os.path.exists(path)]
    if missing:
        raise Failure(f"{missing[0]} is missing; run scripts/install_deps.sh")


def _script_path(name):
    """TAPA_THREE_DIR names another folder of three.js."""
    return os.path.join(os.environ.get("TAPA_THREE_DIR", _THREE), name)


def duration_text(seconds):
    """1:02:03, or 4.2 s."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def write(path, template, **values):
    """Writes a page, which appears only when it is complete."""
    import jinja2  # Only pages need it.

    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES), autoescape=True, trim_blocks=True,
        lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters["duration"] = duration_text
    scripts = [files.read_bytes(_script_path(name)).decode("utf-8") for name in _SCRIPTS]
    files.write_text(path, environment.get_template(template).render(scripts=scripts, **values))
