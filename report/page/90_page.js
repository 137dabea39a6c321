/* The page: one state, what is shown of it, and how it begins. */

/* One report's state. Panels ask it for colours and the camera; it tells them the moment. */
function makePage(data) {
  const page = { data, camera: { ...CAMERA_START }, renderer: makeRenderer(() => page.redraw()), at: 1, playing: false, panels: [], charts: [], hidden: new Set(),
                 choice: { field: null, target: "over", range: "whole", shown: "ink", arrows: true, flux: true, edges: true } };
  Object.defineProperty(page, "ratio", { get: () => window.devicePixelRatio || 1 }); /* it changes with the browser's zoom */
  const fields = data.results.flatMap(fieldsOf);
  page.fieldNames = [...new Set(fields.map((one) => one.name))];
  page.greatestFlux = Math.max(extent(data.results.flatMap((result) => (result.flux || []).map(Math.abs))).high, 1e-30);

  page.fluxScale = fluxScaleOf(data.results);
  page.differences = new Map(differencesOf(data.results).map((one, k) => [data.results[k], one]));

  /* One for all results, so that colours can be compared: of all frames, or of the one that is shown. */
  page.scale = null;
  page.scaleFrames = () => {
    const name = page.choice.field, shown = page.choice.range === "frame";
    const ranges = page.panels.map((panel) => panel.field()).flatMap((field, k) =>
      field ? [shown ? extent(rowNear(field.values, page.frameOf(page.panels[k]))) : field.values] : []);
    const low = Math.min(...ranges.map((one) => one.low)), high = Math.max(...ranges.map((one) => one.high));
    const scale = ranges.length ? makeScale(data.colormaps, low, high, low > 0 && high > low && fields.some((one) => one.name === name && one.values.log)) : null;
    if (JSON.stringify(scale) === JSON.stringify(page.scale)) return;
    page.scale = scale;
    showLegends(page);
  };
  page.unitOf = (name) => fields.find((one) => one.name === name).unit;
  page.color = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  page.dark = () => document.documentElement.dataset.theme === "dark";
  /* A curve's colour, light enough on a dark ground. */
  page.ink = (color) => parseColor(color).map((c) => (page.dark() ? 70 + 0.73 * c : c));
  page.times = () => page.panels.filter((panel) => panel.times).flatMap((panel) => panel.times);
  page.timed = () => page.panels.some((panel) => panel.times) && page.panels.every((panel) => panel.times || panel.count < 2);

  /* Where in its frames a panel is; frames that are moments all stand at one time. */
  page.frameOf = (panel) => {
    if (panel.paper) return page.at;
    if (!page.timed() || !panel.times) return page.at * (panel.count - 1);
    const now = page.time();
    let k = panel.times.findIndex((t) => t >= now);
    if (k <= 0) return k < 0 ? panel.count - 1 : 0;
    return k - (panel.times[k] - now) / (panel.times[k] - panel.times[k - 1] || 1);
  };
  page.time = () => {
    const { low, high } = extent(page.times());
    return low + page.at * (high - low);
  };

  /* s, of a panel whose frames are moments; beside others that are none each is at its own. */
  page.timeOf = (panel) => {
    if (page.timed() || !panel.times) return page.timed() ? page.time() : NaN;
    const at = page.frameOf(panel), k = Math.min(Math.floor(at), panel.count - 1), next = Math.min(k + 1, panel.count - 1);
    return panel.times[k] + (at - k) * (panel.times[next] - panel.times[k]);
  };

  /* One time for all; of two results that have none in common what each shows, of more how far they are. */
  page.words = () => {
    if (page.timed()) return `t = ${say(page.time(), "s")}`;
    const moving = page.panels.filter((one) => one.count > 1), shown = moving.length ? moving : page.panels.slice(0, 1);
    const words = [...new Set(shown.map((panel) => panel.label(page.frameOf(panel))))];
    return words.length > 2 ? `${Math.round(100 * page.at)} % of each` : words.join(" | ");
  };

  let asked = false;
  page.redraw = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; page.draw(); });
  };
  page.draw = () => {
    page.scaleFrames();
    for (const panel of page.panels) panel.draw(page.frameOf(panel)), panel.head.textContent = page.panels.length > 1 ? panel.label(page.frameOf(panel)) : "";
    for (const { chart, kind, panel } of page.charts) {
      if (kind === "stage") chart.markRow(panel.stageOf(page.frameOf(panel)));
      if (kind === "t") chart.mark(page.timeOf(panel));
      if (kind === "evaluation") chart.mark(panel.evaluationOf(page.frameOf(panel)));
      if (kind === "iteration") chart.mark(panel.iteration(page.frameOf(panel)));
    }
    document.getElementById("scrub").value = page.at;
    document.getElementById("moment").textContent = page.words();
  };
  page.go = (at) => { page.at = Math.min(Math.max(at, 0), 1); page.redraw(); };
  /* The moments that are frames of some panel, 0..1 in order; of a drawing hundredths of its ink. */
  page.stops = () => {
    const times = page.timed() ? page.times() : [], { low: first, high: last } = extent(times), all = last - first || 1;
    const most = Math.max(...page.panels.map((panel) => (panel.paper ? 101 : panel.count)), 2) - 1;
    const stops = times.length ? times.map((t) => (t - first) / all) : Array.from({ length: most + 1 }, (_, k) => k / most);
    return [...new Set(stops)].sort((a, b) => a - b);
  };
  page.step = (frames) => {
    const stops = page.stops(), nearest = stops.findIndex((stop) => stop >= page.at - 1e-9), here = nearest < 0 ? stops.length - 1 : nearest;
    const between = frames > 0 && stops[here] > page.at + 1e-9 ? 1 : 0; /* the next one is at hand */
    page.go(stops[Math.min(Math.max(here + frames - between, 0), stops.length - 1)]);
  };
  page.first = CAMERA_START;
  page.look = (camera) => { Object.assign(page.camera, { zoom: 1, panX: 0, panY: 0 }, camera); page.first = camera; page.redraw(); };
  page.play = (on) => {
    page.playing = on;
    document.getElementById("play").textContent = on ? "\u275a\u275a" : "\u25b6";
    if (!on) return;
    let last = performance.now(), now_at = page.at >= 1 ? 0 : page.at;
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches, stops = page.stops();
    const tick = (now) => {
      if (!page.playing) return;
      now_at = Math.min(now_at + (now - last) / 1000 / Number(document.getElementById("speed").value), 1);
      last = now;
      page.go(calm ? stops.findLast((stop) => stop <= now_at) : now_at); /* from frame to frame, nothing in between */
      if (now_at >= 1) page.play(false);
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  };
  return page;
}

/* ---- What is on it ---- */

function node(name, properties, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

function addPanel(page, result) {
  const panel = result.drawing ? makePaperPanel(result, page) : makeSpacePanel(result, page);
  const readout = node("div", { className: "readout" }), legend = node("div", { className: "legend" }), arrows = node("div", { className: "legend" });
  panel.canvas.setAttribute("aria-label", `${result.name}: drag turns it, the wheel zooms`);
  panel.legend = legend, panel.arrowLegend = arrows, panel.head = node("small", {});
  document.getElementById("panels").append(
    node("article", { className: "panel" }, node("h2", {}, result.name, node("small", {}, result.status || ""), node("small", { className: "differs" }, page.differences.get(result).map((one) => one.join(" ")).join(", ")), panel.head),
         node("div", { className: "stage" }, panel.canvas, readout), legend, arrows));
  if (result.no_arrows) panel.head.before(node("small", { textContent: `no arrows of the flux density: ${result.no_arrows}` }));
  if (panel.count === 0) panel.canvas.remove();
  addPointer(panel, page, readout);
  page.panels.push(panel);
  for (const one of result.charts) {
    const chart = makeChart(one, page.data.results.length > 1 ? result.name : "");
    page.charts.push({ chart, kind: one.of_stages ? "stage" : one.x.label, panel });
    document.getElementById("charts").append(chart.svg);
  }
  addWords(page, result);
}

function addWords(page, result) {
  const many = page.data.results.length > 1, of = many ? ` of ${result.name}` : "", words = document.getElementById("words");
  const rows = [...page.differences.get(result), ...result.facts].map(([name, value]) => node("tr", {}, node("th", { textContent: name }), node("td", { textContent: value })));
  if (rows.length) words.append(node("details", { open: !many }, node("summary", { textContent: `facts${of}` }), node("table", {}, ...rows)));
  if (result.scene) words.append(node("details", {}, node("summary", { textContent: `the scene${of}` }), node("pre", { textContent: result.scene })));
}

function showLegends(page) {
  const name = page.choice.field, { scale } = page;
  for (const { legend, field, lines, magnetization, held } of page.panels) {
    legend.replaceChildren(...lines.map(([name, color]) => lineSwitch(page, name, color)));
    legend.classList.toggle("ticked", Boolean(scale && scale.log && field()));
    if (scale && field()) legend.append(say(scale.low, page.unitOf(name)), colorBar(scale, page.unitOf(name)), say(scale.high, page.unitOf(name)),
                               node("span", { className: "faint", textContent: name.replaceAll("_", " ") }));
    if (held) legend.append(node("span", { textContent: "\u25cf held" }));
    if (magnetization && page.choice.arrows) legend.append(node("span", { className: "magnetization", textContent: `\u2192 ${say(magnetization, "A/m")}`, title: "the longest arrow of the magnetisation" }));
  }
  showFluxLegends(page);
}

/* How long and how strong an arrow of the flux density is. */
function showFluxLegends(page) {
  for (const { arrowLegend, arrows } of page.panels) {
    const shown = arrows && page.choice.flux, { low, high } = page.fluxScale || {};
    arrowLegend.hidden = !shown;
    if (!shown) continue;
    const ink = parseColor(page.color("--accent")), color = (size) => [...ink, fluxAlpha(fluxPart(page.fluxScale, size))];
    arrowLegend.classList.add("ticked");
    arrowLegend.replaceChildren(say(low, "T"), colorBar({ low, high, log: high > low, color }, "T"), say(high, "T"),
                                node("span", { className: "faint", textContent: "flux density: arrows by its logarithm", title: "the weakest are 0.3 as long as the strongest" }));
  }
}

/* A curve's name, which hides it and shows it again. */
function lineSwitch(page, name, color) {
  const button = node("button", { type: "button", textContent: name, title: "hide or show", className: "line" });
  button.style.color = `rgb(${page.ink(color)})`;
  button.setAttribute("aria-pressed", !page.hidden.has(name));
  button.addEventListener("click", () => {
    if (!page.hidden.delete(name)) page.hidden.add(name);
    showLegends(page);
    page.redraw();
  });
  return button;
}

function cssColor([r, g, b, a = 1]) {
  return `rgb(${[r, g, b].map(Math.round)}, ${a})`;
}

/* The colours from the least to the greatest, with powers of ten where they are of logarithms. */
function colorBar(scale, unit) {
  const { low, high, log } = scale, at = (t) => (log ? low * (high / low) ** t : low + (high - low) * t);
  const bar = node("i", {});
  bar.style.background = `linear-gradient(to right, ${Array.from({ length: 17 }, (_, i) => cssColor(scale.color(at(i / 16))))})`;
  for (const tick of log ? powerTicks(low, high) : []) {
    const mark = bar.appendChild(node("s", { textContent: say(tick, unit) }));
    mark.style.left = `${(100 * Math.log(tick / low)) / Math.log(high / low)}%`;
  }
  return bar;
}

function addChoices(page) {
  const bar = document.getElementById("choices"), results = page.data.results;
  const has = (key) => results.some((result) => result[key]), body = has("body");
  const set = (key) => (value) => { page.choice[key] = value; page.redraw(); };
  const fields = addSelect(bar, "colours", [...page.fieldNames.map((name) => [name, name.replaceAll("_", " ")]), ["", "none"]], page.choice.field, set("field"));
  const changes = results.some((result) => fieldsOf(result).some((one) => one.values.rows > 1));
  if (changes) addSelect(bar, "from", [["whole", "all frames"], ["frame", "this frame"]], page.choice.range, set("range"));
  const lines = results.some((result) => (result.curves || []).some((curve) => curve.of)), clouds = results.some((result) => result.clouds && result.clouds.sets.length);
  const targets = has("target") ? [["over", "over"], ["beside", "beside"], ["none", "hidden"]] : clouds || lines ? [["over", "shown"], ["none", "hidden"]] : has("drawing") ? [["none", "hidden"], ["beside", "beside"]] : [];
  const target = addSelect(bar, "target", targets, page.choice.target, set("target"));
  if (results.some((result) => result.drawing && result.drawing.film)) addSelect(bar, "shown", [["ink", "stroke by stroke"], ["film", "as it relaxed"]], page.choice.shown, set("shown"));
  const arrows = results.some((result) => result.body && result.body.magnetization) ? addSwitch(bar, "magnetisation", page.choice.arrows, (on) => { set("arrows")(on); showLegends(page); }) : null;
  const flux = page.fluxScale ? addSwitch(bar, "flux density", page.choice.flux, (on) => { set("flux")(on); showLegends(page); }) : null;
  const edges = body ? addSwitch(bar, "edges", page.choice.edges, set("edges")) : null;
  if (results.some((result) => !result.drawing)) addSelect(bar, "view", [["", "free"], ...Object.keys(VIEWS).map((name) => [name, name])], "", (name, select) => { page.look(VIEWS[name]); select.value = ""; });
  const theme = node("button", { type: "button", textContent: "light / dark" });
  theme.addEventListener("click", () => setTheme(page, page.dark() ? "light" : "dark"));
  bar.append(theme);
  const next = (select) => () => { if (select) (select.selectedIndex = (select.selectedIndex + 1) % select.length), select.dispatchEvent(new Event("change")); };
  addKeys(page, { f: next(fields), t: next(target), m: () => arrows && arrows.click(), b: () => flux && flux.click(), e: () => edges && edges.click(), d: () => theme.click() });
}

function setTheme(page, theme) {
  document.documentElement.dataset.theme = theme;
  showLegends(page);
  page.redraw();
}

/* What is printed is light, whatever is seen. */
function addPrinting(page) {
  let seen = "light";
  window.addEventListener("beforeprint", () => { seen = document.documentElement.dataset.theme; document.documentElement.dataset.theme = "light"; page.draw(); });
  window.addEventListener("afterprint", () => setTheme(page, seen));
}

/* "#at=0.5&field=young&theme=dark&target=beside": how it begins. */
function readHash(page) {
  const asked = new URLSearchParams(location.hash.slice(1));
  if (asked.has("field")) page.choice.field = asked.get("field");
  if (asked.has("shown")) page.choice.shown = asked.get("shown") === "film" ? "film" : "ink";
  if (asked.has("range")) page.choice.range = asked.get("range") === "frame" ? "frame" : "whole";
  if (asked.has("target")) page.choice.target = asked.get("target");
  if (asked.has("view") && VIEWS[asked.get("view")]) page.look(VIEWS[asked.get("view")]);
  if (asked.has("arrows")) page.choice.arrows = asked.get("arrows") !== "0";
  if (asked.has("flux")) page.choice.flux = asked.get("flux") !== "0";
  if (asked.has("edges")) page.choice.edges = asked.get("edges") !== "0";
  const dark = asked.get("theme") || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  document.documentElement.dataset.theme = dark;
  const at = asked.has("at") ? Number(asked.get("at")) : 1;
  return Number.isFinite(at) ? Math.min(Math.max(at, 0), 1) : 1;
}

async function start() {
  const page = makePage(await readDocument()), results = page.data.results;
  document.getElementById("title").textContent = results.length > 1 ? `${results.length} results` : results[0].name;
  page.choice.field = results.map(({ body }) => body && body.opens).find(Boolean) || ""; /* curves have their own inks */
  if (results.every((result) => result.drawing)) page.choice.target = "beside";
  page.at = readHash(page);
  if (page.choice.field && !page.fieldNames.includes(page.choice.field)) page.choice.field = "";
  results.forEach((result) => addPanel(page, result));
  addChoices(page);
  showLegends(page);
  const scrub = document.getElementById("scrub");
  scrub.addEventListener("input", () => { page.play(false); page.go(Number(scrub.value)); });
  document.getElementById("play").addEventListener("click", () => page.play(!page.playing));
  document.getElementById("transport").hidden = page.panels.every((panel) => panel.count < 2);
  new ResizeObserver(() => page.redraw()).observe(document.getElementById("panels"));
  addPrinting(page);
  window.addEventListener("hashchange", () => location.reload());
  page.draw();
  if (!page.renderer) document.getElementById("panels").prepend("This browser has no WebGL 2: bodies cannot be shown.");
  document.documentElement.dataset.ready = String(Math.round(performance.now()));
}

start().catch((error) => document.getElementById("panels").prepend(`This report cannot be read: ${error.message}`));
