"""One run: from photographs and poses to depth maps and points.

    run = Run(data, folder, "room", "tapa", seed=0)
    record = complete(run)      # raises Failure; the next call goes on

The folder becomes a COLMAP workspace (scripts/make_workspace.sh). A step that is
done is not done again; where there are maps without a record, the run goes on from
them. record.json says how the results were made (run_record.py).
"""

import dataclasses
import glob
import os

from . import files, machine, processes, run_record
from .methods import FUSION_HIGH, METHODS

_SCRIPTS = os.path.join(machine.ROOT, "scripts")

# Options of stereo_fusion by the name of the cloud, FOLDER/NAME.ply.
FUSIONS = {"fused": FUSION_HIGH, "fused_default": []}


@dataclasses.dataclass
class Run:
    """What to run. data has images/ and sparse/, undistorted."""
    data: str
    folder: str
    set: str
    method: str
    seed: int = 0
    # More options of patch_match_stereo.
    options: list = dataclasses.field(default_factory=list)
    fusions: dict = dataclasses.field(default_factory=lambda: dict(FUSIONS))
    sources: int = 10
    every: int = 1
    bin_dir: str = dataclasses.field(default_factory=machine.default_bin_dir)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)


def folder_name(method, seed):
    return f"{method}-{seed}"


def size_options(image_size):
    """Options that limit photographs to so many pixels; None: full size."""
    if image_size is None:
        return []
    return ["--PatchMatchStereo.max_image_size", str(image_size)]


def all_options(run):
    """Options of patch_match_stereo with those of the method and the seed."""
    return _all_options(run.method, run.seed, run.options)


def _all_options(method, seed, options):
    return ["--PatchMatchStereo.seed", str(seed), *METHODS[method], *options]


def is_record_of(record, options, sources, every):
    """Whether a record is of a run with these settings."""
    return (record["method"] in METHODS
            and record["options"] == _all_options(record["method"],
                                                  record["seed"], options)
            and (record["sources"], record["every"]) == (sources, every))


def workspace_command(run):
    return [os.path.join(_SCRIPTS, "make_workspace.sh"), run.data, run.folder,
            str(run.sources), str(run.every)]


def stereo_command(run):
    return [os.path.join(run.bin_dir, "colmap"), "patch_match_stereo",
            "--workspace_path", run.folder, *all_options(run)]


def fusion_command(run, name):
    """Fuses into FOLDER/NAME.new.ply, which is renamed when it is complete."""
    return [os.path.join(run.bin_dir, "colmap"), "stereo_fusion",
            "--workspace_path", run.folder, "--output_path",
            run.path(name + ".new.ply"), *run.fusions[name]]


def is_complete(run):
    record = run_record.load(run.folder)
    return record is not None and all(
        step in record["done"] for step in ["stereo", *run.fusions])


def missing_commands(run):
    """The commands that complete() would run, in order."""
    record = run_record.load(run.folder)
    done = record["done"] if record else []
    commands = []
    if "stereo" not in done:
        commands += [workspace_command(run), stereo_command(run)]
    for name in run.fusions:
        if not os.path.exists(run.path(name + ".ply")):
            commands.append(fusion_command(run, name))
    return commands


def complete(run):
    """Does what is missing. Returns the record.

    Raises Failure or Interrupted; what was done stays, and is recorded.
    """
    record = _open_record(run)
    if "stereo" not in record["done"]:
        _make_workspace(run, record)
        processes.say(f"{run.folder}: stereo ...")
        before = files.fingerprint(run.path("stereo", "depth_maps"))
        _step(run, record, "stereo", stereo_command(run), "stereo.log")
        if files.fingerprint(run.path("stereo", "depth_maps")) != before:
            _remove_clouds(run)
        record["views"], record["image_size"] = describe_maps(run.folder)
        _finish(run, record, "stereo")
    for name in run.fusions:
        _fuse(run, record, name)
    return record


def _remove_clouds(run):
    """Clouds of maps that are no more, as of a run whose record was lost."""
    for name in run.fusions:
        for end in (".ply", ".ply.vis"):
            if os.path.exists(run.path(name + end)):
                os.remove(run.path(name + end))


def _fuse(run, record, name):
    if name in record["done"] and os.path.exists(run.path(name + ".ply")):
        return
    if not os.path.exists(run.path(name + ".ply")):
        processes.say(f"{run.folder}: {name}.ply ...")
        run_record.forget(record, name)
        record["fusion_options"][name] = run.fusions[name]
        _step(run, record, name, fusion_command(run, name), "fusion.log")
        for end in (".ply.vis", ".ply"):
            new = run.path(name + ".new" + end)
            if os.path.exists(new):
                os.replace(new, run.path(name + end))
    _finish(run, record, name)


def _new_record(run):
    record = {
        "set": run.set, "method": run.method, "seed": run.seed,
        "options": all_options(run), "fusion_options": {},
        "sources": run.sources, "every": run.every, "made_with": {},
        "views": None, "image_size": None,
        "done": [], "failed": None,
        "seconds": {}, "cpu_seconds": {}, "peak_memory_bytes": {}}
    if _map_paths(run.folder):
        run_record.set_unknown(record, "stereo")
    for name in run.fusions:
        if os.path.exists(run.path(name + ".ply")):
            run_record.set_unknown(record, name)
            record["fusion_options"][name] = None
    return record


def _open_record(run):
    machine.find_program(run.bin_dir, "colmap")
    record = run_record.load(run.folder)
    if record is None:
        return _new_record(run)
    for key, value in (("options", all_options(run)),
                       ("sources", run.sources), ("every", run.every)):
        if record[key] != value:
            if isinstance(value, list):
                value, record[key] = (" ".join(v) for v in (value, record[key]))
            raise processes.Failure(
                f"{run.folder} was made with {key} {record[key]}, not {value}; "
                "remove it or name another folder for results")
    for name in run.fusions:
        _check_fusion(run, record, name)
    return record


def _check_fusion(run, record, name):
    """Refuses points that were fused with other options."""
    cloud, asked = run.path(name + ".ply"), run.fusions[name]
    known = record["fusion_options"].get(name)
    if known is not None and known != asked and os.path.exists(cloud):
        known, asked = (" ".join(words) or "none" for words in (known, asked))
        raise processes.Failure(
            f"{cloud} was made with the fusion options {known}, not {asked}; "
            "remove it to make it anew")


def _make_workspace(run, record):
    """Refuses to mix maps of other photographs with those of this run."""
    config = run.path("stereo", "patch-match.cfg")
    before = _content(config) if _map_paths(run.folder) else None
    try:
        processes.run(workspace_command(run), run.path("workspace.log"))
    except processes.ProgramFailed as error:
        _fail(run, record, "workspace", error)
    if before is not None and _content(config) != before:
        with open(config, "w", encoding="utf-8") as file:
            file.write(before)
        _fail(run, record, "workspace", processes.Failure(
            f"{run.folder} has maps of other photographs or sources than "
            f"sources {run.sources}, every {run.every} gives; remove it or name "
            "another folder for results"))


def _step(run, record, step, command, log):
    """Runs a program, and adds to the record with what and what it took."""
    log = run.path(log)

    def end_part(usage):
        run_record.set_usage(record, step, _sum(known, usage))
        run_record.end_part(record, step,
                            machine.gpus_in(processes.last_output(log)))

    # Should this process be killed, the time of this part is not known.
    known = run_record.known_usage(record, step)
    end_part(None)  # The one before may have been killed.
    run_record.begin_part(record, step, machine.program_version(run.bin_dir),
                          machine.describe())
    run_record.save(run.folder, record)
    try:
        end_part(processes.run(command, log))
    except processes.ProgramFailed as error:
        end_part(error.usage)
        _fail(run, record, step, error)
    except processes.Interrupted as stop:
        end_part(stop.usage)
        run_record.save(run.folder, record)
        raise


def _sum(known, usage):
    if None in (known, usage):
        return None
    return processes.Usage(
        known.seconds + usage.seconds, known.cpu_seconds + usage.cpu_seconds,
        max(known.peak_memory_bytes, usage.peak_memory_bytes))


def _fail(run, record, step, error):
    record["failed"] = {"step": step, "message": str(error)}
    run_record.save(run.folder, record)
    raise error


def _finish(run, record, step):
    record["failed"] = None
    if step not in record["done"]:
        record["done"].append(step)
    run_record.save(run.folder, record)


def _content(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except FileNotFoundError:
        return None


def _map_paths(folder):
    return sorted(glob.glob(
        os.path.join(glob.escape(folder), "stereo", "depth_maps", "**",
                     "*.geometric.bin"), recursive=True))


def describe_maps(folder):
    """Number of depth maps, and [width, height] of the first one."""
    paths = _map_paths(folder)
    if not paths:
        return 0, None
    with open(paths[0], "rb") as file:
        header = file.read(64).split(b"&")
    return len(paths), [int(header[0]), int(header[1])]
