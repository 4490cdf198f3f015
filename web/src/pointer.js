// What the reader does to a picture of blocks by hand: drag, wheel, click; and the size of its window.

/** Drags move and the wheel zooms. @param clicked  (x, y): a place of the canvas [css px] was clicked */
export function followPointer(canvas, view, clicked) {
  let down = null;
  canvas.addEventListener("pointerdown", (e) => { down = { x: e.offsetX, y: e.offsetY, moved: false }; canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener("pointermove", (e) => {
    if (!down) return;
    if (!down.moved && Math.hypot(e.offsetX - down.x, e.offsetY - down.y) < 4) return;
    view.pan(e.offsetX - down.x, e.offsetY - down.y);
    down = { x: e.offsetX, y: e.offsetY, moved: true };
    view.draw();
  });
  canvas.addEventListener("pointerup", (e) => {
    const still = down && !down.moved;
    down = null;
    if (still) clicked(e.offsetX, e.offsetY);
  });
  canvas.addEventListener("wheel", (e) => { e.preventDefault(); view.zoom(Math.exp(-e.deltaY / 400), e.offsetX, e.offsetY); view.draw(); }, { passive: false });
}

/** Gives the canvas the pixels of the screen. */
export function matchPixels(canvas) {
  const ratio = window.devicePixelRatio || 1, w = Math.round(canvas.clientWidth * ratio), h = Math.round(canvas.clientHeight * ratio);
  if (canvas.width !== w || canvas.height !== h) canvas.width = w, canvas.height = h;
}

/** Draws anew when the canvas has another size. */
export function followSize(canvas, view, redraw) {
  let waiting = 0;
  new ResizeObserver(() => {
    clearTimeout(waiting);
    waiting = setTimeout(() => { matchPixels(canvas); if (view.fitted) view.fit(); redraw(); }, 50);
  }).observe(canvas);
}
