"""A recording in space whose motion has a closed form: balls that bounce on a plane, a box that tumbles about a
fixed axis in free flight, and one of each other solid at rest.
"""

import numpy

from carom import ContactMode, EventKind, _core
from carom.recorded import Recording, ledger_type

GRAVITY = 9.81
RADIUS = 0.2
BALLS = [(-1.5, 0.0), (-0.9, 0.5), (-0.3, 0.0)]
HEIGHTS = [0.8, 1.1, 1.4]  # of their middles at first
BOX = {
    "centre": (0.9, 0.0, 0.4),
    "sides": (0.6, 0.4, 0.2),
    "velocity": (0.3, 0.0, 5.0),
    "spin": (1.0, 2.0, 2.0),
}
UNTIL, SAMPLES = 1.0, 51


def turn(spin: numpy.ndarray, times: numpy.ndarray) -> numpy.ndarray:
    """Orientations (n, 4) after a constant spin [rad/s], as of equal moments of inertia."""
    rate = numpy.linalg.norm(spin)
    half = 0.5 * rate * times[:, None]
    return numpy.concatenate([numpy.cos(half), numpy.sin(half) * spin / rate], axis=1)


def bounce(height: float, time: float) -> float:
    """Height of a ball's middle that falls from a height and loses nothing."""
    fall = (2.0 * (height - RADIUS) / GRAVITY) ** 0.5
    since = (time + fall) % (2.0 * fall) - fall
    return height - 0.5 * GRAVITY * since**2


def impacts(height: float) -> numpy.ndarray:
    fall = (2.0 * (height - RADIUS) / GRAVITY) ** 0.5
    times = fall * (1.0 + 2.0 * numpy.arange(20))
    return times[times < UNTIL]


def parts() -> list[dict]:
    """Shapes of the bodies and the ground."""
    tetrahedron = [[0.2, 0.2, 0.2], [0.2, -0.2, -0.2], [-0.2, 0.2, -0.2], [-0.2, -0.2, 0.2]]
    shapes = [("Sphere", {"radius": RADIUS})] * len(BALLS) + [
        ("Box", {"sides": list(BOX["sides"])}),
        ("Capsule", {"from": [-0.3, 0.0, 0.0], "to": [0.3, 0.0, 0.0], "radius": 0.12}),
        ("Cylinder", {"from": [0.0, 0.0, -0.2], "to": [0.0, 0.0, 0.2], "radius": 0.2}),
        ("ConvexMesh", {"vertices": tetrahedron, "faces": [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 2, 3]]}),
    ]
    made = [{"role": "obstacle", "type": "HalfSpace", "serial": 0, "name": "floor"}]
    made[0]["fields"] = {"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 2.0]}
    for i, (kind, fields) in enumerate(shapes):
        made.append({"role": "shape", "type": kind, "serial": i, "name": "", "fields": {"body": i, **fields}})
    return made


AT_REST = [(0.2, 0.9, 0.12), (1.2, 1.0, 0.2), (-1.6, 1.2, 0.2)]  # capsule, cylinder, mesh


def states(times: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Positions and orientations of all bodies."""
    count = len(BALLS) + 1 + len(AT_REST)
    positions = numpy.zeros((len(times), count, 3))
    orientations = numpy.zeros((len(times), count, 4))
    orientations[:, :, 0] = 1.0
    for i, ((x, y), height) in enumerate(zip(BALLS, HEIGHTS)):
        positions[:, i] = [(x, y, bounce(height, time)) for time in times]
    box = len(BALLS)
    positions[:, box] = numpy.array(BOX["centre"]) + numpy.outer(times, BOX["velocity"])
    positions[:, box, 2] -= 0.5 * GRAVITY * times**2
    orientations[:, box] = turn(numpy.array(BOX["spin"]), times)
    positions[:, box + 1 :] = AT_REST
    return positions, orientations


def recording() -> Recording:
    """The run."""
    times = numpy.linspace(0.0, UNTIL, SAMPLES)
    positions, orientations = states(times)
    types = {key: numpy.dtype(value) for key, value in _core._row_types(3).items()}
    events = numpy.zeros(sum(len(impacts(height)) for height in HEIGHTS), types["events"])
    struck = sorted((time, i) for i, height in enumerate(HEIGHTS) for time in impacts(height))
    for row, (time, i) in zip(events, struck):
        row["time"], row["name"] = time, i
        row["point"], row["normal"] = (*BALLS[i], 0.0), (0.0, 0.0, 1.0)
        row["impulse"] = (2.0 * (2.0 * GRAVITY * (HEIGHTS[i] - RADIUS)) ** 0.5, 0.0, 0.0)
        row["kind"] = EventKind.impact.value
    contacts = numpy.zeros(len(AT_REST) * SAMPLES, types["contacts"])
    contacts["mode"] = ContactMode.stick.value
    contacts["normal"] = (0.0, 0.0, 1.0)
    for i, place in enumerate(AT_REST):
        rows = contacts[i :: len(AT_REST)]
        rows["point"], rows["name"] = (*place[:2], 0.0), len(BALLS) + i
        rows["impulse"] = (1.0, 0.3, 0.2)
    names = [f"ball {i + 1} on floor" for i in range(len(BALLS))] + ["capsule", "cylinder", "mesh"]
    bodies = [f"ball {i + 1}" for i in range(len(BALLS))] + ["box", "capsule", "cylinder", "mesh"]
    model = {
        "dimension": 3,
        "fingerprint": "0",
        "bodies": [{"serial": i, "name": name} for i, name in enumerate(bodies)],
        "parts": parts(),
        "scene": None,
    }
    arrays = {
        "times": times,
        "positions": positions,
        "velocities": numpy.gradient(positions, times, axis=0),
        "orientations": orientations,
        "ground": numpy.empty((SAMPLES, 0, 3)),
        "ledger": numpy.zeros(SAMPLES, ledger_type()),
        "contacts": contacts,
        "contact_ends": len(AT_REST) * numpy.arange(1, SAMPLES + 1),
        "events": events,
        "event_ends": numpy.searchsorted(events["time"], times, side="right"),
        "names": names,
    }
    return Recording(3, model, [], arrays)
