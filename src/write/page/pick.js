// SPDX-License-Identifier: Apache-2.0
// The vertex under the pointer, and its figures.

function nearestProjected(model, points, matrix, x, y, width, height) {
  let best = -1, least = Infinity;
  for (const p of points) {
    const at = projected(matrix, model.frame.positions.subarray(3 * p, 3 * p + 3), width, height);
    const distance = (at[0] - x) ** 2 + (at[1] - y) ** 2;
    if (distance < least) [best, least] = [p, distance];
  }
  return best;
}

// The point nearest to what the pointer hits, or -1.
function pointAt(canvas, caps, model, view, x, y) {
  const { width, height } = canvas.canvas;
  const hit = pieceAt(canvas, view, Math.floor(x), Math.floor(height - 1 - y));
  if (!hit) return -1;
  let corners;
  if (hit.piece < 4) corners = canvas.sheets[hit.piece - 1].ofTriangle.subarray(3 * hit.triangle, 3 * hit.triangle + 3);
  else {
    const tet = caps[hit.piece - 4].data[3 * hit.triangle * kCapFloats + 10];
    corners = model.shell.tets.subarray(4 * tet, 4 * tet + 4);
  }
  return nearestProjected(model, corners, product(view.project, view.view), x, y, width, height);
}

const pillarOf = (model, v) =>
  Array.from({ length: model.surfaces }, (_, s) => model.shell.surfaces[s * model.vertices + v]);

function leastAround(model, v) {
  const { tets } = model.shell;
  let least = Infinity;
  for (let i = 0; i < tets.length; ++i)
    if (model.vertexOf[tets[i]] === v) least = Math.min(least, model.frame.degrees[i >> 2]);
  return least;
}

// Rows of words.
function figuresOf(model, point) {
  const { page, shell, frame } = model;
  const at = [0, 1, 2].map((axis) => page.origin[axis] + page.unit * frame.positions[3 * point + axis]);
  const place = ["place", at.map((c) => Number(c.toPrecision(5))).join(", ")];
  const v = model.vertexOf[point];
  if (v < 0) return [["point", "of the core, between its tets"], place];
  const original = model.shell.about.coarser ? shell.from[v] : v;
  const rows = [["vertex", original.toLocaleString("en")], place,
    ["depth of the point", figure(model.depths[point])],
    ["thickness", isPinned(model, v) ? "0, pinned" : figure(frame.thickness[v] * page.unit)],
    ["pillar ends for", words(shell.about.stops[shell.stop[v]][0])]];
  if (!shell.about.coarser) rows.push(["least angle around", leastAround(model, v).toFixed(1) + "\u00b0"]);
  return rows;
}

function isPinned(model, v) {
  const { surfaces } = model.shell;
  return surfaces[(model.surfaces - 1) * model.vertices + v] === surfaces[v];
}

function showFigures(model, point) {
  const rows = point < 0 ? [] : figuresOf(model, point);
  const parent = byId("picked");
  parent.querySelector(".hint").hidden = rows.length > 0;
  parent.querySelector("table").replaceChildren(
    ...rows.map(([name, value]) => element("tr", {}, element("th", {}, name), element("td", {}, value))));
}
