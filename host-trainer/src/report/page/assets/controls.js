// Buttons, slider, keys and numbers around the canvas.
const metres = (m) => m.toFixed(2) + " m";
const degrees = (radians) => {
  const turned = Math.atan2(Math.sin(radians), Math.cos(radians)) * 180 / Math.PI;
  return (turned < 0 ? "\u2212" : "") + Math.abs(turned).toFixed(0) + "\u00b0";
};

function showDrive(drive, index) {
  byId("scrub").max = drive.moves;
  byId("choices").querySelectorAll("input").forEach((radio, i) => { radio.checked = i === index; });
  const verdict = byId("verdict");
  verdict.className = drive.lap !== null ? "loop" : drive.kind;
  verdict.textContent = "Drive " + (index + 1) + ": " + drive.verdict + "."
    + (drive.lap === null ? "" : drive.lap === 1
      ? " The car ends standing still."
      : " The car ends in a periodic loop, drawn in amber.");
}

function showReadings(drive, k) {
  const scrub = byId("scrub");
  scrub.value = k;
  scrub.setAttribute("aria-valuetext", "move " + k + " of " + drive.moves);
  byId("clock").textContent = k + " / " + drive.moves;
  byId("position").textContent = drive.x[k].toFixed(2) + ", " + metres(drive.y[k]);
  byId("heading").textContent = degrees(drive.heading[k]);
  byId("wheels").textContent = degrees(Math.abs(drive.steer[k]))
    + (Math.abs(drive.steer[k]) < 0.0087 ? "" : drive.steer[k] > 0 ? " left" : " right");
  byId("pace").textContent = (drive.step[k] / packed.period).toFixed(2) + " m/s";
  byId("collisions").textContent = drive.collisions[k];
  beamRows.forEach(({ bar, text, beam }) => {
    const distance = drive.beams[BEAMS * k + beam];
    const hit = HITS[drive.hits[BEAMS * k + beam]];
    bar.style.width = Math.min(100 * distance / packed.range, 100) + "%";
    bar.className = hit;
    text.textContent = hit === "nothing" ? "nothing" : metres(distance) + " " + hit;
  });
}

function showPlaying(playing) {
  byId("play").textContent = playing ? "Pause" : "Play";
}

// Leftmost beam first, as seen from the driver's seat; mounts come rightmost first.
const beamRows = packed.beams.map((mount, beam) => ({ mount, beam })).reverse().map(({ mount, beam }) => {
  const row = byId("beams").tBodies[0].insertRow();
  row.insertCell().textContent = degrees(mount[2]);
  const bar = document.createElement("i");
  row.insertCell().append(bar);
  return { bar, text: row.insertCell(), beam };
});

drives.forEach((drive, index) => {
  const radio = Object.assign(document.createElement("input"), { type: "radio", name: "drive", value: index });
  radio.addEventListener("change", () => choose(index));
  const text = document.createElement("span");
  text.className = drive.kind;
  text.textContent = (index + 1) + "  " + drive.verdict;
  const label = document.createElement("label");
  label.append(radio, text);
  byId("choices").append(label);
});

const toggle = () => (state.playing ? pause() : play());
const stepBy = (moves) => { pause(); seek(moment() + moves); };
byId("play").addEventListener("click", toggle);
byId("canvas").addEventListener("click", toggle);
byId("back").addEventListener("click", () => stepBy(-1));
byId("forward").addEventListener("click", () => stepBy(1));
byId("scrub").addEventListener("input", (event) => { pause(); seek(Number(event.target.value)); });
byId("speed").addEventListener("change", (event) => { state.speed = Number(event.target.value); });
byId("follow").addEventListener("change", (event) => { state.follow = event.target.checked; show(); });

const keys = {
  " ": toggle,
  ArrowLeft: (event) => stepBy(event.shiftKey ? -10 : -1),
  ArrowRight: (event) => stepBy(event.shiftKey ? 10 : 1),
  Home: () => { pause(); seek(0); },
  End: () => { pause(); seek(current().moves); },
};
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  // Elements that use a key themselves keep it.
  const own = event.key === " " ? "button,select,summary,a,input:not([type=range])" : "select,input:not([type=checkbox])";
  if (event.target.closest(own)) return;
  const { top, bottom: low } = canvas.getBoundingClientRect();
  if (low < 0 || top > window.innerHeight) return;
  const digit = /^[1-9]$/.test(event.key) ? () => choose(event.key - 1) : null;
  const action = keys[event.key] || digit;
  if (!action) return;
  event.preventDefault();
  action(event);
});

// `#drive=2&move=40` shows that moment, so that a link can point at it.
function readAddress() {
  const wanted = new URLSearchParams(location.hash.slice(1));
  if (!wanted.has("drive")) return false;
  pause();
  choose(Number(wanted.get("drive")) - 1);
  seek(Number(wanted.get("move")) || 0);
  byId("replay").scrollIntoView({ block: "start" });
  return true;
}

function refresh() {
  readColours();
  resize();
  show();
}

// For tests and for the curious: what is shown, and a way to show something else.
window.evosteer = Object.freeze({
  get drive() { return state.drive; },
  get step() { return moment(); },
  get steps() { return current().moves; },
  get playing() { return state.playing; },
  get frames() { return state.frames; },
  choose, seek, play, pause,
});

if (drives.length > 0) {
  readColours();
  resize();
  if (!readAddress()) choose(0);
  window.addEventListener("hashchange", readAddress);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", refresh);
  new ResizeObserver(() => { if (canvas.parentElement.clientWidth * pixels.ratio !== pixels.width) refresh(); })
    .observe(canvas.parentElement);
}
