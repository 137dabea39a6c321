/* A mesh at a moment: where its points are, the colours of its faces, the arrows of its magnetisation. */

/* Row `at` of R rows, in between by parts of both; a moment between two frames. */
function rowAt(array, at) {
  const { rows, width, data } = array, low = Math.min(Math.floor(at), rows - 1), part = at - low;
  const row = data.subarray(low * width, (low + 1) * width);
  if (part <= 0 || low + 1 >= rows) return row;
  const next = data.subarray((low + 1) * width, (low + 2) * width);
  return row.map((value, i) => value + part * (next[i] - value));
}

/* The nearest row, of what is not to be mixed. */
function rowNear(array, at) {
  const low = Math.min(Math.round(at), array.rows - 1);
  return array.data.subarray(low * array.width, (low + 1) * array.width);
}

/* The corners of all faces, one after the other. */
function corners(points, faces) {
  const out = new Float32Array(3 * faces.length);
  for (let k = 0; k < faces.length; k++)
    for (let i = 0; i < 3; i++) out[3 * k + i] = points[3 * faces[k] + i];
  return out;
}

/* Three times the same colour for each face; rgb(f): its [r, g, b] 0..255. */
function faceColors(count, rgb) {
  const out = new Uint8Array(12 * count);
  for (let f = 0; f < count; f++) {
    const color = rgb(f);
    for (let i = 0; i < 3; i++) out.set([color[0], color[1], color[2], 255], 12 * f + 4 * i);
  }
  return out;
}

function parseColor(text) {
  return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
}

/* A colour for each number, grey for none; low..high are the ends of the map, of logarithms with `log`. */
function makeScale(maps, low, high, log) {
  const diverging = low < 0 && high > 0, end = Math.max(-low, high);
  if (log) return { low, high, log, color: mapColors(maps.sequential, (value) => Math.log(value / low) / Math.log(high / low)) };
  if (high - low <= 1e-3 * Math.max(Math.abs(low), Math.abs(high))) (low = Math.min(low, 0)), (high = Math.max(high, 0)); /* one number everywhere */
  else if (diverging) (low = -end), (high = end);
  else if (low > 0 && low < 0.2 * high) low = 0;
  return { low, high, log: false, color: mapColors(diverging ? maps.diverging : maps.sequential, (value) => (high > low ? (value - low) / (high - low) : 0)) };
}

/* part(value): where it is on the map, 0..1 or beyond. */
function mapColors(names, part) {
  const map = names.map(parseColor);
  return (value) => {
    if (!Number.isFinite(value)) return [140, 140, 145];
    const t = Math.min(Math.max(part(value), 0), 1) * (map.length - 1), k = Math.min(Math.floor(t), map.length - 2);
    return map[k].map((c, i) => c + (t - k) * (map[k + 1][i] - c));
  };
}


/* ---- Magnetisation ---- */

function sub(x, a, b) {
  return [x[3 * a] - x[3 * b], x[3 * a + 1] - x[3 * b + 1], x[3 * a + 2] - x[3 * b + 2]];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/* Two edges and the unit normal of a triangle, or three edges of a tetrahedron (the last of its corners is not -1). */
function frameOf(x, v) {
  const a = sub(x, v[1], v[0]), b = sub(x, v[2], v[0]);
  if (v[3] >= 0) return [a, b, sub(x, v[3], v[0])];
  const n = cross(a, b), l = Math.hypot(...n) || 1;
  return [a, b, n.map((c) => c / l)];
}

/* M = a e1 + b e2 + c e3 at rest is a e1' + b e2' + c e3' now. */
function carry(rest, now, M) {
  const det = dot(rest[0], cross(rest[1], rest[2])) || 1;
  const parts = [0, 1, 2].map((i) => dot(M, cross(rest[(i + 1) % 3], rest[(i + 2) % 3])) / det);
  return [0, 1, 2].map((k) => parts[0] * now[0][k] + parts[1] * now[1][k] + parts[2] * now[2][k]);
}

/* Of each face the greatest magnetisation in all rows. */
function greatestOf({ rows, width, data }) {
  const sizes = new Float64Array(width / 3);
  for (let k = 0; k < (rows * width) / 3; k++) {
    const f = k % sizes.length;
    sizes[f] = Math.max(sizes[f], Math.hypot(data[3 * k], data[3 * k + 1], data[3 * k + 2]));
  }
  return sizes;
}

/* The faces that carry an arrow: about `most` of them, spread over the surface (each in a cell of space of its own). */
function chooseFaces(rest, carriers, sizes, most) {
  const count = carriers.length / 4, { radius } = enclose([rest]), taken = new Map();
  let cell = (2 * radius) / Math.sqrt(most);
  for (let turn = 0; turn < 12; turn++, cell *= 1.25) {
    taken.clear();
    for (let f = 0; f < count; f++) {
      if (!(sizes[f] > 0)) continue;
      const at = [0, 1, 2].map((i) => Math.floor((rest[3 * carriers[4 * f] + i] + rest[3 * carriers[4 * f + 1] + i] + rest[3 * carriers[4 * f + 2] + i]) / 3 / cell));
      if (!taken.has(at.join())) taken.set(at.join(), f);
    }
    if (taken.size <= most) break;
  }
  return { faces: [...taken.values()], length: cell };
}

function prepareArrows(magnetization, most) {
  const { values } = magnetization, sizes = greatestOf(values), rest = magnetization.rest.data, carriers = magnetization.carriers.data;
  const { faces, length } = chooseFaces(rest, carriers, sizes, most);
  const greatest = Math.max(...faces.map((f) => sizes[f]), 0);
  return { values, rest, carriers, faces, length: 0.9 * length, greatest };
}

/* Strokes of the arrows at frame `at`, with the body's points at x, of one ink [r, g, b]. */
function arrowStrokes(arrows, at, x, ink, ratio) {
  const row = rowNear(arrows.values, at);
  const count = arrows.faces.length, from = new Float32Array(3 * count), to = new Float32Array(3 * count);
  const colors = new Uint8Array(4 * count), widths = new Float32Array(count).fill(1.6 * ratio);
  arrows.faces.forEach((f, k) => {
    const v = arrows.carriers.subarray(4 * f, 4 * f + 4), M = row.subarray(3 * f, 3 * f + 3);
    const now = carry(frameOf(arrows.rest, v), frameOf(x, v), M);
    for (let i = 0; i < 3; i++) {
      const middle = (x[3 * v[0] + i] + x[3 * v[1] + i] + x[3 * v[2] + i]) / 3, half = (0.5 * arrows.length * now[i]) / arrows.greatest;
      from[3 * k + i] = middle - half;
      to[3 * k + i] = middle + half;
    }
    colors.set([...ink, 235], 4 * k);
  });
  return { from, to, colors, widths };
}

/* ---- Lines ---- */

/* Strokes of one ink [r, g, b, a] from points to points, [3 a stroke]. */
function makeStrokes(from, to, ink, width) {
  const count = from.length / 3, colors = new Uint8Array(4 * count);
  for (let k = 0; k < 4 * count; k++) colors[k] = ink[k % 4];
  return { from: new Float32Array(from), to: new Float32Array(to), colors, widths: new Float32Array(count).fill(width) };
}

/* A stroke without length is a dot. */
function dotStrokes(points, color, width) {
  return makeStrokes(points, points, [...color, 255], width);
}

/* The points of polylines that begin at `offsets`: pairs [from, to]. Of very many only every second, fourth, .. point and the last
 * one: strokes much shorter than a pixel take time, and nothing is seen of them. */
function segmentsOf(offsets) {
  const most = 150000, count = offsets[offsets.length - 1];
  let by = 1;
  while (count / by > most && by < count / offsets.length) by *= 2;
  const pairs = new Int32Array(2 * count);
  let at = 0;
  for (let s = 0; s + 1 < offsets.length; s++)
    for (let k = offsets[s], last = offsets[s + 1] - 1; k < last; k += by) (pairs[at++] = k), (pairs[at++] = Math.min(k + by, last));
  return pairs.subarray(0, at);
}

/* Segments as strokes, up to point `end`; points that are NaN interrupt them. */
function lineStrokes(points, segments, color, width, end = Infinity) {
  const from = new Float32Array(1.5 * segments.length), to = new Float32Array(1.5 * segments.length);
  let count = 0;
  for (let k = 0; k < segments.length && segments[k] < end; k += 2) {
    const a = 3 * segments[k], b = 3 * segments[k + 1];
    if (!Number.isFinite(points[a] + points[b])) continue;
    for (let i = 0; i < 3; i++, count++) (from[count] = points[a + i]), (to[count] = points[b + i]);
  }
  return makeStrokes(from.subarray(0, count), to.subarray(0, count), [...color, 255], width);
}

/* The same as tubes: as thick as they are, but `least` pixels; value(point), if there is one, is coloured by the scale. */
function tubeStrokes(points, segments, color, { radius, pixels, least, value, scale }) {
  const strokes = lineStrokes(points, segments, color, least);
  for (let k = 0, n = 0; k < segments.length; k += 2) {
    const a = segments[k], b = segments[k + 1];
    if (!Number.isFinite(points[3 * a] + points[3 * b])) continue;
    if (radius) strokes.widths[n] = Math.max(least, (radius[a] + radius[b]) * pixels);
    if (value) strokes.colors.set(scale.color((value[a] + value[b]) / 2), 4 * n);
    n++;
  }
  return strokes;
}

/* Points of polylines between points that are NaN, [3 each]. */
function lonePoints(points, offsets) {
  const lone = [], has = (k, s) => k >= offsets[s] && k < offsets[s + 1] && Number.isFinite(points[3 * k]);
  for (let s = 0; s + 1 < offsets.length; s++)
    for (let k = offsets[s]; k < offsets[s + 1]; k++)
      if (has(k, s) && !has(k - 1, s) && !has(k + 1, s)) lone.push(...points.subarray(3 * k, 3 * k + 3));
  return lone;
}

/* Points of a mesh that are there in no face that is there whole, [3 each]. */
function loosePoints(points, faces) {
  const whole = new Uint8Array(points.length / 3), loose = [], has = (v) => Number.isFinite(points[3 * v]);
  for (let k = 0; k < faces.length; k += 3)
    if (has(faces[k]) && has(faces[k + 1]) && has(faces[k + 2])) whole[faces[k]] = whole[faces[k + 1]] = whole[faces[k + 2]] = 1;
  for (let v = 0; v < whole.length; v++) if (has(v) && !whole[v]) loose.push(...points.subarray(3 * v, 3 * v + 3));
  return loose;
}

/* Each edge of a mesh once, [2 vertices]; of those whose points are known. */
function edgesOf(faces) {
  const seen = new Set(), edges = [];
  for (let k = 0; k < faces.length; k++) {
    const a = faces[k], b = faces[k % 3 === 2 ? k - 2 : k + 1], key = Math.min(a, b) * 4294967296 + Math.max(a, b);
    if (!seen.has(key)) seen.add(key), edges.push(a, b);
  }
  return edges;
}

function edgeStrokes(points, edges, color, width) {
  const from = [], to = [];
  for (let k = 0; k < edges.length; k += 2) {
    const a = 3 * edges[k], b = 3 * edges[k + 1];
    if (!Number.isFinite(points[a] + points[b])) continue;
    for (let i = 0; i < 3; i++) from.push(points[a + i]), to.push(points[b + i]);
  }
  return makeStrokes(from, to, [...color, 200], width);
}
