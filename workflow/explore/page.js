// Facts are plain values; arrays are 16-bit codes in one compressed block.
const page = JSON.parse(document.getElementById("data").textContent);
const { facts, layout } = page;
const byId = (name) => document.getElementById(name);
const MISSING = 65535;
const FLOOR = -6; // log10 of the least amplitude
const DASHES = ["dot", "dash", "solid", "dashdot", "longdash", "longdashdot"]; // with the colours: none twice
const COLOURS = ["#808080", "#0072B2", "#000000", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#E69F00", "#666666", "#004D40"];
const FEW = 30; // speeds: fewer are marked one by one
const CONFIG = { responsive: true, displaylogo: false, displayModeBar: false };
const MARGIN = { l: 66, r: 12, t: 34, b: 44 };
const WIDEST = 0.04; // of the last speed, a cell of the map
const last = facts.speeds.length - 1;
let chosen = 0;
let chosenBlade = null; // chosen of a stage; null: the worst of each speed

async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

// The array `name` as numbers, NaN where there is none; with `row` only that part of its first axis.
function numbers(codes, name, row) {
  const { shape, low, step, at } = layout[name];
  const size = shape.slice(row === undefined ? 0 : 1).reduce((a, b) => a * b, 1);
  const from = at + (row || 0) * size;
  return Float64Array.from(codes.subarray(from, from + size), (code) => (code === MISSING ? NaN : low + step * code));
}

const has = (name) => name in layout;
const rows = (flat, width) => Array.from({ length: flat.length / width }, (_, i) => flat.slice(i * width, (i + 1) * width));
const linear = (logs) => Array.from(logs, (value) => shown("length", 10 ** value));
const range = (n, of) => Array.from({ length: n }, (_, i) => of(i));
const largest = (values) => values.reduce((best, value) => (value > best ? value : best), -Infinity); // NaN is none

function plot(name, traces, layoutOf) {
  return Plotly.react(name, traces, { margin: MARGIN, font: { size: 12 }, showlegend: false, ...layoutOf }, CONFIG);
}

const titled = (text) => ({ title: { text, font: { size: 14 } } });

function notRecorded(name, title, key) {
  return plot(name, [], { ...titled(title), xaxis: { visible: false }, yaxis: { visible: false }, annotations: [{
    text: `not recorded: ${key}`, showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5 }] });
}

const axis = (text, more) => ({ title: { text, standoff: 8 }, ticks: "outside", linecolor: "#444", ...more });
const decades = (low, high) => ({ type: "log", range: [low, high], tickvals: range(high - low + 1, (i) => 10 ** (low + i)),
  ticktext: range(high - low + 1, (i) => plain(10 ** (low + i))) });
const topDecade = (amplitude) => Math.ceil(Math.log10(shown("length", amplitude)));
const speedAxis = () => axis(units.speed.name, { range: scaled("speed", RANGE) });
const lineAt = (speed, look) => ({ type: "line", x0: shown("speed", speed), x1: shown("speed", speed), yref: "paper", y0: 0, y1: 1,
  line: { width: 1.2, color: "#000", ...look } });

// The chosen speed and the operating speeds, as lines; of the latter also their names.
const OPERATING = Object.entries(facts.operating || {}).map(([name, rpm], i) =>
  ({ name: `${name} ${rpm.toFixed(0)} rpm`, speed: rpm / (60 * facts.f1_Hz), dash: ["dashdot", "dot"][i % 2] }));
const lines = () => [lineAt(facts.speeds[chosen]),
  ...OPERATING.map(({ speed, dash }) => lineAt(speed, { color: "#009E73", width: 2, dash }))];
const lineNames = () => OPERATING.map(({ name, speed }) => ({ text: name, x: shown("speed", speed), yref: "paper", y: 1, yanchor: "top",
  xanchor: "right", textangle: -90, showarrow: false, font: { size: 11, color: "#00664b" }, bgcolor: "rgba(255,255,255,0.7)" }));

const CAMPBELL = "Campbell diagram, engine orders (EO)";
const MODES = facts.campbell.frequencies.map((_, mode) => "f" + String(mode + 1).replace(/\d/g, (digit) => "₀₁₂₃₄₅₆₇₈₉"[digit]));

function drawCampbell() {
  const { speeds, frequencies } = facts.campbell;
  const top = largest([speeds[speeds.length - 1], ...OPERATING.map(({ speed }) => 1.03 * speed)]), highest = 1.08 * largest(frequencies.map(largest));
  const orders = facts.orders;
  const met = facts.crossings.map(([mode, k, speed]) => ({ x: shown("speed", speed), y: shown("frequency", k * speed), mode, k, speed }));
  const traces = [
    ...orders.map((k) => ({ x: scaled("speed", [0, top]), y: scaled("frequency", [0, k * top]), mode: "lines", name: `EO ${k}`,
      hoverinfo: "skip", line: { color: "#808080", width: 0.8, dash: "dot" } })),
    ...frequencies.map((of, mode) => ({ x: scaled("speed", speeds), y: scaled("frequency", of), mode: "lines", name: MODES[mode],
      line: { color: COLOURS[1 + mode], dash: DASHES[(2 + mode) % DASHES.length], width: 2 } })),
    { x: met.map(({ x }) => x), y: met.map(({ y }) => y), mode: "markers", name: "linear crossings", hoverinfo: "text",
      text: met.map(({ mode, k, speed }) => `EO ${k} meets ${MODES[mode - 1]} at ${said("speed", speed)}`),
      marker: { symbol: "square", size: 7, color: "#D55E00" } },
  ];
  const named = orders.map((k) => ({ text: `EO ${k}`, x: 1, xref: "paper", xanchor: "left", y: shown("frequency", k * top),
    showarrow: false, font: { size: 10 } }));
  return plot("campbell", traces, {
    ...titled(CAMPBELL), xaxis: axis(units.speed.name, { range: [0, shown("speed", top)] }),
    yaxis: axis(units.frequency.name, { range: [0, shown("frequency", highest)] }), margin: { ...MARGIN, r: 50 },
    shapes: lines(), annotations: [...lineNames(), ...named, ...frequencies.map((of, mode) => ({ text: MODES[mode], x: 0, xanchor: "left",
      y: shown("frequency", of[0]), yanchor: "bottom", showarrow: false, font: { color: COLOURS[1 + mode] } }))],
  });
}

const ALONG = "Amplitude of the tip along engine orders (EO)";

function drawOrders(codes) {
  if (!has("along")) return notRecorded("orders", ALONG, "record.spectrum_rounds in the scene");
  const all = facts.orders.length;
  const along = chosenBlade === null ? rows(numbers(codes, "along"), all)
    : rows(numbers(codes, "blade_along"), layout.blade_along.shape[1] * all).map((of) => of.slice(chosenBlade * all, (chosenBlade + 1) * all));
  const high = topDecade(1.4 * 10 ** Math.max(largest(along.map(largest)), -2)), low = high - 4;
  const mode = facts.speeds.length < FEW ? "lines+markers" : "lines";
  const traces = facts.orders.map((k, j) => ({
    x: scaled("speed", facts.speeds), y: linear(along.map((values) => values[j])), mode, name: `EO ${k}`,
    line: { dash: DASHES[j % DASHES.length], color: COLOURS[j % COLOURS.length], width: hasPeak(k) ? 2.2 : 1.3 },
    visible: drawn.has(k),
  }));
  const failed = facts.speeds.filter((_, i) => !facts.has_result[i]);
  if (failed.length)
    traces.push({ x: scaled("speed", failed), y: failed.map(() => 10 ** (low + 0.1)), mode: "markers", name: "no result",
      marker: { symbol: "x", size: 8, color: "#000" } });
  const marks = (chosenBlade === null ? facts.peaks : []).map((peak) => ({ // those of the worst blade
    x: shown("speed", facts.speeds[peak.index]), y: Math.log10(shown("length", peak.amplitude)), text: `${peak.name}<br>${peakText(peak)}`,
    hovertext: peak.says,
    showarrow: true, arrowhead: 0, ax: 0, ay: -26 - 28 * above(peak), font: { size: 11 }, bgcolor: "rgba(255,255,255,0.7)",
  }));
  const narrow = byId("orders").clientWidth < 600;
  return plot("orders", traces, {
    ...titled(ALONG + ofBlade()), showlegend: true, hovermode: "x", hoverdistance: -1, // a click anywhere chooses
    xaxis: speedAxis(), yaxis: axis(length("amplitude ‖Y‖"), decades(low, high)), annotations: [...lineNames(), ...marks],
    legend: narrow ? { orientation: "h", y: -0.3, itemclick: false, itemdoubleclick: false }
      : { x: 1.01, itemclick: false, itemdoubleclick: false },
    margin: { ...MARGIN, r: narrow ? 12 : 90 }, shapes: lines(),
  });
}

const NEAR = 0.05; // of the range of speeds, within which labels of peaks would overlap

function above(peak) { // neighbours at lower speeds that its label stands above
  const speed = ({ index }) => facts.speeds[index];
  const near = NEAR * (facts.speeds[last] - facts.speeds[0]);
  return facts.peaks.filter((other) => speed(other) < speed(peak) && speed(peak) - speed(other) < near).length;
}

const hasPeak = (k) => facts.peaks.some((peak) => peak.k === k);
const drawnAtFirst = (k) => facts.of_casing.includes(k) || hasPeak(k);
const drawn = new Set(facts.orders.filter(drawnAtFirst));
const peakText = (peak) => `${peak.at_end ? "≥ " : ""}${said("speed", facts.speeds[peak.index])}`;

function listOrders() { // which of them are drawn, with mouse or keyboard
  facts.orders.forEach((k, j) => {
    const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: drawn.has(k) });
    const label = document.createElement("label");
    label.append(box, ` ${k}`);
    byId("drawn").append(label);
    box.addEventListener("change", () => {
      drawn[box.checked ? "add" : "delete"](k);
      Plotly.restyle("orders", { visible: box.checked }, [j]);
    });
  });
}

// The spectra on a grid of frequencies: the largest amplitude in each of its cells.
function onGrid(codes, cells, highest) {
  const spectra = rows(numbers(codes, "spectrum"), layout.spectrum.shape[1]);
  const grid = range(cells, () => new Float64Array(spectra.length).fill(NaN));
  spectra.forEach((logs, i) => {
    const step = facts.speeds[i] / facts.spectrum_rounds;
    for (let cell = 0; cell < cells; cell++) {
      const low = Math.ceil((cell * highest) / cells / step);
      const high = Math.floor(((cell + 1) * highest) / cells / step);
      const inside = logs.slice(low, Math.max(low, high) + 1);
      if (inside.length && facts.has_result[i]) grid[cell][i] = largest(inside);
    }
  });
  return grid.map((line) => Array.from(line));
}

// Edges of the cells about each speed.
function edgesOf(speeds) {
  const half = (WIDEST * speeds[last]) / 2;
  const middle = (i, j) => (speeds[i] + speeds[j]) / 2;
  return speeds.flatMap((speed, i) => [
    Math.max(i ? middle(i, i - 1) : 2 * speed - (last ? middle(0, 1) : speed + half), speed - half),
    Math.min(i < last ? middle(i, i + 1) : 2 * speed - (last ? middle(last, last - 1) : speed - half), speed + half)]);
}
const EDGES = edgesOf(facts.speeds);
const RANGE = [EDGES[0], EDGES[EDGES.length - 1]];

const MAP = "Spectra, f₁, EO 2, 4, 6, 8 (grey: none)";

function drawMap(codes) {
  if (!has("spectrum")) return notRecorded("map", MAP, "record.spectrum_rounds in the scene");
  const cells = 300, highest = facts.highest;
  const z = onGrid(codes, cells, highest);
  const spread = z.map((line) => line.flatMap((value, i) => (i < last ? [value, null] : [value]))); // none between
  const high = topDecade(10 ** Math.max(largest(z.map(largest)), FLOOR)); // of the unit; z is over the gap
  const ticks = range(4, (i) => high - 3 + i), ofGap = Math.log10(units.length.scale);
  const traces = [{
    type: "heatmap", name: "spectra", x: scaled("speed", EDGES), y: range(cells, (i) => shown("frequency", ((i + 0.5) * highest) / cells)),
    z: spread, zmin: high - 3 - ofGap, zmax: high - ofGap, meta: units.length.scale, colorscale: MAGMA,
    text: spread.map((line) => line.map((value) => (value === null ? "" : said("length", 10 ** value)))),
    hovertemplate: `${units.speed.name} %{x:.4~g}<br>${units.frequency.name} %{y:.3~g}<br>amplitude %{text}<extra></extra>`,
    colorbar: { title: { text: length("amplitude"), side: "right" }, tickvals: ticks.map((n) => n - ofGap),
      ticktext: ticks.map((n) => plain(10 ** n)), thickness: 12 },
  }, { x: scaled("speed", facts.speeds), y: scaled("frequency", facts.f1), mode: "lines", name: "f₁", line: { color: "#0072B2", width: 1.6 },
    hoverinfo: "skip" }];
  for (const k of [2, 4, 6, 8])
    traces.push({ x: scaled("speed", [0, facts.speeds[last]]), y: scaled("frequency", [0, k * facts.speeds[last]]), mode: "lines",
      name: `EO ${k}`, hoverinfo: "skip", line: { color: "#808080", width: 0.8, dash: "dot" } });
  return plot("map", traces, {
    ...titled(MAP),
    xaxis: speedAxis(), yaxis: axis(units.frequency.name, { range: scaled("frequency", [0, highest]) }), plot_bgcolor: "#e0e0e0",
    shapes: lines(), annotations: lineNames(), margin: { ...MARGIN, r: 90 },
  });
}

// Light to dark, so that it reads without colour.
const MAGMA = [[0, "#ffffff"], [0.004, "#fcfdbf"], [0.13, "#fec488"], [0.25, "#fc8961"], [0.38, "#e75263"], [0.5, "#b73779"],
  [0.63, "#832681"], [0.75, "#51127c"], [0.88, "#1d1147"], [1, "#000004"]];

const SPECTRUM = "Spectrum of the last revolutions";

function drawSpectrum(codes) {
  if (!has("spectrum")) return notRecorded("spectrum", SPECTRUM, "record.spectrum_rounds in the scene");
  const logs = numbers(codes, "spectrum", chosen);
  const orders = range(logs.length, (i) => i / facts.spectrum_rounds);
  const high = topDecade(10 ** Math.max(layout.spectrum.low + 65534 * layout.spectrum.step, FLOOR));
  return plot("spectrum", [{ x: orders, y: linear(logs), mode: "lines", line: { color: "#000", width: 1 } }], {
    ...titled(SPECTRUM), xaxis: axis("engine order f / Ω", { range: [0, facts.highest / facts.speeds[chosen]] }),
    yaxis: axis(length("amplitude"), decades(high - 6, high)),
  });
}

const PROFILE = "Worn profile, leading eighth of the chord";
const CIRCLE = 5; // gaps, the undeformed tip in the polar picture
const START = facts.travels ? " at the start" : ""; // where harmonics travel
const POLAR = `Casing${START} and worn liner (tip drawn at ${CIRCLE} gaps)`;

function drawWear(codes) {
  if (!has("worn"))
    return Promise.all([["profile", PROFILE], ["polar", POLAR]].map(([name, title]) =>
      notRecorded(name, title, "record.wear in the scene")));
  const worn = Array.from(numbers(codes, "worn", chosen));
  const degrees = range(worn.length, (i) => (360 * i) / worn.length);
  const inward = Array.from(numbers(codes, "inward"));
  const profile = plot("profile", [{ x: degrees, y: scaled("length", worn), mode: "lines", fill: "tozeroy", line: { color: "#D55E00" } }], {
    ...titled(PROFILE), xaxis: axis("casing angle (deg)", { range: [0, 360], dtick: 45 }),
    yaxis: axis(length("worn depth"), { rangemode: "tozero" }),
  });
  const closed = (values) => [...values, values[0]];
  const around = closed(degrees);
  const liner = (depth) => closed(inward.map((d, i) => CIRCLE + 1 - d + depth[i]));
  const deepest = layout.worn.low + 65534 * layout.worn.step;
  const line = (r, name, look) => ({ type: "scatterpolar", theta: around, r, mode: "lines", name, line: look, hoverinfo: "skip" });
  const polar = plot("polar", [
    line(around.map(() => CIRCLE), "undeformed tip", { color: "#0072B2", dash: "dashdot", width: 1.4 }),
    line(liner(inward.map(() => 0)), "liner, new", { color: "#808080", dash: "dash", width: 1.2 }),
    line(liner(worn), "liner, worn", { color: "#D55E00", width: 2 }),
  ], {
    ...titled(POLAR), showlegend: true, legend: { x: 0.5, y: -0.05, xanchor: "center", orientation: "h" },
    polar: { radialaxis: { showticklabels: false, ticks: "", range: [0, CIRCLE + 1 - Math.min(0, ...inward) + deepest] },
      angularaxis: { dtick: 45 } }, margin: { l: 30, r: 30, t: 50, b: 40 },
  });
  return Promise.all([profile, polar]);
}

const HISTORY = `Range of u_r at ${facts.place}, whole run`;

function drawHistory(codes) {
  if (!has("history"))
    return notRecorded("history", HISTORY, "set record: {motion: 3} in the scene");
  const flat = numbers(codes, "history", chosen);
  const windows = flat.length / 2;
  const rounds = range(windows, (i) => ((i + 0.5) * facts.rounds) / windows);
  const edge = (which) => range(windows, (i) => shown("length", flat[2 * i + which]));
  const line = { color: "#000", width: 1 };
  return plot("history", [{ x: rounds, y: edge(0), mode: "lines", name: "least", line },
    { x: rounds, y: edge(1), mode: "lines", name: "largest", line, fill: "tonexty", fillcolor: "rgba(0,0,0,0.25)" }], {
    ...titled(HISTORY), xaxis: axis(`time (revolutions), least and largest of each 1/${Math.round(windows / facts.rounds)}`), yaxis: axis(length("u_r")),
  });
}

const SIGNAL = `Signal u_r at ${facts.place}, last revolution`;

function drawSignal(codes) {
  if (!has("signal"))
    return notRecorded("signal", SIGNAL, "set record: {motion: 3} in the scene");
  const u = scaled("length", numbers(codes, "signal", chosen));
  const at = range(u.length, (i) => i).filter((i) => !Number.isNaN(u[i])); // a state for each picture of the motion
  const trace = { x: at.map((i) => facts.signal_time[i]), y: at.map((i) => u[i]), mode: "lines", line: { color: "#000", width: 1 } };
  return plot("signal", [trace], {
    ...titled(SIGNAL), xaxis: axis(`time (revolutions${facts.at_most && ", 0 at the end of the run"}), ${at.length} states`), yaxis: axis(length("u_r")),
  });
}

// Names in results, of energies and others, are text, with whatever is in them.
const text = (value) => String(value).replace(/[&<>]/g, (sign) => `&#${sign.charCodeAt(0)};`);

function showNumbers() {
  const row = (name, values) => `<tr><th>${text(name)}</th>${values.map((value) => `<td>${text(value)}</td>`).join("")}</tr>`;
  const joule = (value) => (typeof value === "number" ? value.toExponential(2) : value || "none");
  const percent = (value) => (typeof value === "number" ? `${(100 * value).toPrecision(2)} %` : value || "not known");
  byId("numbers").innerHTML = facts.tables.map(({ says, of }) => {
    const told = says.startsWith("energy") ? joule : percent;
    return row(says, Object.keys(of)) + row("", Object.values(of).map((values) => told(values[chosen])));
  }).join("");
}

// The summary of the scene: a row for each peak; a click chooses its speed.
function showAnswers(codes) {
  const told = facts.answers;
  if (!told) return;
  byId("answers").hidden = false;
  const cells = (kind, values) => values.map((value) => `<${kind}>${text(value)}</${kind}>`).join("");
  byId("of_scene").textContent = told.about;
  const table = ({ heads, rows }) => `<thead><tr>${cells("th", heads)}</tr></thead><tbody>` +
    rows.map((row) => `<tr>${cells("td", row)}</tr>`).join("") + "</tbody>";
  ["peaks", "loads", "blades", "margins"].forEach((name, i) => { byId(name).innerHTML = table(told.tables[i]); });
  ["blades", "margins"].forEach((name, i) => { byId(name).parentElement.hidden = !told.tables[2 + i].rows.length; });
  byId("notes").innerHTML = told.notes.map((note) => `<li>${text(note)}</li>`).join("");
  byId("explained").textContent = told.meaning;
  ["peaks", "loads"].forEach((name) => byId(name).querySelectorAll("tbody tr").forEach((row, i) =>
    row.addEventListener("click", () => choose(codes, nearest(told.speeds[i])))));
}

function showSpeed() {
  const speed = facts.speeds[chosen];
  const hertz = speed * facts.f1_Hz;
  const lobes = facts.lobes.length ? `, ${facts.lobes[chosen]} lobes` : "";
  byId("at").textContent = `${(60 * hertz).toFixed(0)} rpm, ${hertz.toFixed(1)} Hz, Ω / f₁(0) = ${speed.toFixed(4)}: ` +
    `${facts.status[chosen]}, ${facts.trend[chosen]}${lobes}`;
  byId("speed").value = chosen;
  sayBlade();
}

const listeners = []; // what else follows the chosen speed

async function choose(codes, index) {
  chosen = Math.max(0, Math.min(last, index));
  showSpeed();
  showNumbers();
  const maps = ["campbell", ...(has("spectrum") ? ["orders", "map"] : [])].map((name) => Plotly.relayout(name, { shapes: lines() }));
  const drawn = [...maps, drawSpectrum(codes), drawWear(codes), drawHistory(codes), drawSignal(codes), ...(facts.blades ? [drawBlades()] : [])];
  listeners.forEach((listen) => listen(chosen));
  await Promise.all(drawn);
  document.body.dataset.shown = chosen; // for tests
}

function nearest(x) {
  return facts.speeds.reduce((best, speed, i) => (Math.abs(speed - x) < Math.abs(facts.speeds[best] - x) ? i : best), 0);
}

function toPeak(way) {
  const at = facts.peaks.map((peak) => peak.index).sort((a, b) => a - b);
  const beyond = at.filter((index) => way * (index - chosen) > 0);
  return beyond.length ? (way > 0 ? beyond[0] : beyond[beyond.length - 1]) : chosen;
}

function listen(codes) {
  byId("speed").max = last;
  byId("speed").addEventListener("input", (event) => choose(codes, Number(event.target.value)));
  for (const name of ["campbell", "orders", "map"])
    byId(name).on("plotly_click", (event) => choose(codes, nearest(event.points[0].x / units.speed.scale)));
  byId("units").addEventListener("input", async (event) => {
    units = UNITS[event.target.value];
    await drawAll(codes);
    await choose(codes, chosen);
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || ["INPUT", "SELECT"].includes(event.target.tagName)) return;
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!way) return;
    event.preventDefault();
    choose(codes, event.shiftKey ? toPeak(way) : chosen + way);
  });
}

const drawAll = (codes) => Promise.all([drawCampbell(), drawOrders(codes), drawMap(codes)]);

async function start() {
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(await inflated(page.plotly));
  document.head.append(script);
  const codes = new Uint16Array(await inflated(page.codes));
  byId("about").textContent = `Blade ${facts.blade}, scene ${facts.scene}: ${facts.label}. f₁(0) = ` +
    `${facts.f1_Hz.toFixed(2)} Hz, gap ${facts.gap_um.toFixed(1)} µm, ${facts.speeds.length} speeds of ${facts.at_most}${facts.rounds} revolutions.`;
  byId("meanings").textContent = facts.meanings;
  const first = facts.peaks.length ? facts.peaks[0].index : 0;
  chosen = first;
  byId("units").value = facts.norms ? "norms" : "engine";
  listOrders();
  showAnswers(codes);
  await drawAll(codes);
  listen(codes);
  await listBlades(codes);
  offerFiles();
  startBlade(codes);
  await choose(codes, first);
  document.body.dataset.ready = "yes";
}

