"""Starts a program and, at any moment of its run, itself once more, or fusion while
stereo is at work."""

import os

import programs
import trials

TITLE = "two runs at once"


def is_told(line):
    return "Another run is at work in" in line or "There are no geometric maps" in line


def _twice(program, delay, report):
    folder = program.fresh()
    first = programs.start(program.command, folder)
    programs.time.sleep(delay)
    endings = [programs.run(program.command, folder)]
    output, _ = first.communicate()
    endings.append((first.returncode, output))
    faults = [fault for status, text in endings
              for fault in trials.faults_of_ending(status, text, is_told)]
    if all(status != 0 for status, _ in endings):
        faults.append("neither came to its end")
    report.num_trials += 1
    report.num_ended += any(status != 0 for status, _ in endings)
    report.add(f"{program.name}, twice, the second one after {delay:.3f} s",
               trials.finish(program, folder, faults))


def _fuse_meanwhile(program, delay, report):
    folder = program.fresh()
    stereo = programs.start(program.command, folder)
    programs.time.sleep(delay)
    status, output = programs.run(programs.fusion_command(), folder)
    faults = trials.faults_of_ending(status, output, is_told)
    if status == 0 and stereo.poll() is None:
        faults.append("it takes maps that are not complete")
    for name in ("fused.ply", "fused.ply.vis"):
        if os.path.exists(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))
    output, _ = stereo.communicate()
    # Fusion may have been the first of the two.
    if stereo.returncode != 0 and not is_told(output):
        faults.append(f"stereo fails: {output[-300:]!r}")
    report.num_trials += 1
    report.num_ended += status != 0
    report.add(f"fusion {delay:.3f} s after {program.name}",
               trials.finish(program, folder, faults))


def run(program, number, rng, report):
    for _ in range(number):
        _twice(program, rng.uniform(0, 0.9 * program.duration), report)
        if program.command[1] == "patch_match_stereo":
            _fuse_meanwhile(program, rng.uniform(0, 0.9 * program.duration), report)
