// SPDX-License-Identifier: Apache-2.0
// WebGL2. Surfaces are drawn as triangles that look up their corners in a texture of points, so a
// frame of a sequence exchanges one texture and nothing else. What the plane or the depth takes
// away is discarded pixel by pixel; cut.js closes what that opens.

const kShading = `#version 300 es
precision highp float; precision highp int;
centroid in vec3 v_world; in vec3 v_view; centroid in float v_depth; in vec3 v_colour; in vec3 v_weights;
flat in int v_triangle;
uniform sampler2D u_table; uniform float u_lookup;
uniform vec4 u_plane; uniform float u_peel; uniform float u_edges; uniform vec3 u_edge;
uniform int u_pick; uniform float u_plain; uniform vec3 u_core;
out vec4 o_colour;
void main() {
  vec3 normal = normalize(cross(dFdx(v_view), dFdy(v_view)));
  vec3 across = max(fwidth(v_weights), vec3(1e-6));
  if (dot(v_world, u_plane.xyz) > u_plane.w || v_depth < u_peel) discard;
  if (u_pick > 0) {
    int t = v_triangle;
    o_colour = vec4(float(t & 255), float((t >> 8) & 255), float((t >> 16) & 255), float(u_pick)) / 255.0;
    return;
  }
  vec3 to_eye = normalize(-v_view);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  float key = max(dot(normal, normalize(vec3(-0.35, 0.6, 0.75))), 0.0);
  float fill = max(dot(normal, normalize(vec3(0.7, -0.1, 0.5))), 0.0);
  float sky = 0.5 + 0.5 * normal.y;
  float light = 0.34 + 0.52 * key + 0.16 * fill + 0.12 * sky;
  // Numbers are looked up pixel by pixel: colours in between two of a scale need not be on it.
  vec3 base = v_colour;
  if (u_lookup > 0.0)
    base = mix(texture(u_table, vec2((v_colour.r * 255.0 + 0.5) / 256.0, 0.5)).rgb, u_core, v_colour.g);
  // A cut keeps its colours, which are read by the legend.
  vec3 colour = base * mix(light, 0.93 + 0.07 * max(dot(normal, to_eye), 0.0), u_plain);
  vec3 near = smoothstep(vec3(0.0), across * 1.25, v_weights);
  float edge = 1.0 - min(min(near.x, near.y), near.z);
  // Where triangles are as small as pixels, edges would be all there is.
  float widest = max(max(across.x, across.y), across.z);
  edge *= u_edges * (1.0 - smoothstep(0.07, 0.34, widest));
  o_colour = vec4(mix(colour, u_edge * (0.5 + 0.5 * colour), edge), 1.0);
}`;

const kSurface = `#version 300 es
precision highp float; precision highp int; precision highp usampler2D;
in uint a_point; in vec3 a_colour;
uniform usampler2D u_points; uniform vec3 u_low, u_size; uniform mat4 u_view, u_project;
centroid out vec3 v_world; out vec3 v_view, v_colour, v_weights; centroid out float v_depth;
flat out int v_triangle;
void main() {
  int width = textureSize(u_points, 0).x;
  uvec4 texel = texelFetch(u_points, ivec2(int(a_point) % width, int(a_point) / width), 0);
  v_world = u_low + u_size * vec3(texel.xyz) / 65535.0;
  v_depth = float(texel.w) / 65535.0;
  vec4 view = u_view * vec4(v_world, 1.0);
  v_view = view.xyz; v_colour = a_colour; v_triangle = gl_VertexID / 3;
  int corner = gl_VertexID % 3;
  v_weights = vec3(corner == 0, corner == 1, corner == 2);
  gl_Position = u_project * view;
}`;

const kCap = `#version 300 es
precision highp float; precision highp int;
in vec3 a_position; in float a_depth; in vec3 a_colour; in vec3 a_weights;
uniform mat4 u_view, u_project;
centroid out vec3 v_world; out vec3 v_view, v_colour, v_weights; centroid out float v_depth;
flat out int v_triangle;
void main() {
  v_world = a_position; v_depth = a_depth;
  vec4 view = u_view * vec4(a_position, 1.0);
  v_view = view.xyz; v_colour = a_colour; v_triangle = gl_VertexID / 3; v_weights = a_weights;
  gl_Position = u_project * view;
}`;

// What lies behind the plane is told by places within the triangle: at a pixel that it covers in
// part, a place beyond its edge would let specks of it through (hence centroid).

// Points and lines over the surface, a little nearer to the eye than they are.
const kMark = `#version 300 es
precision highp float;
in vec3 a_position; uniform mat4 u_view, u_project; uniform float u_size; uniform float u_lift;
out vec3 v_world;
void main() {
  v_world = a_position;
  vec4 view = u_view * vec4(a_position, 1.0);
  gl_Position = u_project * vec4(view.xyz * (1.0 - u_lift), 1.0);
  gl_PointSize = u_size;
}`;
const kMarkShading = `#version 300 es
precision highp float;
in vec3 v_world; uniform vec4 u_plane; uniform vec3 u_colour; uniform float u_round; out vec4 o_colour;
void main() {
  if (dot(v_world, u_plane.xyz) > u_plane.w) discard;
  float from_middle = length(gl_PointCoord - 0.5);
  // 0 no point, 1 a disc with a rim, 2 a ring.
  if (u_round > 0.5 && from_middle > 0.5 || u_round > 1.5 && from_middle < 0.3) discard;
  bool rim = u_round > 0.5 && u_round < 1.5 && from_middle > 0.36;
  o_colour = vec4(rim ? vec3(1.0) : u_colour, 1.0);
}`;

class Program {
  constructor(gl, vertex, fragment) {
    this.gl = gl;
    this.program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
    this.places = new Map();
  }
  // Numbers and lists of three, four or sixteen; whole numbers by `whole`.
  set(values, whole = {}) {
    const gl = this.gl;
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(values)) {
      const at = this.at(name);
      if (typeof value === "number") gl.uniform1f(at, value);
      else if (value.length === 3) gl.uniform3fv(at, value);
      else if (value.length === 4) gl.uniform4fv(at, value);
      else gl.uniformMatrix4fv(at, false, value);
    }
    for (const [name, value] of Object.entries(whole)) gl.uniform1i(this.at(name), value);
  }
  at(name) {
    if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.program, name));
    return this.places.get(name);
  }
  attribute(name) { return this.gl.getAttribLocation(this.program, name); }
}

// [name, components, offset in bytes]
function floatLayout(gl, program, buffer, stride, fields) {
  const layout = gl.createVertexArray();
  gl.bindVertexArray(layout);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  for (const [name, components, offset] of fields) {
    const at = program.attribute(name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, components, gl.FLOAT, false, stride, offset);
  }
  gl.bindVertexArray(null);
  return layout;
}

const kTextureWidth = 2048;

class Canvas {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
    if (!gl) throw new Error("this browser does not offer WebGL2");
    this.gl = gl;
    this.canvas = canvas;
    this.surface = new Program(gl, kSurface, kShading);
    this.cap = new Program(gl, kCap, kShading);
    this.mark = new Program(gl, kMark, kMarkShading);
    this.points = gl.createTexture();
    this.table = gl.createTexture();
    this.sheets = [this.newSheet(), this.newSheet(), this.newSheet()];
    this.caps = [this.newCap(), this.newCap()];
    this.pins = this.newMarks();
    this.picked = this.newMarks();
    this.target = null;
  }
  newSheet() {
    const gl = this.gl;
    const sheet = { ids: gl.createBuffer(), colours: gl.createBuffer(), layout: gl.createVertexArray(), count: 0 };
    gl.bindVertexArray(sheet.layout);
    gl.bindBuffer(gl.ARRAY_BUFFER, sheet.ids);
    const id = this.surface.attribute("a_point"), colour = this.surface.attribute("a_colour");
    gl.enableVertexAttribArray(id);
    gl.vertexAttribIPointer(id, 1, gl.UNSIGNED_INT, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, sheet.colours);
    gl.enableVertexAttribArray(colour);
    gl.vertexAttribPointer(colour, 3, gl.UNSIGNED_BYTE, true, 3, 0);
    gl.bindVertexArray(null);
    return sheet;
  }
  newCap() {
    const buffer = this.gl.createBuffer();
    return { buffer, count: 0, layout: floatLayout(this.gl, this.cap, buffer, 4 * kCapFloats,
      [["a_position", 3, 0], ["a_depth", 1, 12], ["a_colour", 3, 16], ["a_weights", 3, 28]]) };
  }
  newMarks() {
    const buffer = this.gl.createBuffer();
    return { buffer, count: 0, layout: floatLayout(this.gl, this.mark, buffer, 12, [["a_position", 3, 0]]) };
  }
  // Positions as the page has them, and the depth of each point.
  setPoints(model) {
    const gl = this.gl;
    const rows = Math.max(Math.ceil(model.points / kTextureWidth), 1);
    const texels = new Uint16Array(4 * kTextureWidth * rows);
    const { positions, low, high } = model.frame;
    for (let p = 0; p < model.points; ++p) {
      for (let axis = 0; axis < 3; ++axis)
        texels[4 * p + axis] = Math.round(
          (65535 * (positions[3 * p + axis] - low[axis])) / (high[axis] - low[axis] || 1));
      texels[4 * p + 3] = Math.round(65535 * model.depths[p]);
    }
    gl.bindTexture(gl.TEXTURE_2D, this.points);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16UI, kTextureWidth, rows, 0, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT, texels);
    this.low = low;
    this.size = high.map((h, axis) => h - low[axis]);
  }
  // 256 colours, or null where each corner has its own.
  setTable(table) {
    const gl = this.gl;
    this.lookup = table ? 1 : 0;
    gl.bindTexture(gl.TEXTURE_2D, this.table);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, table || new Uint8Array(768));
  }
  setSheet(i, ids, colours) {
    const gl = this.gl, sheet = this.sheets[i];
    sheet.count = ids ? ids.length : 0;
    sheet.ofTriangle = ids;
    if (!ids) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, sheet.ids);
    gl.bufferData(gl.ARRAY_BUFFER, ids, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, sheet.colours);
    gl.bufferData(gl.ARRAY_BUFFER, colours, gl.DYNAMIC_DRAW);
  }
  setCap(i, data) {
    const gl = this.gl;
    this.caps[i].count = data ? data.used / kCapFloats : 0;
    if (!data) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.caps[i].buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data.data.subarray(0, data.used), gl.DYNAMIC_DRAW);
  }
  setMarks(marks, positions) {
    const gl = this.gl;
    marks.count = positions.length / 3;
    gl.bindBuffer(gl.ARRAY_BUFFER, marks.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(positions), gl.STATIC_DRAW);
  }
}
