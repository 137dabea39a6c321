/* A drawing: its strokes one after the other, as the plotter draws them, beside what was to be drawn. */

function pictureCanvas(picture) {
  const canvas = document.createElement("canvas"), pixels = picture.columns * picture.rows, width = picture.values.width / picture.columns;
  canvas.width = picture.columns;
  canvas.height = picture.rows;
  const image = new ImageData(picture.columns, picture.rows);
  for (let k = 0; k < pixels; k++)
    for (let c = 0; c < 4; c++) image.data[4 * k + c] = c === 3 ? 255 : 255 * (1 - picture.values.data[width * k + (width === 3 ? c : 0)]);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

/* The length of a curve's control polygon: how long it takes, nearly. */
function curveLength(points, first, end) {
  let length = 0;
  for (let k = first; k + 1 < end; k++) length += Math.hypot(points[2 * k + 2] - points[2 * k], points[2 * k + 3] - points[2 * k + 1]);
  return length;
}

function makePaperPanel(result, page) {
  const { paper, area, layers, picture, film = [] } = result.drawing;
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d"), target = pictureCanvas(picture);
  const begins = []; /* [layer][curve] ink before it, mm */
  let ink = 0;
  for (const layer of layers) {
    const offsets = layer.offsets.data;
    const lengths = Array.from({ length: offsets.length - 1 }, (_, k) => curveLength(layer.points.data, offsets[k], offsets[k + 1]));
    begins.push(lengths.map((length) => (ink += length) - length));
  }

  function drawCurve(points, first, end) {
    context.moveTo(points[2 * first], points[2 * first + 1]);
    for (let k = first + 1; k + 2 < end; k += 3)
      context.bezierCurveTo(points[2 * k], points[2 * k + 1], points[2 * k + 2], points[2 * k + 3], points[2 * k + 4], points[2 * k + 5]);
  }

  /* Its first curves, so many. */
  function drawLayer(layer, count) {
    const offsets = layer.offsets.data;
    context.strokeStyle = layer.color;
    context.lineWidth = layer.width;
    context.lineCap = context.lineJoin = "round";
    context.beginPath();
    for (let k = 0; k < count; k++) drawCurve(layer.points.data, offsets[k], offsets[k + 1]);
    context.stroke();
  }

  /* How many curves of a layer have been begun at that moment. */
  function begun(layer, at) {
    return at >= 1 ? begins[layer].length : begins[layer].filter((before) => before < at * ink).length;
  }

  /* What is shown of how it relaxed; null: the drawing itself. */
  function filmAt(at) {
    return page.choice.shown === "film" ? film[Math.round(at * film.length)] || null : null;
  }

  function iteration(at) {
    const frame = filmAt(at);
    return frame ? frame.iteration : NaN;
  }

  function label(at) {
    const frame = filmAt(at);
    if (frame) return `iteration ${frame.iteration}`;
    return page.choice.shown === "film" && film.length ? "as drawn" : `${((ink * Math.min(at, 1)) / 1000).toFixed(1)} m of ink`;
  }

  function draw(at) {
    const beside = page.choice.target === "beside", sheets = beside ? 2 : 1, gap = 0.04 * paper[0];
    const wide = sheets * paper[0] + (sheets - 1) * gap;
    const width = Math.round(canvas.clientWidth * page.ratio), height = Math.round(canvas.clientHeight * page.ratio);
    const scale = Math.min(width / wide, height / paper[1]) * page.camera.zoom;
    if (!width || !height) return;
    canvas.width = width;
    canvas.height = height;
    context.setTransform(scale, 0, 0, scale, width / 2 - (scale * wide) / 2 + page.camera.panX * width, height / 2 - (scale * paper[1]) / 2 + page.camera.panY * height);
    for (let k = 0; k < sheets; k++) {
      context.fillStyle = "#ffffff";
      context.fillRect(k * (paper[0] + gap), 0, ...paper);
    }
    context.globalCompositeOperation = "multiply"; /* inks shine through each other */
    const frame = filmAt(at);
    (frame ? frame.layers : layers).forEach((layer, k) => drawLayer(layer, frame ? layer.offsets.data.length - 1 : begun(k, at)));
    context.globalCompositeOperation = "source-over";
    if (beside) context.drawImage(target, paper[0] + gap + area[0], area[1], area[2], area[3]);
  }

  return { canvas, draw, readAt: () => "", field: () => null, lines: [], count: 2, times: null, paper: true, label, iteration, evaluationOf: () => NaN };
}
