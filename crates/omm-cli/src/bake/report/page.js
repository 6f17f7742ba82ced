"use strict";
// Pictures that can be enlarged: wheel or buttons zoom, dragging or arrow keys move.
for (const viewer of document.querySelectorAll(".viewer")) {
  const stage = viewer.querySelector(".stage");
  const image = stage.querySelector("img");
  const shown = viewer.querySelector("output");
  const MOST = 32;
  let scale = 1, left = 0, top = 0;
  const fit = () => Math.min(stage.clientWidth / image.naturalWidth, stage.clientHeight / image.naturalHeight);
  const within = (offset, room, size) => size <= room ? (room - size) / 2 : Math.min(0, Math.max(room - size, offset));
  const draw = () => {
    left = within(left, stage.clientWidth, image.naturalWidth * scale);
    top = within(top, stage.clientHeight, image.naturalHeight * scale);
    image.style.transform = `translate(${left}px, ${top}px) scale(${scale})`;
    image.style.imageRendering = scale >= 2 ? "pixelated" : "auto";
    shown.textContent = `${Math.round(scale * 100)} %`;
  };
  const zoom = (to, x = stage.clientWidth / 2, y = stage.clientHeight / 2) => {
    to = Math.min(MOST, Math.max(Math.min(fit(), 1), to));
    left = x - (x - left) * to / scale;
    top = y - (y - top) * to / scale;
    scale = to;
    draw();
  };
  const whole = () => { scale = fit(); left = top = 0; draw(); };
  const move = (x, y) => { left += x; top += y; draw(); };
  const actions = { in: () => zoom(scale * 1.5), out: () => zoom(scale / 1.5), one: () => zoom(1), fit: whole };
  for (const button of viewer.querySelectorAll("button")) button.addEventListener("click", actions[button.dataset.action]);
  stage.addEventListener("wheel", event => {
    event.preventDefault();
    const box = stage.getBoundingClientRect();
    zoom(scale * Math.exp(-event.deltaY / 400), event.clientX - box.left, event.clientY - box.top);
  }, { passive: false });
  stage.addEventListener("pointerdown", event => stage.setPointerCapture(event.pointerId));
  stage.addEventListener("pointermove", event => { if (event.buttons & 1) move(event.movementX, event.movementY); });
  stage.addEventListener("keydown", event => {
    const keys = {
      "+": actions.in, "=": actions.in, "-": actions.out, "0": whole, "1": actions.one,
      ArrowLeft: () => move(60, 0), ArrowRight: () => move(-60, 0), ArrowUp: () => move(0, 60), ArrowDown: () => move(0, -60),
    };
    if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  if (image.complete) whole(); else image.addEventListener("load", whole);
  addEventListener("resize", whole);
}
document.documentElement.dataset.ready = "true";
