# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Episodes as a data set of LeRobot (format v2.1), for imitation learning.

    from pyfranka.lerobot import Dataset

    with Dataset("demonstrations", fps=20, robot_type="panda") as dataset:
        for q, action in ((joints, command) for joints, command in steps):
            dataset.add_frame({"observation.state": q, "action": action})
        dataset.save_episode("carry the stone")

pyfranka.gym.RecordEpisodes writes what an environment does. `python3 -m pyfranka.lerobot FOLDER run.csv`
converts recordings of `franka_info record`. Needs pyarrow, and for pictures the program ffmpeg.
"""

from __future__ import annotations

import contextlib
import csv
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy
from numpy.typing import NDArray

from pyfranka.command_line import Parser, missing_package
from pyfranka.sim.arguments import items, mapping, path, text, whole

__all__ = ["Dataset", "convert_recording", "main"]

Values = NDArray[Any]
VERSION = "v2.1"
CHUNK = 1000  # episodes in a folder
DATA = "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet"
VIDEO = "videos/chunk-{episode_chunk:03d}/{video_key}/episode_{episode_index:06d}.mp4"
DTYPES = {"f": numpy.float32, "i": numpy.int64, "u": numpy.int64, "b": numpy.bool_}  # by numpy's kinds
OWN = ("timestamp", "frame_index", "episode_index", "index", "task_index")
RECORDED = {  # features of a recording of franka_info, from its columns of seven joints each
    "observation.state": ("q", "dq"),
    "observation.effort": ("tau_J",),
    "observation.external_torque": ("tau_ext_hat_filtered",),
    "action": ("dq_d",),
}
RECORDED_NAMES = {
    name: [f"{s}{j}" for s in signals for j in range(1, 8)] for name, signals in RECORDED.items()
}


def _pyarrow() -> Any:
    try:
        import pyarrow
        import pyarrow.parquet
    except ModuleNotFoundError:
        raise missing_package("A data set of LeRobot", "pyarrow", "lerobot") from None
    return pyarrow


def _ffmpeg() -> str:
    try:
        import imageio_ffmpeg
    except ModuleNotFoundError:
        program = shutil.which("ffmpeg")
    else:
        program = imageio_ffmpeg.get_ffmpeg_exe()
    if program is None:
        raise RuntimeError(
            "Pictures need the program ffmpeg: apt-get install ffmpeg, or pip install imageio-ffmpeg, which "
            "is in the wheel's extra lerobot."
        )
    return program


class _Video:
    """Pictures of an episode on their way into a file."""

    def __init__(self, file: Path, shape: tuple[int, ...], fps: int):
        height, width, _ = shape
        self.file, self._count, self._sum, self._squares = file, 0, numpy.zeros(3), numpy.zeros(3)
        self._low, self._high = numpy.full(3, 255.0), numpy.zeros(3)
        file.parent.mkdir(parents=True, exist_ok=True)
        source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(fps), "-i", "-"]
        # Short distances between whole pictures: learning programs read single ones.
        target = ["-an", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-g", "2", "-crf", "20", str(file)]
        self._process = subprocess.Popen(
            [_ffmpeg(), "-loglevel", "error", "-y", *source, *target],
            stdin=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    def add(self, picture: Values) -> None:
        values = picture.reshape(-1, 3).astype(float)
        self._count += 1
        self._sum += values.mean(axis=0)
        self._squares += (values**2).mean(axis=0)
        self._low = numpy.minimum(self._low, values.min(axis=0))
        self._high = numpy.maximum(self._high, values.max(axis=0))
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(picture.tobytes())
        except BrokenPipeError:
            self.close()
            raise

    def close(self) -> None:
        """Completes the file. Raises RuntimeError with what ffmpeg says."""
        _, error = self._process.communicate()
        if self._process.returncode != 0:
            raise RuntimeError(f"ffmpeg cannot write {self.file}: {error.decode(errors='replace').strip()}")

    def discard(self) -> None:
        self._process.kill()
        self._process.communicate()
        self.file.unlink(missing_ok=True)

    def statistics(self) -> dict[str, Any]:
        """Of each color, in [0, 1], as LeRobot expects them: 3 x 1 x 1."""
        mean = self._sum / self._count
        deviation = numpy.sqrt(numpy.maximum(self._squares / self._count - mean**2, 0.0))
        values = {"min": self._low, "max": self._high, "mean": mean, "std": deviation}
        shaped = {name: (value / 255.0).reshape(3, 1, 1).tolist() for name, value in values.items()}
        return {**shaped, "count": [self._count]}


def _statistics(values: Values) -> dict[str, Any]:
    """Of a feature in an episode: frames x size."""
    rows = values.astype(float)
    result = {name: getattr(rows, name)(axis=0).tolist() for name in ("min", "max", "mean", "std")}
    return {**result, "count": [len(rows)]}


def _feature_name(name: Any) -> str:
    """A name that LeRobot takes, and that is a folder's of videos."""
    if (
        not text(name, "The name of a feature")
        or not name.isprintable()
        or "/" in name
        or name in (".", "..")
    ):
        raise ValueError(
            f"The name of a feature is a text such as observation.state, without '/', not {name!r}."
        )
    return str(name)


def _checked_names(names: Any) -> dict[str, list[str]]:
    return {
        feature: [
            text(name, f"A name of '{feature}'") for name in items(each, f"The names of '{feature}'", "texts")
        ]
        for feature, each in mapping(names, "names", "lists of texts").items()
    }


class Dataset:
    """Writes episodes, frame by frame, into a new folder. The first frame says what features there are.

    folder: does not exist yet, or is empty. fps: frames a second. robot_type: such as panda. names: of the
    numbers of features, by the features' names.

    Raises ValueError, TypeError, FileExistsError or RuntimeError with a sentence. Called by one thread.

    >>> dataset = pyfranka.lerobot.Dataset(folder / "data", fps=20)
    >>> dataset.add_frame({"observation.state": numpy.zeros(7), "action": numpy.zeros(7)})
    >>> dataset.save_episode("Hold still.")
    """

    def __init__(
        self,
        folder: str | os.PathLike[str],
        fps: int,
        robot_type: str = "",
        names: Mapping[str, Sequence[str]] | None = None,
    ):
        self.folder = Path(path(folder, "folder"))
        self.fps, self._robot = whole(fps, "fps", 1, 1000), text(robot_type, "robot_type")
        self._arrow = _pyarrow()
        self._names = _checked_names(names)
        if self.folder.exists() and (not self.folder.is_dir() or any(self.folder.iterdir())):
            raise FileExistsError(f"There is something in {self.folder} already; name another folder.")
        (self.folder / "meta").mkdir(parents=True, exist_ok=True)
        self._features: dict[str, dict[str, Any]] = {}
        self._tasks: list[str] = []
        self.episodes, self.frames = 0, 0  # that are saved
        self._begin()

    def __repr__(self) -> str:
        return f"<Dataset {str(self.folder)!r}: {self.episodes} episodes>"

    def __enter__(self) -> Dataset:
        return self

    def __exit__(self, *error: object) -> None:
        self.discard_episode()

    def _begin(self) -> None:
        self._rows: list[dict[str, Values]] = []
        self._videos: dict[str, _Video] = {}

    def _is_video(self, name: str) -> bool:
        return bool(self._features[name]["dtype"] == "video")

    def add_frame(self, frame: Mapping[str, Any]) -> None:
        """Adds what belongs to one moment: finite numbers, vectors of such, and pictures (height x width x 3,
        uint8), by the names of features such as observation.state, observation.images.wrist and action.

        >>> dataset = pyfranka.lerobot.Dataset(folder / "data", fps=20)
        >>> dataset.add_frame({"observation.state": numpy.zeros(7), "action": numpy.zeros(7)})
        """
        if not isinstance(frame, Mapping) or not (frame or self._features):
            raise TypeError(f"A frame is a dict of values by the names of features, not {frame!r}.")
        values = {_feature_name(name): self._checked(name, value) for name, value in frame.items()}
        if not self._features:
            self._features = {name: self._feature(name, value) for name, value in values.items()}
        for name in sorted({*values, *self._features}):
            have = values.get(name)
            expected = self._features.get(name, {}).get("shape")
            if have is None or expected is None or list(have.shape) != expected:
                raise ValueError(
                    f"All frames have the features of the first one; '{name}' has the shape {expected} there "
                    f"and {None if have is None else list(have.shape)} here."
                )
            if not self._is_video(name):
                values[name] = self._as_in_first_frame(name, have)
        for name in values:
            if self._is_video(name):
                if name not in self._videos:
                    file = self.folder / self._path(VIDEO, video_key=name)
                    self._videos[name] = _Video(file, values[name].shape, self.fps)
                self._videos[name].add(values[name])
        self._rows.append({name: value for name, value in values.items() if not self._is_video(name)})

    def _as_in_first_frame(self, name: str, have: Values) -> Values:
        dtype = numpy.dtype(self._features[name]["dtype"])
        if dtype.kind != have.dtype.kind and (dtype.kind, have.dtype.kind) != ("f", "i"):
            raise ValueError(
                f"All frames have the types of the first one; '{name}' has {dtype} there and {have.dtype} "
                "here."
            )
        return have.astype(dtype)

    def _checked(self, name: str, value: Any) -> Values:
        try:
            values = numpy.asarray(value)
        except ValueError:  # rows of different lengths
            values = numpy.asarray(None)
        if values.ndim == 3 and values.dtype == numpy.uint8 and values.shape[2] == 3:
            if values.shape[0] % 2 or values.shape[1] % 2:
                raise ValueError(
                    f"Width and height of a video are even; '{name}' has the shape {values.shape}."
                )
            return values
        if name in OWN or values.dtype.kind not in DTYPES or values.ndim > 1 or not values.size:
            raise ValueError(
                f"A frame has numbers, vectors and pictures (height x width x 3, uint8) by names other than "
                f"{', '.join(OWN)}; '{name}' has the shape {values.shape} and the type {values.dtype}."
            )
        with numpy.errstate(over="ignore"):
            result: Values = numpy.atleast_1d(values).astype(DTYPES[values.dtype.kind])
        # Statistics of other numbers would be useless.
        if not numpy.isfinite(result).all() or (values.dtype.kind == "u" and (result < 0).any()):
            raise ValueError(f"'{name}' must be finite numbers within {result.dtype}, not {value!r}.")
        return result

    def _feature(self, name: str, value: Values) -> dict[str, Any]:
        if value.ndim == 1:
            names = self._names.get(name) or None
            if names is not None and len(names) != len(value):
                raise ValueError(f"'{name}' has {len(value)} numbers and {len(names)} names.")
            return {"dtype": value.dtype.name, "shape": list(value.shape), "names": names}
        height, width, channels = value.shape
        video: dict[str, Any] = {
            "video.height": height,
            "video.width": width,
            "video.channels": channels,
            "video.fps": self.fps,
        }
        video |= {"video.codec": "h264", "video.pix_fmt": "yuv420p", "video.is_depth_map": False}
        names = ["height", "width", "channels"]
        return {
            "dtype": "video",
            "shape": list(value.shape),
            "names": names,
            "info": {**video, "has_audio": False},
        }

    def _path(self, pattern: str, **more: str) -> str:
        return pattern.format(episode_chunk=self.episodes // CHUNK, episode_index=self.episodes, **more)

    def discard_episode(self) -> None:
        """Forgets the frames since the last episode that was saved.

        >>> dataset = pyfranka.lerobot.Dataset(folder / "data", fps=20)
        >>> dataset.add_frame({"observation.state": numpy.zeros(7), "action": numpy.zeros(7)})
        >>> dataset.discard_episode()
        """
        for video in self._videos.values():
            video.discard()
        self._begin()

    def save_episode(self, task: str) -> None:
        """Writes the frames since the last one as an episode. task: what is to be done, in words.

        >>> dataset = pyfranka.lerobot.Dataset(folder / "data", fps=20)
        >>> dataset.add_frame({"observation.state": numpy.zeros(7), "action": numpy.zeros(7)})
        >>> dataset.save_episode("Hold still.")
        """
        text(task, "task")
        if not self._rows:
            raise ValueError("The episode has no frames; call add_frame() first.")
        for video in self._videos.values():
            video.close()
        number = self._tasks.index(task) if task in self._tasks else len(self._tasks)
        count = len(self._rows)
        columns = {name: numpy.stack([row[name] for row in self._rows]) for name in self._rows[0]}
        frame = numpy.arange(count)
        moments, episode = (frame / self.fps).astype(numpy.float32), numpy.full(count, self.episodes)
        own: list[Values] = [moments, frame, episode, frame + self.frames, numpy.full(count, number)]
        columns |= {name: values.reshape(-1, 1) for name, values in zip(OWN, own, strict=True)}
        self._write_table(self.folder / self._path(DATA), columns)
        statistics = {name: _statistics(values) for name, values in columns.items()}
        statistics |= {name: video.statistics() for name, video in self._videos.items()}
        if number == len(self._tasks):
            self._tasks.append(task)
            self._append("tasks", {"task_index": number, "task": task})
        self._append("episodes", {"episode_index": self.episodes, "tasks": [task], "length": count})
        self._append("episodes_stats", {"episode_index": self.episodes, "stats": statistics})
        self.episodes, self.frames = self.episodes + 1, self.frames + count
        self._write_info(columns)
        self._begin()

    def _write_table(self, file: Path, columns: Mapping[str, Values]) -> None:
        """One number of a frame is a column of numbers, several are one of lists."""
        arrow, arrays = self._arrow, {}
        for name, values in columns.items():
            flat = arrow.array(values.ravel())
            lists = arrow.FixedSizeListArray.from_arrays
            arrays[name] = flat if values.shape[1] == 1 else lists(flat, values.shape[1])
        file.parent.mkdir(parents=True, exist_ok=True)
        arrow.parquet.write_table(arrow.table(arrays), file)

    def _append(self, name: str, line: Mapping[str, Any]) -> None:
        with open(self.folder / "meta" / f"{name}.jsonl", "a", encoding="utf-8") as file:
            file.write(json.dumps(line, ensure_ascii=False) + "\n")

    def _write_info(self, columns: Mapping[str, Values]) -> None:
        own = {name: {"dtype": columns[name].dtype.name, "shape": [1], "names": None} for name in OWN}
        videos = [name for name in self._features if self._is_video(name)]
        info = {
            "codebase_version": VERSION,
            "robot_type": self._robot,
            "total_episodes": self.episodes,
            "total_frames": self.frames,
            "total_tasks": len(self._tasks),
            "total_videos": self.episodes * len(videos),
            "total_chunks": -(-self.episodes // CHUNK),
            "chunks_size": CHUNK,
            "fps": self.fps,
            "splits": {"train": f"0:{self.episodes}"},
            "data_path": DATA,
            "video_path": VIDEO if videos else None,
            "features": {**self._features, **own},
        }
        file = self.folder / "meta" / "info.json"
        partial = file.with_suffix(".part")
        partial.write_text(json.dumps(info, indent=4) + "\n", encoding="utf-8")
        partial.replace(file)


def _read_recording(recording: str | os.PathLike[str], fps: int) -> dict[str, Values]:
    """The features of a recording, frames x size each, as convert_recording() says. Raises what it raises."""
    file = Path(path(recording, "recording"))
    try:
        with open(file, newline="", encoding="utf-8") as stream:
            titles, *rows = [*csv.reader(stream)] or [[]]
    except (csv.Error, UnicodeDecodeError) as error:
        raise ValueError(f"{file} is not a recording of franka_info record: {error}.") from None
    missing = {"time", *(title for titles in RECORDED_NAMES.values() for title in titles)} - set(titles)
    if missing or not rows:
        raise ValueError(
            f"{file} is not a recording of franka_info record: it has no {min(missing, default='rows')}."
        )
    try:
        values = numpy.array(rows, dtype=float)
    except ValueError:
        values = numpy.empty(0)
    if values.shape != (len(rows), len(titles)) or not numpy.isfinite(values).all():
        raise ValueError(f"Each row of {file} must be {len(titles)} finite numbers.")
    at = {title: number for number, title in enumerate(titles)}
    time = values[:, at["time"]] - values[0, at["time"]]
    if (numpy.diff(time) < 0.0).any():
        raise ValueError(f"The time of each row of {file} must not be less than that of the row before.")
    moments = numpy.arange(int(time[-1] * fps + 1e-6) + 1) / fps
    samples = values[numpy.searchsorted(time, moments + 1e-6, side="right") - 1]
    return {name: samples[:, [at[title] for title in names]] for name, names in RECORDED_NAMES.items()}


def _add_recording(dataset: Dataset, features: Mapping[str, Values], task: str) -> None:
    dataset._names |= RECORDED_NAMES
    for rows in zip(*features.values(), strict=True):
        dataset.add_frame(dict(zip(features, rows, strict=True)))
    dataset.save_episode(task)


def convert_recording(dataset: Dataset, recording: str | os.PathLike[str], task: str) -> None:
    """Adds a recording of `franka_info record` (200 Hz, CSV) as an episode; of each frame's moment the last
    sample counts. Raises ValueError for another file, OSError."""
    _add_recording(dataset, _read_recording(recording, dataset.fps), task)


@contextlib.contextmanager
def _restored_on_failure(folder: Path) -> Iterator[None]:
    """If the block fails, removes what it has put into a folder, and the folder if the block has made it."""
    missing = [each for each in (folder, *folder.parents) if not each.exists()]
    before = set() if missing else {*folder.iterdir()}
    try:
        yield
    except BaseException:
        for added in {*folder.iterdir()} - before if folder.is_dir() else ():
            shutil.rmtree(added, ignore_errors=True)
        with contextlib.suppress(OSError):
            for each in missing:
                each.rmdir()
        raise


def main(arguments: Sequence[str] | None = None) -> int:
    """The program. Returns 0; 1 and no data set if a file cannot be converted; 2 for a wrong call."""
    parser = Parser(
        prog="python3 -m pyfranka.lerobot",
        description="Writes recordings of franka_info record as episodes of a data set of LeRobot.",
    )
    parser.add_argument("folder", help="of the data set; a new one")
    parser.add_argument("recordings", nargs="+", metavar="RECORDING.csv", help="an episode each")
    parser.add_argument("--fps", type=int, default=50, help="frames a second (50)")
    parser.add_argument("--task", default="move the arm", help="what the robot does, in words")
    parser.add_argument("--robot", default="panda", help="kind of the robot (panda)")
    words = parser.parse_args(arguments)
    try:
        folder = Path(path(words.folder, "folder"))
        with _restored_on_failure(folder), Dataset(folder, words.fps, words.robot) as dataset:
            # All are read before the first one is written.
            for features in [_read_recording(recording, dataset.fps) for recording in words.recordings]:
                _add_recording(dataset, features, words.task)
    except (OSError, ValueError, ImportError) as error:
        print(f"pyfranka.lerobot: {error}", file=sys.stderr)
        return 1
    print(f"{dataset.episodes} episodes with {dataset.frames} frames in {dataset.folder}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
