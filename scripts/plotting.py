"""Common to the plot scripts: tables in, pictures out."""
import csv

import matplotlib.pyplot as plt

plt.rcParams["svg.hashsalt"] = "carom"  # equal pictures are equal files


def rows_of(path):
    """Names of the columns, without units, and the rows as text."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return [name.split(" [")[0] for name in rows[0]], rows[1:]


def columns_of(path):
    """Columns of numbers by name."""
    names, rows = rows_of(path)
    return dict(zip(names, zip(*([float(text) for text in row] for row in rows))))


def times_of(path, kind):
    """Times of the events of one kind."""
    names, rows = rows_of(path)
    time, what = names.index("time"), names.index("kind")
    return [float(row[time]) for row in rows if row[what] == kind]


def save(figure, folder, name):
    """Writes a picture as SVG and PNG and closes it."""
    for ending in ("svg", "png"):
        figure.savefig(folder / f"{name}.{ending}", dpi=150, metadata={"Date": None} if ending == "svg" else None)
    plt.close(figure)
