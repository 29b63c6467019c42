// Where metres are on the screen, and the world drawn once for every view of it.
const canvas = byId("canvas");
const pen = canvas.getContext("2d");
const [[left, bottom], [right, top_]] = packed.bounds;
const outline = {
  map: new Path2D(byId("world-map").getAttribute("d")),
  solid: new Path2D(byId("world-solid").getAttribute("d")),
  lines: new Path2D(byId("world-lines").getAttribute("d")),
};
let colours = {};
let pixels = { width: 1, height: 1, ratio: 1 };
let drawnWorld = null;

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const names = ["paper", "ink", "muted", "rule", "wall", "path", "start", "goal", "goal-soft",
    "collision", "loop", "body", "beam", "shade"];
  colours = Object.fromEntries(names.map((name) => [name, style.getPropertyValue("--" + name).trim()]));
  drawnWorld = null;
}

// Fits the canvas to the column it stands in: as wide as there is room, never taller than
// most of the window.
function resize() {
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const width = canvas.parentElement.clientWidth;
  const wanted = width * (top_ - bottom) / (right - left);
  const height = Math.round(Math.max(Math.min(wanted, window.innerHeight * 0.6), width * 0.25, 180));
  canvas.style.height = height + "px";
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  pixels = { width: canvas.width, height: canvas.height, ratio };
  drawnWorld = null;
}

// The part of the world on the screen: its middle in metres, and pixels per metre.
function camera(follow, car) {
  const whole = Math.min(pixels.width / (right - left), pixels.height / (top_ - bottom)) * 0.97;
  if (!follow) return { x: (left + right) / 2, y: (bottom + top_) / 2, scale: whole };
  const span = Math.max(1.6 * packed.range, 10 * packed.body.length);
  const close = Math.min(pixels.width, pixels.height) / span;
  return { x: car.x, y: car.y, scale: Math.max(whole, close) };
}

// Lets a context draw in metres, y upwards.
function inMetres(context, middle, scale, width, height) {
  context.setTransform(scale, 0, 0, -scale, width / 2 - middle.x * scale, height / 2 + middle.y * scale);
}

// A world may have a hundred thousand edges, so it is drawn to a bitmap somewhat larger than
// the screen and drawn anew only when the camera leaves that.
function worldBitmap(view) {
  const margin = drawnWorld && drawnWorld.scale === view.scale
    ? Math.max(Math.abs(view.x - drawnWorld.x) * view.scale - drawnWorld.spare,
      Math.abs(view.y - drawnWorld.y) * view.scale - drawnWorld.spare)
    : Infinity;
  if (margin <= 0) return drawnWorld;
  const spare = Math.round(Math.min(pixels.width, pixels.height) / 2);
  const bitmap = document.createElement("canvas");
  bitmap.width = pixels.width + 2 * spare;
  bitmap.height = pixels.height + 2 * spare;
  const context = bitmap.getContext("2d");
  context.fillStyle = colours.shade;
  context.fillRect(0, 0, bitmap.width, bitmap.height);
  inMetres(context, view, view.scale, bitmap.width, bitmap.height);
  context.fillStyle = colours.paper;
  context.fillRect(left, bottom, right - left, top_ - bottom);
  const pixel = pixels.ratio / view.scale;
  grid(context, pixel);
  context.fillStyle = context.strokeStyle = colours.wall;
  context.lineJoin = context.lineCap = "round";
  context.fill(outline.solid);
  context.fill(outline.map, "evenodd");
  context.lineWidth = 0.7 * pixel;
  context.stroke(outline.map);
  context.lineWidth = 1.6 * pixel;
  context.stroke(outline.lines);
  context.lineWidth = packed.outer_wall ? 3 * pixel : pixel;
  context.setLineDash(packed.outer_wall ? [] : [2 * pixel, 4 * pixel]);
  context.strokeRect(left, bottom, right - left, top_ - bottom);
  drawnWorld = { bitmap, x: view.x, y: view.y, scale: view.scale, spare };
  return drawnWorld;
}

// Faint lines at round distances.
function grid(context, pixel) {
  const rough = Math.max(right - left, top_ - bottom) / 10;
  const decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((m) => m * decade >= rough * 0.999) * decade;
  context.beginPath();
  for (let x = Math.ceil(left / step) * step; x <= right; x += step) {
    context.moveTo(x, bottom);
    context.lineTo(x, top_);
  }
  for (let y = Math.ceil(bottom / step) * step; y <= top_; y += step) {
    context.moveTo(left, y);
    context.lineTo(right, y);
  }
  context.strokeStyle = colours.rule;
  context.lineWidth = pixel;
  context.stroke();
}
