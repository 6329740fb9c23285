"""Published figures of Romanoni and Matteucci, "TAPA-MVS: Textureless-Aware
PAtchMatch Multi-View Stereo", ICCV 2019, in per cent.
"""

SOURCE = ("Romanoni and Matteucci, \"TAPA-MVS: Textureless-Aware PAtchMatch Multi-View "
          "Stereo\", ICCV 2019")

GROUPS = ["training", "training low-res", "training high-res",
          "test", "test low-res", "test high-res"]

# Table 1: F1 at 2 cm on ETH3D, in the order of GROUPS.
TABLE1 = {
    "TAPA-MVS": [71.42, 55.13, 77.69, 73.13, 58.67, 79.15],
    "OpenMVS": [70.44, 55.58, 76.15, 72.83, 56.18, 79.77],
    "ACMH": [65.37, 51.50, 70.71, 67.68, 47.97, 75.89],
    "COLMAP": [62.73, 49.91, 67.66, 66.92, 52.32, 73.01],
    "LTVRE": [59.44, 53.25, 61.82, 69.57, 53.52, 76.25],
    "CMPMVS": [47.48, 9.53, 62.49, 51.72, 7.38, 70.19],
}

TABLE2_TOLERANCES = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5]

# Table 2: completeness, accuracy and F1 on ETH3D's training scenes of high
# resolution at the tolerances above, by the name that the method has here.
TABLE2 = {
    "colmap": [(38.65, 84.34, 51.99), (55.13, 91.85, 67.66),
              (69.91, 97.09, 80.50), (79.47, 98.75, 87.61),
              (88.24, 99.37, 93.27), (96.03, 99.70, 97.78)],
    "paper-weights": [(32.68, 74.40, 44.58), (52.57, 85.70, 63.08),
                      (69.31, 94.08, 78.62), (78.10, 96.91, 85.64),
                      (84.93, 98.34, 90.53), (92.07, 99.30, 95.19)],
    "paper-coarse": [(41.72, 75.30, 53.18), (64.13, 85.98, 72.54),
                     (81.08, 93.69, 86.68), (88.80, 96.53, 92.38),
                     (93.64, 98.12, 95.77), (97.33, 99.23, 98.25)],
    "paper-fine": [(41.35, 75.10, 52.86), (63.69, 85.77, 72.26),
                   (80.84, 93.58, 86.51), (88.61, 96.45, 92.22),
                   (93.61, 98.05, 95.72), (97.54, 99.20, 98.34)],
    "paper-refinement": [(47.78, 72.13, 56.31), (64.27, 83.32, 71.84),
                         (78.62, 92.51, 84.37), (86.33, 95.94, 90.47),
                         (91.26, 97.75, 94.25), (95.65, 99.21, 97.23)],
    "paper": [(51.66, 75.37, 60.85), (71.45, 85.88, 77.69),
              (84.83, 94.31, 88.91), (90.98, 96.79, 93.69),
              (94.72, 98.23, 96.38), (97.60, 99.30, 98.41)],
}
