// Facts are plain values; arrays are 16-bit codes in one compressed block.
const page = JSON.parse(document.getElementById("data").textContent);
const { facts, layout } = page;
const byId = (name) => document.getElementById(name);
const MISSING = 65535;
const FLOOR = -6; // log10 of the least amplitude
const DASHES = ["dot", "dash", "solid", "dashdot", "longdash", "longdashdot", "dot", "dash", "solid", "dashdot"];
const COLOURS = ["#808080", "#56B4E9", "#000000", "#009E73", "#D55E00", "#CC79A7", "#0072B2", "#E69F00", "#666666",
  "#004D40"];
const CONFIG = { responsive: true, displaylogo: false, displayModeBar: false };
const MARGIN = { l: 66, r: 12, t: 34, b: 44 };
const WIDEST = 0.04; // of the last speed, a cell of the map
const last = facts.speeds.length - 1;
let chosen = 0;

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
const linear = (logs) => Array.from(logs, (value) => 10 ** value);
const range = (n, of) => Array.from({ length: n }, (_, i) => of(i));

function plot(name, traces, layoutOf) {
  return Plotly.react(name, traces, { margin: MARGIN, font: { size: 12 }, showlegend: false, ...layoutOf }, CONFIG);
}

const axis = (text, more) => ({ title: { text, standoff: 8 }, ticks: "outside", linecolor: "#444", ...more });
const decades = (low, high) => ({ type: "log", range: [low, high], tickvals: range(high - low + 1, (i) => 10 ** (low + i)),
  ticktext: range(high - low + 1, (i) => `10<sup>${low + i}</sup>`) });
const lineAt = (x) => ({ type: "line", x0: x, x1: x, yref: "paper", y0: 0, y1: 1, line: { width: 1.2, color: "#000" } });
const SPEED = "Ω / f₁(0)";

function drawOrders(codes) {
  const along = rows(numbers(codes, "along"), facts.orders.length);
  const traces = facts.orders.map((k, j) => ({
    x: facts.speeds, y: along.map((values) => 10 ** values[j]), mode: "lines", name: `k = ${k}`,
    line: { dash: DASHES[j], color: COLOURS[j], width: k === 4 || k === 6 ? 2.2 : 1.3 },
    visible: facts.peaks.some((peak) => peak.k === k) || k === 2 ? true : "legendonly",
  }));
  const marks = facts.peaks.map((peak) => ({
    x: facts.speeds[peak.index], y: Math.log10(amplitudeAlong(codes, peak)), text: `k = ${peak.k}<br>${peakText(peak)}`,
    showarrow: true, arrowhead: 0, ax: 0, ay: -26, font: { size: 11 },
  }));
  return plot("orders", traces, {
    title: { text: "Amplitude of the tip along engine orders k", font: { size: 14 } }, showlegend: true,
    xaxis: axis(SPEED, SPEEDS), yaxis: axis("‖Y‖ / gap", decades(-3, top(along))), annotations: marks,
    legend: { orientation: "v", x: 1.01 }, margin: { ...MARGIN, r: 90 }, shapes: [lineAt(facts.speeds[chosen])],
  });
}

const top = (along) => Math.ceil(Math.max(...along.map((values) => Math.max(...values))) + 0.15);
const peakText = (peak) => `${peak.at_end ? "≥ " : ""}${facts.speeds[peak.index].toFixed(3)}`;

function amplitudeAlong(codes, peak) {
  const logs = numbers(codes, "spectrum", peak.index);
  const near = (k) => Math.round(k * facts.spectrum_rounds);
  return 10 ** Math.max(...logs.slice(near(peak.k - 0.25), near(peak.k + 0.25) + 1));
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
      if (inside.length) grid[cell][i] = Math.max(...inside);
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
const SPEEDS = { range: [EDGES[0], EDGES[EDGES.length - 1]] };

function drawMap(codes) {
  const cells = 300, highest = 2.5;
  const z = onGrid(codes, cells, highest);
  const high = Math.ceil(Math.max(...z.flat().filter(Number.isFinite)));
  const spread = z.map((line) => line.flatMap((value, i) => (i < last ? [value, null] : [value]))); // none between
  const traces = [{
    type: "heatmap", x: EDGES, y: range(cells, (i) => ((i + 0.5) * highest) / cells), z: spread, zmin: high - 3, zmax: high,
    colorscale: MAGMA, hovertemplate: "Ω / f₁(0) = %{x:.3f}<br>f / f₁(0) = %{y:.2f}<br>10^%{z:.1f} gaps<extra></extra>",
    colorbar: { title: { text: "amplitude / gap", side: "right" }, tickvals: [high - 3, high - 2, high - 1, high],
      ticktext: [high - 3, high - 2, high - 1, high].map((n) => `10<sup>${n}</sup>`), thickness: 12 },
  }, { x: facts.speeds, y: facts.f1, mode: "lines", line: { color: "#0072B2", width: 1.6 }, hoverinfo: "skip" }];
  for (const k of [2, 4, 6, 8])
    traces.push({ x: [0, facts.speeds[last]], y: [0, k * facts.speeds[last]], mode: "lines", hoverinfo: "skip",
      line: { color: "#808080", width: 0.8, dash: "dot" } });
  return plot("map", traces, {
    title: { text: "Spectra, f₁(Ω), engine orders 2, 4, 6, 8", font: { size: 14 } },
    xaxis: axis(SPEED, SPEEDS), yaxis: axis("f / f₁(0)", { range: [0, highest] }),
    shapes: [lineAt(facts.speeds[chosen])], margin: { ...MARGIN, r: 90 },
  });
}

// Light to dark, so that it reads without colour.
const MAGMA = [[0, "#ffffff"], [0.004, "#fcfdbf"], [0.13, "#fec488"], [0.25, "#fc8961"], [0.38, "#e75263"], [0.5, "#b73779"],
  [0.63, "#832681"], [0.75, "#51127c"], [0.88, "#1d1147"], [1, "#000004"]];

function drawSpectrum(codes) {
  const logs = numbers(codes, "spectrum", chosen);
  const orders = range(logs.length, (i) => i / facts.spectrum_rounds);
  return plot("spectrum", [{ x: orders, y: linear(logs), mode: "lines", line: { color: "#000", width: 1 } }], {
    title: { text: "Spectrum of the last rounds", font: { size: 14 } },
    xaxis: axis("engine order f / Ω", { range: [0, 2.5 / facts.speeds[chosen]] }),
    yaxis: axis("amplitude / gap", decades(-5, 1)),
  });
}

function drawWear(codes) {
  const worn = Array.from(numbers(codes, "worn", chosen));
  const degrees = range(worn.length, (i) => (360 * i) / worn.length);
  const inward = Array.from(numbers(codes, "inward"));
  const drawn = [plot("profile", [{ x: degrees, y: worn, mode: "lines", fill: "tozeroy", line: { color: "#D55E00" } }], {
    title: { text: "Worn profile, leading eighth of the chord", font: { size: 14 } },
    xaxis: axis("casing angle (deg)", { range: [0, 360], dtick: 45 }), yaxis: axis("worn depth / gap", { rangemode: "tozero" }),
  })];
  const closed = (values) => [...values, values[0]];
  const around = closed(degrees);
  const liner = (depth) => closed(inward.map((d, i) => 6 - d + depth[i]));
  drawn.push(plot("polar", [
    { type: "scatterpolar", theta: around, r: around.map(() => 5), mode: "lines", name: "undeformed tip",
      line: { color: "#0072B2", dash: "dashdot", width: 1.4 } },
    { type: "scatterpolar", theta: around, r: liner(inward.map(() => 0)), mode: "lines", name: "liner, new",
      line: { color: "#808080", dash: "dash", width: 1.2 } },
    { type: "scatterpolar", theta: around, r: liner(worn), mode: "lines", name: "liner, worn",
      line: { color: "#D55E00", width: 2 } },
  ], {
    title: { text: "Casing and worn liner, exaggerated", font: { size: 14 } }, showlegend: true,
    legend: { x: 1, y: 1 }, polar: { radialaxis: { showticklabels: false, ticks: "", range: [0, 8] },
      angularaxis: { dtick: 45 } }, margin: { l: 30, r: 30, t: 44, b: 24 },
  }));
  return Promise.all(drawn);
}

function drawHistory(codes) {
  const name = { title: { text: "Displacement over the rounds: least and largest", font: { size: 14 } } };
  if (!has("history"))
    return plot("history", [], { ...name, annotations: [{ text: "not recorded: record.history in the scene",
      showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5 }], xaxis: { visible: false }, yaxis: { visible: false } });
  const flat = numbers(codes, "history", chosen);
  const windows = flat.length / 2;
  const rounds = range(windows, (i) => ((i + 0.5) * facts.rounds) / windows);
  const edge = (which) => range(windows, (i) => flat[2 * i + which]);
  const line = { color: "#000", width: 1 };
  return plot("history", [{ x: rounds, y: edge(0), mode: "lines", line },
    { x: rounds, y: edge(1), mode: "lines", line, fill: "tonexty", fillcolor: "rgba(0,0,0,0.25)" }], {
    ...name, xaxis: axis("time (rounds)"), yaxis: axis("u_r / gap"),
  });
}

function showNumbers() {
  const row = (name, values) => `<tr><th>${name}</th>${values.map((value) => `<td>${value}</td>`).join("")}</tr>`;
  const joule = (value) => (value === null ? "" : value.toExponential(2));
  const energies = Object.entries(facts.energies);
  const doubts = Object.entries(facts.doubts);
  const percent = (value) => (value === null ? "not known" : `${(100 * value).toPrecision(2)} %`);
  byId("numbers").innerHTML =
    row("energy of the run, J", energies.map(([name]) => name)) + row("", energies.map(([, of]) => joule(of[chosen]))) +
    (doubts.length ? row("relative difference from", doubts.map(([name]) => name)) +
      row("", doubts.map(([, of]) => percent(of[chosen]))) : "");
}

function showSpeed() {
  const speed = facts.speeds[chosen];
  const hertz = speed * facts.f1_Hz;
  const lobes = facts.lobes.length ? `, ${facts.lobes[chosen]} lobes` : "";
  byId("at").textContent = `Ω / f₁(0) = ${speed.toFixed(4)}: ${hertz.toFixed(1)} Hz, ${(60 * hertz).toFixed(0)} rpm, ` +
    `${facts.status[chosen]}${lobes}`;
  byId("speed").value = chosen;
}

const listeners = []; // what else follows the chosen speed

async function choose(codes, index) {
  chosen = Math.max(0, Math.min(last, index));
  showSpeed();
  showNumbers();
  const moved = { shapes: [lineAt(facts.speeds[chosen])] };
  const drawn = [];
  if (has("spectrum")) drawn.push(Plotly.relayout("orders", moved), Plotly.relayout("map", moved), drawSpectrum(codes));
  if (has("worn")) drawn.push(drawWear(codes));
  drawn.push(drawHistory(codes));
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
  for (const name of ["orders", "map"])
    if (byId(name).on) byId(name).on("plotly_click", (event) => choose(codes, nearest(event.points[0].x)));
  document.addEventListener("keydown", (event) => {
    if (event.target.tagName === "INPUT" || event.target.tagName === "SELECT") return;
    const to = { ArrowLeft: chosen - 1, ArrowRight: chosen + 1, Home: 0, End: last, ArrowUp: toPeak(1), ArrowDown: toPeak(-1) };
    if (!(event.key in to)) return;
    event.preventDefault();
    choose(codes, to[event.key]);
  });
}

async function start() {
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(await inflated(page.plotly));
  document.head.append(script);
  const codes = new Uint16Array(await inflated(page.codes));
  byId("about").textContent = `Blade ${facts.blade}, scene ${facts.scene}: ${facts.label}. f₁(0) = ` +
    `${facts.f1_Hz.toFixed(2)} Hz, gap ${facts.gap_um.toFixed(1)} µm, ${facts.speeds.length} speeds of ${facts.rounds} rounds.`;
  const first = facts.peaks.length ? facts.peaks[0].index : 0;
  chosen = first;
  if (has("spectrum")) await Promise.all([drawOrders(codes), drawMap(codes)]);
  listen(codes);
  startBlade(codes);
  await choose(codes, first);
  document.body.dataset.ready = "yes";
}

