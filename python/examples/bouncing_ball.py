"""A ball falls on a floor and comes to rest: impacts and energies, as in docs/tutorial.md, section 1."""

from carom import EventDriven, Simulation, Surface, System
from carom.planar import Gravity, HalfPlane, Particle

MODE = EventDriven()
END = 2.0  # [s]


def bouncing_ball() -> System:
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.5, normal_restitution=0.6))
    system.add(HalfPlane(normal=(0.0, 1.0)), "floor")
    system.add(Particle(mass=1.0, position=(0.0, 1.0)), name="ball")
    return system


def run() -> Simulation:
    simulation = Simulation(bouncing_ball(), MODE)
    simulation.run_until(END)
    return simulation


if __name__ == "__main__":
    simulation = run()
    for event in simulation.events():
        before, after = event.velocity_before[0], event.velocity_after[0]
        what = f"{event.kind.name} of {simulation.name(event)}"
        print(f"{event.time:.6g} s: {what}, {before:.6g} -> {after:.6g} m/s")
    print(simulation.energy())
