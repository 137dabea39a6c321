"""What a browser shows of reports: tests/report_browser.sh makes them.    report_browser.py CHROMIUM FOLDER"""
import json, re, sys
import h5py
import numpy as np
from browser import Browser

program, folder = sys.argv[1:]
browser = Browser(program, f"{folder}/profile")
failures = []


def check(what, ok, seen=""):
    if not ok:
        failures.append(f"{what}: {seen}")


def page(name, hash="", **how):
    browser.open(f"file://{folder}/{name}.html#{hash}", **how)


def canvas():
    """Where the first panel's canvas is, in whole pixels; all pages here have a ratio of 1."""
    box = browser.evaluate("(() => { const b = document.querySelector('canvas').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()")
    return [round(v) for v in box]


def panel():
    x, y, width, height = canvas()
    return browser.shot()[y:y + height, x:x + width]


def near(image, color, most=14):
    return np.abs(image - np.array(color)).max(axis=2) <= most


def box_of(mask):
    rows, columns = np.nonzero(mask.any(axis=1))[0], np.nonzero(mask.any(axis=0))[0]
    return columns[0], rows[0], columns[-1] + 1, rows[-1] + 1


def projection(points, size, right, up):
    """Pixels of points [frames][n][3], as the page projects what fills it, and its scale."""
    seen = np.stack([points @ np.array(right), points @ np.array(up)], axis=-1)
    low, high = seen.reshape(-1, 2).min(axis=0), seen.reshape(-1, 2).max(axis=0)
    margin = 0.05 * min(size)
    room = np.array([size[0] - 2 * margin, size[1] - margin - min(92, size[1] / 4)])
    scale = min(room / np.maximum(high - low, 1e-12))
    d = scale * (seen - (low + high) / 2)
    return np.stack([size[0] / 2 + d[..., 0], margin + room[1] / 2 - d[..., 1]], axis=-1), scale


def frames_of(name, first=None):
    with h5py.File(f"{folder}/{name}.vtkhdf") as file:
        steps = file["VTKHDF/Steps/Values"].shape[0]
        points = file["VTKHDF/Points"][:].astype(float).reshape(steps, -1, 3)
    return points[:, :first]


def colors_of(name, count=33):
    """Ends of the colormap, as they are lit from straight above."""
    html = open(f"{folder}/{name}.html").read()
    maps = json.loads(re.search(r'"sequential":(\[[^]]*\])', html).group(1))
    light = 0.42 + 0.34 + 0.28 * 0.55
    return [[int(text[k:k + 2], 16) * light for k in (1, 3, 5)] for text in (maps[0], maps[-1])]


def words():
    return browser.evaluate("document.getElementById('moment').textContent")


def at():
    return float(browser.evaluate("document.getElementById('scrub').value"))


# ---- A sheet of two Young's moduli from above, as it lies at first ----

def sheet_from_above():
    page("sheet", "view=top&at=0&edges=0&arrows=0&field=young")
    image, (soft, stiff) = panel(), colors_of("sheet")
    size = image.shape[1], image.shape[0]
    _, scale = projection(frames_of("sheet"), size, [1, 0, 0], [0, 1, 0])
    left, right = near(image, soft), near(image, stiff)
    box = box_of(left | right)
    check("width of the sheet", abs(box[2] - box[0] - 0.04 * scale) <= 2, (box, 0.04 * scale))
    check("height of the sheet", abs(box[3] - box[1] - 0.02 * scale) <= 2, (box, 0.02 * scale))
    half = 0.02 * 0.02 * scale**2
    check("soft area", abs(left.sum() / half - 1) < 0.02, left.sum() / half)
    check("stiff area", abs(right.sum() / half - 1) < 0.02, right.sum() / half)
    check("soft is left", box_of(left)[2] <= box_of(right)[0] + 2, (box_of(left), box_of(right)))
    check("words", words() == "t = 0 s", words())


def colors_of_a_frame():
    """Of one frame the colours go from its own least to its greatest; logarithms have ticks of powers of ten."""
    page("sheet", "at=0.5&field=energy_bending")
    whole = browser.evaluate("document.querySelector('.legend').textContent")
    page("sheet", "at=0.5&field=energy_bending&range=frame")
    check("a frame's own range", browser.evaluate("document.querySelector('.legend').textContent") != whole, whole)
    page("stiff", "at=1&field=young&view=top&edges=0&arrows=0")
    ticks = browser.evaluate("[...document.querySelectorAll('.legend s')].map((tick) => [tick.textContent, parseFloat(tick.style.left)])")
    check("powers of ten", [tick[0] for tick in ticks] == ["100 kPa", "1 MPa", "10 MPa", "100 MPa", "1 GPa"], ticks)
    check("evenly spaced", np.ptp(np.diff([tick[1] for tick in ticks])) < 0.1, ticks)


def lines():
    """A curve's name in the legend hides it."""
    page("rod", "at=0.5")
    blue = lambda image: (image[..., 2] > image[..., 0] + 60)[:-90].sum()
    before = blue(panel())
    browser.evaluate("[...document.querySelectorAll('.line')].find((button) => button.textContent === 'natural').click()")
    browser.settle()
    check("the natural shape is hidden", before > 100 and blue(panel()) == 0, (before, blue(panel())))


def sheet_sinks():
    """Seen against its length it reaches down to where its tip is."""
    for frame, begin in ((5, 0.5), (10, 1)):
        page("sheet", f"view=side&at={begin}&edges=0&arrows=0&field=young")
        image = panel()
        size = image.shape[1], image.shape[0]
        places, scale = projection(frames_of("sheet"), size, [0, 1, 0], [0, 0, 1])
        body = box_of((image.max(axis=2).astype(int) - image.min(axis=2) > 40)[:-92])
        check(f"the tip of frame {frame}", abs(body[3] - places[frame][:, 1].max()) <= 2, (body, places[frame][:, 1].max()))
        check(f"the width of frame {frame}", abs(body[2] - body[0] - 0.02 * scale) <= 2, (body, 0.02 * scale))


# ---- How it is used ----

def keys():
    page("sheet", "at=0")
    first = panel()
    browser.key("ArrowRight")
    check("a step", abs(at() - 0.1) < 1e-9 and words() == "t = 4 ms", (at(), words()))
    browser.key("End")
    check("the end", at() == 1 and words() == "t = 40 ms", words())
    browser.key("Home")
    check("the beginning again", (panel() == first).all())
    browser.key(" ")
    browser.evaluate("new Promise((done) => setTimeout(done, 300))")
    browser.key(" ")
    played = at()
    browser.settle()
    check("it plays, and stops", 0 < played < 1 and at() == played, (played, at()))
    browser.key("Home")
    browser.drag(*[v + 200 for v in canvas()[:2]], 60, 20)
    check("it turns", np.abs(panel() - first).max(axis=2).mean() > 1)
    browser.evaluate("document.activeElement.blur()")
    browser.key("0")
    check("and back", (panel() == first).all())
    browser.key("d")
    ground = browser.shot()[-1, 5]
    check("dark", ground.max() < 60, ground)


def calm():
    """Who wants less motion gets frames, and nothing in between."""
    page("sheet", "at=0", reduced_motion="reduce")
    seen = browser.evaluate("""new Promise((done) => { const seen = []; document.getElementById("play").click();
        const look = () => { seen.push(Number(document.getElementById("scrub").value)); seen.length < 40 ? requestAnimationFrame(look) : done(seen); };
        document.getElementById("speed").value = 2; look(); })""")
    check("whole frames", len(set(seen)) > 1 and all(abs(10 * at - round(10 * at)) < 1e-6 for at in seen), set(seen))


def lost():
    """The graphics card takes its things away and gives them back."""
    page("sheet", "at=0.5")
    before = panel()
    browser.evaluate("""(async () => { const draw = CanvasRenderingContext2D.prototype.drawImage; let canvas;
        CanvasRenderingContext2D.prototype.drawImage = function (from, ...rest) { canvas = from; return draw.call(this, from, ...rest); };
        window.dispatchEvent(new Event("beforeprint")); /* draws at once */
        const gl = canvas.getContext("webgl2"), lose = gl.getExtension("WEBGL_lose_context"), wait = () => new Promise((done) => setTimeout(done, 100));
        lose.loseContext(); await wait(); window.dispatchEvent(new Event("beforeprint")); await wait(); lose.restoreContext(); await wait(); })()""")
    browser.settle()
    check("all is there again", (panel() == before).all())


def printed():
    page("sheet", "theme=dark")
    check("it prints", len(browser.call("Page.printToPDF", printBackground=True)["data"]) > 20000)
    browser.settle()
    check("and is dark again", browser.shot()[-1, 5].max() < 60)


def touch():
    page("sheet", "at=0", width=390, height=800, mobile=True)
    x, y, width, height = canvas()
    check("nothing is wider than a phone", browser.evaluate("document.documentElement.scrollWidth") <= 390)
    before = (panel().max(axis=2) - panel().min(axis=2) > 40).sum()
    a, b = (x + width / 2, y + height / 2 - 30), (x + width / 2, y + height / 2 + 30)
    browser.touch([a, b], [(a[0], a[1] - 10), (b[0], b[1] + 10)], [(a[0], a[1] - 30), (b[0], b[1] + 30)])
    check("two fingers make it larger", (panel().max(axis=2) - panel().min(axis=2) > 40).sum() > 1.5 * before)


def theme():
    page("rod", color_scheme="dark")
    check("dark where that is preferred", browser.shot()[-1, 5].max() < 60)
    page("rod", "theme=light", color_scheme="dark")
    check("light where that is asked for", browser.shot()[-1, 5].min() > 200)


# ---- Rods and drawings ----

def rod():
    points = frames_of("rod", 41)
    for begin, frame in ((0, 0), (1, -1)):
        page("rod", f"view=front&at={begin}")
        image = panel()
        size = image.shape[1], image.shape[0]
        places, scale = projection(frames_of("rod"), size, [1, 0, 0], [0, 0, 1])
        inked = image.max(axis=2) - image.min(axis=2) > 60
        hits = [inked[round(v) - 1:round(v) + 2, round(u) - 1:round(u) + 2].any() for u, v in places[frame][:41]]
        check(f"the rod at {begin}", np.mean(hits) > 0.95, np.mean(hits))
        inked[-90:] = False  # axes and field
        inked &= image[..., 0] >= image[..., 2]  # the natural shape is blue
        orange = (image[..., 0].astype(int) - image[..., 2] > 60)[:-90].sum()
        seen = np.hypot(*np.diff(places[frame][:41], axis=0).T).sum() * 1.2e-3 * scale
        check(f"as thick as it is at {begin}", 0.85 < orange / seen < 1.3, orange / seen)
        far = inked & (np.abs(np.indices(inked.shape)[..., None] - places[frame][:41, ::-1].T[:, None, None, :]).max(axis=0).min(axis=2) > 30)
        check(f"nothing but the rod at {begin}", far.sum() < 200, far.sum())


def drawing():
    with h5py.File(f"{folder}/drawing.vtkhdf") as file:
        nodes, paper = file["slender/spline/nodes"][:, :2], file["slender/spline/paper"][:]
        start = file["slender/spline/strokes"][:]
    inks = []
    for begin in (1, 0.5):
        page("drawing", f"target=none&at={begin}", color_scheme="light")
        image = panel()
        height, width, _ = image.shape
        scale = min(width / paper[0], height / paper[1])
        corner = np.array([width, height]) / 2 - scale * paper / 2
        dark = 255 - image.min(axis=2)
        sheet = dark[int(corner[1]) + 2:int(corner[1] + scale * paper[1]) - 2, int(corner[0]) + 2:int(corner[0] + scale * paper[0]) - 2]
        inks.append(sheet.sum())
        if begin == 1:
            hits = [dark[round(v), round(u)] > 100 for u, v in corner + scale * nodes]
            check("ink at the nodes", np.mean(hits) > 0.98, np.mean(hits))
            length = sum(np.hypot(*np.diff(nodes[a:b], axis=0).T).sum() for a, b in zip(start, start[1:]))
            ratio = sheet.mean() / 255 / (0.6e-3 * length / paper.prod())
            check("as much ink as there is", 0.75 < ratio < 1.05, ratio)
    check("half of it half way", 0.45 < inks[1] / inks[0] < 0.58, inks)


def film():
    """A drawing as it relaxed has all of its strokes."""
    inks = []
    for shown, begin in (("ink", 1), ("film", 0.9), ("film", 0)):
        page("drawing", f"target=none&at={begin}&shown={shown}", color_scheme="light")
        image = panel()
        inks.append((255.0 - image.min(axis=2)).sum())
    check("words of a film", words() == "iteration 0", words())
    check("all strokes of a film", 0.8 < inks[1] / inks[0] < 1.2 and inks[2] > 0.3 * inks[0], inks)


# ---- What goes wrong ----

def two():
    page("two")
    check("two panels", browser.evaluate("document.querySelectorAll('canvas').length") == 2)
    check("one time", words() == "t = 40 ms", words())
    heads = browser.evaluate("[...document.querySelectorAll('.panel h2 small:last-child')].map((head) => head.textContent)")
    check("each with its moment", heads[0] == "t = 0.04 s" and heads[1].startswith("t = "), heads)


def pair():
    """Runs of a sweep have their folders and what was varied in their heads, and among their facts."""
    page("pair")
    heads = browser.evaluate("[...document.querySelectorAll('.panel h2')].map((head) => [head.firstChild.textContent, head.querySelector('.differs').textContent])")
    check("names", heads == [["soft/0001.vtkhdf", "shell.thickness 0.001"], ["thick/0001.vtkhdf", "shell.thickness 0.002"]], heads)
    check("among the facts", "shell.thickness" in browser.evaluate("document.getElementById('words').querySelector('table').textContent"))


def mixed():
    """A motion beside stages: each chart has the mark of its own result, the bar says where both are."""
    page("mixed", "at=0.5")
    check("both moments", words() == "t = 0.02 s | stage 1: 1 mT", words())
    marks = browser.evaluate("[...document.querySelectorAll('#charts svg')].map((svg) => svg.querySelector('.now').getAttribute('visibility') + Math.round(svg.querySelector('.now').getAttribute('x1')))")
    check("marks half way", len(marks) >= 3 and set(marks) <= {"visible233", "visible234"}, marks)


def stages():
    """Charts over what a sequence goes through have the line of the stage; arrows are red, lighter in the dark."""
    page("stages", "theme=dark&at=0.5&field=&edges=0&view=top")
    places = browser.evaluate("[...document.querySelectorAll('#charts .now')].map((line) => line.getAttribute('visibility') + Number(line.getAttribute('x1')))")
    check("lines of the stage", len(places) == 2 and set(places) == {"visible233"}, places)
    names = browser.evaluate("document.getElementById('charts').textContent")
    check("with a prefix", "flux density, mT" in names, names)
    inks = panel()[:-90].astype(int)
    check("red arrows", (np.abs(inks - [255, 106, 87]).max(axis=2) < 12).sum() > 100)


def clamped():
    """A moment before the first or after the last one is that; what is no number is the last."""
    for asked, seen in (("2", 1), ("-1", 0), ("x", 1), ("", 0)):
        page("sheet", f"at={asked}")
        check(f"at={asked}", at() == seen and words() == ("t = 40 ms" if seen else "t = 0 s"), (at(), words()))


def design():
    """The objective's chart has the line of the evaluation; all numbers of an axis are said in one way; arrows have a scale."""
    page("design", "at=0")
    place = lambda: browser.evaluate("(() => { const chart = [...document.querySelectorAll('#charts svg')].find((svg) => svg.textContent.includes('evaluation')), now = chart.querySelector('.now'); return [now.getAttribute('visibility'), Number(now.getAttribute('x1'))]; })()")
    check("the start", place() == ["visible", 58], place())
    browser.key("End")
    browser.settle()
    check("the best", place()[0] == "visible" and place()[1] > 100, place())
    check("the scale of arrows", "\u2192 " in browser.evaluate("document.querySelector('.magnetization').textContent"))
    ticks = browser.evaluate("[sayTicks([1e-4, 1e-3, 1e-2], '', true), sayTicks([0, 5e-4, 1e-3], 'J'), sayTicks([0, 5e-4, 1e-3], '')]")
    check("two ticks", browser.evaluate("roundTicks(-4.4, 4.3, 4, false)") == [-4, -2, 0, 2, 4])
    check("one way", ticks == [["1e-4", "1e-3", "1e-2"], ["0 mJ", "0.5 mJ", "1 mJ"], ["0", "5e-4", "1e-3"]], ticks)


def filled():
    """A flat body fills the panel's width or height, and nothing of it is where the gauges are."""
    page("sheet", "view=top&at=0&edges=0&arrows=0&field=young&theme=light")
    image = panel().astype(int)
    seen = box_of((image.max(axis=2) - image.min(axis=2))[:-92] > 40)
    size = image.shape[1], image.shape[0] - 92
    check("fills the panel", max((seen[2] - seen[0]) / size[0], (seen[3] - seen[1]) / size[1]) > 0.85, (seen, size))


def flux():
    """Blue arrows above the north pole point away from it; b takes them away and brings them back; the scale is told."""
    page("magnet", "theme=light&view=front&field=&arrows=0&edges=0")
    legend = browser.evaluate("[...document.querySelectorAll('.legend:not([hidden])')].map((one) => one.textContent).join()")
    check("the scale of the field", "mT" in legend and "flux density" in legend, legend)
    blue = lambda: (lambda image: (image[..., 2] - image[..., 0] > 40) & (image[..., 2] - image[..., 1] > 15))(panel()[:-90].astype(int))
    seen = blue()
    check("arrows around", seen.sum() > 1500 and seen[:, :seen.shape[1] // 2].any() and seen[:, seen.shape[1] // 2:].any(), seen.sum())
    browser.key("b")
    browser.settle()
    check("none of them", blue().sum() < 100 and browser.evaluate("document.querySelectorAll('.legend[hidden]').length") == 1, blue().sum())
    browser.key("b")
    browser.settle()
    check("they are back", (blue() == seen).all())
    page("magnet", "flux=0&theme=light&view=front&field=&arrows=0")
    check("as asked for", blue().sum() < 100)


def broken():
    html = open(f"{folder}/sheet.html").read()
    open(f"{folder}/broken.html", "w").write(re.sub(r'(<script id="block" type="text/plain">.{200})[^<]*', r"\1", html))
    try:
        page("broken")
        check("a broken page says so", False)
    except RuntimeError as error:
        check("a broken page says so", "cannot be read" in str(error), error)


for part in (sheet_from_above, colors_of_a_frame, lines, sheet_sinks, keys, calm, lost, printed, touch, theme, rod, drawing, film, two, pair, mixed, stages, clamped, design, filled, flux):
    part()
check("no errors", not browser.errors, browser.errors)
broken()
browser.close()
for failure in failures:
    print(failure)
sys.exit(bool(failures))
