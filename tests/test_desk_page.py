# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk's page in a real browser: two simulated robots, and clients of their FCI."""

import json
import os
import time
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
import page_browser
import pytest
from desk_clients import move
from desk_server import unverified
from page_browser import PASSWORD, browser, wait_for
from pyfranka.desk.sessions import digest_of
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import FR3, Panda

if page_browser.missing():
    pytest.skip(page_browser.missing(), allow_module_level=True)
from selenium.webdriver.common.keys import Keys  # noqa: E402  (only where it is installed)

PHONE = (360, 740)
LONG = pytest.mark.long_form("uses everything of the page")
TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK")
CLOSED, OPEN = [True] * 7, [False] * 7


@pytest.fixture(scope="module")
def executor():
    """For motions of clients, which end with the robots."""
    with ThreadPoolExecutor() as executor:
        yield executor


@pytest.fixture(scope="module")
def sim(executor):
    """A panda and an fr3 in one world, locked, with Desk."""
    robots = (Panda(realism="ideal"), FR3(base=(0, 1.0, 0), realism="ideal"))
    with FrankaSim(*robots, pace="patient", desk="127.0.0.1:0", desk_password=PASSWORD) as sim:
        for robot in sim.robots:
            robot.remote.send("timing brakes 0.1")
        yield sim


@pytest.fixture(scope="module")
def tab(sim):
    """A tab with the page."""
    with browser() as tab:
        tab.open(sim.robot.desk)
        yield tab


@pytest.fixture
def page(tab):
    """The page after login; after the test the console has no error."""
    tab.resize(900, 700)
    if tab.find("form.login"):
        tab.log_in()
    tab.wait_for_view()
    yield tab
    assert tab.errors() == []


def wait_for_report(page, condition, what, robot=0):
    wait_for(lambda: condition(page.report(robot)), what)


def take_control(page, robot=0):
    if not page.run(f"desk.robots[{robot}].inControl"):
        page.click("Take control", robot)
        wait_for(lambda: page.run(f"desk.robots[{robot}].inControl"), "the page has control")


def unlock(page, robot=0):
    take_control(page, robot)
    if page.report(robot)["brakes"] != OPEN:
        page.click("Unlock", robot)
        wait_for_report(page, lambda now: now["brakes"] == OPEN, "the joints are unlocked", robot)


@pytest.fixture
def ready(page):
    """The page with control of the panda, which is unlocked with an active FCI."""
    unlock(page)
    if not page.report()["fci"]:
        page.click("FCI active")
        page.click("Activate")
        wait_for_report(page, lambda now: now["fci"], "the FCI is active")
    return page


@pytest.fixture
def motion(ready, sim, executor):
    """Starts a client's motion of the panda, by default a long one. Returns what will be its result."""

    def start(seconds=600.0, amplitude=0.2):
        motion = executor.submit(move, sim.robots[0], seconds, amplitude, back=False)
        wait_for_report(ready, lambda now: now["mode"] == "Move" or motion.done(), "the client's motion")
        return motion

    return start


def changed(before, after, box):
    """Share of the pixels in a box that differ."""
    pair = [numpy.asarray(picture.crop(box), dtype=int) for picture in (before, after)]
    return float((abs(pair[0] - pair[1]).max(axis=2) > 12).mean())


# ---- one case for all that an operator needs -------------------------------------------------------------


def test_operator_logs_in_takes_control_and_opens_the_brakes(tab, sim):
    tab.log_in(password="wrong")
    tab.shows("User or password is wrong.")
    assert all("401" in error for error in tab.errors())
    tab.log_in()
    tab.wait_for_view()
    tab.shows("No user controls panda")
    assert not tab.button("Unlock").is_enabled() and not tab.button("FCI active").is_enabled()
    assert tab.button("Stop panda").is_enabled()
    unlock(tab)
    tab.shows("Unlocked", '[data-robot="0"]')
    tab.click("FCI active")
    tab.shows("Activate the FCI?", "dialog")
    tab.click("Cancel")
    assert not tab.report()["fci"]
    loaded = tab.run("performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert any(name.endswith("three.module.js") for name in loaded)
    assert [name for name in loaded if not name.startswith(sim.robot.desk)] == []
    assert tab.errors() == []


def test_a_clients_motion_is_drawn_and_ended_by_the_user_stop(motion, ready):
    assert ready.report()["light"]["color"] in ("green", "blue")
    ready.run("document.querySelector('.view').scrollIntoView({block: 'start'})")
    start, before = ready.place("panda_hand"), ready.picture()

    def distance():
        now = ready.place("panda_hand")
        return numpy.hypot(now["x"] - start["x"], now["y"] - start["y"])

    motion(3.0, 0.6).result(page_browser.LIMIT)
    wait_for(lambda: distance() > 15, "the hand moves in the view")
    x, y = int(start["x"]), int(start["y"])
    box = (x - 30, y - 30, x + 30, y + 30)
    wait_for(lambda: changed(before, ready.picture(), box) > 0.05, "the picture of the hand has changed")

    moving = motion()
    ready.click("Stop panda")
    assert moving.exception(page_browser.LIMIT) is not None
    wait_for_report(ready, lambda now: now["mode"] == "User stopped", "the robot is stopped")
    ready.shows("User stopped")
    ready.click("Release stop panda")
    wait_for_report(ready, lambda now: now["mode"] != "User stopped", "the stop is released")
    if ready.report()["errors"]:
        ready.click("Recover")
    ready.shows("No errors.", '[data-robot="0"]')


# ---- one robot -------------------------------------------------------------------------------------------


@LONG
def test_errors_are_shown_in_words_and_recovered(motion, ready):
    moving = motion()
    ready.click("Push with numbers")
    field = ready.find(".view input[type=number]")
    field.clear()
    field.send_keys("150")
    ready.click("Push for 300 ms")
    wait_for_report(ready, lambda now: now["mode"] == "Reflex", "the push has caused a reflex")
    assert moving.exception(page_browser.LIMIT) is not None
    errors = ready.text('[data-robot="0"] .errors')
    assert errors and "exceeded its threshold" in errors
    ready.click("Recover")
    wait_for_report(ready, lambda now: now["mode"] == "Idle", "the robot has recovered")
    ready.shows("No errors.", '[data-robot="0"]')


@LONG
def test_client_receives_the_end_effector(ready, sim):
    ready.click("End effector")
    panel = ready.find('[data-robot="0"] details.end-effector')
    mass = panel.find_element("css selector", "input[type=number]")
    mass.clear()
    mass.send_keys("1.234")
    ready.click("Apply")
    client = sim.robots[0].connect()
    wait_for(lambda: abs(client.read_once().m_ee - 1.234) < 1e-9, "the client sees the mass")
    ready.shows("In force: 1.234 kg", '[data-robot="0"]')


@LONG
def test_operator_drags_the_hand_in_guiding(ready):
    assert not ready.button("Guide by hand").is_enabled()
    ready.click("Safety")
    ready.click("X4 activation device")
    ready.click("Guide by hand")
    wait_for_report(ready, lambda now: now["mode"] == "Guiding", "guiding is active")
    ready.run("document.querySelector('.view').scrollIntoView({block: 'start'})")
    before = numpy.array(ready.report()["q"])

    def push():
        ready.shows(" N ", ".force-label")
        wait_for(lambda: abs(numpy.array(ready.report()["q"]) - before).max() > 0.03, "the arm follows")

    ready.drag(ready.place("panda_link7"), (70, 20), push)
    wait_for(lambda: not ready.text(".force-label"), "the force is gone")
    ready.click("Guide by hand")
    wait_for_report(ready, lambda now: not now["guiding"]["active"], "guiding has ended")
    ready.click("X4 activation device")
    wait_for_report(ready, lambda now: not now["inputs"]["x4"], "the activation device is released")


# ---- several robots, several users -----------------------------------------------------------------------


@LONG
def test_two_robots_are_operated_side_by_side(page):
    unlock(page, 1)
    assert page.report(1)["arm_id"] == "fr3" and page.report(1)["brakes"] == OPEN
    left, right = (page.find(f'[data-robot="{i}"]').rect for i in (0, 1))
    assert left["y"] == right["y"] and left["x"] + left["width"] <= right["x"]
    page.click("Programming", 1)
    wait_for(lambda: page.report(1)["operating_mode"] == "programming", "Programming")
    page.click("Guide by hand", 1)
    wait_for(lambda: page.report(1)["mode"] == "Guiding", "the second robot is guided")
    first = page.report(0)["brakes"]
    assert page.report(0)["mode"] != "Guiding"
    page.click("Guide by hand", 1)
    page.click("Execution", 1)
    page.click("Lock", 1)
    wait_for(lambda: page.report(1)["brakes"] == CLOSED, "the second robot is locked")
    assert page.report(0)["brakes"] == first


def post(address: str, path: str, body: dict, cookie: str = "") -> str:
    headers = {"Content-Type": "application/json", "Cookie": cookie}
    request = urllib.request.Request(address + path, json.dumps(body).encode(), headers)
    with urllib.request.urlopen(request, context=unverified(), timeout=page_browser.LIMIT) as answer:
        return answer.read().decode()


@LONG
def test_holder_is_asked_and_forced_take_over_works(page, sim):
    take_control(page, 1)
    desk, digest = sim.robots[1].desk, digest_of(page_browser.USER, PASSWORD)
    token = post(desk, "/admin/api/login", {"login": page_browser.USER, "password": digest})
    request = "/admin/api/control-token/request", {"requestedBy": "anna"}, f"authorization={token}"
    post(desk, *request)
    page.shows("anna requests control of fr3.")
    page.click("Deny", 1)
    page.shows("You control fr3.")
    post(desk, *request)
    page.shows("anna requests control of fr3.")
    page.click("Accept", 1)
    page.shows("anna controls fr3. You can watch it.")
    assert not page.button("Unlock", 1).is_enabled()
    page.click("Take over by force", 1)
    page.click("Take over")
    page.shows("Press the circle button of the Pilot to take over control from anna.")
    page.shows("s left")
    page.click("Press circle", 1)
    page.shows("You control fr3.")
    page.click("Release control", 1)
    page.shows("No user controls fr3")


# ---- keyboard, phone, colors ----------------------------------------------------------------------------


def go_to(page, name, limit=120):
    """Presses Tab until that has the focus, which must be visible."""
    for _ in range(limit):
        page.press(Keys.TAB)
        focused, shown = page.focused()
        assert shown, f"'{focused}' has the focus, and nothing shows it."
        if focused == name:
            return
    raise AssertionError(f"Tab does not reach '{name}'.")


@LONG
def test_the_keyboard_alone_is_enough(page, sim):
    page.run("desk.robots.forEach((robot) => robot.inControl && robot.changeControl('release'))")
    sim.robots[0].remote.send("joints lock")
    go_to(page, "Log out")
    page.press(Keys.ENTER)
    wait_for(lambda: page.find("form.login"), "the login")
    page.press(page_browser.USER, Keys.TAB, PASSWORD, Keys.ENTER)
    page.wait_for_view()
    go_to(page, "Take control")
    page.press(Keys.ENTER)
    wait_for(lambda: page.run("desk.robots[0].inControl"), "the page has control")
    go_to(page, "Unlock")
    page.press(Keys.SPACE)
    wait_for(lambda: page.report()["brakes"] == OPEN, "the joints are unlocked")
    go_to(page, "FCI active")
    page.press(Keys.SPACE)
    page.shows("Activate the FCI?", "dialog")
    assert page.focused()[0] == "Activate"  # the dialog has the focus
    page.press(Keys.ENTER)
    wait_for(lambda: page.report()["fci"], "the FCI is active")


@LONG
def test_a_page_that_ends_while_it_connects_reports_no_error(page):
    page.run(
        """import("/page/files/js/live.js").then(({ Live }) => new Promise((resolve) => {
             const ignore = () => {}, handlers = { onConnection: ignore, onLoginEnded: ignore };
             new Live({ ...handlers, onFrame: ignore }).end();
             const next = new Live({ ...handlers, onFrame: () => { next.end(); resolve(); } });
           }))"""
    )


@LONG
def test_the_view_is_turned_by_keys_and_does_not_hold_the_focus(page):
    page.run("document.querySelector('.view canvas').focus()")
    name, before = page.focused()[0], page.place("panda_hand")
    page.press(Keys.ARROW_LEFT)
    wait_for(lambda: page.place("panda_hand") != before, "the view turns")
    page.press(Keys.TAB)
    assert page.focused()[0] != name


@LONG
def test_shortcuts_stop_all_robots_and_are_listed(page):
    page.run("document.activeElement.blur()")
    page.press("s")
    wait_for(lambda: page.run("desk.robots.every((robot) => robot.isStopped)"), "all robots are stopped")
    for name in ("Release stop panda", "Release stop fr3"):
        page.click(name)
    wait_for(lambda: not page.run("desk.robots.some((robot) => robot.isStopped)"), "the stops are released")
    page.press("?")
    page.shows("Keyboard shortcuts", "dialog")
    page.press(Keys.ESCAPE)
    wait_for(lambda: page.find("dialog[open]") is None, "the dialog is closed")


@LONG
def test_it_fits_a_phone(page):
    page.resize(*PHONE)
    page.run("document.querySelectorAll('details').forEach((card) => { card.open = true; })")
    outside = """[...document.querySelectorAll('main *')].filter((each) => {
        const box = each.getBoundingClientRect();
        return box.width > 0 && box.right > innerWidth + 1 && !each.closest('.scroll-x');
      }).map((each) => each.outerHTML.slice(0, 80))"""
    wait_for(lambda: page.run(f"({outside})") == [], "everything is within the width of a phone")
    assert page.run("document.documentElement.scrollWidth") <= PHONE[0]
    stop = page.button("Stop panda").rect
    bottom = page.run("innerHeight")
    seen_at = page.run("document.querySelector('.stop').getBoundingClientRect().bottom")
    assert seen_at <= bottom and stop["height"] >= 44
    page.run("document.querySelectorAll('details').forEach((card) => { card.open = false; })")


@LONG
def test_it_follows_the_dark_theme_of_the_system(page):
    brightness = "getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)"
    page.prefer("light")
    light = sum(page.run(brightness))
    page.prefer("dark")
    dark = sum(page.run(brightness))
    assert light > 600 and dark < 150
    page.prefer("light")


# ---- cost ------------------------------------------------------------------------------------------------


def cpu_time(process: int) -> float:
    """Of a process so far [s]."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_SECOND


def desk_process(sim) -> int:
    """The process of Desk, a child of franka_sim."""
    children = Path(f"/proc/{sim.process.pid}/task/{sim.process.pid}/children").read_text().split()
    (desk,) = [
        int(child) for child in children if "franka_desk" in Path(f"/proc/{child}/cmdline").read_text()
    ]
    return desk


@pytest.mark.realtime("measures the share of a processor and frames a second")
def test_one_open_page_costs_a_tenth_of_a_core(page, sim, record_property):
    desk = desk_process(sim)
    begin, used, count = time.monotonic(), cpu_time(desk), page.run("desk.frames")
    wait_for(lambda: page.run("desk.frames") > count + 60, "60 frames")
    seconds = time.monotonic() - begin
    share, rate = (cpu_time(desk) - used) / seconds, (page.run("desk.frames") - count) / seconds
    record_property("share_of_a_core", round(share, 3))
    assert rate > 3, f"The page receives only {rate:.1f} frames a second."
    assert share <= 0.10, f"Desk with two robots and one page takes {100 * share:.1f} % of a core."
