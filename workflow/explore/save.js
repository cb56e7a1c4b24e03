// Plots and the blade as files: a picture, and the numbers that are drawn.
function download(name, suffix, blob) {
  const link = document.createElement("a");
  Object.assign(link, { href: URL.createObjectURL(blob), download: `${fileOf(name)}.${suffix}` });
  link.click();
  URL.revokeObjectURL(link.href);
}

const fileOf = (name) => `${facts.scene}-${name}`;

// One row for each number drawn: the curve, and what stands at its axes.
function tableOf({ data, layout: { xaxis, yaxis } }) {
  const titles = [xaxis, yaxis].map((axis) => axis?.title?.text);
  const rows = data.filter((trace) => trace.visible !== false).flatMap((trace) => {
    const name = trace.name || "";
    if (trace.type === "heatmap")
      return trace.z.flatMap((line, i) => line.flatMap((value, j) =>
        (Number.isFinite(value) ? [[name, trace.x[j], trace.y[i], 10 ** value * trace.meta]] : [])));
    return Array.from(trace.x || trace.theta, (x, i) => [name, x, (trace.y || trace.r)[i]]);
  });
  const heads = ["curve", titles[0] || "angle (deg)", titles[1] || "radius / gap", "amplitude"];
  const width = Math.max(...rows.map((row) => row.length), 0);
  const cell = (value) => (typeof value === "string" ? `"${value}"` : Number.isFinite(value) ? Number(value.toPrecision(6)) : "");
  return [heads.slice(0, width), ...rows].map((row) => row.map(cell).join(",")).join("\n");
}

function button(text, title, press) {
  const made = Object.assign(document.createElement("button"), { type: "button", textContent: text, title });
  made.addEventListener("click", press);
  return made;
}

function offerFiles() {
  document.querySelectorAll(".plot").forEach((plot) => {
    const bar = Object.assign(document.createElement("p"), { className: "save" });
    const size = { width: plot.clientWidth, height: plot.clientHeight, scale: 3 };
    bar.append(
      button("PNG", `Save the plot ${plot.id} as a picture`, () =>
        Plotly.downloadImage(plot, { format: "png", filename: fileOf(plot.id), ...size })),
      button("CSV", `Save the numbers of the plot ${plot.id}`, () =>
        download(plot.id, "csv", new Blob(["\ufeff", tableOf(plot)], { type: "text/csv" }))));
    plot.after(bar);
  });
}
