"""
Healing from a slide-hold-slide test
====================================

While the machine is held, friction relaxes, and the contact heals; when it slides again, friction peaks, higher after a longer
hold. How friction relaxes during the hold tells the ageing law, which heals at rest, from the slip law, which heals with slip only.

You learn to compare laws by what they predict of a part of the record that was left out.
"""

from dataclasses import replace

import numpy as np

import stickslip as ss

body = ss.SpringBlock(mass="20 kg", stiffness="60 kN/mm", normal_force="50 kN")
law = ss.friction.RateAndState(reference=0.62, a=0.008, b=0.0095, distance="15 um")
holds = ss.loading.HoldAndSlide(slide=1e-5, slide_time=50.0, hold_times=[10.0, 30.0, 100.0])
run = ss.simulate(ss.Problem(body, law, pull_rate=holds), "340 s")

# The record: the rate of the load point, which is 0 in the holds, and friction with noise.

time = np.arange(0.0, 340.0, 0.1)
friction = run.traction(time) / 50e3 + 3e-4 * np.random.default_rng(4).standard_normal(len(time))
record = {"time (s)": time, "load rate (m/s)": holds.at(time), "friction": friction}

# %%
# Two evolutions of the state are fitted to the first two holds and their peaks. The third hold and its peak are predicted.

guess = replace(law, a=0.01, b=0.012, distance="10 um", reference=0.6)
free = ["a", "b", "distance", "reference"]
tried = []
for evolution in ("ageing", "slip"):
    problem = ss.Problem(body, replace(guess, evolution=evolution), pull_rate=1e-5)
    tried.append(ss.studies.infer(problem, record, free, held_out="150 s", starts=2))
    print(evolution, tried[-1].headline, f"prediction: {tried[-1].prediction:.2f} times the noise")
print(ss.studies.ranking(*tried).to_string())

figure = tried[0].plot()
