// SPDX-License-Identifier: Apache-2.0
// The state of the page, its controls, and the part of the address behind # that can set it:
// #colour=stop&axis=x&cut=0.4&peel=0.2&frame=3&theme=dark

const kAxes = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

function stateAtFirst(model) {
  return { colour: "depth", axis: "none", cut: 0.5, flip: false, peel: 0, first: 1, last: model.layers, core: true,
    edges: true, pins: true, frame: 0, theme: "" };
}

// Only what the state has, of the type that it has there.
function readAddress(state, camera, text) {
  for (const [key, value] of new URLSearchParams(text.replace(/^#/, ""))) {
    const number = Number(value);
    if (key === "view") {
      const [azimuth, elevation, zoom] = value.split(",").map(Number);
      if (Number.isFinite(azimuth)) camera.azimuth = (azimuth * Math.PI) / 180;
      if (Number.isFinite(elevation)) camera.turn(0, (elevation * Math.PI) / 180 - camera.elevation);
      if (zoom > 0) camera.zoomBy(zoom / camera.zoom);
      camera.fit();
    } else if (key === "up") camera.upAxis = value === "z" ? 2 : 1;
    else if (typeof state[key] === "number" && Number.isFinite(number)) state[key] = number;
    else if (typeof state[key] === "boolean") state[key] = value === "1" || value === "true";
    else if (typeof state[key] === "string") state[key] = value;
  }
}

function limitState(state, model) {
  if (!byId("colour").querySelector(`option[value="${CSS.escape(state.colour)}"]`)) state.colour = "depth";
  if (!kAxes[state.axis] && state.axis !== "view") state.axis = "none";
  state.cut = clamp(state.cut, 0, 1);
  state.peel = clamp(state.peel, 0, 1);
  state.first = clamp(Math.round(state.first), 1, model.layers);
  state.last = clamp(Math.round(state.last), state.first, model.layers);
  state.frame = clamp(Math.round(state.frame), 0, model.page.frames.length - 1);
}

const isDark = () => (document.documentElement.dataset.theme ||
  (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";

function setTheme(theme) {
  if (theme === "dark" || theme === "light") document.documentElement.dataset.theme = theme;
}

function sliderOf(id, text) {
  const input = byId(id);
  input.closest("label").querySelector("output").textContent = text;
  return input;
}

// Controls that say nothing of this shell are not there.
function showState(state, model, cutPlace) {
  byId("colour").value = state.colour;
  for (const id of ["edges", "pins", "core"]) byId(id).checked = state[id];
  for (const button of byId("axis").querySelectorAll("[data-axis]"))
    button.setAttribute("aria-pressed", String(button.dataset.axis === state.axis));
  byId("flip").setAttribute("aria-pressed", String(state.flip));
  sliderOf("cut", state.axis === "none" ? "" : figure(cutPlace)).value = state.cut;
  byId("cut").closest("label").classList.toggle("off", state.axis === "none");
  sliderOf("peel", state.peel.toFixed(3)).value = state.peel;
  for (const id of ["first", "last"]) sliderOf(id, `${state[id]} of ${model.layers}`).value = state[id];
  byId("frame").value = state.frame;
  byId("frame-label").textContent = model.page.frames[state.frame].label;
}

function preparePanel(model) {
  const { about } = model.shell;
  for (const part of document.querySelectorAll("[data-layers]")) part.hidden = model.layers < 2;
  for (const part of document.querySelectorAll("[data-core]")) part.hidden = !model.hasCore;
  byId("colour").querySelector("[value=layer]").hidden = model.layers < 2;
  byId("first").max = byId("last").max = model.layers;
  byId("pins-label").querySelector("span").textContent = counted(about.pinned, "pinned vertex", "pinned vertices");
  byId("pins-label").hidden = about.pinned === 0;
  byId("frame").max = model.page.frames.length - 1;
  byId("time").hidden = model.page.frames.length < 2;
  byId("stage").classList.toggle("timed", model.page.frames.length > 1);
}

function showTitle(model) {
  const { about } = model.shell;
  const report = parsedOrNull(model.frame.report) || {};
  const name = typeof report.source === "string" && report.source ? report.source : model.page.frames[0].label;
  byId("title").querySelector("h1").textContent = name;
  document.title = name + ": shell";
  const parts = [counted(about.vertices, "vertex", "vertices"), counted(about.triangles, "triangle"),
    counted(about.tets, "tet")];
  if (model.layers > 1) parts.push(counted(model.layers, "layer"));
  if (about.core_tets > 0) parts.push(counted(about.core_tets, "tet") + " of the core");
  let text = parts.join(" \u00b7 ");
  if (about.coarser)
    text += `. A coarser shell of ${counted(model.faces, "triangle")} is drawn; ` +
      "all figures but the colours are those of the whole one.";
  byId("title").querySelector("p").textContent = text;
}

// changed(what) is called with the key that changed.
function listenToPanel(state, changed) {
  const on = (id, event, read) => byId(id).addEventListener(event, () => {
    state[id] = read(byId(id));
    changed(id);
  });
  on("colour", "change", (input) => input.value);
  for (const id of ["edges", "pins", "core"]) on(id, "change", (input) => input.checked);
  for (const id of ["cut", "peel", "first", "last", "frame"]) on(id, "input", (input) => Number(input.value));
  byId("axis").addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    if (button.id === "flip") state.flip = !state.flip;
    else state.axis = button.dataset.axis;
    changed("axis");
  });
  byId("theme").addEventListener("click", () => {
    setTheme(isDark() ? "light" : "dark");
    changed("theme");
  });
}
