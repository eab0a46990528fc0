# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""examples/python/lerobot_dataset.py: episodes and recordings as a data set of LeRobot."""

import json
import subprocess
import sys
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType

import numpy as np
import pyfranka.gym
import pytest
from gym_tasks import make

TOP = Path(__file__).resolve().parents[2]
PROGRAM = TOP / "examples" / "python" / "lerobot_dataset.py"
sys.path.append(str(PROGRAM.parent))
import lerobot_dataset  # noqa: E402

# Both versions write format 3; the later one needs Python 3.12. Without dependencies that these tests do not
# import.
LATER = sys.version_info >= (3, 12)
LEROBOT = "lerobot==0.6.1" if LATER else "lerobot==0.4.4"
IMPORTED = ["torch==2.10.0", "torchvision==0.25.0", "av==15.1.0", "einops", "gymnasium==1.4.0", "jsonlines"]
IMPORTED += (
    ["datasets==4.8.5", "draccus==0.11.6", "numpy<2.3", "pandas<3", "pyarrow<26", "safetensors"]
    if LATER
    else ["datasets==4.1.1", "draccus==0.10.0", "numpy<2", "pandas<2.4", "pyarrow<26"]
    + ["accelerate<2", "deepdiff<10", "huggingface-hub<0.36"]
)
READER = """
import json, sys
import torch
from lerobot.datasets.lerobot_dataset import LeRobotDataset

data = LeRobotDataset("someone/set", root=sys.argv[1], video_backend="pyav", **json.loads(sys.argv[2]))
frames = [data[i] for i in range(len(data))]
loader = torch.utils.data.DataLoader(data, batch_size=3)
read = {
    "format": str(data.meta._version),
    "fps": data.fps,
    "robot": data.meta.robot_type,
    "episodes": data.num_episodes,
    "names": data.meta.names,
    "tasks": [frame["task"] for frame in frames],
    "batch": {name: list(value.shape) for name, value in next(iter(loader)).items() if name != "task"},
    "values": {
        name: [frame[name].tolist() for frame in frames] for name in frames[0] if name != "task"
    },
}
print(json.dumps(read))
"""


class Dataset:
    """Stands in for LeRobotDataset, with the checks of its add_frame."""

    def __init__(self, features):
        self.features, self.episodes, self.frames, self.finalized = features, [], [], False

    def add_frame(self, frame):
        described = {
            name: ("video" if np.ndim(value) == 3 else str(value.dtype), value.shape)
            for name, value in frame.items()
            if name != "task"
        }
        assert described == {name: (each["dtype"], each["shape"]) for name, each in self.features.items()}
        self.frames.append(frame)

    def save_episode(self):
        self.episodes.append(self.frames)
        self.frames = []

    def finalize(self):
        self.finalized = True


@pytest.fixture
def written(monkeypatch):
    """What the program passes to LeRobot."""
    created = []

    class Writer(Dataset):
        @classmethod
        def create(cls, repo_id, fps, features, root, robot_type):
            created.append((cls(features), fps, root, robot_type))
            return created[-1][0]

    for name in ("lerobot", "lerobot.datasets", "lerobot.datasets.lerobot_dataset"):
        module = ModuleType(name)
        module.__spec__, module.LeRobotDataset = ModuleSpec(name, None), Writer
        monkeypatch.setitem(sys.modules, name, module)
    return created


@pytest.fixture
def program(monkeypatch, capsys):
    def run(*words):
        monkeypatch.setattr(sys, "argv", ["lerobot_dataset.py", *map(str, words)])
        lerobot_dataset.main()
        return capsys.readouterr().out

    return run


def recording(file, seconds=0.2):
    signals = ("q", "dq", "tau_J", "tau_J_d", "tau_ext_hat_filtered", "dq_d", "ddq_d", "gravity")
    titles = ["time", *(f"{signal}{joint}" for signal in signals for joint in range(1, 8))]
    rows = np.arange(round(1000 * seconds))[:, None] + np.arange(len(titles)) / 100
    rows[:, 0] = 5 + 1e-3 * np.arange(len(rows))
    rows = np.delete(rows, range(41, 44), axis=0)  # states that did not arrive
    np.savetxt(file, rows, delimiter=",", header=",".join(titles), comments="")
    return rows


def play(env, policy, seed):
    """The observations, actions and rewards of an episode."""
    observation, _ = env.reset(seed=seed)
    seen, over = [], False
    while not over:
        action = policy(observation)
        after, reward, terminated, truncated, _ = env.step(action)
        seen.append((observation, action, reward))
        observation, over = after, terminated or truncated
    return seen


def test_a_frame_is_the_observation_before_its_action():
    env = make("Push", max_episode_steps=4, observation="state+pictures", size=(32, 24), robot="fr3")
    env.action_space.seed(1)
    actions = [env.action_space.sample() for _ in range(4)]
    policies = [lambda _, left=left: next(left) for left in (iter(actions), iter(actions))]
    expected = play(env, policies[0], 1)
    frames, success = lerobot_dataset.play(env, policies[1], 1)
    env.close()
    assert len(frames) == len(expected) == 4 and success is False
    for frame, (observation, action, reward) in zip(frames, expected, strict=True):
        assert (frame["observation.state"] == observation["observation"]).all()
        for name in ("achieved_goal", "desired_goal"):
            assert (frame[f"observation.{name}"] == observation[name].astype(np.float32)).all()
        assert (frame["observation.images.picture"] == observation["picture"]).all()
        assert (frame["action"] == action).all() and frame["next.reward"] == np.float32(reward)
        assert not frame["next.success"]
    assert [bool(frame["next.done"][0]) for frame in frames] == [False, False, False, True]


def test_failed_episodes_are_left_out(written, program, tmp_path, monkeypatch):
    policies = iter([pyfranka.gym.scripted_policy, lambda env: lambda observation: np.zeros(6)])
    monkeypatch.setattr(pyfranka.gym, "scripted_policy", lambda env: next(policies)(env))
    words = ("--environment", "pyfranka/Reach-v0", "--robot", "fr3", "--task", "reach", "--episodes", 2)
    printed = program(*words, "--output", tmp_path / "set")
    ((dataset, fps, root, robot),) = written
    assert (fps, root, robot, dataset.finalized) == (20, tmp_path / "set", "fr3", True)
    assert printed.startswith(f"1 episodes with {len(dataset.episodes[0])} frames in ")
    assert [bool(frame["next.success"][0]) for frame in dataset.episodes[0]][-2:] == [False, True]
    assert {frame["task"] for frame in dataset.episodes[0]} == {"reach"}
    names = dataset.features["observation.state"]["names"]
    assert names[0] == "fr3.q.0" and (len(names),) == dataset.features["observation.state"]["shape"]


def test_recordings_of_franka_info_become_episodes(written, program, tmp_path):
    files = [tmp_path / "one.csv", tmp_path / "two.csv"]
    rows = [recording(file) for file in files]
    program(*files, "--output", tmp_path / "set", "--task", "wave", "--robot", "fr3")
    ((dataset, fps, _, robot),) = written
    assert (fps, robot, [len(frames) for frames in dataset.episodes]) == (50, "fr3", [10, 10])
    ticks = np.array([0, 20, 40, 60, 80, 100, 120, 140, 160, 180])
    state = np.stack([frame["observation.state"] for frame in dataset.episodes[1]])
    assert state[:, 0] == pytest.approx(ticks + 0.01) and state.shape == (10, 14)
    action = np.stack([frame["action"] for frame in dataset.episodes[1]])
    assert (action == rows[1][ticks - 3 * (ticks > 40)][:, 36:43].astype(np.float32)).all()
    assert dataset.features["action"]["names"][0] == "dq_d1"


def test_a_recording_of_a_robot_becomes_an_episode(tmp_path, franka_sim):
    file = tmp_path / "recording.csv"
    command = ["franka_info", "record", franka_sim("fr3").robot.address, file, "10", "--move"]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    frames = lerobot_dataset.recorded(file, 50)
    table = np.genfromtxt(file, delimiter=",", names=True)[::4]  # at 200 Hz
    for name, titles in lerobot_dataset.COLUMNS.items():
        expected = np.stack([table[title] for title in titles], axis=1).astype(np.float32)
        values = np.stack([frame[name] for frame in frames])
        assert (np.ptp(expected, axis=0) > 1e-3).all() and (values == expected).all(), name


def backwards(file):
    lines = file.read_text().splitlines()
    file.write_text("\n".join([lines[0], *lines[:0:-1]]))


SPOILED = {
    "two.csv is not of franka_info record: dq1 is missing": lambda file: file.write_text("time,a\n1,2\n"),
    "'utf-8' codec": lambda file: file.write_bytes(bytes(range(256))),
    "two.csv must have finite": lambda file: file.write_text(file.read_text().rpartition(",")[0] + ",nan\n"),
    "whose time does not decrease": backwards,
    "No such file or directory": Path.unlink,
}


@pytest.mark.parametrize("sentence", SPOILED)
def test_all_recordings_become_episodes_or_none(sentence, written, program, tmp_path, capsys):
    files = [tmp_path / "one.csv", tmp_path / "two.csv"]
    for file in files:
        recording(file)
    SPOILED[sentence](files[1])
    with pytest.raises(SystemExit) as ended:
        program(*files, "--output", tmp_path / "set")
    assert ended.value.code == 1 and sentence in capsys.readouterr().err
    assert not written


def test_a_folder_that_exists_is_refused(written, program, tmp_path, capsys):
    with pytest.raises(SystemExit):
        program(tmp_path / "one.csv", "--output", tmp_path)
    assert "exists already; name another folder" in capsys.readouterr().err and not written


def test_without_lerobot_there_is_a_sentence(program, capsys, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(SystemExit):
        program()
    assert "needs the Python package lerobot" in capsys.readouterr().err


@pytest.fixture(scope="module")
def lerobot_python():
    """The interpreter of an environment with lerobot and what it imports, and Debian's NumPy. It is kept."""
    folder = TOP / "out" / "lerobot"
    python, stamp, packages = folder / "bin" / "python", folder / "installed", " ".join([LEROBOT, *IMPORTED])
    if not (stamp.exists() and stamp.read_text() == packages):
        command = ["/usr/bin/python3", "-m", "venv", "--clear", "--system-site-packages", folder]
        subprocess.run(command, check=True, timeout=300)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        for words in (IMPORTED, ["--no-deps", LEROBOT]):
            result = subprocess.run([*pip, *words], capture_output=True, text=True, timeout=3000)
            assert result.returncode == 0, result.stderr
        stamp.write_text(packages)
    return python


@pytest.fixture
def lerobot(lerobot_python, tmp_path, monkeypatch):
    """Runs the program with genuine LeRobot, without a network; returns what LeRobot reads then."""
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    monkeypatch.setenv("HF_HOME", str(tmp_path / "hub"))
    folder = tmp_path / "set"

    def run(*words, **options):
        for command in (
            [lerobot_python, PROGRAM, *words, "--output", folder],
            [lerobot_python, "-c", READER, folder, json.dumps(options)],
        ):
            ran = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=500)
            assert ran.returncode == 0, ran.stderr[-3000:]
        return json.loads(ran.stdout.splitlines()[-1])

    return run


@pytest.mark.long_form("lerobot brings torch")
def test_lerobot_reads_episodes_of_an_environment(lerobot):
    words = (
        "--environment",
        "pyfranka/Push-v0",
        "--pictures",
        "--robot",
        "fr3",
        "--task",
        "push",
        "--episodes",
    )
    read = lerobot(*words, 2, delta_timestamps={"action": [0.0, 1 / 20]})
    env = make("Push", robot="fr3", observation="state+pictures")
    steps = [play(env, pyfranka.gym.scripted_policy(env), seed) for seed in range(2)]
    env.close()
    expected = {"format": "3.0", "fps": 20, "robot": "fr3", "episodes": 2}
    assert {name: read[name] for name in expected} == expected
    assert read["names"]["observation.state"][0] == "fr3.q.0" and set(read["tasks"]) == {"push"}
    found = {name: np.array(each) for name, each in read["values"].items()}
    seen = [each for episode in steps for each in episode]
    assert found["observation.state"] == pytest.approx(np.stack([o["observation"] for o, *_ in seen]))
    following = [a for episode in steps for _, a, _ in (*episode[1:], episode[-1])]  # the last is repeated
    assert found["action"] == pytest.approx(np.stack([[a for _, a, _ in seen], following], axis=1))
    assert found["index"].tolist() == list(range(len(seen)))
    ends = [i + 1 == len(episode) for episode in steps for i in range(len(episode))]
    assert found["next.done"].tolist() == found["next.success"].tolist() == ends
    pictures = np.stack([o["picture"] for o, *_ in seen]).transpose(0, 3, 1, 2) / 255
    decoded = found["observation.images.picture"]
    assert decoded.shape == pictures.shape
    assert np.abs(decoded - pictures).mean(axis=(1, 2, 3)).max() < 0.03  # lossy
    assert read["batch"]["observation.state"] == [3, 33]


@pytest.mark.long_form("lerobot brings torch")
def test_lerobot_reads_recordings(lerobot, tmp_path):
    rows = recording(tmp_path / "one.csv")
    read = lerobot(tmp_path / "one.csv", "--task", "wave")
    assert (read["format"], read["episodes"], read["tasks"]) == ("3.0", 1, ["wave"] * 10)
    assert read["names"]["action"] == [f"dq_d{joint}" for joint in range(1, 8)]
    assert read["values"]["observation.state"][0] == pytest.approx(rows[0, 1:15])
