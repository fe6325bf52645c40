// SPDX-License-Identifier: Apache-2.0
// Where a number that is linear in each tet has a given value: the cut of a plane, of which the
// number is the distance, and the surface of one depth. Both close the shell where parts of it are
// taken away, so it looks as solid as it is.

// Per corner: position, depth, colour, weights that tell the way to the edges, number of the tet.
// Twelve floats.
const kCapFloats = 12;

class CapBuffer {
  constructor() {
    this.data = new Float32Array(kCapFloats * 3 * 4096);
    this.used = 0;
  }
  room() {
    if (this.used + 6 * kCapFloats <= this.data.length) return;
    const larger = new Float32Array(2 * this.data.length);
    larger.set(this.data);
    this.data = larger;
  }
}

// For each choice of corners that are above the level (a bit each): pairs of corners, one above and
// one below, whose edges are cut, three or four of them in the order in which they go round.
const kCutEdges = Array.from({ length: 16 }, (_, mask) => {
  const above = [0, 1, 2, 3].filter((i) => mask & (1 << i)), below = [0, 1, 2, 3].filter((i) => !(mask & (1 << i)));
  if (above.length === 2)
    return [[0, 0], [0, 1], [1, 1], [1, 0]].map(([i, j]) => [below[i], above[j]]);
  return below.flatMap((i) => above.map((j) => [i, j]));
});

// Corners of the cut, by number: of a triangle, and of the two triangles of a quad; and their
// weights. The quad's diagonal is no edge, and no weight is 0 along it.
const kTriangle = { corners: [0, 1, 2], weights: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] };
const kQuad = { corners: [0, 1, 2, 0, 2, 3],
  weights: [[1, 1, 0], [0, 1, 0], [0, 1, 1], [1, 1, 0], [0, 1, 1], [0, 1, 0]] };

function putCorner(buffer, model, colours, own, tet, p, q, t, weights) {
  const positions = model.frame.positions, depths = model.depths, points = colours.points;
  const d = buffer.data;
  const at = buffer.used;
  for (let axis = 0; axis < 3; ++axis) {
    const a = positions[3 * p + axis];
    d[at + axis] = a + t * (positions[3 * q + axis] - a);
    const c = points[3 * p + axis];
    d[at + 4 + axis] = (own ? own[axis] : c + t * (points[3 * q + axis] - c)) / 255;
    d[at + 7 + axis] = weights[axis];
  }
  d[at + 3] = depths[p] + t * (depths[q] - depths[p]);
  d[at + 10] = tet;
  d[at + 11] = 0;
  buffer.used = at + kCapFloats;
}

// The mask's cut of a tet, as triangles.
function putCut(buffer, model, colours, values, level, t, mask) {
  const { tets, layer } = model.shell;
  const own = layer[t] === 255 ? colours.core : colours.ofTet ? colours.ofTet(t) : null;
  const edges = kCutEdges[mask];
  const { corners, weights } = edges.length === 3 ? kTriangle : kQuad;
  buffer.room();
  for (let k = 0; k < corners.length; ++k) {
    const edge = edges[corners[k]];
    // From below to above in every tet, so that neighbours have the same floats.
    const p = tets[4 * t + edge[0]], q = tets[4 * t + edge[1]];
    putCorner(buffer, model, colours, own, t, p, q, (level - values[p]) / (values[q] - values[p]), weights[k]);
  }
}

// `values` by point; `shown(layer)` says which tets there are. Leaves triangles in the buffer.
function capOf(buffer, model, colours, values, level, shown) {
  const { tets, layer } = model.shell;
  const isShown = new Uint8Array(256);
  for (let k = 0; k < 256; ++k) isShown[k] = shown(k) ? 1 : 0;
  const above = new Uint8Array(values.length);
  for (let p = 0; p < above.length; ++p) above[p] = values[p] >= level ? 1 : 0;
  buffer.used = 0;
  for (let t = 0, i = 0; t < layer.length; ++t, i += 4) {
    const mask = above[tets[i]] | (above[tets[i + 1]] << 1) | (above[tets[i + 2]] << 2) | (above[tets[i + 3]] << 3);
    if (mask !== 0 && mask !== 15 && isShown[layer[t]]) putCut(buffer, model, colours, values, level, t, mask);
  }
  return buffer;
}

// Distance of each point along the normal.
function distancesAlong(model, normal) {
  const positions = model.frame.positions;
  const values = new Float32Array(model.points);
  for (let p = 0; p < values.length; ++p)
    values[p] = normal[0] * positions[3 * p] + normal[1] * positions[3 * p + 1] + normal[2] * positions[3 * p + 2];
  return values;
}
