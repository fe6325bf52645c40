// SPDX-License-Identifier: Apache-2.0
// A turntable: the eye goes round what it looks at, what is up stays up.

const kFieldOfView = (30 * Math.PI) / 180;

// Of the canvas, what a shell fills that is seen from where it is first seen from, and how far up
// its middle is, in halves of the canvas: title and legend are above and below it.
const kFilled = 0.78, kRaised = 0.05;
const kMostFitted = 4000; // points are looked at for that

class Camera {
  constructor(low, high, positions) {
    this.middle = scale(add(low, high), 0.5);
    this.radius = 0.5 * length(sub(high, low)) || 1;
    this.upAxis = 1;
    this.fitted = [];
    const step = 3 * Math.max(Math.floor(positions.length / 3 / kMostFitted), 1);
    for (let i = 0; i + 2 < positions.length; i += step)
      this.fitted.push(sub(positions.subarray(i, i + 3), this.middle));
    this.reset();
  }
  reset() {
    this.azimuth = this.startAzimuth ?? 0.6;
    this.elevation = 0.3;
    this.zoom = 1;
    this.target = this.middle;
    this.fit();
  }
  // Looks at the middle of what is seen, and keeps what the distance depends on: of each point,
  // how far it is off the line of sight and how near.
  fit() {
    const { right, up, back } = this.axes();
    const places = this.fitted.map((p) => [dot(p, right), dot(p, up), dot(p, back)]);
    const middleOf = (axis) => {
      let low = Infinity, high = -Infinity;
      for (const place of places) [low, high] = [Math.min(low, place[axis]), Math.max(high, place[axis])];
      return 0.5 * (low + high);
    };
    const [x, y] = [middleOf(0), middleOf(1)];
    this.target = add(this.middle, add(scale(right, x), scale(up, y)));
    this.places = places.map((p) => [Math.abs(p[0] - x), Math.abs(p[1] - y), p[2]]);
    this.distances = new Map();
  }
  // Right, up and back, for the present angles.
  axes() {
    const [a, e] = [this.azimuth, this.elevation];
    const turn = (x, y, z) => (this.upAxis === 1 ? [x, y, z] : [x, -z, y]);
    const back = turn(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e));
    const right = turn(Math.cos(a), 0, -Math.sin(a));
    return { right, up: cross(back, right), back };
  }
  distance(aspect) {
    if (!this.distances.has(aspect)) {
      const size = kFilled * Math.tan(kFieldOfView / 2);
      let most = 0;
      for (const [x, y, near] of this.places) most = Math.max(most, Math.max(x / aspect, y) / size + near);
      this.distances.set(aspect, most || 1);
    }
    return this.distances.get(aspect) / this.zoom;
  }
  matrices(aspect) {
    const { right, up, back } = this.axes();
    const distance = this.distance(aspect);
    const near = Math.max(distance - 2.2 * this.radius - length(sub(this.target, this.middle)), 0.004 * this.radius);
    const far = distance + 2.2 * this.radius + length(sub(this.target, this.middle));
    return { view: lookFrom(add(this.target, scale(back, distance)), right, up, back),
      project: perspective(kFieldOfView, aspect, near, far, kRaised) };
  }
  turn(dx, dy) {
    this.azimuth -= dx;
    this.elevation = clamp(this.elevation + dy, -1.57, 1.57);
  }
  // By shares of the canvas' height.
  move(dx, dy, aspect) {
    const { right, up } = this.axes();
    const size = 2 * this.distance(aspect) * Math.tan(kFieldOfView / 2);
    this.target = sub(this.target, sub(scale(right, dx * size), scale(up, dy * size)));
  }
  zoomBy(factor) { this.zoom = clamp(this.zoom * factor, 0.2, 200); }
}

// Calls changed() after each move, clicked(x, y) for a press that was no drag.
function listenToPointers(canvas, camera, changed, clicked) {
  const held = new Map();
  let moved = 0, spread = 0;
  const middleOf = () => {
    const all = [...held.values()];
    return { x: all.reduce((s, p) => s + p.x, 0) / all.length, y: all.reduce((s, p) => s + p.y, 0) / all.length };
  };
  const spreadOf = () => {
    const [a, b] = [...held.values()];
    return b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    spread = spreadOf();
    if (held.size === 1) moved = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held.has(event.pointerId)) return;
    const before = middleOf();
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const after = middleOf();
    const box = canvas.getBoundingClientRect();
    const dx = (after.x - before.x) / box.height, dy = (after.y - before.y) / box.height;
    moved += Math.abs(after.x - before.x) + Math.abs(after.y - before.y);
    if (held.size > 1 || event.shiftKey || event.buttons & 6) camera.move(dx, dy, box.width / box.height);
    else camera.turn(4 * dx, 4 * dy);
    const now = spreadOf();
    if (held.size > 1 && spread > 0 && now > 0) {
      camera.zoomBy(now / spread);
      moved += Math.abs(now - spread);
    }
    spread = now;
    changed();
  });
  const release = (event) => {
    const wasHeld = held.delete(event.pointerId);
    spread = spreadOf();
    if (wasHeld && event.type === "pointerup" && held.size === 0 && moved < 5 && event.button === 0)
      clicked(event.clientX, event.clientY);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    camera.zoomBy(Math.exp(-0.0014 * lines * event.deltaY));
    changed();
  }, { passive: false });
}

// True where the key was one of the camera's.
function moveByKey(camera, event, aspect) {
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (step && event.shiftKey) camera.move(0.05 * step[0], 0.05 * step[1], aspect);
  else if (step) camera.turn(0.12 * step[0], 0.12 * step[1]);
  else if (event.key === "+" || event.key === "=") camera.zoomBy(1.15);
  else if (event.key === "-") camera.zoomBy(1 / 1.15);
  else if (event.key === "Home" || event.key === "0") camera.reset();
  else if (event.key === "u") camera.upAxis = 3 - camera.upAxis;
  else return false;
  return true;
}
