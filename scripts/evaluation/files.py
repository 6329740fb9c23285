"""Files that appear under their name only when they are complete."""

import json
import os

from .processes import Failure


def write_text(path, text):
    new = path + ".new"
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    with open(new, "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(new, path)


def write_json(path, value):
    write_text(path, json.dumps(value, indent=2, ensure_ascii=False) + "\n")


def read_json(path):
    """The content of a file, None where there is none."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise Failure(f"{path} cannot be read ({error}); remove it to make it "
                      "anew") from error
