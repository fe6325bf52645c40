// SPDX-License-Identifier: Apache-2.0
// One picture of what the canvas holds, for the eye or for the pointer.

const kNoPlane = [0, 0, 0, 1];

function colourOfStyle(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return rgbOf(text).map((c) => c / 255);
}

// view: {view, project, plane, peel, edges, pins}; pick: a number per piece in place of colours.
function drawPieces(canvas, view, pick) {
  const gl = canvas.gl;
  const edge = [0.05, 0.07, 0.12];
  const common = { u_view: view.view, u_project: view.project, u_edges: view.edges ? 0.5 : 0, u_edge: edge,
    u_lookup: canvas.lookup, u_core: kCoreColour.map((c) => c / 255) };
  gl.enable(gl.DEPTH_TEST);
  gl.activeTexture(gl.TEXTURE1);
  gl.bindTexture(gl.TEXTURE_2D, canvas.table);
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, canvas.points);
  canvas.surface.set({ ...common, u_plane: view.plane, u_peel: view.peel, u_low: canvas.low, u_size: canvas.size,
    u_plain: 0 }, { u_points: 0, u_table: 1 });
  canvas.sheets.forEach((sheet, i) => {
    if (sheet.count === 0) return;
    canvas.surface.set({}, { u_pick: pick ? 1 + i : 0 });
    gl.bindVertexArray(sheet.layout);
    gl.drawArrays(gl.TRIANGLES, 0, sheet.count);
  });
  canvas.caps.forEach((cap, i) => {
    if (cap.count === 0) return;
    // The cut of the plane lies in the plane, the surface of one depth has that depth.
    canvas.cap.set({ ...common, u_plane: i === 0 ? kNoPlane : view.plane, u_peel: i === 0 ? view.peel : 0,
      u_plain: i === 0 ? 1 : 0 }, { u_pick: pick ? 4 + i : 0, u_table: 1 });
    gl.bindVertexArray(cap.layout);
    gl.drawArrays(gl.TRIANGLES, 0, cap.count);
  });
}

function drawMarks(canvas, view, ratio) {
  const gl = canvas.gl;
  const common = { u_view: view.view, u_project: view.project, u_plane: view.plane, u_lift: 0.004 };
  if (view.pins && canvas.pins.count > 0) {
    gl.bindVertexArray(canvas.pins.layout);
    // Pins are mostly in creases: those that are hidden show as rings.
    gl.disable(gl.DEPTH_TEST);
    canvas.mark.set({ ...common, u_size: 8 * ratio, u_round: 2, u_colour: rgbOf(kPin).map((c) => c / 255) });
    gl.drawArrays(gl.POINTS, 0, canvas.pins.count);
    gl.enable(gl.DEPTH_TEST);
    canvas.mark.set({ u_size: 9 * ratio, u_round: 1 });
    gl.drawArrays(gl.POINTS, 0, canvas.pins.count);
  }
  if (canvas.picked.count === 0) return;
  // The pillar is inside, and is seen all the same.
  gl.disable(gl.DEPTH_TEST);
  gl.bindVertexArray(canvas.picked.layout);
  const colour = colourOfStyle("--accent");
  canvas.mark.set({ ...common, u_plane: kNoPlane, u_size: 10 * ratio, u_round: 0, u_colour: colour });
  gl.drawArrays(gl.LINE_STRIP, 0, canvas.picked.count);
  canvas.mark.set({ u_round: 1 });
  gl.drawArrays(gl.POINTS, 0, canvas.picked.count);
}

function drawScene(canvas, view) {
  const gl = canvas.gl;
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.viewport(0, 0, canvas.canvas.width, canvas.canvas.height);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  drawPieces(canvas, view, false);
  drawMarks(canvas, view, ratio);
}

// What is under a pixel, counted from the lower left: {piece, triangle} or null.
function pieceAt(canvas, view, x, y) {
  const gl = canvas.gl;
  const width = canvas.canvas.width, height = canvas.canvas.height;
  const target = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  const buffers = [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]].map(
    ([format, place]) => {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
      return buffer;
    });
  gl.viewport(0, 0, width, height);
  gl.enable(gl.SCISSOR_TEST);
  gl.scissor(x, y, 1, 1);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  drawPieces(canvas, view, true);
  const pixel = new Uint8Array(4);
  gl.readPixels(x, y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  gl.disable(gl.SCISSOR_TEST);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.deleteFramebuffer(target);
  for (const buffer of buffers) gl.deleteRenderbuffer(buffer);
  return pixel[3] === 0 ? null : { piece: pixel[3], triangle: pixel[0] + 256 * pixel[1] + 65536 * pixel[2] };
}
