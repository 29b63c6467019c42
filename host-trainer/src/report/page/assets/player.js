// What is being shown, and the passing of time.
const state = { drive: 0, t: 0, playing: false, speed: 1, follow: false, frames: 0 };
let lastTick = null;

const current = () => drives[state.drive];
const moment = () => Math.min(Math.floor(state.t + 1e-9), current().moves);

function show() {
  paint(current(), state.t, state.follow);
  showReadings(current(), moment());
  state.frames += 1;
}

function seek(t) {
  state.t = Math.min(Math.max(t, 0), current().moves);
  show();
}

function choose(index) {
  if (!drives[index]) return;
  state.drive = index;
  state.t = 0;
  showDrive(current(), index);
  show();
}

function play() {
  if (state.playing) return;
  if (state.t >= current().moves) state.t = 0;
  state.playing = true;
  lastTick = null;
  showPlaying(true);
  requestAnimationFrame(tick);
}

function pause() {
  state.playing = false;
  showPlaying(false);
}

function tick(now) {
  if (!state.playing) return;
  // After a pause of the page itself the drive goes on, it does not jump.
  const seconds = lastTick === null ? 0 : Math.min((now - lastTick) / 1000, 0.1);
  lastTick = now;
  seek(state.t + seconds * state.speed / packed.period);
  if (state.t >= current().moves) pause();
  else requestAnimationFrame(tick);
}
