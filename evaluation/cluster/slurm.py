"""Hands jobs to Slurm, by its own commands."""

import shutil
import signal
import subprocess

from ..processes import Failure, Interrupted


def check():
    """Raises Failure unless there is a Slurm to hand jobs to."""
    for name in ("sbatch", "scontrol", "scancel"):
        if not shutil.which(name):
            raise Failure(f"there is no {name}: this machine belongs to no Slurm cluster; "
                          "docs/usage.md says how to go through the steps by hand")


def submit(script, name, output, *options, after_ok=None, after_any=None):
    """Returns the number of the job that runs a script of the shell.

    output: file for what the script does not write elsewhere. after_ok: number of the job that
    has to succeed before, or this one is dropped; after_any: of one that has to end.
    """
    return _job_number(_start(script, name, output, options, after_ok, after_any))


def submit_and_wait(script, name, output, *options, after_any=None):
    """The exit status of such a job. If this program is stopped, so is the job."""
    process = _start(script, name, output, ["--wait", *options], None, after_any)
    job = process.stdout.readline().strip().split(";")[0]
    try:
        error = process.communicate()[1].strip()
    except KeyboardInterrupt as interrupt:
        cancel([job])
        process.kill()
        raise Interrupted(signal.SIGINT) from interrupt
    if not job:
        raise Failure(f"sbatch refuses the job {name}: {error}")
    return process.returncode


def cancel(jobs):
    """Those that have ended already do not matter."""
    if jobs:
        subprocess.run(["scancel", *jobs], check=False, stderr=subprocess.DEVNULL)


def _start(script, name, output, options, after_ok, after_any):
    command = ["sbatch", "--parsable", "--requeue", "--open-mode=append", f"--job-name={name}",
               f"--output={output}", *options]
    if after_ok or after_any:
        condition = f"afterok:{after_ok}" if after_ok else f"afterany:{after_any}"
        command += [f"--dependency={condition}", "--kill-on-invalid-dep=yes"]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    with process.stdin:
        process.stdin.write(script)
    process.stdin = None  # communicate() would want to close it again.
    return process


def _job_number(process):
    output, error = process.communicate()
    # Such as "17", or "17;cluster".
    number = output.strip().split(";")[0]
    if process.returncode != 0 or not number:
        raise Failure(f"sbatch refuses a job: {error.strip()}")
    return number
