"""Fewer points of a cloud, spread evenly over space."""

import numpy as np

_LEVELS = 21  # Cubes are halved so often: three times 21 bits make a key.


def thin(points, count):
    """Which points, at most count, stand for all; in the order of the file.

    Space is divided into cubes, these into eight each, and so on. A point stands for the largest
    cube that it is the first of. Those of the largest cubes are taken, and of the last size
    that does not fit as a whole, evenly many along the way through space. The same points come
    out every time.
    """
    if len(points) <= count:
        return np.arange(len(points))
    keys = _keys(points)
    order = np.argsort(keys, kind="stable")
    sizes = _cube_sizes(keys[order])
    chosen = []
    for size in range(_LEVELS, -1, -1):
        of_size = np.flatnonzero(sizes == size)
        if len(of_size) > count:
            of_size = of_size[np.arange(count) * len(of_size) // count]
        chosen.append(of_size)
        count -= len(of_size)
    return np.sort(order[np.concatenate(chosen)])


def _keys(points):
    """Places along a curve through space (Morton's) that stays long within a cube."""
    low = points.min(axis=0).astype(np.float64)
    extent = (points.max(axis=0) - low).max()
    cells = np.zeros(points.shape, np.uint64)
    if extent > 0:
        scale = (2 ** _LEVELS - 1) / extent
        cells = ((points - low) * scale).astype(np.uint64)
    return sum(_spread(cells[:, axis]) << np.uint64(axis) for axis in range(3))


def _spread(values):
    """Moves the bits of 21-bit numbers apart: two zeros come behind each."""
    for shift, mask in ((32, 0x1f00000000ffff), (16, 0x1f0000ff0000ff),
                        (8, 0x100f00f00f00f00f), (4, 0x10c30c30c30c30c3),
                        (2, 0x1249249249249249)):
        values = (values | (values << np.uint64(shift))) & np.uint64(mask)
    return values


def _cube_sizes(keys):
    """Of sorted keys: up to how many halvings from the smallest each is the first of its cube."""
    differences = keys[1:] ^ keys[:-1]
    sizes = np.full(len(keys), _LEVELS)  # The first is so of the whole.
    # Equal points are the first of nothing, but may fill up what is left.
    sizes[1:] = sum(((differences >> np.uint64(3 * level)) != 0).astype(int)
                    for level in range(1, _LEVELS))
    return sizes
