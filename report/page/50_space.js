/* A panel in space: a body or rods, with all that belongs to them at a moment. */

const TARGET_INK = [213, 94, 0];

function posePoints(points, pose) {
  const out = new Float32Array(points.length);
  for (let v = 0; v < points.length; v += 3)
    for (let i = 0; i < 3; i++)
      out[v + i] = pose[4 * i] * points[v] + pose[4 * i + 1] * points[v + 1] + pose[4 * i + 2] * points[v + 2] + pose[4 * i + 3];
  return out;
}

/* An obstacle's points at a frame. */
function obstacleAt(obstacle, frame) {
  return obstacle.poses ? posePoints(obstacle.points.data, obstacle.poses.slice(12 * frame, 12 * frame + 12)) : obstacle.points.data;
}

/* Points of what is not much larger than the body's way and near it, where it begins, is half way and ends: there is room for all
 * of that. The same rule as in slender picture. */
function nearPoints(obstacles, sphere, count) {
  return obstacles.flatMap((obstacle) => {
    const [largest, near] = obstacle.kind === "obstacle" ? [1.5, 0.5] : [4, 2];
    return [0, Math.floor((count - 1) / 2), count - 1].map((frame) => obstacleAt(obstacle, frame)).filter((points) => {
      const own = enclose([points]), gap = Math.hypot(...own.center.map((c, i) => c - sphere.center[i])) - own.radius - sphere.radius;
      return own.radius <= largest * sphere.radius && gap <= 2 * near * sphere.radius;
    });
  });
}

/* What its faces or its nodes are coloured by. */
function fieldsOf({ body, curves = [] }) {
  return body ? body.fields : curves.flatMap((curve) => curve.fields || []);
}

function makeSpacePanel(result, page) {
  const { body, target, clouds, obstacles = [], curves = [], places = [] } = result, count = result.frames.labels.length;
  const moving = [...(body ? [body.points.data] : []), ...curves.map((curve) => curve.points.data), ...(target ? [target.points.data] : []), ...(clouds ? clouds.sets.map((set) => set.data) : [])];
  const shown = [...moving, ...nearPoints(obstacles, enclose(moving), count)], sphere = enclose(shown), reach = new Map();
  const arrows = body && body.magnetization ? prepareArrows(body.magnetization, 260) : null;
  const segments = curves.map((curve) => segmentsOf(curve.offsets.data)), edges = body && target ? edgesOf(body.faces.data) : [];
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
  let view = null, pointsNow = null;
  if (result.arrows) for (const half of [-0.5, 0.5]) shown.push(result.arrows.points.data.map((x) => x + half * fluxLength(result.arrows))); /* their ends */

  /* As the camera looks at first: what is turned does not become larger or smaller. */
  function reachNow() {
    if (!reach.has(page.first)) reach.set(page.first, reachOf(shown, sphere.center, cameraAxes(page.first)));
    return reach.get(page.first);
  }

  function field() {
    return fieldsOf(result).find((one) => one.name === page.choice.field);
  }

  /* The target of a frame, and the points of its cloud; null: it has none. */
  function targetAt(at) {
    const row = target ? target.of[Math.round(at)] : -1;
    return row >= 0 ? target.points.data.subarray(row * target.points.width, (row + 1) * target.points.width) : null;
  }
  function cloudAt(at) {
    const set = clouds ? clouds.sets[clouds.of[Math.round(at)]] : null;
    return set ? set.data : null;
  }

  function drawBody(gl, at, offset) {
    const faces = body.faces.data, shown = field(), plain = parseColor(page.color("--body"));
    const values = shown ? rowNear(shown.values, at) : null, { scale } = page;
    pointsNow = rowAt(body.points, at);
    gl.drawMesh(offset, corners(pointsNow, faces), faceColors(faces.length / 3, (f) => (values ? scale.color(values[f]) : plain)),
                { edges: page.choice.edges ? 1 : 0 });
    if (arrows && page.choice.arrows) gl.drawStrokes(offset, arrowStrokes(arrows, at, pointsNow, parseColor(page.color("--arrow")), page.ratio), { head: true, raise: 0.004 });
  }

  function drawTarget(gl, at) {
    const points = targetAt(at), cloud = cloudAt(at), faces = body.faces.data;
    if (page.choice.target === "none") return;
    if (cloud) gl.drawStrokes(view, dotStrokes(cloud, TARGET_INK, 3.5 * page.ratio), { raise: 0.004 });
    if (!points) return;
    gl.drawStrokes(view, dotStrokes(loosePoints(points, faces), TARGET_INK, 7 * page.ratio), { raise: 0.02 });
    if (page.choice.target === "over") return gl.drawStrokes(view, edgeStrokes(points, edges, TARGET_INK, page.ratio));
    const beside = { ...view, x: view.x + view.width / 2 };
    gl.drawMesh(beside, corners(points, faces), faceColors(faces.length / 3, () => TARGET_INK), { edges: 0.7 });
  }

  function drawObstacles(gl, at) {
    const near = Math.min(Math.round(at), count - 1);
    for (const obstacle of obstacles) {
      const faces = obstacle.faces.data, rgb = obstacle.colors.data;
      gl.drawMesh(view, corners(obstacleAt(obstacle, near), faces), faceColors(faces.length / 3, (f) => [255 * rgb[3 * f], 255 * rgb[3 * f + 1], 255 * rgb[3 * f + 2]]),
                  { edges: 0.3, alpha: obstacle.kind === "obstacle" ? 0.7 : 1, oneSided: obstacle.kind === "obstacle" });
    }
  }

  function shownOf(curve) {
    return (curve.fields || []).find((one) => one.name === page.choice.field);
  }

  function drawTubes(gl, at, curve, points, segments, { raise }) {
    const shown = shownOf(curve), least = (curve.radius ? Math.min(2, curve.width) : curve.width) * page.ratio;
    const look = { radius: curve.radius && curve.radius.data, pixels: view.scale, least, value: shown && rowNear(shown.values, at), scale: page.scale };
    gl.drawStrokes(view, tubeStrokes(points, segments, page.ink(curve.color), look), { tube: Boolean(curve.radius), raise });
  }

  function drawCurves(gl, at) {
    curves.forEach((curve, k) => { /* later ones over those before them */
      if (curve.of && (curve.of[Math.round(at)] < 0 || page.choice.target === "none")) return;
      if (page.hidden.has(curve.name)) return;
      const offsets = curve.offsets.data, part = count > 1 ? at / (count - 1) : 1;
      const end = curve.grows ? Math.round(part * (offsets[offsets.length - 1] - 1)) : Infinity;
      const points = rowAt(curve.points, at), ink = page.ink(curve.color);
      if (curve.radius || shownOf(curve)) drawTubes(gl, at, curve, points, segments[k], { raise: 0.01 + 0.002 * k });
      else gl.drawStrokes(view, lineStrokes(points, segments[k], ink, curve.width * page.ratio, end), { raise: 0.01 + 0.002 * k });
      if (curve.of) gl.drawStrokes(view, dotStrokes(lonePoints(points, offsets), ink, 9 * page.ratio), { raise: 0.02 });
    });
    for (const place of places) gl.drawStrokes(view, dotStrokes(place.at, parseColor(place.color), 8 * page.ratio), { raise: 0.02 });
  }

  function drawHolds(gl, at) {
    if (result.holds) gl.drawStrokes(view, dotStrokes(rowAt(result.holds, at), parseColor(page.color("--ink")), 8 * page.ratio), { raise: 0.03 });
  }

  function drawFlux(gl, at) {
    if (!result.arrows || !page.choice.flux) return;
    gl.drawStrokes(view, fluxStrokes(result.arrows, at, page.fluxScale, parseColor(page.color("--accent")), page.ratio), { head: true, raise: 0.003 });
  }

  /* ---- Over it ---- */

  function arrow(x, y, dx, dy, text) {
    const length = Math.hypot(dx, dy), tip = Math.min(7, length / 2) * page.ratio;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + dx, y + dy);
    context.stroke();
    if (length > 3) {
      const ux = dx / length, uy = dy / length;
      context.beginPath();
      context.moveTo(x + dx, y + dy);
      context.lineTo(x + dx - tip * (ux - 0.4 * uy), y + dy - tip * (uy + 0.4 * ux));
      context.lineTo(x + dx - tip * (ux + 0.4 * uy), y + dy - tip * (uy - 0.4 * ux));
      context.fill();
    }
    context.textAlign = dx < 0 ? "right" : "left";
    context.fillText(text, x + dx + (dx < 0 ? -4 : 4) * page.ratio, y + dy - 3 * page.ratio);
    context.textAlign = "left";
  }

  /* A direction of the world in pixels. */
  function direction(vector, length) {
    const size = Math.hypot(...vector) || 1;
    return [0, 1].map((k) => ((k ? -1 : 1) * dot(view.axes[k], vector) * length) / size);
  }

  function drawGauges(at) {
    const r = page.ratio, x = 44 * r, y = view.height - 44 * r, row = 3 * Math.min(Math.round(at), count - 1);
    context.lineWidth = 1.4 * r;
    context.font = `${12 * r}px system-ui, sans-serif`;
    context.strokeStyle = context.fillStyle = page.color("--faint");
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((axis, i) => arrow(x, y, ...direction(axis, 26 * r), "xyz"[i]));
    const B = result.flux ? result.flux.slice(row, row + 3) : null, size = B ? Math.hypot(...B) : 0;
    if (size > 0) {
      context.strokeStyle = context.fillStyle = page.color("--accent");
      arrow(x + 120 * r, y, ...direction(B, Math.max(34 * r * Math.min(size / page.greatestFlux, 1), 4)), `B ${say(size, "T")}`);
    }
    if (result.gravity && Math.hypot(...result.gravity) > 0) {
      context.strokeStyle = context.fillStyle = page.color("--faint");
      arrow(x + 62 * r, y - 10 * r, ...direction(result.gravity, 24 * r), "g");
    }
    drawLength();
  }

  /* A bar of a round length. */
  function drawLength() {
    const r = page.ratio, wanted = (110 * r) / view.scale, power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((k) => k * power).find((l) => l <= wanted), pixels = length * view.scale;
    const x = view.width - 16 * r - pixels, y = view.height - 18 * r;
    context.strokeStyle = context.fillStyle = page.color("--ink");
    context.strokeRect(x, y, pixels, 0);
    context.textAlign = "right";
    context.fillText(say(length, "m"), view.width - 16 * r, y - 5 * r);
    context.textAlign = "left";
  }

  /* ---- The panel ---- */

  function draw(at) {
    const width = Math.round(canvas.clientWidth * page.ratio), height = Math.round(canvas.clientHeight * page.ratio), gl = page.renderer;
    if (!width || !height || count === 0) return;
    if (canvas.width !== width || canvas.height !== height) (canvas.width = width), (canvas.height = height);
    view = makeView(page.camera, sphere, reachNow(), { width, height, ratio: page.ratio, beside: target && page.choice.target === "beside" });
    context.clearRect(0, 0, width, height);
    if (gl) {
      gl.begin(width, height);
      if (body) drawBody(gl, at, view);
      if (body) drawTarget(gl, at);
      drawCurves(gl, at);
      drawObstacles(gl, at);
      drawHolds(gl, at);
      drawFlux(gl, at);
      context.drawImage(gl.canvas, 0, 0);
    }
    drawGauges(at);
  }

  /* The face under a place in CSS pixels, and what it has; "" where there is none. */
  function readAt(x, y, at) {
    const shown = field();
    if (!view || !pointsNow) return "";
    const face = pick(view, pointsNow, body.faces.data, x * page.ratio, y * page.ratio);
    if (face < 0) return "";
    const groups = groupsOf(body, face), value = shown ? `: ${say(rowNear(shown.values, at)[face], shown.unit)}` : "";
    return `face ${face}${groups.length ? ` (${groups.join(", ")})` : ""}${value}`;
  }

  const lines = [...new Map(curves.filter((curve) => curve.name).map((curve) => [curve.name, curve.color]))];
  return { canvas, draw, readAt, field, lines, count, magnetization: arrows && arrows.greatest, held: Boolean(result.holds), arrows: result.arrows, times: result.frames.times, evaluationOf: (at) => (result.frames.evaluations || [])[Math.round(at)], stageOf: (at) => (result.frames.stages || [])[Math.round(at)], label: (at) => result.frames.labels[Math.min(Math.round(at), count - 1)] };
}

/* The names of a face's groups. */
function groupsOf(body, face) {
  const row = body.part ? body.part.data[face] : face;
  return (body.groups || []).filter((group) => group.members.data.includes(row)).map((group) => group.name);
}

/* The frontmost face at a pixel; -1: none. */
function pick(view, points, faces, x, y) {
  const at = new Float32Array(points.length); /* [x, y, height] of each point */
  for (let v = 0; v < points.length; v += 3) at.set(project(view, points.subarray(v, v + 3)), v);
  let best = -1, nearest = -Infinity;
  for (let k = 0; k < faces.length; k += 3) {
    const a = 3 * faces[k], b = 3 * faces[k + 1], c = 3 * faces[k + 2];
    const ax = at[a] - x, ay = at[a + 1] - y, bx = at[b] - x, by = at[b + 1] - y, cx = at[c] - x, cy = at[c + 1] - y;
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax), u = (bx * cy - by * cx) / area, v = (cx * ay - cy * ax) / area;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
    const height = u * at[a + 2] + v * at[b + 2] + (1 - u - v) * at[c + 2];
    if (height > nearest) (nearest = height), (best = k / 3);
  }
  return best;
}
