// The table of ropes: it is sorted and filtered as plain data, and has rows for what is in sight alone.

const $ = (id) => document.getElementById(id);

/** Rows that are there beyond those in sight, on either side. */
const SPARE = 6;

const { columns, ropes, size, edge } = report;
const state = { sort: "", down: false, shown: [] };
const lines = new Map();
const names = new Intl.Collator("en", { numeric: true });
const scroller = $("scroller");

// Filters and order

const BESIDE = {
  l_a: (rope) => rope.l_a_difference !== null && rope.l_a_difference < 0,
  l_c: (rope) => rope.l_c_difference !== null && rope.l_c_difference < 0,
  longer: (rope) => rope.l_a_difference > 0,
  none: (rope) => rope.published === null,
};

/** What may be asked for, by the elements that ask. */
const ASKED = ["words", "family", "crossings", "beside"];

function wanted() {
  const words = $("words").value.toLowerCase().split(/\s+/), [family, crossings, beside] = ASKED.slice(1).map((id) => $(id).value);
  return (rope) => words.every((word) => rope.text.includes(word)) && (!family || rope.family === family)
    && (!crossings || rope.crossings === +crossings) && (!beside || BESIDE[beside](rope));
}

/** Compare by a column; what has no value there comes last, either way. */
function order(key, down) {
  const sign = down ? -1 : 1;
  return (a, b) => {
    const [x, y] = [a[key], b[key]];
    if (x === null || y === null) return (x === null) - (y === null) || a.number - b.number;
    return sign * (typeof x === "number" ? x - y : names.compare(x, y)) || a.number - b.number;
  };
}

/** Show what is asked for, from the top. */
function ask() {
  state.shown = ropes.filter(wanted());
  if (state.sort) state.shown.sort(order(state.sort, state.down));
  $("count").textContent = `${state.shown.length.toLocaleString("en")} of ${ropes.length.toLocaleString("en")} ropes`;
  $("none").hidden = state.shown.length > 0;
  document.querySelector("table").setAttribute("aria-rowcount", state.shown.length + 1);
  scroller.scrollTop = 0;
  remember();
  draw();
}

/** Keep what is asked for in the address, for those who come back. */
function remember() {
  const asked = new URLSearchParams(ASKED.map((id) => [id, $(id).value]).filter(([, value]) => value));
  if (state.sort) asked.set("sort", (state.down ? "-" : "") + state.sort);
  history.replaceState(null, "", `#${asked}`);
}

function recall() {
  const asked = new URLSearchParams(location.hash.slice(1)), sort = asked.get("sort") ?? "";
  for (const id of ASKED) $(id).value = asked.get(id) ?? "";
  for (const id of ASKED.slice(1)) if ($(id).selectedIndex < 0) $(id).value = "";
  sortBy(columns.some(({ key }) => key === sort.replace("-", "")) ? sort.replace("-", "") : "", sort.startsWith("-"));
}

function sortBy(key, down) {
  [state.sort, state.down] = [key, down];
  for (const head of document.querySelectorAll("th[data-key]")) {
    if (head.dataset.key === key) head.setAttribute("aria-sort", down ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  }
  ask();
}

// Rows

const height = () => parseFloat(getComputedStyle(document.body).getPropertyValue("--row"));

/** Have rows for what is in sight, and leave those that stay as they are, with their focus. */
function draw() {
  const tall = height(), count = state.shown.length, top = scroller.scrollTop;
  const first = Math.max(0, Math.min(count, Math.floor(top / tall)) - SPARE);
  const last = Math.min(count, Math.ceil((top + scroller.clientHeight) / tall) + SPARE);
  const body = $("rows"), there = state.shown.slice(first, last).map((rope, k) => line(rope, first + k));
  const stay = new Set(there);
  for (const row of [...body.children]) if (!stay.has(row)) row.remove();
  there.forEach((row, k) => body.children[k] === row || body.insertBefore(row, body.children[k] ?? null));
  $("above").style.height = `${first * tall}px`;
  $("below").style.height = `${(count - last) * tall}px`;
}

function line(rope, place) {
  if (!lines.has(rope)) lines.set(rope, made(rope));
  const row = lines.get(rope);
  row.setAttribute("aria-rowindex", place + 2);
  row.dataset.place = place;
  return row;
}

function made(rope) {
  const row = document.createElement("tr"), picture = row.insertCell(), link = link_to(rope);
  picture.className = "picture";
  picture.appendChild(link).innerHTML = drawn(rope.drawing);
  Object.assign(link, { tabIndex: -1, ariaHidden: "true" });
  for (const column of columns) row.append(cell(rope, column));
  return row;
}

function link_to(rope) {
  const link = document.createElement("a");
  link.href = rope.page;
  return link;
}

function cell(rope, { key, digits, signed }) {
  const found = document.createElement(key === "knot" ? "th" : "td"), value = rope[key];
  found.className = kind({ key, digits });
  if (key === "knot") {
    found.scope = "row";
    found.appendChild(link_to(rope)).textContent = found.title = value;
  } else {
    found.textContent = value === null ? "–" : digits === null ? value : (signed && value > 0 ? "+" : "") + value.toFixed(digits);
    if (signed && value < 0) found.classList.add("less");
  }
  return found;
}

/** Return the class of a column's cells. */
const kind = ({ key, digits }) => (key === "knot" ? "text name" : digits === null ? `text ${key}` : key);

/** Draw a rope: in each layer first all lines on dark edges, then all in the colours of their components. */
function drawn([width, layers]) {
  const paths = layers.flatMap((layer) => [
    `<path class="edge" stroke-width="${width + 2 * edge}" d="${layer.map(([, path]) => path).join("")}"/>`,
    ...layer.map(([component, path]) => `<path stroke="${css(componentColour(component))}" d="${path}"/>`),
  ]);
  return `<svg viewBox="0 0 ${size} ${size}" stroke-width="${width}">${paths.join("")}</svg>`;
}

// Keys

/** The arrow keys go from name to name. */
function step(event) {
  const by = { ArrowDown: 1, ArrowUp: -1 }[event.key], row = event.target.closest("#rows tr");
  if (!by || !row) return;
  event.preventDefault();
  const place = Math.max(0, Math.min(state.shown.length - 1, +row.dataset.place + by)), tall = height();
  const head = document.querySelector("thead").offsetHeight, seen = scroller.clientHeight - head - tall;
  scroller.scrollTop = Math.max(Math.min(scroller.scrollTop, place * tall), place * tall - seen);
  draw();
  lines.get(state.shown[place]).querySelector("th a").focus({ preventScroll: true });
}

function press(event) {
  if (event.key !== "/" || event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select")) return;
  event.preventDefault();
  $("words").focus();
}

// The beginning

/** Head a column; the letter after _ in a label is set lower. */
function headed(column) {
  const { key, header } = column, head = document.createElement("th"), button = head.appendChild(document.createElement("button"));
  const [name, lower = ""] = header.split("_");
  Object.assign(head, { scope: "col", className: kind(column) });
  head.dataset.key = key;
  button.append(name);
  button.appendChild(document.createElement("sub")).textContent = lower.slice(0, 1);
  button.append(lower.slice(1));
  button.onclick = () => sortBy(key, state.sort === key && !state.down);
  return head;
}

function offer(id, values) {
  $(id).append(...[...new Set(values)].filter((value) => value !== null).map((value) => new Option(value)));
}

function listen() {
  for (const id of ASKED) $(id).oninput = ask;
  document.forms[0].onsubmit = (event) => event.preventDefault();
  $("all").onclick = () => (ASKED.forEach((id) => ($(id).value = "")), ask(), $("words").focus());
  $("theme").onclick = () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
  Object.assign($("rows"), { onkeydown: step });
  addEventListener("keydown", press);
  addEventListener("hashchange", recall);
  scroller.onscroll = () => requestAnimationFrame(draw);
  new ResizeObserver(draw).observe(scroller);
}

const theme = (name) => (document.documentElement.dataset.theme = name);
const night = matchMedia("(prefers-color-scheme: dark)");
night.onchange = () => theme(night.matches ? "dark" : "light");
theme(night.matches ? "dark" : "light");
ropes.forEach((rope, number) => Object.assign(rope, { number, text: `${rope.knot} ${rope.type}`.toLowerCase() }));
document.querySelector("thead tr").append(...columns.map(headed));
offer("family", ropes.map((rope) => rope.family));
offer("crossings", ropes.map((rope) => rope.crossings).sort((a, b) => a - b));
listen();
recall();
