"""What the jobs of a run do, as scripts of the shell."""

import os
import shlex

SHARE = '"$SLURM_ARRAY_TASK_ID/{}"'

_TRY = """\
#!/bin/sh
# Runs a command, and has Slurm run it again, at most {attempts} times in all, if it fails.
attempt=$((${{SLURM_RESTART_COUNT:-0}} + 1))
share=$(printf %06d "${{SLURM_ARRAY_TASK_ID:-1}}")
exec >>{logs}/{name}."$share.$attempt".log 2>&1 || exit 1
echo "# {name}, job $SLURM_JOB_ID, share $share, attempt $attempt, on ${{SLURMD_NODENAME:-$(hostname)}}, $(date)"
{command}
status=$?
echo "# {name}, job $SLURM_JOB_ID, share $share, attempt $attempt, ended with status $status, $(date)"
if [ "$status" -ne 0 ] && [ "$attempt" -lt {attempts} ]; then
  # It ends this job, which then waits to be run again.
  scontrol requeue "$SLURM_JOB_ID" && sleep 600
fi
exit "$status"
"""

_JOIN = """\
#!/bin/sh
# Joins the logs of all jobs to one, and says whether all of them have succeeded.
status=1
[ ! -e {logs}/.complete ] || status=0
{{
  [ ! -e {log} ] || cat {log}
  for part in {logs}/*; do cat "$part"; done
  if [ "$status" -eq 0 ]; then
    echo "# The run is complete."
  else
    echo "ERROR: The run has failed; lines above say why. The same command goes on from here."
  fi
}} >{log}.new && mv {log}.new {log} && rm -r {logs} && exit "$status"
exit 1
"""


class Jobs:
    """Makes the scripts of a run whose logs are in a folder."""

    def __init__(self, logs, attempts):
        self.logs = logs
        self.attempts = attempts

    def run(self, name, command, share_of=None, attempts=None, is_last=False):
        """Runs a command, given as words.

        share_of: as a job array of that size, each of which computes its share of a step.
        """
        text = shlex.join(command)
        if share_of:
            text += " --PatchMatchStereo.share " + SHARE.format(share_of)
        if is_last:
            text += " && : >" + shlex.quote(os.path.join(self.logs, ".complete"))
        return _TRY.format(attempts=attempts or self.attempts, logs=shlex.quote(self.logs),
                           name=name, command=text)

    def join(self, log):
        return _JOIN.format(logs=shlex.quote(self.logs), log=shlex.quote(log))

    def log_of(self, name):
        """Of the first attempt of a job that is not shared out."""
        return os.path.join(self.logs, f"{name}.000001.1.log")

    @property
    def output(self):
        """For what a job says that does not come to open its log."""
        return os.path.join(self.logs, "slurm.out")
