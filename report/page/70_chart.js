/* Charts as SVG: lines over time, stages or evaluations, with a line at the moment that is shown. */

const SVG = "http://www.w3.org/2000/svg";
const CHART = { width: 420, height: 210, left: 58, right: 12, top: 26, bottom: 34 };

function svgNode(name, attributes, text) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

/* Round numbers within low..high; of whole numbers whole ones. */
function roundTicks(low, high, wanted, whole) {
  const raw = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(raw));
  let step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw * 0.999);
  if (whole) step = Math.max(1, Math.round(step));
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * (high - low); k++) ticks.push(k * step);
  return ticks.length > 1 || wanted > 20 ? ticks : roundTicks(low, high, 2 * wanted, whole); /* one tells no scale */
}

function powerTicks(low, high) {
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9), by = Math.max(1, Math.ceil((last - first) / 5));
  const ticks = [];
  for (let k = first; k <= last; k += by) ticks.push(10 ** k);
  return ticks.length ? ticks : [low];
}

/* A range that has a size, about its numbers. */
function rangeOf(values, log) {
  const finite = values.filter((v) => Number.isFinite(v) && (!log || v > 0));
  const { low, high } = extent(finite);
  if (!finite.length) return [0, 1];
  if (log) return low < high ? [low / 1.15, high * 1.15] : [low / 2, high * 2];
  if (high - low <= 1e-12 * Math.max(Math.abs(low), Math.abs(high))) return [low - (Math.abs(low) || 1) * 0.5, high + (Math.abs(high) || 1) * 0.5];
  return [low - 0.05 * (high - low), high + 0.05 * (high - low)];
}

/* Logarithmic where all numbers are positive and span more than a factor of 100, as in slender picture. */
function isLog(chart, values) {
  const finite = values.filter(Number.isFinite);
  const { low, high } = extent(finite);
  return !chart.linear && finite.length > 1 && low > 0 && high > 100 * low;
}

/* Ticks of an axis, all in one way: with one prefix or, of powers, their own; with powers of ten if any has one. */
function sayTicks(ticks, unit, log) {
  const one = prefixed(Math.max(...ticks.map(Math.abs)), unit), named = ticks.map((tick) => (log ? prefixed(tick, unit) : one));
  const numbers = ticks.map((tick, k) => tick / named[k].scale), far = numbers.some((number) => trim(number).includes("e"));
  return numbers.map((number, k) => `${far && number ? Number(number.toPrecision(3)).toExponential() : trim(number)} ${named[k].unit}`.trim());
}

function addAxes(svg, chart, xOf, yOf, xs, ys, log) {
  const { left, right, top, bottom, width, height } = CHART, whole = !chart.x.unit;
  const { unit, scale } = prefixed(Math.max(...xs.map(Math.abs)), chart.x.unit);
  const across = roundTicks(...xs, 6, whole), upward = log ? powerTicks(...ys) : roundTicks(...ys, 4, false);
  const names = { x: sayTicks(across.map((tick) => tick / scale), ""), y: sayTicks(upward, chart.y.unit, log) };
  across.forEach((tick, k) => {
    svg.append(svgNode("line", { class: "grid", x1: xOf(tick), x2: xOf(tick), y1: top, y2: height - bottom }));
    svg.append(svgNode("text", { x: xOf(tick), y: height - bottom + 13, "text-anchor": "middle" }, names.x[k]));
  });
  upward.forEach((tick, k) => {
    svg.append(svgNode("line", { class: "grid", x1: left, x2: width - right, y1: yOf(tick), y2: yOf(tick) }));
    svg.append(svgNode("text", { x: left - 5, y: yOf(tick) + 4, "text-anchor": "end" }, names.y[k]));
  });
  const label = unit ? `${chart.x.label}, ${unit}` : chart.x.label;
  svg.append(svgNode("text", { x: (left + width - right) / 2, y: height - 5, "text-anchor": "middle" }, label));
}

/* Lines, with gaps where there is no number; a single point is a dot. */
function addSeries(svg, series, xOf, yOf) {
  let path = "";
  let gap = true;
  series.y.forEach((value, k) => {
    const x = series.x ? series.x[k] : k, y = value === null ? NaN : yOf(value);
    if (!Number.isFinite(x) || x === null || !Number.isFinite(y)) return void (gap = true);
    const next = series.y[k + 1], alone = gap && (next === undefined || next === null);
    path += `${gap ? "M" : "L"}${xOf(x).toFixed(1)} ${y.toFixed(1)}`;
    if (alone) svg.append(svgNode("circle", { cx: xOf(x), cy: y, r: 2.5, fill: series.color }));
    gap = false;
  });
  svg.append(svgNode("path", { d: path, fill: "none", stroke: series.color, "stroke-width": 1.6 }));
}

/* Returns {svg, mark(x), markRow(k)}: a chart, whose moment can be set, by its x or by the row of its lines. */
function makeChart(chart, title) {
  const { width, height, left, right, top, bottom } = CHART;
  const values = chart.series.flatMap((s) => s.y.map((y) => (y === null ? NaN : y))), log = isLog(chart, values);
  const places = chart.series.flatMap((s) => s.x || s.y.map((_, k) => k)).filter((x) => x !== null);
  const ys = rangeOf(values, log), { low: first, high: last } = extent(places), xs = [first, last];
  if (!(xs[1] > xs[0])) xs[1] = xs[0] + 1;
  const xOf = (x) => left + ((x - xs[0]) / (xs[1] - xs[0])) * (width - left - right);
  const part = (y) => (log ? Math.log(y / ys[0]) / Math.log(ys[1] / ys[0]) : (y - ys[0]) / (ys[1] - ys[0]));
  const yOf = (y) => height - bottom - part(y) * (height - top - bottom);
  const svg = svgNode("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${chart.y.label} over ${chart.x.label}` });
  addAxes(svg, chart, xOf, yOf, xs, ys, log);
  const now = svg.appendChild(svgNode("line", { class: "now", y1: top, y2: height - bottom, visibility: "hidden" }));
  chart.series.forEach((series) => addSeries(svg, series, xOf, yOf));
  svg.append(svgNode("text", { x: left, y: 15 }, title ? `${chart.y.label} \u2013 ${title}` : chart.y.label));
  let x = width - right;
  if (chart.series.length > 1)
    for (const series of [...chart.series].reverse()) {
      svg.append(svgNode("text", { x, y: 15, "text-anchor": "end", style: `fill: ${series.color}` }, series.name));
      x -= 10 + 7 * String(series.name).length;
    }
  function mark(place) {
    const within = place >= xs[0] && place <= xs[1];
    now.setAttribute("visibility", within ? "visible" : "hidden");
    if (!within) return;
    now.setAttribute("x1", xOf(place));
    now.setAttribute("x2", xOf(place));
  }
  const rows = chart.series.map((series) => series.x).find(Boolean);
  return { svg, mark, markRow: (k) => mark(rows ? rows[k] : k) };
}
