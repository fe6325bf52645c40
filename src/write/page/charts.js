// SPDX-License-Identifier: Apache-2.0
// Histograms, and JSON as tables. All words go in as text, whatever they are.

const kSvg = "http://www.w3.org/2000/svg";

function drawn(name, attributes, text) {
  const made = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// Bars over the range from 0 to `end`; `what` is one of those that are counted.
function histogram(parent, counts, end, table, shareOf, unitName, what) {
  const width = 312, height = 96, base = 76, top = 14;
  const most = Math.max(...counts, 1), all = counts.reduce((a, b) => a + b, 0);
  const svg = drawn("svg", { viewBox: `0 0 ${width} ${height}`, role: "img" });
  const step = width / counts.length;
  counts.forEach((count, i) => {
    if (count === 0) return;
    const tall = Math.max(((base - top) * count) / most, 1);
    const at = 3 * Math.round(clamp(shareOf((i + 0.5) / counts.length), 0, 1) * 255);
    const bar = drawn("rect", { x: i * step + 0.5, y: base - tall, width: step - 1, height: tall,
      fill: `rgb(${table.subarray(at, at + 3)})` });
    const range = `${figure((i / counts.length) * end)} to ${figure(((i + 1) / counts.length) * end)}${unitName}`;
    bar.append(drawn("title", {}, `${range}: ${counted(count, what)}, ${((100 * count) / all).toFixed(1)} %`));
    svg.append(bar);
  });
  svg.append(drawn("line", { x1: 0, x2: width, y1: base, y2: base, class: "base" }));
  for (const [share, anchor] of [[0, "start"], [0.25, "middle"], [0.5, "middle"], [0.75, "middle"], [1, "end"]])
    svg.append(drawn("text", { x: share * width, y: base + 14, "text-anchor": anchor },
      figure(share * end) + unitName));
  svg.append(drawn("text", { x: width, y: 10, "text-anchor": "end" },
    `highest bar ${counted(most, what)} of ${all.toLocaleString("en")}`));
  parent.replaceChildren(svg);
}

function valueText(value) {
  if (value === null) return "\u2013";
  if (value === true) return "yes";
  if (value === false) return "no";
  if (typeof value === "number")
    return Number.isInteger(value) ? value.toLocaleString("en") : String(Number(value.toPrecision(5)));
  if (Array.isArray(value)) return value.length === 0 ? "none" : value.map(valueText).join(", ");
  return String(value);
}

const isTable = (value) => value !== null && typeof value === "object" &&
  (!Array.isArray(value) || value.some((entry) => entry !== null && typeof entry === "object"));
const words = (key) => key.replace(/_/g, " ");

// Members that are single values make one table, the others fold up below it. Reports are ours,
// and are not deep; a file may hold anything.
function tablesOf(json, depth = 0) {
  const entries = Array.isArray(json) ? json.map((value, i) => [String(i + 1), value]) : Object.entries(json);
  const table = element("table");
  const parts = [];
  for (const [key, value] of entries.slice(0, 500)) {
    if (isTable(value) && depth < 8) {
      const details = element("details", {}, element("summary", {}, words(key)));
      details.addEventListener("toggle", () => {
        if (details.open && details.childElementCount === 1) details.append(...tablesOf(value, depth + 1));
      });
      parts.push(details);
    } else if (value !== null) {
      table.append(element("tr", {}, element("th", {}, words(key)), element("td", {},
        isTable(value) ? JSON.stringify(value) : valueText(value))));
    }
  }
  return table.childElementCount > 0 ? [table, ...parts] : parts;
}

function reportTables(parent, texts) {
  const parts = [];
  for (const [title, text] of texts) {
    const json = parsedOrNull(text);
    if (text === "") continue;
    const details = element("details", {}, element("summary", {}, title));
    if (json !== null && typeof json === "object") details.append(...tablesOf(json));
    else details.append(element("pre", {}, text));
    parts.push(details);
  }
  if (parts.length > 0) parts[0].open = true;
  parent.replaceChildren(...parts);
}
