"""Kills a program, at moments all over its run and before its changes of files, and
starts it again until it comes to its end."""

import io_errors
import programs
import snapshots
import trials

TITLE = "killed at any moment"
MAX_KILLS_OF_A_RUN = 4


def _kill_by_time(program, folder, rng):
    """Returns what it did; None: the program was faster."""
    process = programs.start(program.command, folder)
    moment = rng.uniform(0, program.duration)
    try:
        output, _ = process.communicate(timeout=moment)
    except programs.subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return f"killed after {moment:.3f} s"
    assert process.returncode == 0, output
    return None


def _kill_by_change(program, folder, rng, num_changes):
    number = rng.randint(1, num_changes)
    status, output = programs.run(program.command, folder,
                                  io_errors.environment(folder, "change", number, -1))
    assert status in (0, -programs.signal.SIGKILL), output
    return f"killed before change {number} of files" if status != 0 else None


def run(program, count, rng, report):
    """Kills it `count` times in all."""
    num_changes = io_errors.count(program, "change")
    while count > 0:
        folder = program.fresh()
        done = []
        faults = []
        for _ in range(min(count, rng.randint(1, MAX_KILLS_OF_A_RUN))):
            what = (_kill_by_change(program, folder, rng, num_changes)
                    if num_changes and rng.random() < 0.5
                    else _kill_by_time(program, folder, rng))
            if what is None:
                break
            done.append(what)
            faults += snapshots.faults_at_names(folder, program.start, program.expected)
        count -= len(done)
        report.num_trials += len(done)
        report.num_ended += len(done)
        report.add(f"{program.name}, {', '.join(done)}",
                   trials.finish(program, folder, faults))
