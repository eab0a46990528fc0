# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.lerobot and pyfranka.gym.RecordEpisodes: episodes as a data set of LeRobot, read back."""

import errno
import json
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import gymnasium
import numpy as np
import page_output
import pyarrow.parquet
import pyfranka.gym
import pytest
from pyfranka.lerobot import Dataset, convert_recording, main

# A stand-in for ffmpeg: keeps what it is given, and its arguments beside it.
FFMPEG = """#!{python}
import sys
from pathlib import Path
file = Path(sys.argv[-1])
file.write_bytes(sys.stdin.buffer.read())
file.with_suffix(".txt").write_text(" ".join(sys.argv))
"""
TOP = Path(__file__).resolve().parents[2]
# The last version that reads format v2.1, without its many dependencies that a reader does not import.
LEROBOT = ["lerobot==0.3.3", "torchvision==0.22.1"]
IMPORTED = [
    "torch==2.13.0",
    "av==15.1.0",
    "datasets==3.6.0",
    "huggingface-hub==0.36.0",
    "imageio-ffmpeg==0.6.0",
    "jsonlines==4.0.0",
    "numpy==2.3.5",
    "pillow==13.0.0",
]
READER = """
import json, sys
import torch
# Only the operator's name: torchvision's binary is of another torch, and is not needed here.
library = torch.library.Library("torchvision", "FRAGMENT")
library.define("nms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor")
from lerobot.datasets.lerobot_dataset import LeRobotDataset

options = {"root": sys.argv[1], "video_backend": "pyav", **json.loads(sys.argv[2])}
data = LeRobotDataset("someone/set", **options)
frames = [data[i] for i in range(len(data))]
read = {
    "format": str(data.meta._version),
    "fps": data.fps,
    "robot": data.meta.robot_type,
    "episodes": data.num_episodes,
    "frames": data.num_frames,
    "ends": data.episode_data_index["to"].tolist(),
    "features": {name: list(each["shape"]) for name, each in data.features.items()},
    "names": data.meta.names,
    "tasks": [frame["task"] for frame in frames],
    "mean": {name: each["mean"].tolist() for name, each in data.meta.stats.items()},
    "values": {
        name: [frame[name].tolist() for frame in frames]
        for name in frames[0] if name != "task"
    },
    "batch": {
        name: list(value.shape)
        for name, value in next(iter(torch.utils.data.DataLoader(data, batch_size=3))).items()
        if name != "task"
    },
}
print(json.dumps(read))
"""
OWN = {"timestamp": "float", "frame_index": "int64", "episode_index": "int64", "index": "int64"}
OWN["task_index"] = "int64"


@pytest.fixture
def ffmpeg(tmp_path, monkeypatch):
    program = tmp_path / "bin" / "ffmpeg"
    program.parent.mkdir()
    program.write_text(FFMPEG.format(python=sys.executable))
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "set"


def lines(folder, name):
    return [json.loads(line) for line in (folder / "meta" / f"{name}.jsonl").read_text().splitlines()]


def info_of(folder):
    return json.loads((folder / "meta" / "info.json").read_text())


def episode(folder, number):
    return pyarrow.parquet.read_table(folder / "data" / "chunk-000" / f"episode_{number:06d}.parquet")


def values(table, name):
    return np.array(table[name].to_pylist())


def play(env, seed, steps=None):
    """The observations, actions and rewards of an episode, or of its first steps."""
    env.action_space.seed(seed)
    observation, _ = env.reset(seed=seed)
    seen, over = [], False
    while not over and len(seen) != steps:
        action = env.action_space.sample()
        after, reward, terminated, truncated, _ = env.step(action)
        seen.append((observation, action, reward))
        observation, over = after, terminated or truncated
    return seen


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"env": 5}, "Expected env to be a `gymnasium.Env`"),
        ({"folder": 5}, "folder must be the name of a file, not 5."),
        ({"task": 5}, "task must be a text, not 5."),
        ({"only_success": "yes"}, "only_success must be True or False, not 'yes'."),
    ],
)
def test_a_recorder_with_wrong_arguments_is_refused_and_writes_nothing(arguments, sentence, folder):
    with pytest.raises(TypeError) as refused:
        pyfranka.gym.RecordEpisodes(
            **{"env": gymnasium.make("pyfranka/Reach-v0"), "folder": folder, **arguments}
        )
    assert sentence in str(refused.value)
    assert not folder.exists()


def test_episodes_of_an_environment_are_read_back(folder, ffmpeg):
    options = {"observation": "state+pictures", "size": (32, 24), "frequency": 25, "robot": "fr3"}
    inner = gymnasium.make("pyfranka/Push-v0", max_episode_steps=4, **options)
    env = pyfranka.gym.RecordEpisodes(inner, folder, "push the cube")
    played = [play(env, 1), play(env, 2)]
    play(env, 3, steps=2)  # does not end
    env.close()

    info = info_of(folder)
    assert (info["codebase_version"], info["robot_type"], info["fps"]) == ("v2.1", "fr3", 25)
    totals = {name: info[f"total_{name}"] for name in ("episodes", "frames", "tasks", "videos", "chunks")}
    assert totals == {"episodes": 2, "frames": 8, "tasks": 1, "videos": 2, "chunks": 1}
    assert info["splits"] == {"train": "0:2"}
    assert lines(folder, "tasks") == [{"task_index": 0, "task": "push the cube"}]
    expected = [{"episode_index": i, "tasks": ["push the cube"], "length": 4} for i in (0, 1)]
    assert lines(folder, "episodes") == expected
    state = info["features"]["observation.state"]
    assert state["shape"] == [33] and state["names"][0] == "fr3.q.0" and len(state["names"]) == 33

    for number, steps in enumerate(played):
        table = episode(folder, number)
        assert {name: str(table.schema.field(name).type) for name in OWN} == OWN
        assert values(table, "timestamp") == pytest.approx(np.arange(4) / 25)
        assert values(table, "frame_index").tolist() == [0, 1, 2, 3]
        assert values(table, "episode_index").tolist() == [number] * 4
        assert values(table, "index").tolist() == list(range(4 * number, 4 * number + 4))
        assert values(table, "task_index").tolist() == [0] * 4
        assert values(table, "next.done").tolist() == [False, False, False, True]
        assert values(table, "next.reward").tolist() == [reward for *_, reward in steps]
        assert (values(table, "action") == [action for _, action, _ in steps]).all()
        for name in ("observation", "achieved_goal", "desired_goal"):
            column = "observation.state" if name == "observation" else f"observation.{name}"
            assert (values(table, column) == [seen[name] for seen, *_ in steps]).all()
            assert table.schema.field(column).type.list_size == info["features"][column]["shape"][0]
        path = info["video_path"].format(
            episode_chunk=0, video_key="observation.images.picture", episode_index=number
        )
        pictures = np.stack([seen["picture"] for seen, *_ in steps])
        assert (folder / path).read_bytes() == pictures.tobytes()
        assert "-s 32x24 -r 25 " in (folder / path).with_suffix(".txt").read_text()
        stats = lines(folder, "episodes_stats")[number]["stats"]
        assert stats.keys() == info["features"].keys()
        assert stats["action"]["mean"] == pytest.approx(np.mean([action for _, action, _ in steps], axis=0))
        colors = pictures.reshape(-1, 3) / 255
        for name in ("min", "max", "mean", "std"):
            measured = np.array(stats["observation.images.picture"][name])
            assert measured.shape == (3, 1, 1)
            assert measured.ravel() == pytest.approx(getattr(colors, name)(axis=0)), name
    names = {file.name for file in folder.rglob("*.mp4")}
    assert names == {"episode_000000.mp4", "episode_000001.mp4"}, "none of the episode that did not end"


def test_the_examples_of_the_documentation_run(folder, monkeypatch, capsys):
    monkeypatch.chdir(folder.parent)
    for example in page_output.examples("gym.md"):
        example.run()
        example.check(capsys.readouterr().out)
    assert info_of(folder.parent / "demonstrations")["total_episodes"] == 2


def test_any_environment_can_be_recorded(folder):
    env = pyfranka.gym.RecordEpisodes(gymnasium.make("CartPole-v1"), folder)
    seen = play(env, 1)
    env.close()
    info, table = info_of(folder), episode(folder, 0)
    assert (info["fps"], info["video_path"], info["features"]["action"]["dtype"]) == (50, None, "int64")
    assert (values(table, "observation.state") == [observation for observation, *_ in seen]).all()
    assert values(table, "action").tolist() == [action for _, action, _ in seen]
    assert lines(folder, "tasks")[0]["task"] == "CartPole-v1"


def test_failed_episodes_can_be_left_out(folder):
    env = gymnasium.make("pyfranka/Reach-v0")
    env = pyfranka.gym.RecordEpisodes(env, folder, only_success=True)
    play(env, 1)
    observation, _ = env.reset(seed=2)
    policy, over, steps = pyfranka.gym.scripted_policy(env), False, 0
    while not over:
        observation, _, over, _, _ = env.step(policy(observation))
        steps += 1
    env.close()
    assert [line["length"] for line in lines(folder, "episodes")] == [steps]
    assert values(episode(folder, 0), "next.success").tolist() == [False] * (steps - 1) + [True]


@pytest.mark.parametrize("only_success", [False, True])
def test_automatic_resets_are_no_frames(only_success, folder):
    env = gymnasium.wrappers.Autoreset(gymnasium.make("pyfranka/Reach-v0", time_limit=0.15))
    env = pyfranka.gym.RecordEpisodes(env, folder, only_success=only_success)
    policy = pyfranka.gym.scripted_policy(env)
    observation, _ = env.reset(seed=1, options={"goal": [2, 2, 2]})
    for _ in range(2):  # the first episode fails, the second one begins at its goal
        for _ in range(3):
            observation, _, terminated, truncated, _ = env.step(policy(observation))
            if terminated:
                break
        goal = observation["achieved_goal"]
        env.unwrapped.episode.task.draw_goal = lambda random, body, goal=goal: goal
        if not terminated:
            observation, *_ = env.step(policy(observation))
    env.close()
    assert terminated
    lengths = [line["length"] for line in lines(folder, "episodes")]
    assert lengths == [1] if only_success else [3, 1]
    table = episode(folder, len(lengths) - 1)
    assert values(table, "next.success").tolist() == [True]
    assert values(table, "frame_index").tolist() == [0]


def recording(file, seconds):
    signals = ("q", "dq", "tau_J", "tau_J_d", "tau_ext_hat_filtered", "dq_d", "ddq_d", "gravity")
    titles = ["time", *(f"{signal}{joint}" for signal in signals for joint in range(1, 8))]
    rows = np.arange(round(1000 * seconds))[:, None] + np.arange(len(titles)) / 100
    rows[:, 0] = 5 + 1e-3 * np.arange(len(rows))
    rows = np.delete(rows, range(41, 44), axis=0)  # states that did not arrive
    np.savetxt(file, rows, delimiter=",", header=",".join(titles), comments="")
    return rows


def test_recordings_of_franka_info_become_episodes(folder, tmp_path, capsys):
    files = [tmp_path / "one.csv", tmp_path / "two.csv"]
    rows = [recording(file, 0.2) for file in files]
    arguments = [str(folder), *map(str, files), "--fps", "50", "--task", "wave", "--robot", "fr3"]
    assert main(arguments) == 0
    assert capsys.readouterr().out.startswith("2 episodes with 20 frames in ")
    assert info_of(folder)["robot_type"] == "fr3" and info_of(folder)["fps"] == 50
    table = episode(folder, 1)
    ticks = np.array([0, 20, 40, 60, 80, 100, 120, 140, 160, 180])
    assert values(table, "observation.state")[:, 0] == pytest.approx(ticks + 0.01)
    assert values(table, "observation.state").shape == (10, 14)
    assert (values(table, "action") == rows[1][ticks - 3 * (ticks > 40)][:, 36:43].astype(np.float32)).all()
    assert info_of(folder)["features"]["action"]["names"][0] == "dq_d1"

    assert main(arguments) == 1 and "There is something in" in capsys.readouterr().err
    files[0].write_text("time,a\n1,2\n")
    assert main([str(tmp_path / "other"), str(files[0])]) == 1
    assert "one.csv is not a recording of franka_info record" in capsys.readouterr().err


def test_a_recording_of_a_robot_becomes_an_episode(folder, tmp_path, franka_sim):
    file = tmp_path / "recording.csv"
    command = ["franka_info", "record", franka_sim("fr3").robot.address, file, "10", "--move"]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    with Dataset(folder, 50) as dataset:
        convert_recording(dataset, file, "swing all joints")
    recorded, table = np.genfromtxt(file, delimiter=",", names=True), episode(folder, 0)
    assert np.diff(recorded["time"]) == pytest.approx(0.005)
    frames = recorded[::4]  # at 200 Hz
    assert values(table, "timestamp") == pytest.approx(frames["time"], abs=1e-6)
    features = {
        "observation.state": ("q", "dq"),
        "observation.effort": ("tau_J",),
        "observation.external_torque": ("tau_ext_hat_filtered",),
        "action": ("dq_d",),
    }
    for name, signals in features.items():
        titles = [f"{signal}{joint}" for signal in signals for joint in range(1, 8)]
        assert info_of(folder)["features"][name]["names"] == titles
        expected = np.stack([frames[title] for title in titles], axis=1).astype(np.float32)
        assert (np.ptp(expected, axis=0) > 1e-3).all() and (values(table, name) == expected).all(), name


def another_file(file):
    file.write_text("time,a\n1,2\n")


def binary_file(file):
    file.write_bytes(bytes(range(256)))


def backwards(file):
    lines = file.read_text().splitlines()
    file.write_text("\n".join([lines[0], *lines[:0:-1]]))


def without_number(file):
    file.write_text(file.read_text().rpartition(",")[0] + ",nan\n")


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (another_file, "two.csv is not a recording of franka_info record: it has no dq1."),
        (binary_file, "two.csv is not a recording of franka_info record: 'utf-8' codec"),
        (without_number, "two.csv must be 57 finite numbers."),
        (backwards, "The time of each row of"),
        (Path.unlink, "No such file or directory"),
        (None, "No space left on device"),
    ],
)
def test_all_recordings_become_episodes_or_none(spoil, sentence, tmp_path, capsys, monkeypatch):
    files = [tmp_path / "one.csv", tmp_path / "two.csv"]
    for file in files:
        recording(file, 0.06)
    folder = tmp_path / "data sets" / "set"
    if spoil is not Path.unlink:  # otherwise the folder is made, too
        folder.mkdir(parents=True)
    if spoil:
        spoil(files[1])
    else:
        write = Dataset._write_table

        def fill_disk(self, file, columns):
            write(self, file, columns)
            if self.episodes == 1:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        monkeypatch.setattr(Dataset, "_write_table", fill_disk)
    before = sorted(tmp_path.rglob("*"))
    assert main([str(folder), *map(str, files)]) == 1
    assert sentence in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == before


def with_frames(folder, *frames, fps=20):
    with Dataset(folder, fps) as dataset:
        for frame in frames:
            dataset.add_frame(frame)
        dataset.save_episode("x")


REFUSED = {
    "The episode has no frames": (),
    "fps must be 1 to 1000": ({"action": [1.0]}, 0),
    "'action' has the shape [2] there and [3] here": ({"action": [1, 2]}, {"action": [1, 2, 3]}),
    "'b' has the shape None there and [1] here": ({"a": 1.0}, {"a": 1.0, "b": 1.0}),
    "'a' has the shape [1] there and None here": ({"a": 1.0}, {}),
    "by names other than timestamp": ({"index": 1},),
    "'a' has the shape () and the type <U4": ({"a": "text"},),
    "'a' must be finite numbers within float32, not [nan]": ({"a": [np.nan]},),
    "within float32, not 1e+300": ({"a": 1e300},),
    "within int64, not ": ({"a": np.uint64(2**63)},),
    "'a' has the shape (0,)": ({"a": []},),
    "by names other than timestamp, frame": ({"a": [[1], [1, 2]]},),
    "'a' has int64 there and float32 here": ({"a": 1}, {"a": 1.5}),
    "'a' has float32 there and bool here": ({"a": 1.0}, {"a": True}),
    "without '/', not 'a/b'": ({"a/b": 1.0},),
    "without '/', not '../../a'": ({"../../a": np.zeros((4, 4, 3), dtype=np.uint8)},),
    "without '/', not ''": ({"": 1.0},),
    "must be a text, not 5": ({5: 1.0},),
    "A frame is a dict of values by the names of features, not [1]": ([1],),
    "A frame is a dict of values by the names of features, not {}": ({},),
    "Width and height of a video are even": ({"a": np.zeros((3, 4, 3), dtype=np.uint8)},),
    "Pictures need the program ffmpeg": ({"a": np.zeros((4, 4, 3), dtype=np.uint8)},),
}


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_cannot_be_written_is_refused_with_a_sentence(sentence, folder, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    *frames, last = REFUSED[sentence] or [None]
    frames, fps = ([*frames], last) if last == 0 else ([*frames, last], 20)
    with pytest.raises((ValueError, TypeError, RuntimeError)) as refused:
        with_frames(folder, *[frame for frame in frames if frame is not None], fps=fps)
    assert sentence in str(refused.value)
    assert not list(folder.rglob("*.parquet"))


@pytest.mark.parametrize(
    ("names", "sentence"),
    [
        ({"a": ["x"]}, "'a' has 2 numbers and 1 names"),
        ({"a": "xy"}, "The names of 'a' must be a list of texts, not 'xy'"),
        ({"a": [1, 2]}, "A name of 'a' must be a text, not 1"),
        (5, "names must be a dict of lists of texts, not 5"),
    ],
)
def test_names_that_do_not_fit_are_refused(names, sentence, folder):
    with pytest.raises((ValueError, TypeError)) as refused:
        Dataset(folder, 20, names=names).add_frame({"a": [1.0, 2.0]})
    assert sentence in str(refused.value)


def test_a_refused_frame_leaves_the_others(folder):
    with Dataset(folder, 20) as dataset:
        for value in (1.5, 2, "x", 3.5):
            with suppress(ValueError):
                dataset.add_frame({"a": value})
        dataset.save_episode("x")
    assert values(episode(folder, 0), "a").tolist() == [1.5, 2.0, 3.5]
    assert str(episode(folder, 0).schema.field("a").type) == "float"


def test_a_file_is_refused_as_a_folder(folder):
    folder.write_text("")
    with pytest.raises(FileExistsError, match="name another folder"):
        Dataset(folder, 10)


def test_tasks_are_numbered_and_a_full_folder_is_refused(folder):
    with Dataset(folder, 10) as dataset:
        for task in ("take", "put", "take"):
            dataset.add_frame({"action": np.float64(2.5)})
            dataset.save_episode(task)
    assert [values(episode(folder, i), "task_index")[0] for i in range(3)] == [0, 1, 0]
    assert [line["task"] for line in lines(folder, "tasks")] == ["take", "put"]
    with pytest.raises(FileExistsError, match="name another folder"):
        Dataset(folder, 10)


@pytest.fixture(scope="module")
def lerobot_python():
    """The interpreter of an environment with lerobot and what its reader imports. It is kept."""
    folder = TOP / "out" / "lerobot"
    python, stamp, wanted = folder / "bin" / "python", folder / "installed", " ".join([*LEROBOT, *IMPORTED])
    if not (stamp.exists() and stamp.read_text() == wanted):
        subprocess.run(["/usr/bin/python3", "-m", "venv", "--clear", folder], check=True, timeout=300)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        for words in (IMPORTED, ["--no-deps", *LEROBOT]):
            result = subprocess.run([*pip, *words], capture_output=True, text=True, timeout=3000)
            assert result.returncode == 0, result.stderr
        stamp.write_text(wanted)
    return python


@pytest.fixture
def genuine_ffmpeg(lerobot_python, tmp_path, monkeypatch):
    program = "import imageio_ffmpeg; print(imageio_ffmpeg.get_ffmpeg_exe())"
    file = subprocess.check_output([lerobot_python, "-I", "-c", program], text=True, timeout=60).strip()
    (tmp_path / "ffmpeg").symlink_to(file)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)


def read_by_lerobot(python, folder, **options):
    """What LeRobotDataset finds in a folder, without a network."""
    offline = {"HF_HUB_OFFLINE": "1", "HF_HOME": str(folder.parent / "hub"), "PATH": os.environ["PATH"]}
    command = [python, "-I", "-c", READER, folder, json.dumps(options)]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=300, env=offline)
    assert ran.returncode == 0, ran.stderr[-3000:]
    return json.loads(ran.stdout.splitlines()[-1])


@pytest.mark.long_form("lerobot brings torch")
def test_lerobot_reads_episodes_of_an_environment(lerobot_python, genuine_ffmpeg, folder):
    options = {"observation": "state+pictures", "size": (64, 48), "frequency": 25, "robot": "fr3"}
    inner = gymnasium.make("pyfranka/Push-v0", max_episode_steps=4, **options)
    env = pyfranka.gym.RecordEpisodes(inner, folder, "push the cube")
    steps = [*play(env, 1), *play(env, 2)]
    env.close()

    delta = {"action": [0.0, 1 / 25]}
    read = read_by_lerobot(lerobot_python, folder, delta_timestamps=delta)
    expected = {"format": "2.1", "fps": 25, "robot": "fr3", "episodes": 2, "frames": 8, "ends": [4, 8]}
    assert {name: read[name] for name in expected} == expected
    info = info_of(folder)["features"]
    assert read["features"] == {name: each["shape"] for name, each in info.items()}
    assert read["names"]["observation.state"][0] == "fr3.q.0"
    assert read["tasks"] == ["push the cube"] * 8
    found = {name: np.array(each) for name, each in read["values"].items()}
    actions = np.array([action for _, action, _ in steps])
    following = actions[[1, 2, 3, 3, 5, 6, 7, 7]]  # an episode's last one is repeated
    assert (found["action"] == np.stack([actions, following], axis=1)).all()
    assert found["action_is_pad"].tolist() == [[False, i % 4 == 3] for i in range(8)]
    assert (found["observation.state"] == [seen["observation"] for seen, *_ in steps]).all()
    assert found["next.reward"] == pytest.approx([reward for *_, reward in steps])
    assert found["next.done"].tolist() == [False, False, False, True] * 2
    pictures = np.stack([seen["picture"] for seen, *_ in steps]).transpose(0, 3, 1, 2) / 255
    decoded = found["observation.images.picture"]
    assert decoded.shape == (8, 3, 48, 64)
    assert np.abs(decoded - pictures).mean(axis=(1, 2, 3)).max() < 0.03  # lossy
    colors = np.array(read["mean"]["observation.images.picture"])
    assert colors.ravel() == pytest.approx(pictures.mean(axis=(0, 2, 3)))
    assert read["batch"]["observation.images.picture"] == [3, 3, 48, 64]
    assert read["batch"]["observation.state"] == [3, 33]


@pytest.mark.long_form("lerobot brings torch")
def test_lerobot_reads_recordings_and_numbers(lerobot_python, folder, tmp_path):
    rows = recording(tmp_path / "one.csv", 0.2)
    assert main([str(folder), str(tmp_path / "one.csv"), "--task", "wave"]) == 0
    read = read_by_lerobot(lerobot_python, folder)
    assert (read["episodes"], read["frames"], read["tasks"]) == (1, 10, ["wave"] * 10)
    assert read["names"]["action"] == [f"dq_d{joint}" for joint in range(1, 8)]
    assert read["values"]["observation.state"][0] == pytest.approx(rows[0, 1:15])

    env = pyfranka.gym.RecordEpisodes(gymnasium.make("CartPole-v1"), tmp_path / "cart")
    seen = play(env, 1)
    env.close()
    read = read_by_lerobot(lerobot_python, tmp_path / "cart")
    assert read["values"]["action"] == [action for _, action, _ in seen]
    assert (read["frames"], read["tasks"][0]) == (len(seen), "CartPole-v1")
