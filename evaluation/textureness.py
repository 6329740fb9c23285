"""Textureness as the TAPA-MVS paper defines it; the engine has values of its own."""

import cv2
import numpy as np

MIN_TEXTURENESS = 0.5  # Of a patch without any variance.
_PATCH = (5, 5)
_EPSILON = 0.00005  # Variance of intensities (0 to 1) that counts as little texture.


def textureness(image):
    """Of every pixel of a grey image, from the variance in the patch around it.

    0.5 where the patch is flat; it tends to 1 with growing variance. At the border the patch
    has those of its pixels that lie in the image.
    """
    def patch_sums(values):
        # Whole numbers, which makes them exact.
        return cv2.boxFilter(values, cv2.CV_64F, _PATCH, normalize=False,
                             borderType=cv2.BORDER_CONSTANT)

    values = image.astype(np.float64)
    count, total, squares = map(patch_sums, (np.ones_like(values), values, values * values))
    variance = (count * squares - total * total) / (count * count * 255 ** 2)
    return ((variance + _EPSILON) / (variance + _EPSILON / MIN_TEXTURENESS)).astype(np.float32)
