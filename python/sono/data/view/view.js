// The page: its curves and what is shown of them, and what mouse, fingers and keys do.

const $ = (id) => document.getElementById(id);
/** Radians that an arrow key turns by. */
const TURN = 0.12;

/** The radius of the rope that lets its contacts be seen. */
const THIN = 0.13;

const given = JSON.parse($("data").textContent);
const curves = [];
const state = { which: 0, beads: false, thin: false, dye: "component", radius: 1, marks: [] };
const camera = new Camera();
const map = new ContactMap($("map"));
let stage = $("rope"), painter = null, colours = null, waiting = false;

/** Return a curve, which is made when it is first seen. */
const shown = () => (curves[state.which] ??= new Curve(given[state.which]));

function painterOf(canvas) {
  try {
    return new Painter(canvas);
  } catch (error) {
    const plain = canvas.cloneNode(); // one that has given a context gives no other
    canvas.replaceWith(plain);
    stage = plain;
    $("warning").textContent = `The rope is only sketched: ${error.message}. A newer browser shows it in the round, or this one with hardware acceleration.`;
    $("warning").hidden = false;
    return new FlatPainter(plain);
  }
}

const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const inkOf = (name) => hex(ink(name).slice(1));
const dark = () => document.documentElement.dataset.theme === "dark";

const look = () => camera.look(shown(), stage.clientWidth / stage.clientHeight);

/** Draw soon, once for all that changes until then. */
function redraw() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    draw();
  });
}

function draw() {
  const dense = Math.min(devicePixelRatio || 1, 2);
  const [width, height] = [stage.clientWidth, stage.clientHeight].map((x) => Math.max(1, Math.round(x * dense)));
  if (stage.width !== width || stage.height !== height) [stage.width, stage.height] = [width, height];
  const marks = state.marks.map((vertex, k) => ({ vertex, colour: inkOf(k ? "other" : "mark") }));
  painter.draw({ ...state, curve: shown(), colours, look: look(), back: inkOf("back"), marks });
  map.draw(shown(), marks, { line: ink("line"), soft: ink("soft"), mark: ink("mark"), other: ink("other") });
  if (!performance.getEntriesByName("drawn").length) performance.mark("drawn");
}

// What is shown

function show(which) {
  state.which = Math.max(0, Math.min(given.length - 1, which));
  const curve = shown();
  $("name").textContent = curve.name;
  $("type").textContent = `Type: ${curve.type}`;
  $("which").value = state.which;
  $("which").setAttribute("aria-valuetext", curve.name);
  $("place").textContent = `${state.which + 1} of ${given.length}`;
  $("measures").replaceChildren(...curve.rows.map(([label, value]) => row(label, value)));
  $("strongest").textContent = curve.strongest.toPrecision(2);
  mark([]);
  dye(state.dye);
}

/** A row of the table; the letter after _ in a label is set lower. */
function row(label, value) {
  const line = document.createElement("tr"), head = line.appendChild(document.createElement("th")), [name, lower = ""] = label.split("_");
  head.scope = "row";
  head.append(name);
  head.appendChild(document.createElement("sub")).textContent = lower.slice(0, 1);
  head.append(lower.slice(1));
  line.appendChild(document.createElement("td")).textContent = value;
  return line;
}

function dye(name) {
  state.dye = $("colour").value = name;
  const curve = shown(), { label, of, scale, most, above = "" } = DYES[name];
  colours = dyed(curve, name);
  $("of").textContent = of ?? (curve.sizes.length > 1 ? label : "");
  $("scale").style.background = scale ? gradient(scale) : "none";
  $("scale").hidden = !scale;
  const top = scale && Math.max(...curve.sizes.map((_, c) => most(curve, c)));
  $("least").textContent = scale ? "0" : "";
  $("most").textContent = scale ? above + +top.toPrecision(3) : "";
  listComponents(curve, !scale && curve.sizes.length > 1);
  redraw();
}

function listComponents(curve, wanted) {
  $("legend").querySelector("ul")?.remove();
  if (!wanted) return;
  const list = $("legend").appendChild(document.createElement("ul"));
  curve.sizes.slice(0, COMPONENTS.length).forEach((size, c) => {
    const item = list.appendChild(document.createElement("li"));
    item.textContent = `${c}: ${size} vertices`;
    item.style.setProperty("--dye", css(componentColour(c)));
  });
}

function toggle(name) {
  state[name] = !state[name];
  $(name).setAttribute("aria-pressed", state[name]);
  state.radius = state.thin ? THIN : 1;
  redraw();
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  redraw();
}

// Places on the rope

/** Mark up to two vertices, on the rope and on the map, and say what is known of them. */
function mark(vertices) {
  if (vertices.length === state.marks.length && vertices.every((i, k) => i === state.marks[k])) return;
  state.marks = vertices;
  $("told").hidden = !vertices.length;
  $("told").tBodies[0].replaceChildren(...vertices.map(told));
  $("told").tFoot.rows[0].cells[0].textContent = between(vertices);
  redraw();
}

function told(i) {
  const curve = shown(), c = curve.component[i], first = curve.first[c], line = document.createElement("tr");
  const figures = [curve.arclength[i] - curve.arclength[first], curve.curvature[i], curve.force[i]];
  for (const text of [`${c}:${i - first}`, ...figures.map((x) => x.toFixed(3))]) line.insertCell().textContent = text;
  return line;
}

/** What two vertices have to do with each other. */
function between([i, j]) {
  if (j === undefined) return "";
  const curve = shown(), apart = Math.hypot(...sub(curve.vertex(i), curve.vertex(j)));
  const k = curve.pressing.findIndex((_, k) => [[i, j], [j, i]].some(([a, b]) => curve.pairs[2 * k] === a && curve.pairs[2 * k + 1] === b));
  return `${apart.toFixed(3)} R apart${k < 0 ? "" : `, pressing with ${curve.pressing[k].toFixed(4)} of the tension`}`;
}

function pointAtRope(event) {
  const box = stage.getBoundingClientRect(), x = (2 * (event.clientX - box.left)) / box.width - 1, y = 1 - (2 * (event.clientY - box.top)) / box.height;
  const view = look(), pixel = (-2 * view.shift[2]) / view.lens[1] / box.height;
  const vertex = struck(shown(), view, x, y, Math.max(state.radius, 6 * pixel));
  mark(vertex === null ? [] : [vertex]);
}

function pointAtMap(event) {
  const box = $("map").getBoundingClientRect();
  mark(map.under(event.clientX - box.left, event.clientY - box.top));
}

/** A mouse that has left points at nothing; a finger that was lifted did point. */
function leave(event) {
  if (event.pointerType === "mouse") mark([]);
}

function stepOnMap(event) {
  const curve = shown(), step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
  if (!step) return;
  event.preventDefault();
  event.stopPropagation();
  const [i = 0, j = i] = state.marks;
  mark([(i + step[0] + curve.n) % curve.n, (j + step[1] + curve.n) % curve.n]);
}

// Mouse and fingers

const fingers = new Map();

function down(event) {
  stage.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  pointAtRope(event);
}

function up(event) {
  fingers.delete(event.pointerId);
}

function move(event) {
  const old = fingers.get(event.pointerId);
  if (!old) return pointAtRope(event);
  const now = [event.clientX, event.clientY], [x, y] = [now[0] - old[0], now[1] - old[1]], height = stage.clientHeight;
  fingers.set(event.pointerId, now);
  if (fingers.size === 2) pinch(event.pointerId, old, now);
  else if (event.buttons & 6 || event.shiftKey) camera.pan(x / height, -y / height);
  else camera.rotate((4 * x) / height, (-4 * y) / height);
  redraw();
}

/** One of two fingers has moved: move by half of that, turn and zoom as the line between them does. */
function pinch(id, old, now) {
  const other = [...fingers].find(([key]) => key !== id)[1], height = stage.clientHeight;
  const [before, after] = [old, now].map(([x, y]) => [x - other[0], y - other[1]]);
  camera.magnify(Math.hypot(...after) / (Math.hypot(...before) || 1));
  camera.roll(-Math.atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]));
  camera.pan((now[0] - old[0]) / 2 / height, (old[1] - now[1]) / 2 / height);
}

function wheel(event) {
  event.preventDefault();
  camera.magnify(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)));
  redraw();
}

// Keys

const KEYS = {
  b: () => toggle("beads"),
  t: () => toggle("thin"),
  c: () => dye(Object.keys(DYES)[(Object.keys(DYES).indexOf(state.dye) + 1) % Object.keys(DYES).length]),
  d: () => theme(dark() ? "light" : "dark"),
  r: () => camera.reset(),
  "+": () => camera.magnify(1.15),
  "=": () => camera.magnify(1.15),
  "-": () => camera.magnify(1 / 1.15),
  "[": () => show(state.which - 1),
  "]": () => show(state.which + 1),
  "?": () => $("keys").showModal(),
};

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function press(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || $("keys").open) return;
  const arrow = !event.target.matches("input, select") && ARROWS[event.key];
  if (arrow && event.shiftKey) camera.pan(arrow[0] / 20, arrow[1] / 20);
  else if (arrow) camera.rotate(TURN * arrow[0], TURN * arrow[1]);
  else if (KEYS[event.key] && !event.target.matches("select")) KEYS[event.key]();
  else return;
  event.preventDefault();
  redraw();
}

// The beginning

function listen() {
  for (const name of ["beads", "thin"]) $(name).onclick = () => toggle(name);
  $("reset").onclick = () => (KEYS.r(), redraw());
  $("theme").onclick = KEYS.d;
  $("help").onclick = KEYS["?"];
  $("colour").onchange = () => dye($("colour").value);
  $("which").oninput = () => show(+$("which").value);
  Object.assign(stage, { onpointerdown: down, onpointermove: move, onpointerup: up, onpointercancel: up, onpointerleave: leave, oncontextmenu: (event) => event.preventDefault() });
  stage.addEventListener("wheel", wheel, { passive: false });
  stage.addEventListener("webglcontextlost", (event) => event.preventDefault());
  stage.addEventListener("webglcontextrestored", () => ((painter = painterOf(stage)), redraw()));
  Object.assign($("map"), { onpointermove: pointAtMap, onpointerdown: pointAtMap, onpointerleave: leave, onkeydown: stepOnMap });
  addEventListener("keydown", press);
  new ResizeObserver(redraw).observe(stage);
  const night = matchMedia("(prefers-color-scheme: dark)");
  night.onchange = () => theme(night.matches ? "dark" : "light");
  theme(night.matches ? "dark" : "light");
}

$("colour").append(...Object.entries(DYES).map(([name, { label }]) => new Option(label, name)));
$("series").hidden = given.length < 2;
$("which").max = given.length - 1;
$("forces").style.background = gradient(PLASMA);
painter = painterOf(stage);
listen();
show(0);
