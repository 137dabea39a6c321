/* How the page is used: mouse, touch and keys on the panels, the choices, the moment. */

/* Drag turns; with shift, the right button or two fingers it shifts; wheel and pinch zoom. Keys: arrows. */
function addPointer(panel, page, readout) {
  const { canvas } = panel, fingers = new Map();
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  function turn(dx, dy) {
    const { camera } = page;
    if (panel.paper) return shift(dx, dy);
    camera.azimuth -= dx * 0.01;
    camera.elevation = Math.min(Math.max(camera.elevation + dy * 0.01, -Math.PI / 2), Math.PI / 2);
  }
  function shift(dx, dy) {
    page.camera.panX += dx / canvas.clientWidth;
    page.camera.panY += dy / canvas.clientHeight;
  }
  function zoom(factor) {
    page.camera.zoom = Math.min(Math.max(page.camera.zoom * factor, 0.2), 40);
  }
  function spread() {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  }
  canvas.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId), box = canvas.getBoundingClientRect();
    if (!finger) return void (readout.textContent = panel.readAt(event.clientX - box.left, event.clientY - box.top, page.frameOf(panel)));
    const dx = event.clientX - finger.x, dy = event.clientY - finger.y, before = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size === 2) shift(dx / 2, dy / 2), zoom(spread() / (before || 1));
    else if (event.shiftKey || event.buttons & 2) shift(dx, dy);
    else turn(dx, dy);
    page.redraw();
  });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("pointerleave", () => (readout.textContent = ""));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoom(Math.exp(-event.deltaY * 0.0015)); page.redraw(); }, { passive: false });
  canvas.addEventListener("dblclick", () => page.look(CAMERA_START));
}

/* A named choice out of several, [value, words] each. */
function addSelect(bar, words, options, chosen, set) {
  if (options.length < 2) return null;
  const label = document.createElement("label"), select = document.createElement("select");
  for (const [value, text] of options) select.append(new Option(text, value, false, value === chosen));
  select.addEventListener("change", () => set(select.value, select));
  label.append(`${words} `, select);
  bar.append(label);
  return select;
}

function addSwitch(bar, words, on, set) {
  const label = document.createElement("label"), box = document.createElement("input");
  box.type = "checkbox";
  box.checked = on;
  box.addEventListener("change", () => set(box.checked));
  label.append(box, ` ${words}`);
  bar.append(label);
  return box;
}

const VIEWS = { "three quarters": CAMERA_START, front: { azimuth: -Math.PI / 2, elevation: 0 }, side: { azimuth: 0, elevation: 0 }, top: { azimuth: -Math.PI / 2, elevation: Math.PI / 2 } };

/* What has this letter is switched by it. */
function addKeys(page, switches) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== "range") return;
    const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 }[event.key];
    const moves = page.panels.some((panel) => panel.count > 1);
    if (moves && event.key === " " && !/^(BUTTON|SUMMARY)$/.test(event.target.tagName)) page.play(!page.playing);
    else if (moves && event.key === "Home") page.go(0);
    else if (moves && event.key === "End") page.go(1);
    else if (moves && step) page.play(false), page.step(step);
    else if (event.key === "0") page.look(CAMERA_START);
    else if (switches[event.key]) switches[event.key]();
    else return;
    event.preventDefault();
  });
}
