# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A data set of LeRobot, written by LeRobot: episodes of a task, or recordings of a robot.

    python3 lerobot_dataset.py [--environment pyfranka/Push-v0] [--pictures] [--episodes 10] [--output FOLDER]
    python3 lerobot_dataset.py my_panda.csv ... [--fps 50] [--task "move all joints"] [--output FOLDER]

A frame is the observation before a step of a written policy, the action, and what the step led to; episodes
that fail are left out. Of a recording of `franka_info record` (200 Hz) a frame has the last sample until its
moment. FOLDER must not exist. How LeRobot is installed: docs/gym.md#export-of-episodes.
"""

import argparse
import csv
import importlib.util
from pathlib import Path

import numpy

SIGNALS = {  # of seven joints each, in a recording
    "observation.state": ("q", "dq"),
    "observation.effort": ("tau_J",),
    "observation.external_torque": ("tau_ext_hat_filtered",),
    "action": ("dq_d",),
}
COLUMNS = {
    name: [f"{s}{joint}" for s in signals for joint in range(1, 8)] for name, signals in SIGNALS.items()
}


def observed(observation):
    """Vectors and pictures of an observation, by LeRobot's names."""
    named = {}
    for name, value in observation.items():
        if numpy.ndim(value) == 3:
            named[f"observation.images.{name}"] = value
        else:
            own = "state" if name == "observation" else name
            named[f"observation.{own}"] = numpy.asarray(value, numpy.float32)
    return named


def play(env, policy, seed):
    """An episode: its frames, and whether it succeeded."""
    observation, _ = env.reset(seed=seed)
    frames, over = [], False
    while not over:
        action = policy(observation)
        frame = {**observed(observation), "action": numpy.asarray(action, numpy.float32)}
        observation, reward, terminated, truncated, info = env.step(action)
        over = terminated or truncated
        ends = {"next.done": numpy.array([over]), "next.success": numpy.array([info["is_success"]])}
        frames.append({**frame, "next.reward": numpy.array([reward], numpy.float32), **ends})
    return frames, info["is_success"]


def demonstrations(arguments):
    """Episodes that succeed, frames a second, and the names of the numbers of features."""
    import gymnasium
    import pyfranka.gym

    observation = "state+pictures" if arguments.pictures else "state"
    env = gymnasium.make(arguments.environment, robot=arguments.robot, observation=observation)
    episodes = []
    for seed in range(arguments.episodes):
        frames, success = play(env, pyfranka.gym.scripted_policy(env), seed)
        episodes += [frames] if success else []
    layout = env.get_wrapper_attr("layout")
    env.close()
    state = [f"{part}.{i}" for part, where in layout.items() for i in range(where.stop - where.start)]
    return episodes, int(env.metadata["render_fps"]), {"observation.state": state}


def recorded(file, fps):
    """The frames of a recording. Raises ValueError for another file, OSError."""
    with open(file, newline="", encoding="utf-8") as stream:
        titles, *rows = [*csv.reader(stream)] or [[]]
    missing = {"time", *(title for titles in COLUMNS.values() for title in titles)} - set(titles)
    if missing or not rows:
        raise ValueError(f"{file} is not of franka_info record: {min(missing, default='rows')} is missing.")
    values = numpy.array([[float(value) for value in row] for row in rows])
    time = values[:, titles.index("time")] - values[0, titles.index("time")]
    if not numpy.isfinite(values).all() or (numpy.diff(time) < 0.0).any():
        raise ValueError(f"{file} must have finite numbers, in rows whose time does not decrease.")
    moments = numpy.arange(int(time[-1] * fps + 1e-6) + 1) / fps
    samples = values[numpy.searchsorted(time, moments + 1e-6, side="right") - 1].astype(numpy.float32)
    places = {name: [titles.index(title) for title in names] for name, names in COLUMNS.items()}
    return [{name: sample[place] for name, place in places.items()} for sample in samples]


def feature(value, names):
    """How LeRobot describes an array."""
    if value.ndim == 3:
        return {"dtype": "video", "shape": value.shape, "names": ["height", "width", "channels"]}
    return {"dtype": value.dtype.name, "shape": value.shape, "names": names}


def write(folder, episodes, fps, names, robot, task):
    """Writes episodes of frames into a new folder."""
    from lerobot.datasets.lerobot_dataset import LeRobotDataset

    features = {name: feature(value, names.get(name)) for name, value in episodes[0][0].items()}
    dataset = LeRobotDataset.create(f"local/{folder.name}", fps, features, root=folder, robot_type=robot)
    for frames in episodes:
        for frame in frames:
            dataset.add_frame({**frame, "task": task})
        dataset.save_episode()
    dataset.finalize()


def command_line():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    add = parser.add_argument
    add("recordings", nargs="*", type=Path, metavar="RECORDING.csv", help="an episode each")
    add("--environment", default="pyfranka/Push-v0", help="of pyfranka.gym (pyfranka/Push-v0)")
    add("--pictures", action="store_true", help="with the environment's pictures, as videos")
    add("--episodes", type=int, default=10, help="of the environment (10)")
    add("--fps", type=int, default=50, help="frames a second, of recordings (50)")
    add("--task", default="move the arm", help="what the robot does, in words")
    add("--robot", default="panda", help="kind of the robot (panda)")
    add("--output", type=Path, default=Path("dataset"), metavar="FOLDER", help="a new one (dataset)")
    return parser


def main():
    parser = command_line()
    arguments = parser.parse_args()
    for name in ("lerobot",) if arguments.recordings else ("lerobot", "gymnasium"):
        if importlib.util.find_spec(name) is None:
            parser.exit(1, f"{parser.prog} needs the Python package {name}: docs/gym.md#export-of-episodes\n")
    if arguments.output.exists():
        parser.exit(1, f"{parser.prog}: {arguments.output} exists already; name another folder.\n")
    try:
        if arguments.recordings:
            episodes = [recorded(file, arguments.fps) for file in arguments.recordings]
            fps, names = arguments.fps, COLUMNS
        else:
            episodes, fps, names = demonstrations(arguments)
        if not episodes:
            raise ValueError("No episode has succeeded; nothing is written.")
    except (OSError, ValueError) as error:
        parser.exit(1, f"{parser.prog}: {error}\n")
    write(arguments.output, episodes, fps, names, arguments.robot, arguments.task)
    print(f"{len(episodes)} episodes with {sum(map(len, episodes))} frames in {arguments.output}")


if __name__ == "__main__":
    main()
