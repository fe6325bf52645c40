// SPDX-License-Identifier: Apache-2.0
// What is coloured how: a scale of numbers or a list of kinds, and the legend that says so.

const kScales = {
  depth: ["#f4e6cc", "#efb27a", "#d86a4d", "#9c3a5e", "#54246b", "#1f1646"],
  quality: ["#a50f2d", "#e2593b", "#f8b15f", "#f3e3a0", "#9fd0a4", "#4f9dab", "#2b5f9b"],
  thickness: ["#f3f2cf", "#b6dcae", "#62bda9", "#2f8fa6", "#28588f", "#251f5c"],
};
// Neighbours in the list differ in lightness as well as in hue.
const kKinds = ["#9aa5b1", "#b08d57", "#3b7dd8", "#7a5195", "#2f9e8f", "#145a6e", "#5c5c5c", "#8dc26f",
  "#c9b458", "#e8833a", "#5aa9e6", "#c2395b", "#d7263d", "#8c564b", "#c4b7d4"];
const kPin = "#e3173e";
const kCoreColour = [164, 176, 190];
const kPlain = [214, 198, 172];

const rgbOf = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

// 256 colours of three bytes.
function tableOf(stops) {
  const colours = stops.map(rgbOf);
  const table = new Uint8Array(768);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (colours.length - 1);
    const k = Math.min(Math.floor(at), colours.length - 2);
    for (let c = 0; c < 3; ++c)
      table[3 * i + c] = Math.round(colours[k][c] + (at - k) * (colours[k + 1][c] - colours[k][c]));
  }
  return table;
}
const kTables = Object.fromEntries(Object.entries(kScales).map(([name, stops]) => [name, tableOf(stops)]));

function figure(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(3)));
}
const counted = (count, one, many = one + "s") => count.toLocaleString("en") + " " + (count === 1 ? one : many);

function colourAt(table, share) {
  const at = 3 * Math.round(255 * clamp(share, 0, 1));
  return table.subarray(at, at + 3);
}

function layerColour(layer, layers) {
  return colourAt(kTables.thickness, layers < 2 ? 0.3 : 0.15 + (0.75 * layer) / (layers - 1));
}

// Bytes of points: red, green and blue, or where there is a table the place in it and two zeros.
// Tets and triangles that have a colour of their own, whatever their corners have, are asked for it
// by number. `model` is what main.js makes of the page's blocks, with the present frame.
function paint(model, mode) {
  const points = new Uint8Array(3 * model.points);
  const shares = { depth: (p) => model.depths[p],
    thickness: (p, v) => model.frame.thickness[v] / (model.thickest || 1) }[mode];
  const kinds = kKinds.map(rgbOf);
  for (let p = 0; p < model.points; ++p) {
    const v = model.vertexOf[p];
    if (shares) points[3 * p] = Math.round(255 * clamp(v < 0 ? 1 : shares(p, v), 0, 1));
    else points.set(v < 0 ? kCoreColour : mode === "stop" ? kinds[model.shell.stop[v]] : kPlain, 3 * p);
  }
  if (shares) return { points, table: kTables[mode], core: [0, 255, 0] };
  const colours = { points, table: null, core: kCoreColour };
  if (mode === "quality") {
    const { degrees, worst } = model.frame;
    const of = (angle) => colourAt(kTables.quality, angle / kRegularDegrees);
    colours.ofTet = (t) => of(degrees[t]);
    colours.ofFace = (layer, f) => of(worst[layer * model.faces + f]);
  } else if (mode === "layer") {
    const layers = Array.from({ length: model.layers }, (_, i) => layerColour(i, model.layers));
    colours.ofTet = (t) => layers[model.shell.layer[t]];
    colours.ofFace = (layer) => layers[layer];
  }
  return colours;
}

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function scaleLegend(title, stops, ticks) {
  const bar = element("div", { class: "bar" });
  bar.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
  return [element("b", {}, title), bar,
    element("div", { class: "ticks" }, ...ticks.map(([share, text]) => {
      const tick = element("span", {}, text);
      tick.style.left = 100 * share + "%";
      // Those at the ends stay within the bar.
      tick.style.transform = `translateX(${share === 0 ? 0 : share === 1 ? -100 : -50}%)`;
      return tick;
    }))];
}

// [colour, name, what is said of it]
function kindsLegend(title, kinds) {
  const rows = kinds.map(([colour, name, more]) => {
    const swatch = element("i");
    swatch.style.background = colour;
    return element("span", {}, swatch, name + " ", element("small", {}, more));
  });
  return [element("b", {}, title), element("div", { class: rows.length > 3 ? "kinds" : "kinds few" }, ...rows)];
}

function legendOf(model, mode) {
  if (mode === "depth")
    return scaleLegend("Depth, share of the way inward", kScales.depth, [[0, "0 outer"], [0.5, "0.5"], [1, "1 inner"]]);
  if (mode === "quality")
    return scaleLegend("Least dihedral angle of the tet, degrees", kScales.quality,
      [0, 20, 40, 60].map((degrees) => [degrees / kRegularDegrees, String(degrees)]));
  if (mode === "thickness")
    return scaleLegend("Thickness, units of the file", kScales.thickness,
      [0, 0.5, 1].map((s) => [s, figure(s * model.thickest * model.page.unit)]));
  if (mode === "stop")
    return kindsLegend("Why the pillar ends", model.shell.about.stops
      .map(([name, count], i) => [kKinds[i], name.replace(/_/g, " "), count.toLocaleString("en"), count])
      .filter((kind) => kind[3] > 0).sort((a, b) => b[3] - a[3]));
  if (mode === "layer")
    return kindsLegend("Layer, from the outermost", Array.from({ length: model.layers }, (_, i) =>
      [`rgb(${layerColour(i, model.layers)})`, String(i + 1), ""]).slice(0, 12));
  return [];
}
