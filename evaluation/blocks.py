"""Large arrays, a block at a time, so that memory stays bounded."""

import numpy as np


def slices(count, size=1 << 18):
    """Slices of so many items that follow each other."""
    return [slice(begin, min(begin + size, count)) for begin in range(0, count, size)]


def numbered(counts, size=1 << 16):
    """Yields all pairs of i and a number from 0 to counts[i] - 1, in order.

    As two arrays of the same length, which is at most size.
    """
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    for block in slices(total, size):
        first, last = np.searchsorted(ends, (block.start, block.stop - 1), side="right")
        owners = np.arange(first, last + 1)
        begins = ends[owners] - counts[owners]
        lengths = np.minimum(ends[owners], block.stop) - np.maximum(begins, block.start)
        yield (np.repeat(owners, lengths),
               np.arange(block.start, block.stop) - np.repeat(begins, lengths))
