# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Two arms in one simulation hand a bar over: one takes it from a stand, the other puts it on another."""

import random
import threading
from pathlib import Path

import numpy as np
import pytest
import rospy
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.geometry import downwards, pose_of, rotation_vector, wrap, yaw_of
from franka_sim_mujoco.pick_and_place import Arm, Gripper, Scene, wait_until
from PIL import Image
from ros_client import launched

HERE = Path(__file__).resolve().parent
SEEDS, SEEDS_IN_SHORT = range(1, 11), range(1, 2)
BAR_SIZE, BAR_MASS = (0.34, 0.03, 0.03), 0.08  # [m], [kg], as in hand_over.sdf
REST_HEIGHT = 0.465  # of the bar's center on a stand [m]
FIRST, MIDDLE, SECOND = -0.2, 0.0, 0.2  # y of the stands, and of the place between them [m]
LIFT = 0.08  # [m]
GRIP = 0.13  # from the bar's center to an arm's grasp: the last links must not touch [m]
FORCE = 40.0  # [N]
STIFFNESS = {"nullspace_stiffness": 10.0, "translational_stiffness": 400.0, "rotational_stiffness": 30.0}


class Side:
    """An arm, its hand, and the end of the bar that is nearer to it."""

    def __init__(self, arm_id: str, scene: Scene, side: float):
        namespace = f"/{arm_id}/"
        self.arm, self.gripper = Arm(arm_id, namespace), Gripper(namespace)
        self.arm.wait_ready()
        self.gripper.wait_ready()
        self.arm.configure(**STIFFNESS)
        self._scene = scene
        self._base_inverse = np.linalg.inv(scene.pose(f"{arm_id}_link0"))
        self._end = np.array([side * GRIP, 0.0, 0.0, 1.0])
        self.modes, self.errors = set(), set()
        rospy.Subscriber(f"{namespace}franka_state_controller/franka_states", FrankaState, self._watch)

    def _watch(self, state: FrankaState) -> None:
        self.modes.add(state.robot_mode)
        errors = state.current_errors
        self.errors |= {name for name in errors.__slots__ if getattr(errors, name)}

    def at(self, bar: np.ndarray, above: float = 0.0) -> np.ndarray:
        """Pose of the hand that holds its end of a bar at this pose (world, 4x4), or is above it."""
        place = self._base_inverse @ bar
        x, y, z, _ = place @ self._end
        return downwards(x, y, z + above, wrap(yaw_of(place), np.pi))

    def go(self, bar: np.ndarray, above: float = 0.0, **options) -> None:
        self.arm.move(self.at(bar, above), **options)

    def grasp(self, bar: np.ndarray) -> None:
        self.go(bar, speed=0.06, what="the descent")
        self.gripper.grasp(BAR_SIZE[1], FORCE)

    def let_go(self) -> None:
        self.gripper.stop()
        self.gripper.move(0.08, speed=0.05)

    def carry(self) -> None:
        self.arm.carry(self._base_inverse @ self._scene.pose("bar"), BAR_SIZE, BAR_MASS)

    def force(self) -> float:
        return self._scene.grip_force("bar", self.arm.fingers)


class Watch:
    """Records the smallest height of the bar from now on."""

    def __init__(self, scene: Scene):
        self._scene, self._ended, self.lowest = scene, threading.Event(), np.inf
        self._thread = threading.Thread(target=self._look)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._ended.set()
        self._thread.join()

    def _look(self):
        while not self._ended.wait(0.02):
            self.lowest = min(self.lowest, float(self._scene.pose("bar")[2, 3]))


def bar_at(y: float, lift: float = 0.0, x: float = 0.0, yaw: float = 0.0) -> np.ndarray:
    """Pose of a bar along the line between the arms, or rotated from it."""
    bar = np.eye(4)
    c, s = np.cos(yaw), np.sin(yaw)
    bar[:2, :2] = [[c, -s], [s, c]]
    bar[:3, 3] = [x, y, REST_HEIGHT + lift]
    return bar


def hand_over(one: Side, two: Side, scene: Scene, seed: int) -> dict:
    chance = random.Random(seed)
    x, y, yaw = chance.uniform(-0.01, 0.01), chance.uniform(-0.01, 0.01), chance.uniform(-0.3, 0.3)
    scene.place("bar", pose_of(bar_at(FIRST + y, x=x, yaw=yaw)))
    one.gripper.move(0.08)
    two.gripper.move(0.08)
    start = scene.pose("bar")
    one.go(start, LIFT)
    one.grasp(start)
    one.carry()
    one.arm.move(one.at(start, LIFT), speed=0.1, what="the lift")
    with Watch(scene) as watch:
        one.go(bar_at(MIDDLE, LIFT), what="the way to the middle")
        held = scene.pose("bar")
        two.go(held, LIFT, what="the way above the bar")
        two.grasp(held)
        forces = {"one": one.force(), "two": two.force()}
        image = scene.picture((0.05, -1.3, 1.1), (0.0, 0.0, 0.6))
        one.arm.carry_nothing()
        two.carry()
        one.let_go()
        one.arm.move(one.at(held, LIFT), what="the retreat of arm one")
        forces["one after"] = one.force()
        two.go(bar_at(SECOND, LIFT), what="the way to the second stand")
    two.go(bar_at(SECOND, 0.002), speed=0.06, what="the way down")
    two.let_go()
    two.arm.carry_nothing()
    two.go(bar_at(SECOND, LIFT), what="the retreat of arm two")
    end = scene.pose("bar")
    return {
        "seed": seed,
        "lowest": watch.lowest - REST_HEIGHT,
        "forces": forces,
        "away": float(np.linalg.norm(end[:2, 3] - [0.0, SECOND])),
        "height": float(end[2, 3] - REST_HEIGHT),
        "turned": float(np.linalg.norm(rotation_vector(end[:3, :3]))),
        "picture": Image.frombytes("RGB", (image.width, image.height), image.data),
    }


pytestmark = [pytest.mark.own_process("robot"), pytest.mark.timeout(900)]


@pytest.fixture(
    scope="module",
    params=["panda", pytest.param("fr3", marks=pytest.mark.long_form("the same with FR3s"))],
)
def robot(request):
    return request.param


@pytest.fixture(scope="module")
def sides(robot, tmp_path_factory):
    """The two arms, and their scene."""
    launch = [str(HERE / "data" / "hand_over.launch"), f"robot:={robot}"]
    with launched(*launch, log=tmp_path_factory.mktemp("hand_over") / "launch.log"):
        wait_until(lambda: rospy.get_time() > 0, "the simulation's clock")
        scene = Scene()
        yield Side(f"{robot}_1", scene, -1.0), Side(f"{robot}_2", scene, 1.0), scene


def test_a_bar_is_handed_over(sides, long_run):
    one, two, scene = sides
    for seed in SEEDS if long_run else SEEDS_IN_SHORT:
        go = hand_over(one, two, scene, seed)
        forces = go["forces"]
        assert forces["one"] > 30.0 and forces["two"] > 30.0, go  # both hold it at the same time
        assert forces["one after"] == 0.0, go
        assert go["lowest"] > LIFT - 0.02, go  # it never falls
        assert go["away"] < 0.015 and go["turned"] < 0.05, go  # it stands on the second stand
        assert abs(go["height"]) < 1e-3, go
        assert len(go["picture"].getcolors(maxcolors=1 << 20)) > 200, "The picture is empty."
    assert one.modes | two.modes == {FrankaState.ROBOT_MODE_MOVE}
    assert one.errors | two.errors == set()
