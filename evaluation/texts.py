"""Figures as a reader sees them."""


def number(value, digits=0, factor=1):
    """A multiple of a value, "-" if it is not known."""
    return "-" if value is None else f"{factor * value:.{digits}f}"


def percent(share, digits=1):
    return number(share, digits, 100)


def tolerance_text(value, unit="m"):
    """2 cm, 1.5 m or 0.5 %."""
    if unit == "%":
        return f"{value:.12g} %"
    return f"{100 * value:.12g} cm" if value < 1 else f"{value:.12g} m"


def clock(seconds):
    """0:01:30."""
    minutes, seconds = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02d}:{seconds:02d}"
