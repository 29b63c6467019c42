// One frame: world, target, path, collisions, beams and car, in metres.
const body = packed.body;

function paint(drive, t, follow) {
  const now = momentAt(drive, t);
  const view = camera(follow, now);
  const world = worldBitmap(view);
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.drawImage(world.bitmap,
    Math.round((world.x - view.x) * view.scale) - world.spare,
    Math.round((view.y - world.y) * view.scale) - world.spare);
  inMetres(pen, view, view.scale, pixels.width, pixels.height);
  const pixel = pixels.ratio / view.scale;
  pen.lineJoin = pen.lineCap = "round";
  target(drive, pixel);
  path(drive, now, pixel);
  crosses(drive, now.k, pixel);
  start(drive, pixel);
  if (packed.range > 0) beams(now, pixel);
  car(now, pixel);
}

function target(drive, pixel) {
  const [x, y] = drive.goal;
  pen.beginPath();
  pen.arc(x, y, packed.target, 0, 2 * Math.PI);
  pen.globalAlpha = 0.75;
  pen.fillStyle = colours["goal-soft"];
  pen.fill();
  pen.globalAlpha = 1;
  pen.strokeStyle = colours.goal;
  pen.lineWidth = 1.5 * pixel;
  pen.stroke();
  pen.fillStyle = colours.goal;
  pen.fillRect(x - 4 * pixel, y - 4 * pixel, 8 * pixel, 8 * pixel);
}

function start(drive, pixel) {
  const [x, y] = drive.start;
  const r = 6 * pixel;
  pen.beginPath();
  pen.moveTo(x - r, y);
  pen.lineTo(x, y - r);
  pen.lineTo(x + r, y);
  pen.lineTo(x, y + r);
  pen.closePath();
  pen.fillStyle = colours.start;
  pen.fill();
}

// The whole path faintly, the part behind the car clearly, a periodic loop in its own colour.
function path(drive, now, pixel) {
  const lap = drive.lap === null ? Infinity : Math.max(drive.moves - 2 * drive.lap, 0);
  const stretch = (from, to, colour, width, alpha, end) => {
    if (to < from) return;
    pen.beginPath();
    pen.moveTo(drive.x[from], drive.y[from]);
    for (let k = from + 1; k <= to; k++) pen.lineTo(drive.x[k], drive.y[k]);
    if (end) pen.lineTo(end.x, end.y);
    pen.globalAlpha = alpha;
    pen.strokeStyle = colour;
    pen.lineWidth = width * pixel;
    pen.stroke();
    pen.globalAlpha = 1;
  };
  stretch(0, Math.min(drive.moves, lap), colours.path, 1.5, 0.3);
  if (lap < Infinity) stretch(lap, drive.moves, colours.loop, 4, 0.35);
  stretch(0, Math.min(now.k, lap), colours.path, 2.5, 1, now.k < lap ? now : null);
  if (now.k >= lap) stretch(lap, now.k, colours.loop, 3.5, 1, now);
  if (drive.lap === 1 && now.k >= lap) ring(now, 16 * pixel, colours.loop, 2.5 * pixel);
}

function crosses(drive, upTo, pixel) {
  const r = 4.5 * pixel;
  pen.beginPath();
  let [x, y] = [NaN, NaN];
  for (const k of drive.collided) {
    // A car held by a wall collides on one spot for many moves.
    if (k > upTo || (drive.x[k] === x && drive.y[k] === y)) continue;
    [x, y] = [drive.x[k], drive.y[k]];
    pen.moveTo(x - r, y - r);
    pen.lineTo(x + r, y + r);
    pen.moveTo(x - r, y + r);
    pen.lineTo(x + r, y - r);
  }
  pen.strokeStyle = colours.collision;
  pen.lineWidth = 2.2 * pixel;
  pen.stroke();
}

function beams(now, pixel) {
  const [sin, cos] = [Math.sin(now.heading), Math.cos(now.heading)];
  for (const { mount, hit, distance } of now.beams) {
    const x = now.x + mount[0] * cos - mount[1] * sin;
    const y = now.y + mount[0] * sin + mount[1] * cos;
    const angle = now.heading + mount[2];
    const [endX, endY] = [x + distance * Math.cos(angle), y + distance * Math.sin(angle)];
    pen.strokeStyle = pen.fillStyle = [colours.muted, colours.beam, colours.goal][hit];
    pen.lineWidth = (hit === 2 ? 2.4 : 1.4) * pixel;
    pen.setLineDash(hit === 0 ? [3 * pixel, 5 * pixel] : []);
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(endX, endY);
    pen.stroke();
    if (hit === 0) continue;
    pen.beginPath();
    pen.arc(endX, endY, 3 * pixel, 0, 2 * Math.PI);
    pen.fill();
  }
  pen.setLineDash([]);
}

function car(now, pixel) {
  pen.save();
  pen.translate(now.x, now.y);
  pen.rotate(now.heading);
  const half = body.width / 2;
  const rear = body.front_overhang - body.length;
  const wheel = (x, y, angle) => {
    pen.save();
    pen.translate(x, y);
    pen.rotate(angle);
    pen.fillRect(-0.11 * body.length, -0.09 * body.width, 0.22 * body.length, 0.18 * body.width);
    pen.restore();
  };
  pen.fillStyle = colours.ink;
  for (const side of [-half, half]) {
    wheel(0, side, now.steer);
    wheel(-body.wheelbase, side, 0);
  }
  pen.fillStyle = now.collided ? colours.collision : colours.body;
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1.3 * pixel;
  pen.beginPath();
  pen.roundRect(rear, -half, body.length, body.width, 0.2 * body.width);
  pen.fill();
  pen.stroke();
  // The windscreen shows which end is the front.
  pen.globalAlpha = 0.55;
  pen.fillStyle = colours.ink;
  pen.fillRect(body.front_overhang - 0.36 * body.length, -0.75 * half, 0.14 * body.length, 1.5 * half);
  pen.globalAlpha = 1;
  pen.restore();
  // A flash where it collides, and a ring that finds a car too small to see.
  if (now.collided) ring(now, Math.max(0.75 * body.length, 14 * pixel), colours.collision, 3 * pixel);
  else if (body.length < 14 * pixel) ring(now, 12 * pixel, colours.ink, 1.2 * pixel);
}

function ring(at, radius, colour, width) {
  pen.beginPath();
  pen.arc(at.x, at.y, radius, 0, 2 * Math.PI);
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.stroke();
}
