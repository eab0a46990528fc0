# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The entry script: its help, its errors, and its environment."""

import os
import re
import shutil
import signal
import subprocess
import time
from contextlib import suppress
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
FRANKA = str(TOP / "franka")
COMMANDS = (
    *("install", "build", "demo", "test", "wheel", "deb", "docs", "bench"),
    *("lock", "clean", "shell", "completion"),
)


def franka(*arguments: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [FRANKA, *arguments],
        env={**os.environ, **environment},
        text=True,
        capture_output=True,
        timeout=120,
        stdin=subprocess.DEVNULL,
    )


def in_script(code: str, **environment: str) -> str:
    """Output of shell code that runs with the script's functions."""
    result = subprocess.run(
        ["bash", "-c", f"source {FRANKA}; {code}"],
        env={**os.environ, **environment},
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


def failing(code: str, *before: str) -> str:
    """The error message of shell code that ends with status 1 when it runs with the script's functions."""
    command = [*before, "bash", "-c", f"source {FRANKA}; {code}; echo went on"]
    result = subprocess.run(command, text=True, capture_output=True, timeout=60)
    assert result.returncode == 1 and "went on" not in result.stdout, result
    return result.stderr


@pytest.fixture
def foreign_python(tmp_path):
    """A folder whose python3 always fails, like a pyenv or conda without rospy."""
    python = tmp_path / "python3"
    python.write_text("#!/bin/sh\necho 'the wrong python3 was run' >&2\nexit 1\n")
    python.chmod(0o755)
    return f"{tmp_path}:{os.environ['PATH']}"


@pytest.mark.parametrize("release", ["bookworm", "trixie"])
def test_packages_depend_on_the_release(release):
    names = in_script(f"debian_release() {{ echo {release}; }}; required_packages").splitlines()
    assert {"catkin", "libmujoco-dev"} <= set(names)
    assert ("python3-nose" in names) == (release == "bookworm")
    assert all(" " not in name and "[" not in name for name in names)


def packages_of(*groups: str) -> set[str]:
    return set(in_script(f"required_packages {' '.join(groups)}").split())


def test_packages_of_tests_come_with_their_group_only():
    tools = {"clang-22", "clang-tidy-22", "chromium", "python3-selenium", "xvfb"}
    running = packages_of()
    assert {"catkin", "rviz", "librostest-dev"} <= running and not running & {*tools, "doxygen"}
    assert packages_of("docs") == running | {"doxygen"}
    assert packages_of("docs", "wheel") == packages_of("docs")
    assert packages_of("test") >= packages_of("docs") | tools


@pytest.mark.parametrize(
    ("command", "groups"),
    [
        ("build", ""),
        ("demo", ""),
        ("shell", ""),
        ("docs", "docs"),
        ("wheel", "wheel"),
        ("deb", "extras"),
        ("bench", "test"),
        ("test", "test"),
        ("test --style", "test"),
    ],
)
def test_a_command_installs_its_groups(tmp_path, command, groups):
    code = f'workspace={tmp_path}; cmd_install() {{ echo "$*"; exit; }}; cmd_{command}'
    assert in_script(code) == f"{groups}\n"


@pytest.mark.parametrize("system", ["ID=ubuntu\nVERSION_CODENAME=noble\nPRETTY_NAME='Ubuntu 24.04'\n", None])
def test_another_system_is_refused(tmp_path, system):
    file = tmp_path / "os-release"
    if system:
        file.write_text(system)
    printed = failing(f"debian_release {file}")
    assert ("Ubuntu 24.04" if system else "unknown") in printed
    assert "Debian 12 (bookworm) and Debian 13 (trixie)" in printed


@pytest.mark.parametrize("name", ["two words", "a:b"])
def test_a_folder_that_ros_cannot_take_is_refused_at_once(tmp_path, name):
    folder = tmp_path / name
    folder.mkdir()
    shutil.copy(FRANKA, folder)
    for command in ("install", "build", "shell"):
        result = subprocess.run([folder / "franka", command], capture_output=True, text=True, timeout=60)
        assert result.returncode == 1
        assert f'"{folder}" has a space or a colon' in result.stderr
    assert [path.name for path in folder.iterdir()] == ["franka"]


@pytest.mark.parametrize("words", [(), ("dance",)])
def test_no_or_another_command_is_refused_with_help(words):
    result = franka(*words)
    assert result.returncode == 2 and "usage:" in result.stderr
    assert all(f'no command "{word}"' in result.stderr for word in words)


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_explains_itself_without_doing_anything(command):
    result = franka(command, "--help")
    assert result.returncode == 0
    assert result.stdout.startswith(f"  {command} ")
    assert "== " not in result.stdout  # a build would print this
    others = set(COMMANDS) - {command, "completion"}
    assert not [other for other in others if f"\n  {other} " in result.stdout]


@pytest.mark.parametrize(
    "arguments",
    [
        ["install", "docs", "rviz"],
        ["build", "franka_hw"],
        ["demo", "--gui", "robot:=ur5"],
        ["demo", "--seed", "-3", "--fast"],
        ["test", "franka_hv"],
        ["bench", "fci", "jitter"],
        ["wheel", "dist"],
        ["shell", "--rviz"],
        ["docs", "html"],
    ],
)
def test_unknown_arguments_are_refused_before_a_build(arguments):
    result = franka(*arguments)
    assert result.returncode == 2
    assert result.stdout == ""
    assert f'unknown argument "{arguments[-1]}" of ./franka {arguments[0]}.' in result.stderr
    assert f"\n  {arguments[0]} " in result.stderr


def test_an_option_without_a_value_is_refused_before_a_build():
    result = franka("demo", "--speed")
    assert result.returncode == 2 and result.stdout == ""
    assert "--speed needs a value" in result.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        "install",
        "install docs test",
        "demo robot:=fr3 --gui --seed -3 --speed=0.5",
        "test --long franka_hw tests",
        "bench fci tick",
    ],
)
def test_known_arguments_are_accepted(arguments):
    assert in_script(f"check_arguments {arguments} && echo taken") == "taken\n"


@pytest.mark.parametrize(
    "command",
    [
        ["python3", "-c", "import rospy, tf2_ros"],
        ["rosrun", "franka_sim_mujoco", "pick_and_place", "--help"],
    ],
)
def test_shell_works_with_any_python_first_in_path(command, foreign_python):
    result = franka("shell", *command, PATH=foreign_python)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "wrong python3" not in result.stderr


def test_programs_are_found_by_their_names():
    result = franka("shell", "franka_sim", "--help")
    assert result.returncode == 0 and "--pace" in result.stdout
    for program in ("franka_info", "pick_and_place", "new_controller", "franka_control_node"):
        assert franka("shell", "bash", "-c", f"command -v {program}").returncode == 0, program


def interactive(commands: str, home: Path) -> str:
    """Output of commands in an interactive `./franka shell`."""
    result = subprocess.run(
        [FRANKA, "shell"],
        env={**os.environ, "HOME": str(home), "TERM": "dumb"},
        input=commands + "\nexit\n",
        text=True,
        capture_output=True,
        timeout=120,
    )
    return result.stdout


def test_a_shell_has_roscd_and_completion(tmp_path):
    (tmp_path / ".bashrc").write_text("export PATH=/usr/bin:/bin\n")  # it overwrites PATH
    printed = interactive(
        "roscd franka_description && pwd; "
        "complete -p roslaunch roscd franka franka_info; "
        "command -v franka_sim",
        tmp_path,
    )
    assert "/franka_description\n" in printed
    for line in (
        "-F _roscomplete_launch roslaunch",
        "_roscomplete_sub_dir roscd",
        "-F _franka franka",
        "-F _franka_program franka_info",
    ):
        assert line in printed, printed
    assert "/devel/bin/franka_sim\n" in printed


OTHER_WORKSPACE = """
export CMAKE_PREFIX_PATH={0}/devel ROS_PACKAGE_PATH={0}/src PATH={0}/devel/bin:$PATH ROS_DISTRO=noetic
export PYTHONPATH={0}/devel/lib/python3/dist-packages PYTHONHOME={0} LD_LIBRARY_PATH={0}/devel/lib
"""
OF_WORKSPACE = (
    "CMAKE_PREFIX_PATH",
    "ROS_PACKAGE_PATH",
    "PATH",
    "PYTHONPATH",
    "PYTHONHOME",
    "LD_LIBRARY_PATH",
)


def test_another_workspace_in_bashrc_does_not_replace_ours(tmp_path):
    (tmp_path / "setup.bash").write_text(OTHER_WORKSPACE.format(tmp_path / "other"))
    (tmp_path / ".bashrc").write_text(f"source {tmp_path}/setup.bash\nexport ROS_MASTER_URI=http://robot:1\n")
    values = " ".join(f'"{name}=${{{name}-}}"' for name in OF_WORKSPACE)
    printed = interactive(
        f"printf '%s\\n' {values}; echo $ROS_MASTER_URI; rospack find franka_description", tmp_path
    )
    assert "/other/" not in printed and f"{TOP}/catkin_ws/src/franka_description\n" in printed
    assert f"CMAKE_PREFIX_PATH={TOP}/catkin_ws/devel" in printed
    assert "http://robot:1\n" in printed  # the user's choice


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (
            "./franka ",
            {*COMMANDS, "--help"},
        ),
        ("./franka be", {"bench"}),
        ("./franka install docs ex", {"extras"}),
        ("./franka test --long franka_gaz", {"franka_gazebo"}),
        ("./franka demo --no-p", {"--no-pictures"}),
        ("./franka demo robot:=f", {"fr3"}),  # for bash a new word starts after :=
    ],
)
def test_its_own_commands_are_completed(line, expected):
    code = f"""
        source <(./franka completion)
        COMP_LINE='{line}' COMP_POINT={len(line)}
        _franka
        printf '%s\\n' "${{COMPREPLY[@]#=}}"
    """
    result = subprocess.run(["bash", "-c", code], cwd=TOP, text=True, capture_output=True, timeout=60)
    assert set(result.stdout.split()) == expected, result.stderr


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("franka_plot ", {"robot", "topic", "bag", "log", "--list", "--help"}),
        ("franka_plot log ", set()),
        ("franka_sim --vi", {"--viewer"}),
        ("franka_info record --mo", {"--move"}),
        ("new_controller --int", {"--interfaces"}),
    ],
)
def test_options_of_programs_are_completed(words, expected):
    code = f"""
        source <({FRANKA} completion)
        COMP_WORDS=({words} ) COMP_CWORD={len(words.split(" ")) - 1}
        complete -p {words.split()[0]} >/dev/null || exit
        _franka_program {words.split()[0]}
        printf '%s\\n' "${{COMPREPLY[@]}}"
    """
    result = franka("shell", "bash", "-c", code)
    assert set(result.stdout.split()) == expected, result.stderr


def test_the_demo_builds_targets_that_exist():
    targets = set(in_script("demo_targets").split())
    listed = subprocess.check_output(
        ["cmake", "--build", TOP / "catkin_ws/build", "--target", "help"], text=True
    )
    assert "franka_sim_mujoco_node" in targets and "franka_msgs_generate_messages_py" in targets
    assert targets <= set(re.findall(r"^(\w+): ", listed, re.M))


@pytest.mark.parametrize(("built", "said"), [("all_built", ""), ("some_built", "builds")])
def test_a_shell_builds_what_the_demo_did_not(built, said, tmp_path):
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / built).touch()
    stubs = "cmd_build() { echo builds; }; end_alone() { :; }; ros_environment() { :; }"
    assert in_script(f"workspace={tmp_path}; {stubs}; cmd_shell true").strip() == said


def test_shell_keeps_the_status_of_its_command():
    assert franka("shell", "bash", "-c", "exit 7").returncode == 7


def test_a_shell_names_a_command_that_is_not_there():
    result = franka("shell", "roslunch")
    assert (result.returncode, result.stdout) == (127, "")
    assert result.stderr == 'franka: there is no command "roslunch" in this shell.\n'


@pytest.mark.parametrize("arguments, taken", [("--style", ""), ("--long --style", "--long")])
def test_style_runs_the_style_checks_without_a_build(tmp_path, arguments, taken):
    python = tmp_path / "bin" / "python3"
    python.parent.mkdir()
    python.write_text('#!/bin/sh\necho "$@"\n')
    python.chmod(0o755)
    printed = in_script(f"venv={tmp_path}; cmd_install() {{ :; }}; cmd_test {arguments}")
    assert printed.split() == [str(TOP / "tests" / "style.py"), *taken.split()]


@pytest.mark.parametrize(
    ("message", "jobs"),
    [
        ("a.h:919:5: internal compiler error: Segmentation fault", "2"),
        ("g++: fatal error: Killed signal terminated program cc1plus", "1"),
        ("a.cpp:3: error: expected a sentence", "given up"),
    ],
)
def test_a_build_whose_compiler_died_goes_on_once(message, jobs, tmp_path):
    """After a killed one with one at a time, since memory was short."""
    (tmp_path / "out").mkdir()
    printed = in_script(
        f"top={tmp_path}; jobs=2; once() {{"
        f" [ -e $top/failed ] && {{ echo $jobs >$top/jobs; return; }};"
        f" touch $top/failed; echo '{message}'; return 1; }};"
        "building once 2>&1 && cat $top/jobs || echo given up"
    )
    assert message in printed and printed.endswith(f"\n{jobs}\n")


@pytest.mark.parametrize("generated, kept", [("Makefile", False), ("build.ninja", True)])
def test_what_make_has_built_is_not_left_to_ninja(generated, kept, tmp_path):
    (tmp_path / "build").mkdir()
    for name in (generated, "object.o"):
        (tmp_path / "build" / name).touch()
    printed = in_script(
        f"top={tmp_path}; workspace=$top; catkin_make() {{ ls build; }}; configure_and_make OFF OFF"
    )
    assert ("object.o" in printed) == kept


BUILD = """
    echo "-- +++ processing catkin package: 'one'"
    for i in 3 9 10 57 100 2 99; do echo "[ $i%] Building $i.o"; done"""


def test_a_build_prints_its_progress(tmp_path):
    (tmp_path / "out").mkdir()
    printed = in_script(f"top={tmp_path}; once() {{ {BUILD}; }}; quietly build once")
    assert printed.split("\n") == [f"   {percent} %" for percent in (3, 10, 57, 100, 2, 99)] + [""]
    assert "Building 9.o" in (tmp_path / "out" / "build.log").read_text()


def test_a_verbose_build_shows_everything(tmp_path):
    (tmp_path / "out").mkdir()
    printed = in_script(f"top={tmp_path}; once() {{ {BUILD}; }}; quietly build once", FRANKA_VERBOSE="1")
    assert "[ 57%] Building 57.o" in printed
    assert "FRANKA_VERBOSE" in franka("--help").stdout


# ---- compilers at a time ---------------------------------------------------------------------------------

V2 = {"own": "0::/user.slice/job\n"}
V1 = {"own": "4:memory:/docker/abc\n3:cpu,cpuacct:/docker/abc\n"}
CPU_V1, UNLIMITED_V1 = "cpu,cpuacct/cpu.cfs_{}_us", "9223372036854771712"


@pytest.mark.parametrize(
    ("files", "jobs"),
    [
        ({}, 16),
        ({"own": None, "meminfo": None}, 16),
        ({"meminfo": "MemAvailable: 500000 kB\n"}, 1),
        (V2 | {"user.slice/job/cpu.max": "max 100000", "user.slice/job/memory.max": "max"}, 16),
        (V2 | {"user.slice/job/cpu.max": "max 100000", "user.slice/cpu.max": "250000 100000"}, 3),
        (V2 | {"cpu.max": "500000 100000"}, 5),  # in a container the root has the container's
        (V2 | {"user.slice/memory.max": str(5 << 30), "user.slice/job/memory.max": "max"}, 3),
        (V1 | {CPU_V1.format("quota"): "350000", CPU_V1.format("period"): "100000"}, 4),
        (V1 | {"memory/docker/abc/memory.limit_in_bytes": str(3 << 30)}, 2),
        (V1 | {"memory/memory.limit_in_bytes": UNLIMITED_V1}, 16),
    ],
)
def test_jobs_follow_processors_quota_and_memory(files, jobs, tmp_path):
    default = {"own": "0::/\n", "meminfo": "MemAvailable: 99999999 kB\n"}
    for name, text in (default | files).items():
        if text is not None:
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(f"{text}\n")
    code = f"cgroups={tmp_path} own_cgroups={tmp_path}/own meminfo={tmp_path}/meminfo; nproc() {{ echo 16; }}"
    assert in_script(f"{code}; default_jobs") == f"{jobs}\n"


def test_the_users_number_of_jobs_is_taken():
    assert in_script("echo $jobs", FRANKA_JOBS="7") == "7\n"


# ---- steps that fail, two commands at once ---------------------------------------------------------------


@pytest.fixture
def debian(tmp_path):
    """Code for a Debian with `needed` installed, and without `compiler`. The file apt has calls of apt."""
    (tmp_path / "out").mkdir()
    (tmp_path / "list").write_text("[run]\nneeded\n\n[test]\nbrowser\ncompiler\n")
    return f"""
        top={tmp_path} package_lists=({tmp_path}/list)
        offline() {{ false; }}
        as_root() {{ echo "$@" >>$top/apt; }}
        dpkg-query() {{ echo "installed needed"; }}
        apt-cache() {{ printf '%s\\n' browser needed; }}
    """


def test_a_package_that_debian_lacks_is_named_and_the_others_are_installed(debian, tmp_path):
    printed = in_script(f"{debian} step Begin install_packages test")
    assert "lacks compiler:" in printed
    installed = (tmp_path / "apt").read_text().splitlines()[-1].split()
    assert "browser" in installed and "compiler" not in installed
    assert in_script(f"{debian} missing_packages test").split() == ["browser"]
    yesterday = time.time() - 25 * 3600
    os.utime(tmp_path / "out" / "not_in_debian", (yesterday, yesterday))
    assert in_script(f"{debian} missing_packages test").split() == ["browser", "compiler"]


def test_a_package_for_running_that_debian_lacks_is_requested(debian, tmp_path):
    (tmp_path / "list").write_text("[run]\nneeded\ncompiler\n")
    in_script(f"{debian} install_packages")
    assert (tmp_path / "apt").read_text().split()[-1] == "compiler"


def test_without_root_and_sudo_the_command_for_an_administrator_is_printed(debian):
    user = "id() { echo 1000; }; command() { false; }"
    printed = failing(f"{debian} {user}; step Begin install_packages test")
    assert "apt-get install browser compiler\n" in printed


def test_what_another_user_has_left_is_named(tmp_path):
    left = tmp_path / "venv" / "lib" / "module.py"
    left.parent.mkdir(parents=True)
    left.touch(0o444)
    user = '[ "$1" = -u ] && echo 65534 || echo somebody'
    # Root without this capability may write only what the modes of files allow, as all others do.
    before = ["setpriv", "--bounding-set=-dac_override"] if os.geteuid() == 0 else []
    code = f"top={tmp_path} venv={tmp_path}/venv workspace={tmp_path}; id() {{ {user}; }}; begin_alone"
    printed = failing(code, *before)
    assert f"{left} belongs to " in printed and f"sudo chown -R somebody {tmp_path}" in printed


@pytest.mark.parametrize(("free", "said"), [("3", "only 3 MB are left on the disk of /a disk"), ("3000", "")])
def test_a_full_disk_is_named(tmp_path, free, said):
    listed = f"df() {{ printf 'Avail Mounted on\\n{free}M /a disk\\n 9000M /tmp\\n'; }}"
    printed = failing(f"{listed}; step Begin false")
    assert said in printed and ("MB are left" in printed) == bool(said)
    assert "Begin failed" in printed
    (tmp_path / "out").touch()
    assert said in failing(f"{listed}; top={tmp_path}; begin_alone")


@pytest.mark.parametrize(
    "code",
    [
        # no mirror answers
        'as_root() { [[ "$*" != *update* ]]; }; missing_packages() { echo x; }; step Begin install_packages',
        'as_root() { [[ "$*" != *install* ]]; }; missing_packages() { echo x; }; step Begin install_packages',
        # a file is in the way of the workspace
        "touch $top/ws; workspace=$top/ws; catkin_make() { :; }; step Begin configure_and_make OFF OFF",
        "touch $top/dist; step Begin build_wheel",
    ],
)
def test_a_step_that_failed_in_its_middle_has_failed(code, tmp_path):
    (tmp_path / "out").mkdir()
    assert "Begin failed" in failing(f"top={tmp_path}; offline() {{ false; }}; {code}")


class Begun:
    """A command of that folder in a process of its own, which goes on when it is told to."""

    def __init__(self, folder: Path, code: str, name: str = "build"):
        code = f"source {FRANKA}; {of(folder)} command={name}; {code}; echo begun; read -r; echo done"
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self.process = subprocess.Popen(["bash", "-c", code], process_group=0, **pipes)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        with suppress(ProcessLookupError):  # also what waits for the lock
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.communicate()

    def line(self) -> str:
        return self.process.stdout.readline()

    def finish(self) -> str:
        return self.process.communicate("\n", timeout=60)[0]


def of(folder: Path) -> str:
    return f"top={folder} workspace={folder} venv={folder}/.venv"


BUILDS = "replaces=build begin_alone"
USES = f"{BUILDS}; end_build"


def test_two_commands_wait_for_each_other(tmp_path):
    with Begun(tmp_path, "begin_alone", "wheel") as first:
        assert first.line() == "begun\n"
        with Begun(tmp_path, "begin_alone") as second:
            assert f"./franka wheel (process {first.process.pid})" in second.line()
            assert first.finish() == "done\n"
            assert second.finish() == "begun\ndone\n"


def test_nothing_is_replaced_while_a_command_uses_the_build(tmp_path):
    """The user is another program by then, as after `exec`."""
    use = f"{USES}; exec bash -c 'echo begun; read -r; echo done'"
    with Begun(tmp_path, use, "bench") as user:
        assert user.line() == "begun\n"
        with Begun(tmp_path, BUILDS) as builder:
            assert f"./franka bench (process {user.process.pid})" in builder.line()
            assert user.finish() == "done\n"
            assert builder.finish() == "begun\ndone\n"


@pytest.mark.parametrize("use", ["begin_alone", BUILDS])
def test_what_runs_in_the_tests_may_build(use, tmp_path):
    with Begun(tmp_path, USES, "test") as user:
        assert user.line() == "begun\n"
        # another one waits meanwhile
        with Begun(tmp_path, BUILDS, "demo") as other:
            assert "./franka test" in other.line()
            printed = in_script(f"{of(tmp_path)}; {use}; echo begun", FRANKA_IN_USE=str(tmp_path))
            assert printed == "begun\n"
            assert in_script(f"{of(tmp_path)}; begin_alone; echo begun") == "begun\n"


def test_a_lock_that_clean_has_removed_is_taken_again(tmp_path):
    with Begun(tmp_path, f"{BUILDS}; rm -rf {tmp_path}/out", "clean") as first:
        assert first.line() == "begun\n"
    with Begun(tmp_path, BUILDS, "clean") as first:
        assert first.line() == "begun\n"
        with Begun(tmp_path, BUILDS) as second:
            assert "Waiting" in second.line()
            shutil.rmtree(tmp_path / "out")
            first.finish()
            assert second.line() == "begun\n"
            with Begun(tmp_path, BUILDS) as third:
                assert "Waiting" in third.line()


@pytest.mark.parametrize(
    ("command", "replaces"),
    [
        *((command, "build") for command in ("build", "demo", "docs", "test", "bench")),
        *((command, "") for command in ("wheel", "deb", "test --style")),
    ],
)
def test_commands_that_replace_the_build_wait_for_its_users(command, replaces, tmp_path):
    code = f'top={tmp_path} workspace=$top; cmd_install() {{ echo "${{replaces:-}}"; exit; }}; cmd_{command}'
    assert in_script(code) == f"{replaces}\n"


@pytest.mark.parametrize("there", [True, False])
def test_another_environment_of_python_waits_for_the_users_of_this_one(there, tmp_path):
    stubs = f'python_groups() {{ {str(there).lower()}; }}; begin_alone() {{ echo "<$replaces>"; exit; }}'
    assert in_script(f"check_folder() {{ :; }}; {stubs}; cmd_install") == f"<{'' if there else 'build'}>\n"


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "out").touch()
    assert f"{tmp_path}/out cannot be written" in failing(f"top={tmp_path}; begin_alone")


def test_clean_removes_what_was_made_and_nothing_else(tmp_path):
    subprocess.run(["git", "init", "--quiet", tmp_path], check=True, timeout=60)
    for name in ("franka", ".gitignore"):
        shutil.copy(TOP / name, tmp_path)
    (tmp_path / ".git/info/exclude").write_text("*.bag\n.envrc\n")  # the user's own
    for name in ("out/a", ".venv/b", "catkin_ws/build/c", "mine.txt", "my.bag", ".envrc"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    command = [tmp_path / "franka", "clean"]
    printed = subprocess.run(command, check=True, timeout=60, text=True, stdout=subprocess.PIPE).stdout
    assert {".venv/", "catkin_ws/build/", "out/"} <= set(printed.splitlines())
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == [".envrc", ".git", ".gitignore", "franka", "mine.txt", "my.bag"]
