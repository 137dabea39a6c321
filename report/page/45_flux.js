/* Arrows of a flux density that varies in space, at the body and around it. A source's field falls by orders of magnitude: length
 * and ink go by the logarithm of its size, between the weakest and the strongest of all results. */

const WEAK = 0.3; /* of the longest arrow */

function fluxScaleOf(results) {
  const shown = results.filter((result) => result.arrows).map((result) => result.arrows.sizes);
  return shown.length ? { low: Math.min(...shown.map((one) => one.low)), high: Math.max(...shown.map((one) => one.high)) } : null;
}

function fluxPart({ low, high }, size) {
  return high > low ? Math.log(size / low) / Math.log(high / low) : 1;
}

/* The ink of an arrow is fainter the weaker the field is. */
function fluxAlpha(part) {
  return 0.25 + 0.75 * part;
}

/* How long the longest arrow is: from one place of the grid to the next. */
function fluxLength({ points, on_body }) {
  return 0.9 * Math.hypot(...[0, 1, 2].map((i) => points.data[3 * on_body + 3 + i] - points.data[3 * on_body + i]));
}

/* Those at the body are wider. */
function fluxStrokes(arrows, at, scale, ink, ratio) {
  const points = rowNear(arrows.points, at), directions = rowNear(arrows.directions, at), sizes = rowNear(arrows.sizes, at), first = arrows.on_body;
  const longest = fluxLength(arrows), count = sizes.length, from = new Float32Array(3 * count), to = new Float32Array(3 * count), colors = new Uint8Array(4 * count), widths = new Float32Array(count);
  for (let k = 0; k < count; k++) {
    if (!Number.isFinite(sizes[k])) continue; /* no width, no ink */
    const part = fluxPart(scale, sizes[k]), half = 0.5 * longest * (WEAK + (1 - WEAK) * part);
    for (let i = 0; i < 3; i++) (from[3 * k + i] = points[3 * k + i] - half * directions[3 * k + i]), (to[3 * k + i] = points[3 * k + i] + half * directions[3 * k + i]);
    colors.set([...ink, 255 * fluxAlpha(part)], 4 * k);
    widths[k] = (k < first ? 2.2 : 1.3) * ratio;
  }
  return { from, to, colors, widths };
}
