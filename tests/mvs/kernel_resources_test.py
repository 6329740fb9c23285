"""What ptxas said about the kernels while they were compiled.

    kernel_resources_test.py REPORT

REPORT is what cmake/save_report.sh kept. Prints a table and fails if a kernel
takes more than was agreed on: docs/design.md says why these limits.
"""

import re
import sys

# Kernel: (registers, bytes of stack, bytes of spills).
LIMITS = {
    # Four blocks of 128 threads on a multiprocessor, 65536 registers.
    "SweepPiecesKernel": (128, 128, 64),
    "InitializeKernel": (128, 64, 0),
    "CheckpointKernel": (48, 0, 0),
    # The reference: its scratch is on the stack.
    "NaiveSweepPiecesKernel": (168, 4352, 64),
}
# Instances of each for every architecture: more of them cost compile time.
INSTANCES = {"SweepPiecesKernel": 3, "InitializeKernel": 3,
             "CheckpointKernel": 1, "NaiveSweepPiecesKernel": 1}


def read_report(path):
    """Yields (mangled name, architecture, stack, spills, registers)."""
    name = arch = None
    stack = spills = 0
    for line in open(path):
        entry = re.search(r"Compiling entry function '(\w+)' for '(\w+)'", line)
        if entry:
            name, arch = entry.groups()
            stack = spills = 0
        frame = re.search(r"(\d+) bytes stack frame, (\d+) bytes spill stores, "
                          r"(\d+) bytes spill loads", line)
        if frame:
            stack = int(frame.group(1))
            spills = max(int(frame.group(2)), int(frame.group(3)))
        used = re.search(r"Used (\d+) registers", line)
        if used and name:
            yield name, arch, stack, spills, int(used.group(1))
            name = None


def kernel_of(mangled):
    """The longest known name that the mangled one contains."""
    found = [kernel for kernel in LIMITS
             if re.search(r"\d%s" % kernel, mangled)]
    return max(found, key=len) if found else None


def main():
    errors = []
    count = {}
    print("%-8s %-24s %9s %6s %6s" % ("", "kernel", "registers", "stack",
                                      "spills"))
    for mangled, arch, stack, spills, registers in read_report(sys.argv[1]):
        kernel = kernel_of(mangled)
        if kernel is None:
            errors.append("%s has no limits" % mangled)
            continue
        print("%-8s %-24s %9d %6d %6d" % (arch, kernel, registers, stack,
                                          spills))
        count[arch, kernel] = count.get((arch, kernel), 0) + 1
        for what, value, limit in zip(
                ("registers", "bytes of stack", "bytes of spills"),
                (registers, stack, spills), LIMITS[kernel]):
            if value > limit:
                errors.append("%s for %s: %d %s, agreed are %d" %
                              (kernel, arch, value, what, limit))
    architectures = {arch for arch, _ in count}
    if not architectures:
        errors.append("the report is empty")
    for arch in architectures:
        for kernel, expected in INSTANCES.items():
            if count.get((arch, kernel), 0) != expected:
                errors.append("%s for %s: %d instances, agreed are %d" % (
                    kernel, arch, count.get((arch, kernel), 0), expected))
    for error in errors:
        print("ERROR: " + error)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
