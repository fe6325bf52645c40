// SPDX-License-Identifier: Apache-2.0
// From the texts that stand in the page to arrays; src/write/page_block.cpp is the way there.

const byId = (id) => document.getElementById(id);

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  if (typeof DecompressionStream === "undefined")
    throw new Error("this browser is too old: it has no DecompressionStream");
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Bytes of equal weight stand side by side, and each number is the difference to the one a stride
// before. Sums wrap round as they did when the differences were made.
function arrayOf(bytes, begin, size, count, stride) {
  const made = size === 1 ? new Uint8Array(count) : size === 2 ? new Uint16Array(count) : new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    let value = 0;
    for (let byte = 0; byte < size; ++byte) value |= bytes[begin + byte * count + i] << (8 * byte);
    made[i] = (value >>> 0) + (i < stride ? 0 : made[i - stride]);
  }
  return made;
}

// {about, arrays by name}
async function readBlock(id) {
  const element = byId(id);
  const bytes = await inflated(bytesOf(element.textContent));
  element.textContent = "";
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const about = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  const block = { about };
  let begin = 4 + length;
  for (const [name, size, count, stride] of about.arrays) {
    block[name] = arrayOf(bytes, begin, size, count, stride);
    begin += size * count;
  }
  return block;
}

// Texts that other programs may have put into the file.
function parsedOrNull(text) {
  try {
    return JSON.parse(text);
  } catch (error) {
    return null;
  }
}

// Vertex of the surface and number of the surface of each point; points of the core have none.
function placeOfPoints(shell, points, vertices) {
  const surfaces = shell.surfaces.length / vertices;
  const vertexOf = new Int32Array(points).fill(-1);
  const surfaceOf = new Uint8Array(points).fill(255);
  for (let s = surfaces - 1; s >= 0; --s)
    for (let v = 0; v < vertices; ++v) {
      const point = shell.surfaces[s * vertices + v];
      vertexOf[point] = v;
      surfaceOf[point] = s;
    }
  return { vertexOf, surfaceOf, surfaces };
}

const kRegularDegrees = 70.528779365509308;

// A frame's arrays as they are needed: positions in world units, degrees, thickness.
function frameOf(block, about) {
  const size = about.high.map((h, axis) => h - about.low[axis]);
  const positions = new Float32Array(block.positions.length);
  for (let i = 0; i < positions.length; ++i)
    positions[i] = about.low[i % 3] + (size[i % 3] * block.positions[i]) / 65535;
  const degrees = new Float32Array(block.angles.length);
  for (let t = 0; t < degrees.length; ++t) degrees[t] = (block.angles[t] * kRegularDegrees) / 255;
  const thickness = new Float32Array(block.thickness.length);
  for (let v = 0; v < thickness.length; ++v) thickness[v] = (about.thickest * block.thickness[v]) / 65535;
  return { ...about, positions, degrees, thickness, angleCounts: block.about.angles,
    thicknessCounts: block.about.thickness, report: block.about.report };
}

const frameCache = new Map();
const kMostCached = 24;

// Blocks are inflated when they are first wanted; their base 64 stays in the document until then.
async function loadFrame(page, index) {
  if (frameCache.has(index)) return frameCache.get(index);
  const id = "frame" + index;
  const text = byId(id).textContent;
  const frame = frameOf(await readBlock(id), page.frames[index]);
  byId(id).textContent = text;
  frameCache.set(index, frame);
  if (frameCache.size > kMostCached) frameCache.delete(frameCache.keys().next().value);
  return frame;
}
