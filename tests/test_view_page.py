"""The page of ``grasp-xl view`` in a real browser: what it shows, computes, copies and takes."""

from __future__ import annotations

import copy
import json
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import Browser, run_browser
from office import lack
from view_data import (
    VIEW,
    Data,
    bracket_book,
    bracket_data,
    bracket_scene,
    mesh_of_size,
    scene_of,
)

from grasp_xl.chromosome import from_active
from grasp_xl.grasp import evaluate
from grasp_xl.rules import Criterion
from grasp_xl.space import OptionSpace
from grasp_xl.stability import support
from grasp_xl.task import settle
from grasp_xl.view.page import assembled, scene_data

WEB = Path(__file__).parents[1] / "grasp_xl" / "view" / "web"
FIRST_PICTURE_MS = 2000
MOST_BYTES = 1_000_000
CARD = ("force_n", "fos", "cost", "moment", "deviation", "structure", "divergence", "clearance")
HOSTILE = "<script>document.title='stolen'</script><img src=x onerror=alert(1)>"
FORMULA = '=cmd|"/c calc"!A1'
STILL = {"name": "prefers-reduced-motion", "value": "reduce"}
PHONE = {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True}


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    yield from run_browser(tmp_path_factory.mktemp("profile"))


@pytest.fixture(scope="module")
def sample() -> Data:
    return bracket_data()


@pytest.fixture
def scene(sample: Data) -> Data:
    return copy.deepcopy(sample)


@pytest.fixture
def show(browser: Browser, tmp_path: Path) -> Iterator[Callable[..., Browser]]:
    """Give a function that opens the page of a scene."""

    def opened(scene: Data, *, address: str = "") -> Browser:
        path = tmp_path / "page.html"
        path.write_bytes(assembled(scene))
        browser.open(path, address=address)
        return browser

    yield opened
    browser.command("Emulation.clearDeviceMetricsOverride")
    browser.command("Emulation.setEmulatedMedia", media="", features=[])


def press(browser: Browser, *keys: str) -> None:
    from selenium.webdriver import ActionChains

    actions = ActionChains(browser.driver)
    for key in keys:
        actions.send_keys(key)
    actions.perform()


def paste(browser: Browser, text: str) -> Any:
    """Paste genes, press Show, and return what the page says against them."""
    return browser.run(
        "document.getElementById('pasted').value = arguments[0];"
        "document.querySelector('#paste button').click();"
        "return document.getElementById('fault').textContent",
        text,
    )


def test_an_open_page_is_silent(show, scene):
    """A page asks for nothing over the network and says nothing on the console, whatever is done."""
    browser = show(scene)
    browser.wait("document.querySelector('[role=option] .value').textContent")
    for selector in ("[data-view=top]", "#perspective", "#compare", "[data-layer=part]", "#fit"):
        browser.find(selector).click()
    asked = browser.requests()
    assert asked[0].startswith("file:")
    assert [url for url in asked[1:] if not url.startswith("data:")] == []
    assert browser.log() == []


def test_the_picture_is_not_blank(show, scene):
    """The picture has part, elements and frame, and each layer that is switched off takes some."""
    browser = show(scene)
    before = browser.view("pixels()")
    assert before["drawn"] > 0.03 * before["all"]
    for layer in ("part", "elements", "frame", "places", "polygons", "centres", "numbers"):
        browser.find(f"[data-layer={layer}]").click()
        after = browser.view("pixels()")
        assert after["drawn"] < before["drawn"], layer
        before = after
    assert before["drawn"] == 0


@pytest.mark.parametrize("shape", ["mesh", "polygon"])
def test_every_form_of_a_part_is_drawn(show, scene, shape):
    """A part is drawn from its mesh, else from its faces (above), else from its polygon."""
    scene["part"]["faces"] = []
    if shape == "mesh":
        scene["part"]["mesh"] = mesh_of_size(0.02)
    browser = show(scene)
    whole = browser.view("pixels()")
    browser.find("[data-layer=part]").click()
    assert browser.view("pixels()")["drawn"] < whole["drawn"]
    assert browser.log() == []


def test_each_design_has_the_numbers_of_its_card(show, scene):
    """The page works out every number of every design as Python does, to 1e-9, and says so."""
    browser = show(scene)
    for position, design in enumerate(scene["designs"]):
        browser.view(f"select({position})")
        card = browser.view("card()")
        given = [design["card"][name] for name in CARD]
        np.testing.assert_allclose([card[name] for name in CARD], given, rtol=1e-9)
        for name in ("feasible", "meets_all_goals"):
            assert card[name] == design["card"][name]
        assert "The workbook and this page agree." in browser.text("#panel")
        assert browser.text("#live") == f"Shown: {design['group']}, {design['name']}"


@pytest.mark.parametrize(
    "said",
    [
        {},
        {"moment_arm": "plan", "criterion": Criterion.parse("cost+structure")},
        {"criterion": Criterion.parse("moment"), "goals": (None, 900.0, None, 1e-3), "fos": 1.0},
    ],
)
def test_any_grasp_is_judged_alike(show, said):
    """Random grasps of all sizes get the same numbers in the page and in Python, by any rules."""
    book = bracket_book()
    parameters = replace(book.parameters, **said)
    random = np.random.default_rng(7)
    task = settle(book.space, parameters, from_active(book.space, [[7], [50]]))
    grasps = [from_active(task.space, random_active(task.space, random)) for _ in range(40)]
    designs = [("All", str(number), each) for number, each in enumerate(grasps)]
    scene = scene_data(scene_of(book, task, designs))
    browser = show(scene)
    cards = browser.view("designs().map((_, position) => window.graspView.card(position))")
    for card, chromosome in zip(cards, grasps, strict=True):
        grasp = evaluate(task.space, task.rules, chromosome)
        held = support(task.space, grasp)
        ours = [card[name] for name in (*CARD[:-1], "value", "longest_mm", "arm_mm")]
        theirs = [grasp.force_n, grasp.fos, *grasp.terms, grasp.divergence, grasp.value]
        np.testing.assert_allclose(ours, [*theirs, grasp.longest_mm, grasp.eccentricity_mm], 1e-9)
        assert card["clearance"] == pytest.approx(grasp.clearance_mm, rel=1e-9)
        assert tuple(card["truss"] or ()) == (grasp.main_truss or ())
        assert card["support"]["hull_area_mm2"] == pytest.approx(held.hull_area_mm2, rel=1e-9)
        assert card["support"]["centroid_inside"] == held.centroid_inside
        assert card["support"]["can_swing"] == held.can_swing
        assert card["feasible"] == grasp.feasible
        assert card["meets_all_goals"] == grasp.meets_all_goals


def random_active(space: OptionSpace, random: np.random.Generator) -> list[list[int]]:
    """Draw counts and places."""
    return [
        (
            1 + random.permutation(kind.total)[: random.integers(kind.count_min, kind.most + 1)]
        ).tolist()
        for kind in space.kinds
    ]


def test_the_card_is_read_as_a_person_does(show, scene):
    """The card says value, goal and whether it is met, with units; the bill sums the elements."""
    browser = show(scene)
    card = scene["designs"][0]["card"]
    panel = browser.find("#panel").text
    assert "Meets FoS and distance, not every goal." in panel
    assert re.search(rf"Residual moment N-mm\s+≤ 5,127\.6\s+{card['moment']:,.1f}", panel)
    assert re.search(r"104\.5 %, missed", panel)
    rows = [row.text for row in browser.driver.find_elements("css selector", ".sum")]
    assert rows == ["Sum 4 100.00 not known"]


def test_the_frame_is_that_of_the_cad_models(show):
    """Main truss, branches and posts run where those of the assembly do."""
    scene = bracket_scene()
    browser = show(scene_data(scene))
    for number, design in enumerate(scene.designs):
        frame, bars = scene.grip(design).frame, browser.view(f"bars({number})")
        for ours, theirs in (
            (frame.main, bars["main"]),
            (frame.branches, bars["branches"]),
            (frame.posts, bars["posts"]),
        ):
            assert len(ours) == len(theirs)
            for bar, other in zip(ours, theirs, strict=True):
                assert other["radius"] == pytest.approx(bar.radius_mm)
                ends = (other["start"], other["end"])
                pairs = ((bar.start_mm, bar.end_mm), (bar.end_mm, bar.start_mm))
                assert any(np.allclose(ends, pair) for pair in pairs)


def test_elements_that_are_not_round_are_drawn(show, scene):
    """A block far wider than the part covers ground around it."""
    narrow = show(scene).view("pixels()")["drawn"]
    block = {"colour": "#00A0B0", "box_mm": [900, 60], "angle_deg": 30, "z_mm": [0, 10]}
    scene["kinds"][0]["solids"].append(block)
    browser = show(scene)
    assert browser.view("pixels()")["drawn"] > 1.2 * narrow
    assert browser.log() == []


def test_a_disagreement_is_told(show, scene):
    """A number of the workbook that differs by more than 1e-9 is named in a warning, and alone."""
    first, second, third, _ = (design["card"] for design in scene["designs"])
    first["moment"] *= 1 + 1e-8
    first["clearance"] *= 1 + 1e-11
    second["meets_all_goals"] = True
    third["clearance"] = None
    browser = show(scene)
    told = []
    for position in range(3):
        browser.view(f"select({position})")
        assert "agree" not in browser.text("#panel")
        told.append(re.sub(r"\d+\.\d+", "1.5", browser.text(".differs")))
    differ = "The workbook and this page differ: "
    assert told == [
        f"{differ}moment (workbook 1.5, page 1.5).",
        f"{differ}every goal met (workbook yes, page no).",
        f"{differ}smallest distance (workbook none, page 1.5).",
    ]


def test_copy_gives_both_gene_rows(show, scene):
    """Copy puts the rows on the clipboard as Excel's cells; a blank gene is an empty one."""
    scene["kinds"][1] |= {"footprints_mm": "", "count_min": 0, "count_max": 0}
    scene["designs"] = scene["designs"][:1]
    scene["designs"][0]["genes"] = [[2, 15, 9, 1, 1, 1], [0, None, None, None, None, None]]
    browser = show(scene)
    rows = "2\t15\t9\t1\t1\t1\n0\t\t\t\t\t"
    assert browser.view("genes()") == rows
    browser.command(
        "Browser.grantPermissions", permissions=["clipboardReadWrite", "clipboardSanitizedWrite"]
    )
    browser.find("[data-copy]").click()
    browser.wait("document.getElementById('live').textContent.includes('copied')")
    assert browser.run("return navigator.clipboard.readText()") == rows


def test_copy_works_without_the_clipboards_consent(show, scene):
    """Where a page has no right to the clipboard, the rows are selected and copied as of old."""
    browser = show(scene)
    browser.run(
        "navigator.clipboard.writeText = () => Promise.reject(new Error('no right'));"
        "document.execCommand = (name) => { window.did = name; return false; };"
    )
    browser.find("[data-copy]").click()
    browser.wait("document.getElementById('live').textContent.includes('Ctrl+C')")
    assert browser.run("return [window.did, window.getSelection().toString()]") == [
        "copy",
        browser.view("genes()"),
    ]


PASTED = (
    "1\t15\t5\t22\t12\t17\n3\t39\t50\t66\t92\t16",
    "1 15 5 22 12 17\r\n3 39 50 66 92 16\r\n",
    "1,15,5,22,12,17\n3, 39, 50, 66, 92, 16",
    "1;15;5;22;12;17 / 3;39;50;66;92;16",
    "1 15 5 22 12 17 3 39 50 66 92 16",
    "1\t15\t5\t22\t12\t17\t3\t39\t50\t66\t92\t16",
)


def test_pasted_genes_are_shown(show, scene):
    """Two rows, or both in one, in any usual separators become one design, which is shown."""
    browser = show(scene)
    for text in PASTED:
        browser.view("select(1)")
        assert paste(browser, text) == ""
        assert browser.view("shown()") == len(scene["designs"])
        assert browser.view("genes()") == PASTED[0]
    assert browser.view("designs()")[len(scene["designs"]) :] == [
        {"group": "Pasted", "name": "Pasted"}
    ]
    moment = scene["designs"][0]["card"]["moment"]
    assert browser.view("card()")["moment"] == pytest.approx(moment, rel=1e-9)
    assert paste(browser, "1 15\n2 39 50") == ""
    assert browser.view("designs()")[-1]["name"] == "Pasted 2"
    assert browser.view("genes()") == "1\t15\t1\t1\t1\t1\n2\t39\t50\t1\t1\t1"


WRONG = {
    "": "There are no genes where two are expected: suction cups, then magnets.",
    "1 15": "There is one row of genes where two are expected: suction cups, then magnets.",
    "1\n1 5": "Row 1 (suction cups) has a count of 1 and no index where at least 1 are expected.",
    "1 x\n1 1": "Row 1 (suction cups) has “x” where a whole number is expected.",
    "1 15\n9 1 2 3 4 5": "Row 2 (magnets) begins with a count of 9 where 1 to 5 may be.",
    "1 15\n2 1": "Row 2 (magnets) has a count of 2 and 1 index where at least 2 are expected.",
    "1 999\n1 1": "Row 1 (suction cups) has the index 999 where 1 to 28 are known.",
    "2 15 15\n1 1": "Row 1 (suction cups) has the index 15 more than once"
    " where each place can hold one element.",
    "1 2 3 4 5 6 7\n1 1": "Row 1 (suction cups) has 7 numbers"
    " where a count and at most 5 index genes are expected.",
    "<script>alert(document.title)\n1": "Row 1 (suction cups) has “<script>alert(document.t…”"
    " where a whole number is expected.",
}


def test_wrong_genes_are_refused_by_a_sentence(show, scene):
    """Wrong genes are not shown; one sentence says which row, what was found, what is expected."""
    browser = show(scene)
    assert {text: paste(browser, text) for text in WRONG} == WRONG
    assert browser.view("shown()") == 0
    assert len(browser.view("designs()")) == len(scene["designs"])


def test_two_designs_are_compared(show, scene):
    """Compare shows the benchmark beside the shown design: two pictures, a second card column."""
    browser = show(scene)
    browser.find("#compare").click()
    assert browser.view("compared()") == 2
    captions = [
        each.text for each in browser.driver.find_elements("css selector", "#captions span")
    ]
    assert captions == [scene["designs"][0]["name"], scene["designs"][2]["name"]]
    heads = browser.driver.find_elements("css selector", ".card thead th")
    assert [head.text for head in heads[2:]] == captions
    assert len(browser.driver.find_elements("css selector", "[data-copy]")) == 2
    browser.find("#swap").click()
    assert [browser.view("shown()"), browser.view("compared()")] == [2, 0]
    browser.find("#compare").click()
    assert browser.view("compared()") is None


def test_the_address_remembers_what_is_shown(show, scene, browser):
    """A reload shows the same design and comparison, also where one was pasted."""
    show(scene, address="#shown=1&compare=2")
    assert [browser.view("shown()"), browser.view("compared()")] == [1, 2]
    paste(browser, "1 3\n1 7")
    browser.driver.refresh()
    assert [browser.view("genes()"), browser.view("compared()")] == [
        "1\t3\t1\t1\t1\t1\n1\t7\t1\t1\t1\t1",
        2,
    ]


def test_a_strange_address_is_ignored(show, scene):
    """An address with a design that is not there shows the first one, and nothing breaks."""
    browser = show(scene, address="#shown=77&compare=1.x_2")
    assert [browser.view("shown()"), browser.view("compared()")] == [0, None]
    assert browser.log() == []


def test_hostile_names_stay_text(show, scene):
    """Markup and formulas in names are shown as they are, and nothing in them runs."""
    scene["title"] = HOSTILE
    scene["part"]["name"] = FORMULA
    scene["kinds"][0] |= {"model": HOSTILE, "label": FORMULA}
    scene["designs"][0] |= {"name": HOSTILE, "group": "</script>" + HOSTILE, "note": HOSTILE}
    browser = show(scene)
    browser.find("#compare").click()
    assert browser.text("#title") == HOSTILE
    assert HOSTILE in browser.text("#designs")
    assert f"{FORMULA} {HOSTILE}" in browser.text("#panel")
    assert browser.driver.title.startswith(HOSTILE)
    assert browser.run("return document.querySelectorAll('img, script').length") == 2
    assert browser.log() == []


def test_a_foreign_script_does_not_run(show, scene):
    """The page's policy lets its own script in, and no other."""
    browser = show(scene)
    browser.run(
        "const other = document.createElement('script'); other.textContent = 'window.ran = 1';"
        "document.body.append(other)"
    )
    assert browser.run("return window.ran") is None


def test_keys_reach_everything(show, scene):
    """Arrow keys choose in the list and turn the picture; numbers give the views; all has focus."""
    from selenium.webdriver import Keys

    browser = show(scene)
    browser.run("document.getElementById('designs').focus()")
    press(browser, Keys.ARROW_DOWN)
    assert browser.view("shown()") == 1
    press(browser, Keys.END)
    assert browser.view("shown()") == 3
    assert browser.run(
        "return document.getElementById('designs').getAttribute('aria-activedescendant')"
    ) == browser.run("return document.querySelector('[aria-selected=true]').id")
    seen = []
    for _ in range(30):
        press(browser, Keys.TAB)
        seen.append(browser.run("const e = document.activeElement; return e.id || e.textContent"))
        outline = browser.run("return getComputedStyle(document.activeElement).outlineStyle")
        if seen[-1] in ("genes-0", "canvas", "fit"):
            assert outline != "none", seen[-1]
    assert {"compare", "pasted", "Top", "fit", "perspective", "canvas", "genes-0"} <= set(seen)
    browser.run("document.getElementById('canvas').focus()")
    for key in (Keys.ARROW_LEFT, Keys.ARROW_DOWN, "+", "-"):
        before = browser.view("spot(0)")
        press(browser, key)
        assert browser.view("spot(0)") != before, key


def test_the_views_look_along_the_axes(show, scene):
    """Keys and buttons turn to top, front and side: what is right and what is up is as in CAD."""
    browser = show(scene)
    browser.command("Emulation.setEmulatedMedia", features=[STILL])
    elements = browser.view("card()")["elements"]
    quarters = [scene["kinds"][each["kind"]]["height_mm"] / 4 for each in elements]
    plan = np.array([each["place"] for each in elements])
    plan[:, 2] += quarters  # a spot is a quarter up the element
    axes = {"1": (0, 1), "2": (0, 2), "3": (1, 2)}
    for key, (right, up) in axes.items():
        press(browser, key)
        seen = [browser.view(f"spot({number})") for number in range(len(elements))]
        scale = np.ptp([each["x"] for each in seen]) / np.ptp(plan[:, right])
        for spots, places in (
            ([each["x"] for each in seen], plan[:, right]),
            ([-each["y"] for each in seen], plan[:, up]),
        ):
            moved = np.subtract(spots, spots[0])
            np.testing.assert_allclose(moved, scale * (places - places[0]), atol=1e-6)


def test_hovering_tells_what_is_there(show, scene):
    """An element under the pointer is named with its index, coordinates and force."""
    from selenium.webdriver import ActionChains

    browser = show(scene)
    spot, canvas = browser.view("spot(0)"), browser.find("#canvas")
    size = canvas.size
    offset = round(spot["x"] - size["width"] / 2), round(spot["y"] - size["height"] / 2)
    ActionChains(browser.driver).move_to_element_with_offset(canvas, *offset).perform()
    browser.wait("!document.getElementById('tooltip').hidden")
    told = browser.find("#tooltip").text
    assert told == "Suction cup 15\nx \N{MINUS SIGN}128.57, y 15.71, z 100.00 mm\n69.0 N"


def test_dark_and_light_follow_the_machine(show, scene):
    """Page and picture change their colours together as soon as the machine turns dark."""
    browser = show(scene)
    for scheme, darkest, lightest in (("light", 200, 255), ("dark", 0, 60), ("light", 200, 255)):
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        browser.command("Emulation.setEmulatedMedia", features=features)
        within = f"(channel) => channel >= {darkest} && channel <= {lightest}"
        browser.wait(f"window.graspView.pixels().ground.every({within})")
        ground = "getComputedStyle(document.body).backgroundColor.match(/[0-9]+/g)"
        assert browser.run(f"return {ground}.map(Number).every({within})")


def test_a_phone_shows_one_column(show, scene):
    """On a screen of 390 pixels nothing overflows sideways, one design or two."""
    browser = show(scene)
    browser.command("Emulation.setDeviceMetricsOverride", **PHONE)
    paste(browser, "1 15\n3 39 50 66")
    for _ in range(2):
        assert browser.run("return document.documentElement.scrollWidth") <= 390
        over = browser.run(
            "return [...document.querySelectorAll('main *')].filter((e) =>"
            " e.getBoundingClientRect().right > 391 && e.offsetParent).map((e) => e.outerHTML)"
        )
        assert over == []
        browser.run("document.getElementById('compare').click()")


def test_print_hides_the_controls(show, scene):
    """A print has the picture on white, card and bill, and neither buttons nor the list."""
    browser = show(scene)
    browser.command("Emulation.setEmulatedMedia", media="print")
    browser.run("window.dispatchEvent(new Event('beforeprint'))")
    shown = browser.run(
        "return Object.fromEntries(['nav', '.controls', '#canvas', '#paper', '.card', '.sum',"
        " '[data-copy]'].map((s) => [s, document.querySelector(s).offsetParent !== null]))"
    )
    hidden = {"nav": False, ".controls": False, "#canvas": False, "[data-copy]": False}
    assert shown == {**hidden, "#paper": True, ".card": True, ".sum": True}
    corner = browser.run(
        "const p = document.getElementById('paper');"
        "return [...p.getContext('2d').getImageData(2, 2, 1, 1).data, p.width > 500]"
    )
    assert corner == [255, 255, 255, 255, True]


def test_without_webgl_the_rest_works(show, scene, browser):
    """Where there are no 3-D pictures a sentence says so, and the cards are there."""
    source = "HTMLCanvasElement.prototype.getContext = () => null;"
    added = browser.command("Page.addScriptToEvaluateOnNewDocument", source=source)
    try:
        show(scene)
    finally:
        browser.command("Page.removeScriptToEvaluateOnNewDocument", **added)
    assert "shows no 3-D pictures" in browser.text("#stage")
    browser.view("select(2)")
    assert "Meets FoS, distance and every goal." in browser.text("#panel")
    assert browser.log() == []


def test_faulty_genes_of_a_workbook_are_told(show, scene):
    """A design whose genes the option space does not have is named with its fault, not drawn."""
    scene["designs"][1]["genes"][0][1] = 9999
    browser = show(scene)
    browser.view("select(1)")
    assert "has the index 9999 where 1 to 28 are known." in browser.text("#panel")
    browser.view("select(0)")
    assert browser.log() == []


def test_the_first_picture_comes_at_once(show, scene):
    """The first picture of a mesh of 5 MB is there within two seconds, in software rendering."""
    scene["part"]["mesh"] = mesh_of_size(5)
    browser = show(scene)
    mark = "return performance.getEntriesByName('first-picture')[0].startTime"
    for _ in range(2):  # the machine may be busy: the page is as fast as its best try
        if browser.run(mark) > FIRST_PICTURE_MS:
            browser.driver.refresh()
    assert browser.run(mark) < FIRST_PICTURE_MS


def test_the_page_is_small(scene):
    """Without its data the page has less than a million bytes."""
    assert len(assembled(scene)) - len(json.dumps(scene)) < MOST_BYTES


def test_the_bundle_is_what_its_sources_build(tmp_path):
    """The committed bundle is, byte for byte, what npm makes of the sources."""
    npm = shutil.which("npm")
    if not npm:
        lack("npm is not here: install nodejs and npm")
    web = tmp_path / "web"
    shutil.copytree(WEB, web, ignore=shutil.ignore_patterns("node_modules"))
    if (WEB / "node_modules").is_dir():
        (web / "node_modules").symlink_to(WEB / "node_modules")
    else:
        install = [npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund"]
        done = subprocess.run(install, cwd=web, capture_output=True, text=True, check=False)  # noqa: S603
        if done.returncode:
            lack("the npm packages of the page are not here: run npm ci in grasp_xl/view/web")
    subprocess.run([npm, "run", "--silent", "build"], cwd=web, check=True, capture_output=True)  # noqa: S603
    assert (tmp_path / "viewer.js").read_bytes() == (VIEW / "viewer.js").read_bytes()


def test_the_lock_names_no_registry():
    """The lock of the build has exact versions, and no address that they came from."""
    lock = (WEB / "package-lock.json").read_text()
    assert "resolved" not in lock
    assert "http" not in lock
    wanted = json.loads((WEB / "package.json").read_text())["devDependencies"]
    assert wanted == {"esbuild": "0.28.2", "three": "0.187.0"}


def test_the_bundle_carries_its_licences():
    """The licence of three.js stands in the bundle, and nothing ends the script too early."""
    script = (VIEW / "viewer.js").read_text()
    assert "Permission is hereby granted, free of charge" in script
    assert "</script" not in script.lower()
    assert "<!--" not in script
