"""
A sweep on a cluster
====================

A sweep hands its members to a dask cluster in chunks. Here the cluster is this machine; on a real one the address is that of
``dask scheduler``. Results do not depend on where a member ran.

You learn to run a sweep elsewhere, to keep it in a store, and to continue it after it was stopped. It needs
``pip install "stickslip[cluster]"``.
"""

import tempfile
from pathlib import Path

import numpy as np
from distributed import LocalCluster

import stickslip as ss

vary = {"friction.alpha": np.linspace(0.1, 0.4, 25)}
quantities = ["slip", "events"]

# %%
# Threads are enough for this example. A cluster of processes on this machine is ``ss.sweep(..., workers=4)``; scripts that start
# processes need ``if __name__ == "__main__":``.

with tempfile.TemporaryDirectory() as folder:
    store = Path(folder) / "alpha.zarr"
    with LocalCluster(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None) as cluster:
        found = ss.sweep("fig6-slab", vary, quantities=quantities, out=store, scheduler=cluster.scheduler_address).load()

# %%
# The same members on threads of this process, without a cluster, bit for bit:

here = ss.sweep("fig6-slab", vary, quantities=quantities)
print(f"identical: {bool((found.slip == here.slip).all())}")
alpha = found["friction.alpha"].values
print(f"slip begins between alpha = {alpha[found.events == 0].max():.4f} and {alpha[found.events == 1].min():.4f} s/m")

figure = ss.figures.plot_sweep(found, "slip")
