"""How much faster a run would be on several nodes, from the times of its views.

    scripts/cluster_speed_up LOG [--nodes 10,100,1000]

LOG: what patch_match_stereo printed, on one machine or on a cluster (WORKSPACE/cluster.log). A
step ends with its slowest share, and each share takes a start: to read the model and to hash and
read the photographs, as long as it took in the log at most, and to wait for the queue.
"""

import argparse
import re
import sys

from .. import command_line, files
from ..processes import Failure

_VIEW = re.compile(r"\s*[\d.]+ %\s+\S+ to go  ((?:level \d+ )?(?:photometric|draft|geometric)) "
                   r"(\d{1,12})/\d+ .+: [\d.]+ megapixels in (\d{1,12}(?:\.\d+)?) s")
_ELAPSED = re.compile(r"Elapsed time: (\d{1,12}(?:\.\d+)?) \[minutes\]")


class Times:
    """Seconds that a run took, by its log."""

    def __init__(self, lines):
        # For each step, in order, the seconds of its views by their number.
        self.steps = {}
        # Of the program that took longest to begin and to end.
        self.start = 0
        in_views = 0
        for line in lines:
            if match := _VIEW.match(line):
                # A share that was computed again counts once.
                self.steps.setdefault(match[1], {})[int(match[2])] = float(match[3])
                in_views += float(match[3])
            elif match := _ELAPSED.match(line):
                if in_views > 0:
                    self.start = max(self.start, 60 * float(match[1]) - in_views)
                in_views = 0

    def views(self):
        """Of each step a list of seconds, in the order of the views."""
        return [[seconds for _, seconds in sorted(step.items())] for step in self.steps.values()]


def seconds_on(steps, num_nodes, start, queue):
    """Of a run on several nodes: it is prepared, goes through all steps, and is finished."""
    return (len(steps) + 2) * (start + queue) + sum(max(shares(step, num_nodes))
                                                    for step in steps)


def shares(step, num_nodes):
    """Seconds of each share of a step, divided as RunPart::HasItem does."""
    count = min(num_nodes, len(step))
    sums = [0.0] * count
    for i, seconds in enumerate(step):
        sums[i * count // len(step)] += seconds
    return sums


def limit(steps, num_nodes, start, queue):
    """What most of the time is spent on, in words."""
    slowest = sum(map(max, steps))
    computing = sum(sum(step) for step in steps) / num_nodes
    starts = (len(steps) + 2) * (start + queue)
    uneven = sum(max(shares(step, num_nodes)) for step in steps) - max(computing, slowest)
    parts = {"computing": computing, "starts of the steps": starts,
             "shares of unequal size": uneven}
    if slowest > computing:
        parts["the slowest view of each step"] = slowest
        del parts["computing"]
    return max(parts, key=parts.get)


def main():
    parser = command_line.Parser(prog="scripts/cluster_speed_up", description=__doc__,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log")
    parser.add_argument("--nodes", type=command_line.whole_numbers, default=[1, 10, 100, 1000],
                        help="numbers of nodes, separated by commas (default: 1,10,100,1000)")
    parser.add_argument("--views", type=command_line.whole_number(1), default=None, metavar="N",
                        help="as if the run had so many views: those of the log over again")
    parser.add_argument("--queue", type=command_line.positive_number, default=2, metavar="SECONDS",
                        help="how long a job waits for a free node (default: %(default)s)")
    arguments = parser.parse(sys.argv[1:])
    text = files.read_bytes(arguments.log).decode("utf-8", errors="surrogateescape")
    times = Times(text.splitlines())
    if not times.steps:
        raise Failure(f"{arguments.log} has no times of views; it must be what patch_match_stereo "
                      "printed")
    steps = times.views()
    if arguments.views:
        steps = [[step[i % len(step)] for i in range(arguments.views)] for step in steps]
    alone = times.start + sum(map(sum, steps))
    print(f"{len(steps)} steps, {max(map(len, steps))} views, {alone:.0f} s on one machine, of "
          f"which {times.start:.1f} s before and after the views")
    print(f"{'nodes':>6} {'seconds':>9} {'speed-up':>9}  most of it")
    for num_nodes in arguments.nodes:
        if num_nodes < 1:
            raise Failure("--nodes must be whole numbers from 1 on")
        seconds = seconds_on(steps, num_nodes, times.start, arguments.queue)
        print(f"{num_nodes:>6} {seconds:>9.1f} {alone / seconds:>9.1f}  "
              f"{limit(steps, num_nodes, times.start, arguments.queue)}")
    return 0
