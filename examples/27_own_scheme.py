"""
Your own numerical scheme
=========================

A scheme is an object with a name and `begin(grid)`, which returns a body that can make its `first` state and `advance` by one step.
How friction is met is left to the package. This one is the upwind scheme: in a step a wave passes a share of its cell to the next.

You learn to write a scheme of your own, to count the energy that it dissipates, and to read its order and the rule that it follows.
"""

import numpy as np

import stickslip as ss
from stickslip.extensions.schemes.contract import Energies, Meeting, Sample


class Upwind:
    """What the scheme says about itself."""

    name, title, order, courant, largest_courant = "upwind", "first-order upwind on waves", 1.0, 0.5, 1.0

    def begin(self, grid):
        """Return the slab at t = 0."""
        return Cells(grid)


# %%
# The waves Z v + s and Z v - s, with the stress s beyond that of the start, live in cells. An upwind step dissipates
# nu (1 - nu) times the squares of the differences between cells: with that, the balance of energy closes to rounding.


class Cells:
    """The slab: waves down to the contact and up to the driver, Pa."""

    def __init__(self, grid):
        self.grid, self.steps, self.slip, self.driven = grid, 0, 0.0, 0.0
        middle = 0.5 * (grid.start_rates[1:] + grid.start_rates[:-1])
        self.down, self.up = grid.impedance * middle, grid.impedance * middle
        self.driver = self.friction = self.damped = self.rate = 0.0

    def first(self, contact):
        """Return the state just after t = 0."""
        return self.meet(contact)

    def advance(self, contact):
        """Move all waves by one step."""
        grid, nu, Z = self.grid, self.grid.courant, self.grid.impedance
        wave = self.up[-1]
        pull = grid.pull_rate if grid.is_rigid else (wave + grid.push(self.steps * grid.dt)) / (Z + grid.driver_impedance)
        down = np.append(self.down, 2 * Z * pull - wave)
        up = np.append(Z * self.rate - self.excess, self.up)
        self.driver += grid.dt * (Z * pull - wave) * pull
        self.friction += grid.dt * self.excess * self.rate
        lower, upper = np.diff(down), np.diff(up)
        self.damped += nu * (1 - nu) * grid.dx / (4 * grid.shear_modulus) * (lower @ lower + upper @ upper)
        self.down, self.up = down[:-1] + nu * lower, up[1:] - nu * upper
        self.slip, self.driven, self.steps = self.slip + grid.dt * self.rate, self.driven + grid.dt * pull, self.steps + 1
        return self.meet(contact)

    def meet(self, contact):
        """Let the contact find its slip rate, and say how things are."""
        grid = self.grid
        load = grid.stress + self.down[0]
        self.rate, traction = contact.meet(Meeting(load, grid.impedance, grid.slip + self.slip), self.rate)
        self.excess = traction - grid.stress
        stored = grid.dx / (4 * grid.shear_modulus) * (self.down @ self.down + self.up @ self.up)
        own = Energies(stored, self.driver, self.friction, self.damped)
        return Sample(self.steps * grid.dt, self.slip, self.rate, traction, own.beside(grid.stress, self.slip, self.driven))


# %%
# On a problem with one answer it has its order. On the loop that tells selection rules apart it follows the minimal rule with trial
# stick, and perfect delay if the contact searches from the slip rate before: its effective impedance is Z, as that of the slab.

law = ss.friction.SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=2.0)
slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
smooth = ss.Problem(slab, law, pull_rate=0.3, initial_slip=np.pi / 4, initial_excess=0.0)
order = ss.studies.schemes(smooth, 4.0, Upwind(), [200, 400, 800]).table
print(order[["cells", "slip_error", "slip_order", "energy_drift"]].to_string(index=False))

rules = {}
for search in ("stick-first", "continue"):
    loop = ss.studies.schemes("fig4-loop", scheme=Upwind(), cells=[200, 400, 800], search=search)
    rules[search] = loop.verdicts["upwind"]
    print(f"{search}: {rules[search]}")
    print((loop.table.damped / loop.table.heat).round(3).to_list(), "of the heat are dissipated by the scheme")
loop.plot()
