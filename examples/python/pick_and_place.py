# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pick and place: the arm carries the stone from the blue tray to the red one.

    python3 pick_and_place.py [--robot fr3] [--output FOLDER]

Writes pick_and_place.png: before, and after. The task itself stands in sweep_stiffness.py.
"""

# %%
from common import options
from matplotlib import pyplot
from sweep_stiffness import PickAndPlace

# %%
arguments, Robot = options(__doc__)
task = PickAndPlace(Robot, stiffness=800.0, seed=1)
with task.sim as sim:
    before = sim.render(width=480, height=360).rgb
    result = task.run()
    after = sim.render(width=480, height=360).rgb
print("placed" if result["placed"] else "missed", f"{1e3 * result['distance']:.0f} mm from the tray's middle")

# %%
figure, axes = pyplot.subplots(1, 2, figsize=(9.6, 3.6))
for one, picture in zip(axes, (before, after), strict=True):
    one.imshow(picture)
    one.axis("off")
figure.tight_layout()
figure.savefig(arguments.output / "pick_and_place.png", dpi=100)
