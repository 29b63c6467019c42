// The drives, from whole numbers back to metres and radians.
const byId = (id) => document.getElementById(id);
const packed = JSON.parse(byId("drives").textContent);
const real = (numbers) => Float64Array.from(numbers, (n) => n * packed.unit);
const BEAMS = packed.beams.length;
const HITS = ["nothing", "wall", "target"];

const drives = packed.drives.map((d) => {
  const collided = new Set(d.collided);
  // How many collisions there were up to each moment.
  let count = 0;
  const collisions = Array.from(d.x, (_, k) => (collided.has(k) ? ++count : count));
  return {
    start: real(d.start), goal: real(d.goal), verdict: d.verdict, kind: d.kind, lap: d.lap,
    x: real(d.x), y: real(d.y), heading: real(d.heading), steer: real(d.steer),
    step: real(d.step), beams: real(d.beams), hits: d.hits, collided, collisions,
    moves: Math.max(d.x.length - 1, 0),
  };
});

// The state at a possibly fractional moment: what a screen shows between two moves.
function momentAt(drive, t) {
  const k = Math.min(Math.floor(t), drive.moves);
  const next = Math.min(k + 1, drive.moves);
  const part = Math.min(t - k, 1);
  const mix = (a, b) => a + (b - a) * part;
  const turn = Math.atan2(
    Math.sin(drive.heading[next] - drive.heading[k]),
    Math.cos(drive.heading[next] - drive.heading[k]));
  const beams = packed.beams.map((mount, i) => {
    const [here, there] = [BEAMS * k + i, BEAMS * next + i];
    const hit = Number(drive.hits[here]);
    // A beam that changes from one thing to another jumps; in between it slides.
    const same = drive.hits[here] === drive.hits[there];
    return { mount, hit, distance: same ? mix(drive.beams[here], drive.beams[there]) : drive.beams[here] };
  });
  return {
    k, x: mix(drive.x[k], drive.x[next]), y: mix(drive.y[k], drive.y[next]),
    heading: drive.heading[k] + turn * part, steer: drive.steer[k], beams,
    collided: drive.collided.has(Math.round(t)),
  };
}
