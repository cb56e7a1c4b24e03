// Blades of a stage: their amplitudes at the chosen speed, and the choice of one.
const ofBlade = () => (facts.blades ? (chosenBlade === null ? ", worst blade" : `, blade ${chosenBlade}`) : "");

// The blades of a stage at the chosen speed; a click on a bar chooses one.
function drawBlades(codes) {
  if (!facts.blades || !has("blade_most")) return Promise.resolve();
  const most = numbers(codes, "blade_most", chosen), worst = facts.blades.worst[chosen];
  const shade = (j) => (j === worst ? "#D55E00" : j === chosenBlade ? "#0072B2" : "#808080");
  return plot("by_blade", [{ type: "bar", x: range(most.length, (j) => j), y: scaled("length", Array.from(most)),
    marker: { color: range(most.length, shade) }, text: range(most.length, differs), textposition: "none",
    hovertemplate: "blade %{x}: %{y:.3~g}<br>%{text}<extra></extra>" }], {
    ...titled(`Largest amplitude along an engine order, by blade; the worst is blade ${worst}`),
    xaxis: axis("number of the blade, in the sense of rotation", { dtick: Math.ceil(most.length / 24) }), yaxis: axis(length("amplitude"), { rangemode: "tozero" }) });
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
  await drawBlades(codes);
  const option = (value, text) => byId("of_blade").append(new Option(text, value));
  option("", "the worst");
  facts.blades.longer_um.forEach((_, j) => option(j, j));
  const take = (value) => {
    chosenBlade = value === "" ? null : Number(value);
    byId("of_blade").value = value;
    sayBlade();
    return Promise.all([drawOrders(codes), drawBlades(codes)]);
  };
  byId("of_blade").addEventListener("input", (event) => take(event.target.value));
  if (has("blade_most")) byId("by_blade").on("plotly_click", (event) => take(event.points[0].x));
  else byId("by_blade").parentElement.hidden = true;
}
