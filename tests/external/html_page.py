# SPDX-License-Identifier: Apache-2.0
"""Opens pages that vdb_shell wrote in a headless Chromium, from a file and without a network, and
looks at what they show.

    html_page.py VDB_SHELL FOLDER_OF_BROWSER_PY MESH

Ends with 77 where Chromium or VTK, which reads the pictures, is not installed."""

import pathlib
import subprocess
import sys
import tempfile

PROGRAM, SCRIPTS, MESH = sys.argv[1:4]
sys.path.insert(0, SCRIPTS)
from browser import Browser, find_chromium  # noqa: E402

try:
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)
if not find_chromium():
    print("skipped: there is no chromium")
    sys.exit(77)

WIDTH, HEIGHT = 900, 600
STAGE = WIDTH - 348  # the rest are the controls
EVIL = 'a"b<img src=x onerror=alert(1)>&amp;.obj'
DEPTH_SCALE = ["f4e6cc", "efb27a", "d86a4d", "9c3a5e", "54246b", "1f1646"]  # of colours.js
failures = []


def expect(fact, what):
    print("ok     " if fact else "FAILED ", what)
    if not fact:
        failures.append(what)


def pixels(png):
    """Rows from the top, of red, green and blue."""
    with tempfile.NamedTemporaryFile(suffix=".png") as file:
        file.write(png)
        file.flush()
        reader = vtk.vtkPNGReader()
        reader.SetFileName(file.name)
        reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return values.reshape(height, width, -1)[::-1, :, :3].astype(int)


def stage(browser):
    """What is drawn of the shell, without title, legend and controls."""
    return pixels(browser.picture())[60:500, :STAGE - 60]


def shell_pixels(picture):
    """The background is grey, and nearly the same along a row."""
    return numpy.abs(picture - picture[:, :1]).max(axis=2) > 24


def difference(a, b):
    return (numpy.abs(a - b).max(axis=2) > 24).mean()


def run(*words):
    subprocess.run([PROGRAM, *map(str, words)], check=True)


def say(browser, script):
    value = browser.evaluate(script)
    browser.settle()
    return value


def choose(browser, name, value):
    event = "change" if name == "colour" else "input"
    say(browser, f"{{ const control = document.getElementById('{name}'); control.value = '{value}'; "
                 f"control.dispatchEvent(new Event('{event}', {{ bubbles: true }})); }}")


def press(browser, selector):
    say(browser, f"document.querySelector('{selector}').click()")


def pyramid_over_u(path):
    """No point inside sees all sides of its apex, which is therefore pinned."""
    corners = [(0, 0, 0), (3, 0, 0), (3, 3, 0), (2, 3, 0), (2, 1, 0), (1, 1, 0), (1, 3, 0), (0, 3, 0), (1.5, 0.5, 2)]
    faces = [(i, (i + 1) % 8, 8) for i in range(8)]
    for a, b, c, d in ((0, 1, 4, 5), (0, 5, 6, 7), (1, 2, 3, 4)):
        faces += [(a, c, b), (a, d, c)]
    path.write_text("".join("v %g %g %g\n" % p for p in corners) +
                    "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces))


def make(folder):
    mesh = folder / EVIL
    mesh.write_bytes(pathlib.Path(MESH).read_bytes())
    run("build", mesh, "--resolution", 32, "--layers", 2, "-q", "-o", folder / "one.html", "-o", folder / "rest.vdb")
    lines = []
    for line in mesh.read_text().splitlines():
        words = line.split()
        if words and words[0] == "v":
            line = f"v {2 * float(words[1])} {words[2]} {words[3]}"
        lines.append(line)
    (folder / "long.obj").write_text("\n".join(lines) + "\n")
    pyramid_over_u(folder / "u.obj")
    run("build", folder / "u.obj", "--resolution", 32, "-q", "-o", folder / "pinned.html")
    run("pose", folder / "rest.vdb", folder / "long.obj", "-q", "-o", folder / "pose.0002.vdb")
    (folder / "rest.vdb").rename(folder / "pose.0001.vdb")
    run("page", folder / "pose.####.vdb", "--frames", "1-2", "-o", folder / "two.html")


def look_at_one(browser, page):
    browser.open(page, "#axis=none&view=0,0")
    expect(EVIL in browser.evaluate("document.querySelector('h1').textContent"), "the title is the name as text")
    expect(browser.evaluate("document.images.length") == 0, "no name is a tag")
    whole = stage(browser)
    seen = shell_pixels(whole).mean()
    expect(0.1 < seen < 0.9, f"the shell covers a part of the canvas ({seen:.2f})")

    press(browser, "[data-axis=z]")
    choose(browser, "cut", 0.5)
    cut = stage(browser)
    expect(abs(shell_pixels(cut).mean() - seen) < 0.35, "half of it is left")
    for colour in DEPTH_SCALE:
        wanted = numpy.array([int(colour[i:i + 2], 16) for i in (0, 2, 4)])
        share = (numpy.abs(cut - wanted).max(axis=2) < 26).mean()
        before = (numpy.abs(whole - wanted).max(axis=2) < 26).mean()
        if colour != DEPTH_SCALE[0]:
            expect(share > 0.002 > before, f"depth {colour} is on the cut alone, which is solid ({share:.3f})")

    pictures = {"depth": cut}
    for colour in ("quality", "thickness", "stop", "layer", "plain"):
        choose(browser, "colour", colour)
        pictures[colour] = stage(browser)
        for other in list(pictures)[:-1]:
            share = difference(pictures[other], pictures[colour])
            expect(share > 0.03, f"{colour} does not look as {other} ({share:.2f})")
    choose(browser, "colour", "depth")
    expect(difference(stage(browser), cut) < 0.001, "the same state is the same picture")

    press(browser, "[data-axis=none]")
    choose(browser, "peel", 0.4)
    peeled = shell_pixels(stage(browser)).mean()
    expect(0.02 < peeled < seen - 0.02, f"without its outer part it is smaller ({peeled:.2f})")
    choose(browser, "peel", 0)
    choose(browser, "first", 2)
    inner = shell_pixels(stage(browser)).mean()
    expect(0.02 < inner < seen - 0.02, f"without its outer layer it is smaller ({inner:.2f})")
    choose(browser, "first", 1)
    expect(difference(stage(browser), whole) < 0.001, "and whole again")


def use_hands(browser, page):
    browser.open(page, "#axis=none&view=0,0")
    whole = stage(browser)
    browser.drag((STAGE / 2, HEIGHT / 2), (STAGE / 2 + 80, HEIGHT / 2))
    expect(difference(stage(browser), whole) > 0.05, "it is turned by a drag")
    browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=200, y=300, deltaX=0, deltaY=-80)
    near = shell_pixels(stage(browser)).mean()
    expect(near > 1.1 * shell_pixels(whole).mean(), "it is nearer after the wheel")
    browser.click(STAGE / 2, HEIGHT / 2)
    rows = browser.evaluate("document.querySelector('#picked table').innerText")
    expect("vertex" in rows and "thickness" in rows and "pillar ends for" in rows, "a click tells a vertex's figures")
    browser.click(12, HEIGHT / 2)
    expect(browser.evaluate("document.querySelector('#picked table').innerText") == "", "beside it there are none")
    expect(browser.evaluate("document.querySelectorAll('.chart rect').length") > 8, "there are histograms")
    expect(browser.evaluate("document.querySelectorAll('#report tr').length") > 2, "there are tables")
    browser.set_scheme("dark")
    dark = stage(browser)[:, :5].mean()
    press(browser, "#theme")
    light = stage(browser)[:, :5].mean()
    expect(dark < 60 and light > 190, f"light and dark ({light:.0f}, {dark:.0f})")
    browser.set_scheme("light")


def touch(browser, page):
    browser.open(page, "#axis=none&view=0,0")
    before = shell_pixels(stage(browser)).mean()
    for step in (60, 64, 68):
        points = [{"x": STAGE / 2 + side * step, "y": HEIGHT / 2, "id": 1 + (side > 0)} for side in (-1, 1)]
        browser.call("Input.dispatchTouchEvent", type="touchStart" if step == 60 else "touchMove", touchPoints=points)
    browser.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
    after = shell_pixels(stage(browser)).mean()
    expect(after > 1.1 * before, f"two fingers zoom ({before:.2f}, {after:.2f})")


def pin_pixels(browser):
    picture = pixels(browser.picture())[:, :STAGE]
    return (numpy.abs(picture - [0xe3, 0x17, 0x3e]).max(axis=2) < 12).sum()


def see_pins(browser, page):
    browser.open(page, "#axis=none&colour=plain&edges=0&view=0,0")
    red = pin_pixels(browser)
    expect(red > 10, f"pinned vertices are marked ({red} pixels)")
    choose_off = "{ const box = document.getElementById('pins'); box.checked = false; " \
                 "box.dispatchEvent(new Event('change')); }"
    say(browser, choose_off)
    expect(pin_pixels(browser) == 0, "unless that is not wanted")


def look_at_two(browser, page):
    browser.open(page, "#axis=none")
    first = stage(browser)
    choose(browser, "frame", 1)
    browser.wait_for("document.documentElement.dataset.frame === '1'")
    expect(difference(first, stage(browser)) > 0.05, "the frames differ")
    expect(browser.evaluate("document.getElementById('frame-label').textContent") == "pose.0002", "and say which")
    browser.evaluate("document.getElementById('play').click()")
    browser.wait_for("document.documentElement.dataset.frame === '0'")
    browser.evaluate("document.getElementById('play').click()")
    browser.resize(390, 844, True)
    browser.settle()
    expect(browser.evaluate("document.documentElement.scrollWidth") <= 390, "a phone scrolls in one direction")
    apart = """(() => { const [a, b, c] = ['legend', 'time', 'title'].map(id => document.getElementById(id)
               .getBoundingClientRect()); return a.bottom <= b.top && c.bottom <= a.top && a.right <= 390; })()"""
    expect(browser.evaluate(apart), "nothing lies over anything on a phone")
    browser.resize(WIDTH, HEIGHT)


with tempfile.TemporaryDirectory() as name, Browser(WIDTH, HEIGHT) as browser:
    folder = pathlib.Path(name)
    make(folder)
    look_at_one(browser, folder / "one.html")
    use_hands(browser, folder / "one.html")
    look_at_two(browser, folder / "two.html")
    see_pins(browser, folder / "pinned.html")
    touch(browser, folder / "one.html")
    expect(browser.console == [], f"no message on the console and nothing from the network {browser.console}")
    # The last, as it breaks what it looks at.
    damaged = (folder / "one.html").read_text().replace('id="shell">', 'id="shell">AAAA')
    (folder / "damaged.html").write_text(damaged)
    browser.call("Page.navigate", url=(folder / "damaged.html").as_uri())
    browser.wait_for("document.getElementById('message')?.textContent.startsWith('This page cannot be shown')")
    expect(True, "a damaged page says so")
sys.exit(1 if failures else 0)
