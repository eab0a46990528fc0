# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""How stiff must an arm be to carry the stone? Stiffnesses times random scenes, as a heat map.

    python3 sweep_stiffness.py [--scenes 8] [--output FOLDER] [--cluster tcp://host:8786]

An arm with the friction of a real one picks the stone off the blue tray and places it in the red one, by a
Cartesian impedance controller below a slow policy. A soft arm stops short of its targets: it misses the
stone, or places it badly. Called again, the sweep goes on where it was interrupted.
"""

# %%
import argparse
import sys
from pathlib import Path

import numpy
import pyfranka
from pyfranka.sim import KINDS, Panda, RequestRefused, Simulation

STIFFNESSES = (50, 100, 200, 400, 800, 1600)  # [N/m]
BASE = (-0.5, 0.0, 0.0)  # of the robot in the world [m]
STONE = (0.000286, -0.221972, 0.475172)  # where it rests [m]
TRAY = (0.004103, 0.219654)  # the middle of the red tray [m]
TRAY_SIZE = (0.235, 0.145)  # [m]
ABOVE, PLACED = 0.15, 0.003  # [m] over the stone while moving, and when it is let go
WIDTH, FORCE = 0.032, 20.0  # of the stone between the fingers [m], of the grasp [N]
SPEED, TURN_SPEED = 0.15, 0.4  # [m/s, rad/s], mean
SETTLE = 500  # ticks after a motion
POLICY = 50  # ticks between two decisions
NOTEBOOK = "ipykernel" in sys.modules


def downwards(position):
    """O_T_EE of a hand that points downwards, at a position in the world."""
    pose = numpy.diag([1.0, -1.0, -1.0, 1.0])
    pose[:3, 3] = numpy.subtract(position, BASE)
    return pose


# %%
class PickAndPlace:
    """The task: a world with a robot, a random scene, and a policy that carries the stone."""

    def __init__(self, kind=Panda, stiffness=800.0, seed=1, realism="real"):
        self.sim = Simulation("stone.xml", [kind(base=BASE, realism=realism)], seed=seed)
        self.robot = self.sim[kind.kind]
        self.stiffness = [stiffness] * 3 + [stiffness / 20] * 3  # [N/m, Nm/rad]
        chance = numpy.random.default_rng(seed)
        self.stone = numpy.add(STONE, [*chance.uniform(-0.02, 0.02, 2), 0.0])
        self.sim.reset(q=self.robot.state.q + chance.uniform(-0.1, 0.1, 7), objects={"stone": self.stone})
        self.robot.set_collision_behavior([100.0] * 7, [100.0] * 7, [100.0] * 6, [100.0] * 6)

    def go(self, position):
        """Moves the controller's target there, and gives the arm time to settle."""
        here, target = self.robot.state.O_T_EE, downwards(position)
        way = numpy.linalg.norm(target[:3, 3] - here[:3, 3])
        turn = numpy.arccos(min((numpy.trace(here[:3, :3].T @ target[:3, :3]) - 1) / 2, 1.0))
        duration = max(way / SPEED, turn / TURN_SPEED, 0.3)
        self.robot.cartesian_impedance(target, duration, self.stiffness)
        self.sim.step(int(1000 * duration) + SETTLE)

    def wait(self, action):
        """Steps until the hand has finished."""
        for _ in range(100):
            self.sim.step(POLICY)
            if action.done:
                return

    def carry(self):
        """Takes the stone to the red tray. @returns whether the hand had it"""
        over = numpy.array([0.0, 0.0, ABOVE])
        goal = numpy.array([*TRAY, STONE[2] + PLACED])
        hand = self.robot.gripper
        self.wait(hand.move(0.08))
        self.go(self.stone + over)
        self.go(self.stone)
        self.wait(hand.grasp(WIDTH, 0.1, FORCE, 0.01, 0.01))
        grasped = hand.is_grasped
        self.go(self.stone + over)
        self.go(goal + over)
        self.go(goal)
        self.wait(hand.move(0.08))
        self.go(goal + over)
        self.sim.step(SETTLE)
        return grasped

    def run(self):
        """Carries the stone. @returns where it is then, and whether it rests in the red tray"""
        try:
            grasped = self.carry()
        except RequestRefused:  # after a reflex: the hand hit an obstacle; see mode
            grasped = False
        where, _ = self.sim.body_pose("stone")
        beside = numpy.abs(where[:2] - TRAY)
        return {
            "placed": bool((beside < numpy.divide(TRAY_SIZE, 2)).all() and where[2] > 0.45),
            "distance": float(numpy.linalg.norm(where[:2] - TRAY)),
            "grasped": grasped,
            "stone": where,
            "ticks": self.sim.ticks,
            "mode": str(self.robot.state.robot_mode),
            "hash": f"{self.robot.state_hash():016x}",
        }


# %%
def case(case, seed):
    """One case of the sweep. The scene is the same for each stiffness, so the sweep's seed is not used."""
    task = PickAndPlace(KINDS[case["robot"]], case["stiffness"], case["scene"])
    with task.sim:
        return task.run()


def heat_map(done, stiffnesses, scenes, path):
    """Draws how far from the tray's middle the stone ended; white: not in the tray."""
    import matplotlib

    if not NOTEBOOK:
        matplotlib.use("Agg")  # no display
    from matplotlib import pyplot

    distances = numpy.full((len(stiffnesses), scenes), numpy.nan)
    for outcome in done:
        if outcome.ok and outcome.result["placed"]:
            row = stiffnesses.index(outcome.case["stiffness"])
            distances[row, outcome.case["scene"] - 1] = 1e3 * outcome.result["distance"]
    figure, axes = pyplot.subplots(figsize=(1.5 + 0.6 * scenes, 0.8 + 0.5 * len(stiffnesses)))
    picture = axes.imshow(distances, origin="lower", cmap="viridis", aspect="auto")
    axes.set_xticks(range(scenes), range(1, scenes + 1))
    axes.set_yticks(range(len(stiffnesses)), stiffnesses)
    axes.set_xlabel("scene")
    axes.set_ylabel("stiffness [N/m]")
    figure.colorbar(picture, label="stone from the tray's middle [mm]")
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--robot", choices=["panda", "fr3"], default="panda", help="which arm (panda)")
    parser.add_argument("--scenes", type=int, default=8, help="how many random scenes (8)")
    parser.add_argument(
        "--stiffnesses", type=int, nargs="+", default=STIFFNESSES, metavar="N/m", help="each in all scenes"
    )
    parser.add_argument("--output", type=Path, default=Path(), metavar="FOLDER", help="of the picture")
    parser.add_argument("--cluster", help="a Dask scheduler; this machine's cores")
    options = parser.parse_args(arguments)
    scenes = range(1, options.scenes + 1)
    cases = [
        {"robot": options.robot, "stiffness": float(stiffness), "scene": scene}
        for stiffness in options.stiffnesses
        for scene in scenes
    ]
    done = pyfranka.sweep(
        case, cases, options.cluster, output=options.output / "stiffness.parquet", progress=True
    )
    for stiffness in options.stiffnesses:
        placed = [o.result["placed"] for o in done if o.ok and o.case["stiffness"] == stiffness]
        print(f"{stiffness:5.0f} N/m: {sum(placed)} of {len(placed)} placed")
    heat_map(done, list(options.stiffnesses), options.scenes, options.output / "stiffness.png")


# %%
if __name__ == "__main__":
    main([] if NOTEBOOK else None)
