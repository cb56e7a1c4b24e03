// Blades of a stage: their amplitudes at the chosen speed, and the choice of one.
const ofBlade = () => (facts.blades ? (chosenBlade === null ? ", worst blade" : `, blade ${chosenBlade}`) : "");

// The blades of a stage at the chosen speed; a click on a bar chooses one.
function drawBlades() {
  const { displacement_um, worst } = facts.blades, of = displacement_um.map((values) => values[chosen]);
  const shade = (j) => (j === worst[chosen] ? "#D55E00" : j === chosenBlade ? "#0072B2" : "#808080");
  return plot("by_blade", [{ type: "bar", x: range(of.length, (j) => j), y: of.map((um) => shown("length", um / facts.gap_um)),
    marker: { color: range(of.length, shade) }, text: range(of.length, differs), textposition: "none",
    hovertemplate: "blade %{x}: %{y:.3~g}<br>%{text}<extra></extra>" }], {
    ...titled(`Largest displacement by blade; the worst is blade ${worst[chosen]}`),
    xaxis: axis("number of the blade, in the sense of rotation", { dtick: Math.ceil(of.length / 24) }),
    yaxis: axis(length("largest displacement"), { rangemode: "tozero" }) });
}

const signed = (value) => `${value < 0 ? "−" : "+"}${Math.abs(value).toPrecision(3)}`;

function differs(j) { // by what a blade differs from the scene's
  const { longer_um, percent } = facts.blades;
  return `length ${signed(longer_um[j])} µm, frequencies ${signed(percent[j])} %`;
}

function sayBlade() {
  if (!facts.blades) return;
  const { worst, rubs, displacement_um } = facts.blades;
  const j = chosenBlade === null ? worst[chosen] : chosenBlade, largest = displacement_um[j][chosen];
  byId("blade_says").textContent = `blade ${j}${j === worst[chosen] ? ", the worst at this speed" : ""}: ${differs(j)}; ` +
    `${rubs[chosen][j] ? "rubs" : "does not rub"}, largest displacement ${typeof largest === "number" ? largest.toPrecision(3) : "-"} µm`;
}

async function listBlades(codes) {
  if (!facts.blades) return;
  document.querySelectorAll(".of_stage").forEach((part) => { part.hidden = false; });
  await drawBlades();
  const option = (value, text) => byId("of_blade").append(new Option(text, value));
  option("", "the worst");
  facts.blades.longer_um.forEach((_, j) => option(j, j));
  const take = (value) => {
    chosenBlade = value === "" ? null : Number(value);
    byId("of_blade").value = value;
    sayBlade();
    return Promise.all([drawOrders(codes), drawBlades()]);
  };
  byId("of_blade").addEventListener("input", (event) => take(event.target.value));
  byId("by_blade").on("plotly_click", (event) => take(event.points[0].x));
}
