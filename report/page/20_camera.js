/* Where one looks from: a turntable about z, the same for all panels; what each panel shows fills it. */

const CAMERA_START = { azimuth: -0.9, elevation: 0.55, zoom: 1, panX: 0, panY: 0 };

/* Rows right, up, toward: x_eye = rows . x. */
function cameraAxes(camera) {
  const ca = Math.cos(camera.azimuth), sa = Math.sin(camera.azimuth);
  const ce = Math.cos(camera.elevation), se = Math.sin(camera.elevation);
  return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The middle and the radius of points [..3n], NaN aside; of several arrays together. */
function enclose(arrays) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const points of arrays)
    for (let i = 0; i < points.length; i++) {
      if (points[i] < low[i % 3]) low[i % 3] = points[i];
      if (points[i] > high[i % 3]) high[i % 3] = points[i];
    }
  if (low[0] > high[0]) return { center: [0, 0, 0], radius: 1 };
  const center = low.map((l, i) => (l + high[i]) / 2);
  let most = 0;
  for (const points of arrays)
    for (let i = 0; i + 2 < points.length; i += 3) {
      const square = (points[i] - center[0]) ** 2 + (points[i + 1] - center[1]) ** 2 + (points[i + 2] - center[2]) ** 2;
      if (square > most) most = square;
    }
  return { center, radius: Math.sqrt(most) || 1 };
}

/* How far points [..3n] of several arrays reach to the right and upward of a centre, as a camera sees them: {middle, size}, [2] each. */
function reachOf(arrays, center, [right, up]) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity], axes = [right, up], of_center = axes.map((axis) => dot(axis, center));
  for (const points of arrays)
    for (let i = 0; i + 2 < points.length; i += 3)
      for (let k = 0; k < 2; k++) {
        const axis = axes[k], at = axis[0] * points[i] + axis[1] * points[i + 1] + axis[2] * points[i + 2] - of_center[k];
        if (at < low[k]) low[k] = at;
        if (at > high[k]) high[k] = at;
      }
  return low[0] <= high[0] ? { middle: low.map((l, k) => (l + high[k]) / 2), size: low.map((l, k) => high[k] - l) } : { middle: [0, 0], size: [0, 0] };
}

/* What a panel of width x height pixels sees: `scale` pixels a metre. What there is of `sphere` fills it as it reaches at first,
 * but for a margin, and gauges below. */
function makeView(camera, sphere, reach, { width, height, ratio, beside }) {
  const margin = 0.05 * Math.min(width, height), room = [(beside ? width / 2 : width) - 2 * margin, height - margin - Math.min(92 * ratio, height / 4)];
  const scale = camera.zoom * Math.min(...room.map((pixels, k) => pixels / Math.max(reach.size[k], 1e-3 * sphere.radius)));
  return { axes: cameraAxes(camera), center: sphere.center, radius: sphere.radius, scale, width, height,
           x: (beside ? width / 4 : width / 2) + camera.panX * width - scale * reach.middle[0], y: margin + room[1] / 2 + camera.panY * height + scale * reach.middle[1] };
}

/* Pixels from the upper left corner, and height towards the eye in metres. */
function project(view, point) {
  const d = [point[0] - view.center[0], point[1] - view.center[1], point[2] - view.center[2]];
  return [view.x + view.scale * dot(view.axes[0], d), view.y - view.scale * dot(view.axes[1], d), dot(view.axes[2], d)];
}

/* The same as a matrix for WebGL, column by column. */
function viewMatrix(view) {
  const [r, u, t] = view.axes, sx = (2 * view.scale) / view.width, sy = (2 * view.scale) / view.height, sz = 0.05 / view.radius;
  const tx = (2 * view.x) / view.width - 1 - sx * dot(r, view.center), ty = 1 - (2 * view.y) / view.height - sy * dot(u, view.center);
  return new Float32Array([sx * r[0], sy * u[0], -sz * t[0], 0, sx * r[1], sy * u[1], -sz * t[1], 0, sx * r[2], sy * u[2], -sz * t[2], 0,
                           tx, ty, sz * dot(t, view.center), 1]);
}
