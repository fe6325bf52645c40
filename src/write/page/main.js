// SPDX-License-Identifier: Apache-2.0
// Puts the parts together: reads the blocks, keeps the model and the state, and draws when either
// has changed.

async function readModel() {
  const page = (await readBlock("page")).about;
  const shell = await readBlock("shell");
  const model = { page, shell, layers: shell.about.layers, faces: shell.triangles.length / 3 };
  model.vertices = shell.stop.length;
  model.hasCore = shell.layer.includes(255);
  model.thickest = Math.max(...page.frames.map((frame) => frame.thickest));
  model.low = [0, 1, 2].map((axis) => Math.min(...page.frames.map((frame) => frame.low[axis])));
  model.high = [0, 1, 2].map((axis) => Math.max(...page.frames.map((frame) => frame.high[axis])));
  await setFrame(model, 0);
  Object.assign(model, placeOfPoints(shell, model.points, model.vertices));
  model.depths = new Float32Array(model.points);
  for (let p = 0; p < model.points; ++p)
    model.depths[p] = model.vertexOf[p] < 0 ? 1 : model.surfaceOf[p] / model.layers;
  return model;
}

async function setFrame(model, index) {
  const frame = await loadFrame(model.page, index);
  model.points = frame.positions.length / 3;
  if (!frame.worst) {
    frame.worst = new Float32Array(model.layers * model.faces).fill(kRegularDegrees);
    const { prism, layer } = model.shell;
    for (let t = 0; t < prism.length; ++t)
      if (layer[t] !== 255) {
        const at = layer[t] * model.faces + prism[t];
        frame.worst[at] = Math.min(frame.worst[at], frame.degrees[t]);
      }
  }
  model.frame = frame;
}

// Corners of the triangles of a surface, but not of those that are the same on `other`.
function cornersOf(model, surface, other) {
  const { triangles, surfaces } = model.shell;
  const ids = new Uint32Array(triangles.length);
  const faces = new Uint32Array(model.faces);
  let used = 0;
  for (let f = 0; f < model.faces; ++f) {
    let same = true;
    for (let c = 0; c < 3; ++c) {
      const v = triangles[3 * f + c];
      ids[3 * used + c] = surfaces[surface * model.vertices + v];
      same = same && other >= 0 && surfaces[other * model.vertices + v] === ids[3 * used + c];
    }
    if (!same) faces[used++] = f;
  }
  return { ids: ids.subarray(0, 3 * used), faces: faces.subarray(0, used) };
}

function coloursOf(sheet, layer, colours) {
  const bytes = new Uint8Array(3 * sheet.ids.length);
  for (let i = 0; i < sheet.ids.length; ++i) {
    const own = layer === 255 ? colours.core : colours.ofFace && colours.ofFace(layer, sheet.faces[Math.floor(i / 3)]);
    for (let c = 0; c < 3; ++c) bytes[3 * i + c] = own ? own[c] : colours.points[3 * sheet.ids[i] + c];
  }
  return bytes;
}

class Page {
  constructor(model) {
    this.model = model;
    this.canvas = new Canvas(byId("canvas"));
    this.camera = new Camera(model.low, model.high, model.frame.positions);
    this.caps = [new CapBuffer(), new CapBuffer()];
    this.state = stateAtFirst(model);
    this.point = -1;
    // Across the thinner of the two sides that stand upright, seen from the side that is cut off.
    const size = sub(model.high, model.low);
    this.state.axis = size[0] < size[2] ? "x" : "z";
    this.camera.startAzimuth = this.state.axis === "x" ? 0.95 : 0.6;
    this.camera.reset();
    this.viewNormal = this.camera.axes().back;
  }

  start() {
    readAddress(this.state, this.camera, location.hash);
    preparePanel(this.model);
    setTheme(this.state.theme);
    this.chooseAxis();
    addEventListener("hashchange", () => {
      readAddress(this.state, this.camera, location.hash);
      setTheme(this.state.theme);
      this.changed("frame");
    });
    listenToPanel(this.state, (what) => this.changed(what));
    listenToPointers(this.canvas.canvas, this.camera, () => this.drawSoon(), (x, y) => this.pick(x, y));
    addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.drawSoon()).observe(byId("stage"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.drawSoon());
    this.canvas.canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      byId("message").textContent = "The graphics were lost. Load the page again.";
    });
    byId("play").addEventListener("click", () => this.play(!this.playing));
    return this.changed("frame");
  }

  aspect() {
    const box = byId("stage").getBoundingClientRect();
    return box.width / Math.max(box.height, 1);
  }

  chooseAxis() {
    if (this.state.axis === "view") this.viewNormal = this.camera.axes().back;
  }

  // Normal and distance; what is beyond is cut off.
  plane() {
    const { axis, cut, flip } = this.state;
    if (axis === "none") return null;
    const normal = kAxes[axis] || this.viewNormal;
    const { low, high } = this.model;
    const middle = scale(add(low, high), 0.5);
    const half = dot(normal.map(Math.abs), scale(sub(high, low), 0.5));
    // A hair more than the shell, so that the ends of the slider cut nothing and all.
    const at = dot(normal, middle) + 1.001 * (2 * cut - 1) * half;
    return { normal, at, cutter: flip ? [...scale(normal, -1), -at] : [...normal, at] };
  }

  async changed(what) {
    const { state, model } = this;
    if (what === "axis") this.chooseAxis();
    if (what === "last") state.first = Math.min(state.first, state.last);
    limitState(state, model);
    if (what === "frame") {
      await setFrame(model, state.frame);
      this.canvas.setPoints(model);
      this.newFrame();
    }
    if (["frame", "colour", "first", "last", "core"].includes(what)) this.paintSheets();
    if (!["edges", "pins", "theme"].includes(what)) this.close();
    const plane = this.plane();
    showState(state, model, plane ? plane.at * model.page.unit : 0);
    this.drawSoon();
  }

  newFrame() {
    const { model } = this;
    showTitle(model);
    histogram(byId("angle-chart"), model.frame.angleCounts, 72, kTables.quality,
      (share) => (share * 72) / kRegularDegrees, "\u00b0", "tet");
    histogram(byId("thickness-chart"), model.frame.thicknessCounts, model.frame.thickest * model.page.unit,
      kTables.thickness, (share) => (share * model.frame.thickest) / (model.thickest || 1), "", "pillar");
    reportTables(byId("report"), [["figures", model.frame.report], ["options", model.shell.about.parameters]]);
    const pins = [];
    for (let v = 0; v < model.vertices; ++v)
      if (isPinned(model, v)) pins.push(...model.frame.positions.subarray(3 * model.shell.surfaces[v]).slice(0, 3));
    this.canvas.setMarks(this.canvas.pins, pins);
    this.showPoint(this.point);
  }

  // The surfaces that bound the layers that are shown.
  paintSheets() {
    const { model, state, canvas } = this;
    this.colours = paint(model, state.colour);
    canvas.setTable(this.colours.table);
    const core = model.hasCore && state.core;
    const upper = state.first - 1, lower = state.last;
    const wanted = [[upper, -1, upper]];
    if (!(core && lower === model.layers)) wanted.push([lower, upper, lower - 1]);
    if (core && lower < model.layers) wanted.push([model.layers, -1, 255]);
    for (let i = 0; i < 3; ++i) {
      const sheet = wanted[i] && cornersOf(model, wanted[i][0], wanted[i][1]);
      canvas.setSheet(i, sheet && sheet.ids, sheet && coloursOf(sheet, wanted[i][2], this.colours));
    }
    byId("legend").replaceChildren(...legendOf(model, state.colour));
  }

  // What the plane and the depth open.
  close() {
    const { model, state, canvas, colours } = this;
    const shown = (layer) => (layer === 255 ? state.core : layer + 1 >= state.first && layer + 1 <= state.last);
    const plane = this.plane();
    canvas.setCap(0, plane &&
      capOf(this.caps[0], model, colours, distancesAlong(model, plane.normal), plane.at, shown));
    canvas.setCap(1, state.peel > 0 && capOf(this.caps[1], model, colours, model.depths, state.peel, shown));
  }

  view() {
    const plane = this.plane();
    return { ...this.camera.matrices(this.aspect()), plane: plane ? plane.cutter : kNoPlane, peel: this.state.peel,
      edges: this.state.edges, pins: this.state.pins };
  }

  drawSoon() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  draw() {
    const canvas = this.canvas.canvas;
    const box = byId("stage").getBoundingClientRect();
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(Math.round(box.width * ratio), 1), height = Math.max(Math.round(box.height * ratio), 1);
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    drawScene(this.canvas, this.view());
    const { dataset } = document.documentElement;
    dataset.drawn = String(Number(dataset.drawn || 0) + 1);
    dataset.frame = String(this.state.frame);
    if (!dataset.firstPicture) this.firstPicture(dataset);
  }

  // Reading a pixel waits until all is drawn.
  firstPicture(dataset) {
    const { gl } = this.canvas;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    dataset.firstPicture = performance.now().toFixed(0);
    byId("message").textContent = "";
    byId("about").textContent = `Made by vdb_shell ${this.model.page.version}. First picture after ` +
      `${(performance.now() / 1000).toFixed(2)} s. Positions and thicknesses are rounded to 1/65535 of their range, ` +
      "angles to a quarter of a degree.";
  }

  pick(x, y) {
    const box = this.canvas.canvas.getBoundingClientRect();
    const ratio = this.canvas.canvas.width / box.width;
    const [across, down] = [(x - box.left) * ratio, (y - box.top) * ratio];
    this.showPoint(pointAt(this.canvas, this.caps, this.model, this.view(), across, down));
    this.drawSoon();
  }

  showPoint(point) {
    this.point = point;
    showFigures(this.model, point);
    const v = point < 0 ? -1 : this.model.vertexOf[point];
    const points = point < 0 ? [] : v < 0 ? [point] : pillarOf(this.model, v);
    const positions = this.model.frame.positions;
    this.canvas.setMarks(this.canvas.picked, points.flatMap((p) => [...positions.subarray(3 * p, 3 * p + 3)]));
  }

  key(event) {
    const onControl = /^(INPUT|SELECT|SUMMARY)$/.test(event.target.tagName);
    if (event.ctrlKey || event.altKey || event.metaKey || onControl) return;
    const step = { "[": ["cut", -0.01], "]": ["cut", 0.01], ",": ["frame", -1], ".": ["frame", 1] }[event.key];
    if (moveByKey(this.camera, event, this.aspect())) this.drawSoon();
    else if (step) {
      this.state[step[0]] += step[1];
      this.changed(step[0]);
    } else if (event.key === " " && this.model.page.frames.length > 1 && event.target.tagName !== "BUTTON") {
      this.play(!this.playing);
    } else return;
    event.preventDefault();
  }

  // 24 frames a second, or as many as this machine draws.
  async play(on) {
    this.playing = on;
    byId("play").textContent = on ? "\u23f8" : "\u25b6";
    byId("play").setAttribute("aria-label", on ? "Pause" : "Play");
    for (let next = performance.now(); this.playing; next = Math.max(next + 1000 / 24, performance.now())) {
      this.state.frame = (this.state.frame + 1) % this.model.page.frames.length;
      await this.changed("frame");
      await new Promise((done) => setTimeout(done, Math.max(next - performance.now(), 8)));
    }
  }
}

readModel()
  .then((model) => new Page(model).start())
  .catch((error) => { byId("message").textContent = "This page cannot be shown: " + error.message; });
