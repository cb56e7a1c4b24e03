// The blade at the chosen speed, in motion, below the liner: drawn with WebGL, turned under the mouse.
const VERTEX = `#version 300 es
in vec3 place; in float value;
uniform mat3 view; uniform vec3 middle; uniform vec3 zoom;
out float shade; out vec3 seen;
void main() {
  seen = view * (place - middle);
  shade = value;
  gl_Position = vec4(seen.xy * zoom.xy, -seen.z * zoom.z, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in float shade; in vec3 seen;
uniform sampler2D palette; uniform float opacity;
out vec4 colour;
void main() {
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  float light = 0.55 + 0.45 * abs(normal.z);
  colour = vec4(texture(palette, vec2(clamp(shade, 0.002, 0.998), 0.5)).rgb * light, 1.0) * opacity;
}`;
const GREYS = [[0, "#f2f2f2"], [1, "#303030"]];
const ANGLES = 61; // across the liner's surface
const SPAN = 0.16; // rad, of the liner drawn, to both sides of the blade
const VIEW = { turn: 0.9, tilt: 0.2, zoom: 1 }; // rad, from where the blade is seen at first
const TIP = 0.005; // of the blade's height: its upper end
const LARGEST = 0.15; // of the blade's length, the displacement drawn at first

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

function paletteOf(scale) {
  return Uint8Array.from(range(256, (i) => {
    const x = i / 255;
    const after = Math.max(1, scale.findIndex(([at]) => at >= x));
    const [[low, from], [high, to]] = [scale[after - 1], scale[after]];
    const [start, end] = [rgb(from), rgb(to)];
    return [...start.map((c, j) => c + ((end[j] - c) * (x - low)) / (high - low)), 255];
  }).flat());
}

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  return made;
}

function texture(gl, scale) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, paletteOf(scale));
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
  return made;
}

// A surface: triangles, and buffers that are filled anew in each frame.
function surfaceOf(gl, shaders, triangles, nodes) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const buffers = [["place", 3], ["value", 1]].map(([name, size]) => {
    const buffer = gl.createBuffer();
    const at = gl.getAttribLocation(shaders, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, 4 * size * nodes, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    return buffer;
  });
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, Uint16Array.from(triangles), gl.STATIC_DRAW);
  return { array, buffers, count: triangles.length, place: new Float32Array(3 * nodes), value: new Float32Array(nodes) };
}

function drawSurface(gl, surface) {
  gl.bindVertexArray(surface.array);
  [surface.place, surface.value].forEach((values, i) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, surface.buffers[i]);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
  });
  gl.drawElements(gl.TRIANGLES, surface.count, gl.UNSIGNED_SHORT, 0);
}

function roundStep(least) { // 1, 2 or 5 times a power of ten
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-9));
}

function grid(down, across) { // triangles of a grid of nodes
  const found = [];
  for (let i = 0; i + 1 < down; i++)
    for (let j = 0; j + 1 < across; j++) {
      const at = i * across + j;
      found.push(at, at + 1, at + across, at + 1, at + across + 1, at + across);
    }
  return found;
}

// Amplitudes of the shapes at the recorded times of a speed, in the order of a round.
function recorded(codes, speed) {
  const width = facts.motion.shapes;
  return rows(numbers(codes, "a", speed), width).map((a, i) => ({ at: facts.motion.of_round[i], a }))
    .filter(({ a }) => !Number.isNaN(a[0])).sort((one, other) => one.at - other.at);
}

function between(states, time) { // amplitudes at a time, in rounds
  const at = ((time % 1) + 1) % 1;
  let next = states.findIndex((state) => state.at > at);
  const from = states[(next <= 0 ? states.length : next) - 1];
  const to = states[next < 0 ? 0 : next];
  const gap = (((to.at - from.at) % 1) + 1) % 1 || 1;
  const part = ((((at - from.at) % 1) + 1) % 1) / gap;
  return from.a.map((value, i) => value + (to.a[i] - value) * part);
}

function startBlade(codes) {
  if (!facts.motion) {
    byId("still").textContent = "The blade in motion: set record: {motion: 3} in the scene.";
    return;
  }
  try {
    showBlade(codes, byId("blade").getContext("webgl2", { antialias: true }));
  } catch (fault) {
    byId("still").textContent = `The blade in motion needs WebGL 2, which this browser does not give: ${fault.message}`;
  }
}

function showBlade(codes, gl) {
  if (!gl) throw new Error("no context");
  const canvas = byId("blade");
  const points = numbers(codes, "points");
  const shapes = rows(numbers(codes, "shapes"), points.length);
  const ofShapes = rows(numbers(codes, "of_shapes"), 2 * points.length);
  const powers = rows(numbers(codes, "static"), 2 * points.length);
  const [radius, axial, gaps] = ["liner_radius", "liner_z", "liner_gap"].map((name) => numbers(codes, name));
  const inward = numbers(codes, "inward");
  const nodes = points.length / 3, strips = gaps.length - 1, gap = facts.gap_um * 1e-6;
  const shaders = program(gl);
  const blade = surfaceOf(gl, shaders, numbers(codes, "triangles").map(Math.round), nodes);
  const liner = surfaceOf(gl, shaders, grid(strips + 1, ANGLES), (strips + 1) * ANGLES);
  const palettes = [texture(gl, MAGMA), texture(gl, GREYS)];
  const ends = range(3, (c) => range(2, (side) => points.reduce((found, x, i) =>
    i % 3 === c ? (side ? Math.max(found, x) : Math.min(found, x)) : found, side ? -Infinity : Infinity)));
  const size = ends[0][1] - ends[0][0];
  const middle = ends.map(([low, high]) => (low + high) / 2);
  const eye = { ...VIEW };
  const tip = range(nodes, (n) => n).filter((n) => points[3 * n] > ends[0][1] - TIP * size);
  const [LE, TE] = [-1, 1].map((way) => tip.reduce((best, n) => (way * (points[3 * n + 2] - points[3 * best + 2]) > 0 ? n : best)));
  const now = { speed: 0, states: [], still: new Float64Array(2 * points.length), wear: [], deepest: 1, top: 1, time: 0 };
  let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, stamp = 0, frames = 0;

  const factor = () => 10 ** Number(byId("scale").value);
  const pace = () => 10 ** Number(byId("pace").value); // rounds in a second

  function moved(a) { // vibration of all nodes, m
    const u = new Float64Array(points.length);
    a.forEach((value, i) => { const shape = shapes[i]; for (let j = 0; j < u.length; j++) u[j] += value * shape[j]; });
    return u;
  }

  function vonMises(a) { // MPa, of rotation and vibration
    const s = Float64Array.from(now.still);
    a.forEach((value, i) => { const of = ofShapes[i]; for (let j = 0; j < s.length; j++) s[j] += value * of[j]; });
    return Float64Array.from({ length: nodes }, (_, n) => {
      const [x, y, z, xy, yz, xz] = s.subarray(6 * n, 6 * n + 6);
      return Math.sqrt(0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) + 3 * (xy * xy + yz * yz + xz * xz));
    });
  }

  function coloured(a, u) {
    if (byId("colour").value === "stress") return vonMises(a);
    return Float64Array.from({ length: nodes }, (_, n) => 1e6 * Math.hypot(u[3 * n], u[3 * n + 1], u[3 * n + 2]));
  }

  function poseBlade() {
    const a = between(now.states, now.time), u = moved(a), values = coloured(a, u), s = factor();
    for (let j = 0; j < u.length; j++) blade.place[j] = points[j] + s * u[j];
    for (let n = 0; n < nodes; n++) blade.value[n] = values[n] / now.top;
  }

  function poseLiner() { // at the angle of the blade, the radial distances exaggerated like the blade
    const s = factor();
    for (let i = 0; i <= strips; i++)
      for (let j = 0; j < ANGLES; j++) {
        const phi = SPAN * ((2 * j) / (ANGLES - 1) - 1), at = i * ANGLES + j;
        const part = ((((phi / (2 * Math.PI) + now.time) % 1) + 1) % 1);
        const strip = now.wear[Math.min(i, now.wear.length - 1)];
        const worn = strip[Math.floor(part * strip.length)];
        const d = inward[Math.floor(part * inward.length)];
        const r = radius[i] + s * (gaps[i] + gap * (worn - d));
        liner.place.set([r * Math.cos(phi), r * Math.sin(phi), axial[i]], 3 * at);
        liner.value[at] = worn / now.deepest;
      }
  }

  function look() { // rows: to the right, up, towards the eye
    const v = [Math.sin(eye.tilt), Math.cos(eye.tilt) * Math.cos(eye.turn), Math.cos(eye.tilt) * Math.sin(eye.turn)];
    const across = Math.hypot(v[1], v[2]);
    const right = [0, -v[2] / across, v[1] / across];
    const up = [v[1] * right[2] - v[2] * right[1], v[2] * right[0] - v[0] * right[2], v[0] * right[1] - v[1] * right[0]];
    return [right, up, v];
  }

  function paint() {
    const [wide, tall] = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.round(n * devicePixelRatio));
    if (canvas.width !== wide || canvas.height !== tall) [canvas.width, canvas.height] = [wide, tall];
    poseBlade();
    poseLiner();
    gl.viewport(0, 0, wide, tall);
    gl.clearColor(0.98, 0.98, 0.98, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(shaders);
    const uniform = (name) => gl.getUniformLocation(shaders, name);
    const rowsOf = look();
    gl.uniformMatrix3fv(uniform("view"), false, range(9, (i) => rowsOf[i % 3][Math.floor(i / 3)]));
    gl.uniform3fv(uniform("middle"), middle);
    const zoom = (1.7 * eye.zoom) / size;
    gl.uniform3fv(uniform("zoom"), [(zoom * tall) / wide, zoom, 0.5 / size]);
    gl.enable(gl.BLEND); // the liner lets the blade's tip be seen
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    [blade, liner].forEach((surface, i) => {
      gl.uniform1f(uniform("opacity"), i ? 0.6 : 1);
      gl.bindTexture(gl.TEXTURE_2D, palettes[i]);
      drawSurface(gl, surface);
    });
    name("LE", LE, rowsOf, [(zoom * tall) / wide, zoom]);
    name("TE", TE, rowsOf, [(zoom * tall) / wide, zoom]);
    canvas.dataset.frames = ++frames; // for tests
  }

  function name(edge, node, [right, up], zooms) { // where a corner is seen
    const from = [0, 1, 2].map((c) => blade.place[3 * node + c] - middle[c]);
    const [x, y] = [right, up].map((row, i) => zooms[i] * row.reduce((sum, of, c) => sum + of * from[c], 0));
    Object.assign(byId(edge).style, { left: `${50 * (1 + x)}%`, top: `${50 * (1 - y)}%` });
  }

  function follow(speed) {
    now.speed = speed;
    now.states = recorded(codes, speed);
    byId("moving").hidden = !now.states.length;
    byId("still").hidden = now.states.length > 0;
    if (!now.states.length) return;
    const ratio = (facts.speeds[speed] / facts.motion.Omega_m_over_f1) ** 2;
    now.still.fill(0);
    powers.forEach((of, p) => { for (let j = 0; j < of.length; j++) now.still[j] += ratio ** p * of[j]; });
    now.wear = has("liner") ? rows(numbers(codes, "liner", speed), layout.liner.shape[2]) : [[0]];
    now.deepest = Math.max(largest(now.wear.map((strip) => largest(strip))), 1e-9);
    rescale();
    show();
  }

  function rescale() { // colours: from 0 to the largest value of the round
    now.top = Math.max(largest(now.states.map(({ a }) => largest(coloured(a, moved(a))))), 1e-12);
    const unit = byId("colour").value === "stress" ? "MPa, with that of rotation" : "µm, about the static deflection";
    byId("range").textContent = `0 to ${plain(now.top)} ${unit}; liner: grey, to ${said("length", now.deepest)} ` +
      `worn; ${facts.motion.shapes} shapes, which miss ${plain(100 * facts.motion.missed[now.speed], 1)} % of the motion`;
    const step = roundStep(now.top / 5);
    byId("ticks").replaceChildren(...range(Math.floor(now.top / step * (1 + 1e-9)) + 1, (i) => {
      const tick = Object.assign(document.createElement("span"), { textContent: plain(i * step) });
      tick.style.left = `${(100 * i * step) / now.top}%`;
      return tick;
    }));
  }

  function labels() {
    byId("times").textContent = `× ${plain(factor(), 2)}`;
    const hertz = facts.speeds[now.speed] * facts.f1_Hz;
    byId("slow").textContent = `${plain(hertz / pace(), 2)} times slower`;
    byId("play").textContent = playing ? "stop" : "play";
  }

  function show() { labels(); if (now.states.length) paint(); }

  function tick(time) {
    const passed = Math.min(time - stamp, 100);
    stamp = time;
    if (playing && now.states.length && !document.hidden) {
      now.time += (passed / 1000) * pace();
      paint();
    }
    requestAnimationFrame(tick);
  }

  function toggle() { playing = !playing; show(); }

  function turn(across, down) { // rad: the blade follows the hand
    eye.turn -= across;
    eye.tilt = Math.max(-1.5, Math.min(1.5, eye.tilt + down));
    show();
  }
  function zoomBy(part) { eye.zoom *= Math.exp(part); show(); }
  function reset() { Object.assign(eye, VIEW); show(); }

  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons) turn(event.movementX / 150, event.movementY / 150);
  });
  canvas.addEventListener("wheel", (event) => { // plain scrolling is the page's
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoomBy(-event.deltaY / 800);
  });
  const keys = { ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, -0.1),
    ArrowDown: () => turn(0, 0.1), "+": () => zoomBy(0.1), "=": () => zoomBy(0.1), "-": () => zoomBy(-0.1), Home: reset, " ": toggle };
  canvas.addEventListener("keydown", (event) => {
    if (!(event.key in keys) || event.ctrlKey || event.altKey || event.metaKey) return;
    event.stopPropagation();
    event.preventDefault();
    keys[event.key]();
  });
  byId("play").addEventListener("click", toggle);
  byId("reset").addEventListener("click", reset);
  byId("png").addEventListener("click", () => {
    paint(); // a picture is lost after its frame
    canvas.toBlob((picture) => download("blade", "png", picture));
  });
  byId("colour").addEventListener("input", () => { rescale(); show(); });
  for (const name of ["scale", "pace"]) byId(name).addEventListener("input", show);
  const bar = byId("bar").getContext("2d");
  const colours = paletteOf(MAGMA);
  range(256, (i) => { bar.fillStyle = `rgb(${colours.slice(4 * i, 4 * i + 3)})`; bar.fillRect(i, 0, 1, 14); });
  const strongest = facts.speeds.flatMap((_, speed) => recorded(codes, speed).map(({ a }) => a))
    .reduce((best, a) => (Math.hypot(...a) > Math.hypot(...best) ? a : best), [0]);
  const farthest = Math.max(largest(moved(strongest).map(Math.abs)), 1e-12);
  byId("scale").value = Math.log10((LARGEST * size) / farthest);
  byId("pace").value = -1;
  listeners.push(follow);
  requestAnimationFrame(tick);
}

start();
