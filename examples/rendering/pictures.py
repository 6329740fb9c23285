"""Pictures that scenes wrap around their books, fabrics and frames.

Each is drawn by a function of a random generator, in linear reflectances; nothing is
read. save() writes the PNG files that a scene.pov looks up by name.
"""

import os

import cv2
import numpy as np


def smooth_noise(rng, height, width, cell, aspect=1.0):
    """Uniform noise on a lattice of `cell` pixels, interpolated; 0 to 1."""
    rows = int(np.ceil(height / cell)) + 3
    cols = int(np.ceil(width / (cell * aspect))) + 3
    lattice = rng.random((rows, cols)).astype(np.float32)
    big = cv2.resize(lattice, (int(cols * cell * aspect), int(rows * cell)),
                     interpolation=cv2.INTER_CUBIC)
    return np.clip(big[:height, :width], 0, 1)


def fractal_noise(rng, height, width, cell, octaves, aspect=1.0):
    total = np.zeros((height, width), np.float32)
    weight_sum = 0.0
    for octave in range(octaves):
        weight = 0.55 ** octave
        total += weight * smooth_noise(rng, height, width,
                                       max(cell / 2 ** octave, 1.0), aspect)
        weight_sum += weight
    return total / weight_sum


def weave(rng, image, thread, strength):
    """Gives every thread crossing its own brightness, as cloth has."""
    height, width = image.shape[:2]
    rows, cols = height // thread + 1, width // thread + 1
    crossing = rng.normal(0, strength, (rows, cols)).astype(np.float32)
    crossing[(np.add.outer(np.arange(rows), np.arange(cols)) % 2) == 0] -= (
        0.5 * strength)
    big = cv2.resize(crossing, (cols * thread, rows * thread),
                     interpolation=cv2.INTER_NEAREST)
    return image * (1 + big[:height, :width, None])


def ornament(rng, height, width, palette, cell, levels=None):
    """A pattern mirrored about both axes, in the colours of a palette."""
    half_height, half_width = (height + 1) // 2, (width + 1) // 2
    field = fractal_noise(rng, half_height, half_width, cell, 3)
    field = np.hstack([field, field[:, ::-1]])[:, :width]
    field = np.vstack([field, field[::-1]])[:height]
    levels = levels or 2 * len(palette)
    rank = np.searchsorted(np.quantile(field, np.arange(1, levels) / levels),
                           field)
    return np.asarray(palette, np.float32)[rank % len(palette)]


def rug(rng):
    """2.4 m x 1.7 m at 1.5 mm."""
    height, width = 1134, 1600
    red, navy = (0.40, 0.10, 0.09), (0.10, 0.13, 0.24)
    cream, ochre, teal = (0.78, 0.70, 0.55), (0.66, 0.44, 0.16), (0.18, 0.34, 0.34)
    image = ornament(rng, height, width, [red, red, navy, ochre, red, cream], 90)
    yy, xx = np.mgrid[0:height, 0:width].astype(np.float32)
    u, v = (xx - width / 2) / width * 2, (yy - height / 2) / height * 2
    # The medallion in the middle, with a scalloped edge.
    angle = np.arctan2(v, u)
    radius = np.hypot(u * 1.25, v * 1.05) - 0.035 * np.cos(14 * angle)
    medallion = ornament(rng, height, width, [navy, cream, navy, teal, ochre], 60)
    image = np.where((radius < 0.55)[..., None], medallion, image)
    image[(radius > 0.55) & (radius < 0.58)] = cream
    # Borders: bands of repeated motifs.
    edge = np.minimum(np.minimum(xx, width - 1 - xx), np.minimum(yy, height - 1 - yy))
    motif = ornament(rng, 96, 96, [navy, ochre, cream, red, teal], 22)
    tiled = np.tile(motif, (height // 96 + 1, width // 96 + 1, 1))[:height, :width]
    image = np.where((edge < 150)[..., None], tiled, image)
    for low, high, colour in ((0, 10, cream), (10, 38, red), (38, 44, ochre),
                              (134, 142, cream), (142, 152, navy)):
        image[(edge >= low) & (edge < high)] = colour
    small = ornament(rng, 24, 48, [red, cream, navy], 9)
    tiled = np.tile(small, (height // 24 + 1, width // 48 + 1, 1))[:height, :width]
    image = np.where(((edge >= 14) & (edge < 34))[..., None], tiled, image)
    # Pile: knots of 6 mm, and wear.
    image = weave(rng, image, 4, 0.17)
    return image * (0.75 + 0.5 * fractal_noise(rng, height, width, 160, 5)[..., None])


def landscape(rng):
    """A painting: sky, ridges, a meadow, in visible strokes. 1.15 m x 0.75 m."""
    height, width = 750, 1150
    yy, xx = np.mgrid[0:height, 0:width].astype(np.float32)
    sky = np.array((0.42, 0.56, 0.72)) + (yy / height)[..., None] * np.array(
        (0.55, 0.30, 0.02))
    clouds = fractal_noise(rng, height, width, 120, 6, aspect=2.2)
    image = sky + 1.6 * np.clip(clouds - 0.5, 0, 1)[..., None] * np.array((1, 0.9, 0.8))
    for level, colour, rough in ((0.40, (0.42, 0.47, 0.60), 60),
                                 (0.52, (0.27, 0.36, 0.42), 80),
                                 (0.63, (0.20, 0.30, 0.20), 50),
                                 (0.74, (0.45, 0.42, 0.16), 30)):
        ridge = fractal_noise(rng, 8, width, rough * 2, 6)[4]
        line = (level + 0.35 * (ridge - 0.5)) * height
        shade = 0.65 + 0.8 * fractal_noise(rng, height, width, 40, 5, aspect=1.7)
        mask = yy > line[None, :]
        image = np.where(mask[..., None], np.array(colour) * shade[..., None], image)
    canvas = np.ascontiguousarray(np.clip(image, 0, 1).astype(np.float32))
    # Strokes pick up the colour below them and vary it.
    for _ in range(9000):
        x, y = int(rng.integers(0, width)), int(rng.integers(0, height))
        angle = rng.normal(0, 25) if y < 0.6 * height else rng.normal(70, 30)
        size = (int(rng.integers(5, 15)), int(rng.integers(2, 4)))
        colour = canvas[y, x] * (1 + rng.normal(0, 0.20)) + rng.normal(0, 0.035, 3)
        cv2.ellipse(canvas, (x, y), size, angle, 0, 360,
                    tuple(float(c) for c in colour), -1, cv2.LINE_AA)
    for _ in range(420):
        x, y = int(rng.integers(0, width)), int(rng.integers(int(0.78 * height), height))
        colour = ((0.75, 0.15, 0.12), (0.85, 0.75, 0.30), (0.80, 0.78, 0.74))[
            int(rng.integers(0, 3))]
        cv2.circle(canvas, (x, y), int(rng.integers(2, 6)), colour, -1, cv2.LINE_AA)
    return canvas


def botanical(rng, tint):
    """A print: twigs with leaves, and a few lines of text. 0.45 m x 0.60 m."""
    height, width = 600, 450
    paper = 0.86 - 0.10 * fractal_noise(rng, height, width, 60, 5)
    canvas = np.ascontiguousarray(
        (paper[..., None] * np.array((1.0, 0.96, 0.86))).astype(np.float32))
    for _ in range(9):
        x, y = width / 2 + rng.normal(0, 30), height * 0.86
        heading = np.radians(-90 + rng.normal(0, 26))
        for step in range(26):
            nx, ny = x + 18 * np.cos(heading), y + 18 * np.sin(heading)
            if not (30 < nx < width - 30 and ny > 40):
                break
            cv2.line(canvas, (int(x), int(y)), (int(nx), int(ny)),
                     (0.22, 0.20, 0.13), 2, cv2.LINE_AA)
            side = 1 if step % 2 else -1
            leaf = heading + side * np.radians(50)
            centre = (int(nx + 16 * np.cos(leaf)), int(ny + 16 * np.sin(leaf)))
            colour = np.array(tint) * (0.6 + 0.8 * rng.random()) + rng.normal(0, 0.03, 3)
            axes = (int(rng.integers(10, 18)), int(rng.integers(4, 8)))
            cv2.ellipse(canvas, centre, axes, np.degrees(leaf), 0, 360,
                        tuple(float(c) for c in colour), -1, cv2.LINE_AA)
            cv2.ellipse(canvas, centre, axes, np.degrees(leaf), 0, 360,
                        (0.15, 0.16, 0.10), 1, cv2.LINE_AA)
            x, y, heading = nx, ny, heading + rng.normal(0, 0.16)
    for line, text in enumerate(("Folia varia", "tab. %d" % rng.integers(10, 90))):
        cv2.putText(canvas, text, (width // 2 - 80, height - 50 + 28 * line),
                    cv2.FONT_HERSHEY_COMPLEX, 0.8, (0.2, 0.18, 0.15), 1, cv2.LINE_AA)
    return canvas


WORDS = ("ATLAS", "TIDES", "STONE", "WINTER", "GARDEN", "LETTERS", "OPTICS",
         "HARBOUR", "NORTH", "FIELD", "ESSAYS", "RIVERS", "SUMMER", "GEOMETRY",
         "BIRDS", "LIGHT", "CITIES", "MOSS", "MAPS", "POEMS", "WEATHER", "ISLANDS")


def spines(rng, count):
    """`count` book spines side by side, 48 x 320 pixels each."""
    height, width = 320, 48
    cloths = np.array([(0.45, 0.09, 0.08), (0.08, 0.16, 0.33), (0.10, 0.25, 0.15),
                       (0.72, 0.65, 0.50), (0.14, 0.12, 0.12), (0.62, 0.38, 0.10),
                       (0.80, 0.80, 0.76), (0.35, 0.20, 0.12), (0.20, 0.38, 0.42),
                       (0.55, 0.22, 0.32), (0.86, 0.72, 0.20)])
    row = []
    for _ in range(count):
        cloth = cloths[rng.integers(0, len(cloths))] * (0.8 + 0.4 * rng.random())
        ink = np.array((0.88, 0.80, 0.55)) if cloth.mean() < 0.4 else np.array(
            (0.12, 0.10, 0.16))
        book = np.ones((height, width, 3), np.float32) * cloth
        book *= 0.72 + 0.56 * fractal_noise(rng, height, width, 14, 4)[..., None]
        band = cloths[rng.integers(0, len(cloths))]
        for _ in range(rng.integers(1, 5)):
            top = int(rng.integers(6, height - 30))
            book[top:top + int(rng.integers(4, 26))] = band * (0.8 + 0.3 * rng.random())
        for edge in (14, height - 18):
            book[edge:edge + 3] = ink
        strip = np.zeros((width, height - 60), np.float32)
        title = " ".join(rng.choice(WORDS, 2, replace=False))
        scale = 0.62 + 0.5 * rng.random()
        (length, _), _ = cv2.getTextSize(title, cv2.FONT_HERSHEY_DUPLEX, scale, 2)
        scale *= min(1.0, (height - 80) / length)
        cv2.putText(strip, title, (8, 33), cv2.FONT_HERSHEY_DUPLEX, scale, 1.0, 2,
                    cv2.LINE_AA)
        text = cv2.rotate(strip, cv2.ROTATE_90_CLOCKWISE)[..., None]
        book[30:height - 30] = book[30:height - 30] * (1 - text) + ink * text
        # Rounded back: darker towards both joints.
        book *= (1 - 0.55 * np.abs(np.linspace(-1, 1, width)) ** 3)[None, :, None]
        row.append(book)
    return np.hstack(row)


def magazine(rng, palette):
    """A cover: a bold title over a patterned picture. 0.21 m x 0.28 m."""
    height, width = 392, 294
    image = ornament(rng, height, width, palette, 70, levels=11)
    image = np.ascontiguousarray(
        image * (0.6 + 0.8 * fractal_noise(rng, height, width, 30, 5)[..., None]))
    image[:84] = palette[0]
    cv2.putText(image, WORDS[int(rng.integers(0, len(WORDS)))], (14, 62),
                cv2.FONT_HERSHEY_DUPLEX, 1.6, (0.95, 0.93, 0.85), 4, cv2.LINE_AA)
    for line in range(7):
        cv2.putText(image, " ".join(rng.choice(WORDS, 2)).lower(),
                    (16, 230 + 22 * line), cv2.FONT_HERSHEY_SIMPLEX, 0.5,
                    (0.95, 0.95, 0.9), 1, cv2.LINE_AA)
    return image


def chair_fabric(rng):
    """A tile of upholstery, 0.42 m square."""
    image = ornament(rng, 600, 600, [(0.80, 0.74, 0.60), (0.12, 0.27, 0.34),
                                     (0.80, 0.74, 0.60), (0.66, 0.30, 0.16),
                                     (0.24, 0.40, 0.36)], 105, levels=15)
    return weave(rng, image, 6, 0.12)


def kilim(rng):
    """Zigzag bands, 0.5 m square."""
    size = 500
    yy, xx = np.mgrid[0:size, 0:size]
    zigzag = (yy + np.abs((xx % 80) - 40)) // 17
    palette = np.array([(0.70, 0.26, 0.13), (0.84, 0.77, 0.60), (0.13, 0.20, 0.30),
                        (0.80, 0.55, 0.16), (0.16, 0.36, 0.36)])
    order = rng.integers(0, len(palette), zigzag.max() + 1)
    return weave(rng, palette[order][zigzag].astype(np.float32), 5, 0.16)


def leafy_cloth(rng):
    """Scattered leaves on dark cloth, 0.5 m square."""
    canvas = np.ones((500, 500, 3), np.float32) * np.array((0.10, 0.16, 0.15),
                                                           np.float32)
    for _ in range(330):
        centre = tuple(int(c) for c in rng.integers(0, 500, 2))
        axes = (int(rng.integers(14, 30)), int(rng.integers(5, 10)))
        hue = ((0.75, 0.68, 0.40), (0.42, 0.55, 0.35), (0.72, 0.40, 0.30))[
            int(rng.integers(0, 3))]
        colour = tuple(float(c * (0.7 + 0.5 * rng.random())) for c in hue)
        turn = float(rng.random() * 360)
        cv2.ellipse(canvas, centre, axes, turn, 0, 360, colour, -1, cv2.LINE_AA)
        cv2.ellipse(canvas, centre, (axes[0], 0), turn, 0, 360, (0.08, 0.12, 0.1), 1,
                    cv2.LINE_AA)
    return weave(rng, canvas, 5, 0.14)


def tweed(rng):
    """The sofa's cloth, 0.8 m square: threads of several greys."""
    height = width = 640
    base = np.ones((height, width, 3), np.float32) * np.array((0.33, 0.36, 0.40),
                                                              np.float32)
    base *= 0.80 + 0.4 * fractal_noise(rng, height, width, 24, 5)[..., None]
    base = weave(rng, base, 4, 0.24)
    return weave(rng, base, 8, 0.13)


def page(rng, tint=(0.84, 0.83, 0.79)):
    """A printed notice: a heading, lines of text, a small figure. 0.21 m x 0.30 m."""
    height, width = 420, 294
    canvas = np.ones((height, width, 3), np.float32) * np.array(tint, np.float32)
    ink = (0.10, 0.10, 0.12)
    cv2.putText(canvas, str(rng.choice(WORDS)), (24, 52), cv2.FONT_HERSHEY_DUPLEX, 1.1, ink, 2,
                cv2.LINE_AA)
    figure = int(rng.integers(3, 9))
    for line in range(15):
        y = 88 + 21 * line
        if figure <= line < figure + 5:
            continue
        cv2.putText(canvas, " ".join(rng.choice(WORDS, 4)).lower()[:34], (24, y),
                    cv2.FONT_HERSHEY_SIMPLEX, 0.4, ink, 1, cv2.LINE_AA)
    top = 76 + 21 * figure
    for bar in range(10):
        tall = int(rng.integers(15, 90))
        colour = tuple(float(c) for c in rng.uniform(0.1, 0.6, 3))
        cv2.rectangle(canvas, (30 + 24 * bar, top + 95 - tall), (48 + 24 * bar, top + 95), colour,
                      -1)
    return canvas


def screen(rng):
    """What a monitor shows: windows with text over a blue picture."""
    height, width = 450, 800
    field = fractal_noise(rng, height, width, 220, 4)[..., None]
    canvas = np.ascontiguousarray((np.array((0.03, 0.09, 0.20)) + field * np.array(
        (0.10, 0.20, 0.30))).astype(np.float32))
    for left, top, right, bottom in ((30, 30, 470, 400), (500, 60, 770, 250),
                                     (520, 280, 760, 410)):
        cv2.rectangle(canvas, (left, top), (right, bottom), (0.80, 0.81, 0.82), -1)
        cv2.rectangle(canvas, (left, top), (right, top + 22), (0.25, 0.27, 0.30), -1)
        for y in range(top + 46, bottom - 8, 18):
            text = " ".join(rng.choice(WORDS, 6)).lower()
            cv2.putText(canvas, text[:(right - left - 40) // 9], (left + 14, y),
                        cv2.FONT_HERSHEY_SIMPLEX, 0.42, (0.1, 0.1, 0.12), 1, cv2.LINE_AA)
    return canvas


def whiteboard(rng):
    """Mostly white: a few lines by hand, a diagram, and what was not wiped well.
    1.6 m x 1.0 m."""
    height, width = 700, 1120
    canvas = np.ones((height, width, 3), np.float32) * np.array((0.82, 0.83, 0.83), np.float32)
    canvas *= 0.985 + 0.03 * fractal_noise(rng, height, width, 200, 3)[..., None]
    canvas = np.ascontiguousarray(canvas)
    blue, red = (0.08, 0.12, 0.40), (0.50, 0.08, 0.08)
    for line in range(4):
        cv2.putText(canvas, " ".join(rng.choice(WORDS, 2)).lower(), (70, 90 + 55 * line),
                    cv2.FONT_HERSHEY_SCRIPT_SIMPLEX, 1.3, blue, 2, cv2.LINE_AA)
    boxes = [(int(x), int(y)) for x, y in zip(rng.integers(120, 480, 4), (340, 430, 520, 600))]
    for (x, y), (u, v) in zip(boxes, boxes[1:]):
        cv2.line(canvas, (x, y), (u, v), red, 2, cv2.LINE_AA)
    for x, y in boxes:
        cv2.ellipse(canvas, (x, y), (60, 28), 0, 0, 360, blue, 2, cv2.LINE_AA)
    return canvas


def quilt(rng):
    """Patchwork of plain and patterned squares. 1.5 m x 1.5 m."""
    side, count = 150, 8
    colours = np.array([(0.62, 0.20, 0.16), (0.82, 0.76, 0.64), (0.16, 0.24, 0.40),
                        (0.70, 0.55, 0.25), (0.32, 0.42, 0.36), (0.78, 0.62, 0.58)])
    rows = []
    for _ in range(count):
        row = []
        for _ in range(count):
            pair = colours[rng.choice(len(colours), 2, replace=False)]
            patch = (np.ones((side, side, 3), np.float32) * pair[0] if rng.random() < 0.35
                     else ornament(rng, side, side, list(pair), int(rng.integers(20, 50))))
            patch[:3] = patch[:, :3] = 0.6 * pair[0]
            row.append(patch)
        rows.append(np.hstack(row))
    return weave(rng, np.vstack(rows).astype(np.float32), 3, 0.06)


def save(folder, name, image):
    """Colours are linear reflectances; the file is sRGB, as POV-Ray expects."""
    linear = np.clip(image, 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear,
                       1.055 * linear ** (1 / 2.4) - 0.055)
    cv2.imwrite(os.path.join(folder, name),
                np.rint(encoded[..., ::-1] * 255).astype(np.uint8))
