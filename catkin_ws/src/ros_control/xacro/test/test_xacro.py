# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The xacro executable works on all paths that launch files and users call."""

import os
import shutil
import stat
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
ROBOT = os.path.join(HERE, "robot.xacro")


def run(*command, **environment):
    """Run a command; return its completed process with text output."""
    return subprocess.run(
        command, env=dict(os.environ, **environment), capture_output=True, text=True, timeout=60, check=False
    )


class XacroTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.directory)

    def path_with_a_foreign_python(self):
        """Return a PATH whose first python3 always fails."""
        python = os.path.join(self.directory, "python3")
        with open(python, "w", encoding="utf-8") as script:
            script.write("#!/bin/sh\necho 'the wrong python3 was called' >&2\nexit 42\n")
        os.chmod(python, os.stat(python).st_mode | stat.S_IXUSR)
        return self.directory + os.pathsep + os.environ["PATH"]

    def expect_robot(self, text, name):
        robot = ElementTree.fromstring(text)
        self.assertEqual([part.get("name") for part in robot], [name, "link7"])

    def test_finds_packages_includes_yaml_and_arguments(self):
        done = run("xacro", ROBOT, "name:=somebody")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.expect_robot(done.stdout, "somebody")
        self.expect_robot(run("xacro", ROBOT).stdout, "nobody")

    def test_runs_by_rosrun_and_from_the_package_with_another_python(self):
        path = self.path_with_a_foreign_python()
        package = run("/usr/bin/rospack", "find", "xacro").stdout.strip()
        for command in (["rosrun", "xacro", "xacro"], [os.path.join(package, "xacro")], ["xacro"]):
            done = run(*command, ROBOT, PATH=path)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.expect_robot(done.stdout, "nobody")

    def test_runs_in_launch_files(self):
        done = run(
            "/usr/bin/roslaunch",
            "--dump-params",
            os.path.join(HERE, "robot.launch"),
            "file:=" + ROBOT,
            PATH=self.path_with_a_foreign_python(),
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.expect_robot(yaml.safe_load(done.stdout)["/robot_description"], "launched")

    def test_module_is_importable_by_nodes(self):
        done = run(
            "/usr/bin/python3",
            "-c",
            "import sys, xacro; print(xacro.process_file(sys.argv[1]).toxml())",
            ROBOT,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.expect_robot(done.stdout, "nobody")

    def test_names_the_package_that_is_missing(self):
        missing = os.path.join(self.directory, "missing.xacro")
        with open(missing, "w", encoding="utf-8") as file:
            file.write(
                '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">'
                '<xacro:include filename="$(find no_such_package)/a.xacro"/></robot>'
            )
        done = run("xacro", missing)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("'no_such_package' was not found", done.stderr)

    def test_cmake_function_rebuilds_the_file_when_an_include_changes(self):
        for name in ("robot.xacro", "link.xacro", "numbers.yaml"):
            shutil.copy(os.path.join(HERE, name), self.directory)
        with open(os.path.join(self.directory, "robot.xacro"), encoding="utf-8") as file:
            text = file.read().replace("$(find xacro)/test", self.directory)
        with open(os.path.join(self.directory, "robot.xacro"), "w", encoding="utf-8") as file:
            file.write(text)
        with open(os.path.join(self.directory, "CMakeLists.txt"), "w", encoding="utf-8") as file:
            file.write(
                "cmake_minimum_required(VERSION 3.10)\nproject(user C CXX)\n"
                "find_package(catkin REQUIRED COMPONENTS xacro)\n"
                "xacro_add_xacro_file(robot.xacro robot.urdf REMAP name:=built)\n"
                "add_custom_target(robot ALL DEPENDS ${XACRO_OUTPUT_FILE})\n"
            )
        build = os.path.join(self.directory, "build")
        configure = run("cmake", "-S", self.directory, "-B", build, "-DPYTHON_EXECUTABLE=/usr/bin/python3")
        self.assertEqual(configure.returncode, 0, configure.stderr)

        def built():
            made = run("cmake", "--build", build)
            self.assertEqual(made.returncode, 0, made.stderr)
            with open(os.path.join(build, "robot.urdf"), encoding="utf-8") as file:
                return file.read()

        self.expect_robot(built(), "built")
        link = os.path.join(self.directory, "link.xacro")
        with open(link, encoding="utf-8") as file:
            text = file.read().replace("link$", "other$")
        with open(link, "w", encoding="utf-8") as file:
            file.write(text)
        self.assertIn('name="other7"', built())
