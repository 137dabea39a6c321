/* Triangles and strokes in WebGL 2, drawn on one hidden canvas for all panels, which copy it. */

const MESH_VERTEX = `#version 300 es
in vec3 position; in vec4 color;
uniform mat4 view;
out vec4 ink; out vec3 place, corner;
void main() {
  place = position; ink = color;
  corner = vec3(equal(ivec3(gl_VertexID % 3), ivec3(0, 1, 2)));
  gl_Position = view * vec4(position, 1.0);
}`;

/* Both sides are lit: by a headlight and from the upper left, as in slender picture. */
const MESH_FRAGMENT = `#version 300 es
precision highp float;
in vec4 ink; in vec3 place, corner;
uniform vec3 toward, key; uniform float edges, alpha;
out vec4 color;
void main() {
  vec3 n = normalize(cross(dFdx(place), dFdy(place)));
  if (dot(n, toward) < 0.0) n = -n;
  float light = 0.42 + 0.34 * dot(n, toward) + 0.28 * max(dot(n, key), 0.0);
  vec3 width = fwidth(corner), near = smoothstep(vec3(0.0), 0.9 * width, corner);
  float line = edges * (1.0 - min(min(near.x, near.y), near.z));
  color = vec4(ink.rgb * min(light, 1.06) * (1.0 - 0.28 * line), ink.a * alpha);
  color.rgb *= color.a;
}`;

/* An instance is a stroke from a to b: 6 vertices of a rectangle with room for round ends, 3 of a head. As a tube it is lit as a
 * surface is, across it. */
const STROKE_VERTEX = `#version 300 es
in vec3 a, b; in vec4 color; in float width;
uniform mat4 view; uniform vec2 size; uniform float head, raise;
out vec4 ink; out vec2 along; out float reach, radius; flat out vec2 side;
void main() {
  vec4 A = view * vec4(a, 1.0), B = view * vec4(b, 1.0);
  vec2 p = A.xy * size / 2.0, q = B.xy * size / 2.0, d = q - p;
  float l = length(d), r = width / 2.0 + 0.75;
  vec2 t = l > 1e-4 ? d / l : vec2(1.0, 0.0), n = vec2(-t.y, t.x);
  float tip = head > 0.0 ? min(4.5 * width, 0.6 * l) : 0.0;
  ink = color; reach = l - tip; radius = width / 2.0; side = n;
  int k = gl_VertexID;
  vec2 at; float z;
  if (k < 6) {
    float end = (k == 1 || k == 2 || k == 4) ? 1.0 : 0.0, edge = (k == 2 || k == 4 || k == 5) ? 1.0 : -1.0;
    along = vec2(mix(-r, l - tip + r, end), edge * r);
    at = p + t * along.x + n * along.y; z = mix(A.z, B.z, end);
  } else {
    float edge = k == 6 ? 0.0 : k == 7 ? 1.0 : -1.0;
    along = vec2(0.0); reach = 1.0;
    at = q - (k == 6 ? vec2(0.0) : t * tip) + n * edge * tip * 0.38; z = B.z;
  }
  gl_Position = vec4(at * 2.0 / size, z - raise, 1.0);
}`;

const STROKE_FRAGMENT = `#version 300 es
precision highp float;
in vec4 ink; in vec2 along; in float reach, radius; flat in vec2 side;
uniform float inside, tube;
out vec4 color;
void main() {
  float d = length(vec2(along.x - clamp(along.x, 0.0, max(reach, 0.0)), along.y)), a = ink.a * clamp(radius + 0.5 - d, 0.0, 1.0);
  if (a <= 0.0 || (a > 0.98 * ink.a) != (inside > 0.0)) discard;
  float across = clamp(along.y / radius, -1.0, 1.0), toward = sqrt(1.0 - across * across);
  float light = 0.42 + 0.34 * toward + 0.28 * max(dot(vec3(side * across, toward), vec3(-0.5, 0.67, 0.55)), 0.0);
  color = vec4(ink.rgb * mix(1.0, min(light, 1.06), tube) * a, a);
}`;

function makeProgram(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

/* An attribute of an array: `each` numbers a vertex, or an instance. */
function setAttribute(gl, program, name, data, each, instanced) {
  const at = gl.getAttribLocation(program, name), buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, data, gl.STREAM_DRAW);
  gl.enableVertexAttribArray(at);
  const bytes = data instanceof Uint8Array;
  gl.vertexAttribPointer(at, each, bytes ? gl.UNSIGNED_BYTE : gl.FLOAT, bytes, 0, 0);
  gl.vertexAttribDivisor(at, instanced ? 1 : 0);
  return { at, buffer };
}

/* null: the browser cannot; redraw() is called when all must be drawn again. */
function makeRenderer(redraw) {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
  if (!gl) return null;
  let mesh, stroke;

  /* The graphics card may take all of it away, and give it back empty. */
  function prepare() {
    mesh = makeProgram(gl, MESH_VERTEX, MESH_FRAGMENT);
    stroke = makeProgram(gl, STROKE_VERTEX, STROKE_FRAGMENT);
  }
  prepare();
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => { prepare(); redraw(); });

  function begin(width, height) {
    if (canvas.width !== width || canvas.height !== height) (canvas.width = width), (canvas.height = height);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  function draw(program, view, attributes, uniforms, run) {
    if (gl.isContextLost()) return;
    gl.useProgram(program);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, "view"), false, viewMatrix(view));
    for (const [name, value] of Object.entries(uniforms)) {
      const at = gl.getUniformLocation(program, name);
      if (typeof value === "number") gl.uniform1f(at, value);
      else if (value.length === 2) gl.uniform2fv(at, value);
      else gl.uniform3fv(at, value);
    }
    const buffers = attributes.map(([name, data, each, instanced]) => setAttribute(gl, program, name, data, each, instanced));
    run();
    for (const { at, buffer } of buffers) gl.disableVertexAttribArray(at), gl.deleteBuffer(buffer);
  }

  /* positions [9 per face], colors [12 bytes per face]. */
  function drawMesh(view, positions, colors, { edges = 0, alpha = 1, oneSided = false } = {}) {
    const [right, up, toward] = view.axes;
    const key = toward.map((t, i) => 0.55 * t - 0.5 * right[i] + 0.67 * up[i]);
    if (oneSided) gl.enable(gl.CULL_FACE);
    gl.depthMask(alpha === 1);
    draw(mesh, view, [["position", positions, 3], ["color", colors, 4]], { toward, key, edges, alpha },
         () => gl.drawArrays(gl.TRIANGLES, 0, positions.length / 3));
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
  }

  /* from, to [3 a stroke], colors [4 bytes a stroke], widths [1 a stroke, pixels]. */
  function drawStrokes(view, strokes, { head = false, tube = false, raise = 0 } = {}) {
    if (strokes.widths.length === 0) return;
    const attributes = [["a", strokes.from, 3, true], ["b", strokes.to, 3, true], ["color", strokes.colors, 4, true], ["width", strokes.widths, 1, true]];
    for (const inside of [1, 0]) { /* soft edges hide nothing: neither the next stroke of their line nor its own end */
      gl.depthMask(inside === 1);
      draw(stroke, view, attributes, { size: [view.width, view.height], head: head ? 1 : 0, tube: tube ? 1 : 0, raise, inside },
           () => gl.drawArraysInstanced(gl.TRIANGLES, 0, head ? 9 : 6, strokes.widths.length));
    }
    gl.depthMask(true);
  }

  return { canvas, begin, drawMesh, drawStrokes };
}
