// A curve as it came: vertices at R = 1 and what is known of each; and what is reckoned from them.

/** The distance between two rings of a tube: an arc of radius 1 rises 0.002 over it. */
const RING = 0.12;

/** Rings of a rope, beyond which no edge is cut into pieces: the longer it is, the smaller it is seen. */
const RINGS = 1500;

const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** Decode shares of `most`, two bytes each. */
const shares = (text, most) => Float32Array.from(new Uint16Array(bytes(text).buffer), (x) => (most * x) / 65535);

/** Decode whole numbers of digits of seven bits, the lowest first; all but the last have the eighth. */
function wholes(text) {
  const found = [];
  let sum = 0, worth = 1;
  for (const byte of bytes(text)) {
    sum += worth * (byte & 127);
    worth *= 128;
    if (byte > 127) continue;
    found.push(sum);
    [sum, worth] = [0, 1];
  }
  return found;
}

/** Decode pairs of numbers below n: i n + j, as differences. */
function pairs(text, n) {
  let sum = 0;
  return Uint32Array.from(wholes(text).flatMap((step) => [Math.floor((sum += step) / n), sum % n]));
}

/** Decode coordinates: steps from a corner, as differences of differences of differences, with those below 0 folded in. */
function places({ vertices, corner, step }) {
  const found = wholes(vertices).map((x) => (x % 2 ? -(x + 1) / 2 : x / 2));
  for (let times = 0; times < 3; times++) for (let k = 3; k < found.length; k++) found[k] += found[k - 3];
  return Float32Array.from(found, (x, k) => corner[k % 3] + step * x);
}

const add = (a, b, t = 1) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
const sub = (a, b) => add(a, b, -1);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, t) => [t * a[0], t * a[1], t * a[2]];
const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));
const mix = (a, b, t) => a.map((x, k) => x + t * (b[k] - x));

/** Any unit vector across t. */
function across(t) {
  const axis = Math.abs(t[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
  return unit(cross(t, axis));
}

/** Return what of `u` is across `t`, as a unit vector. */
const turnedAcross = (u, t) => unit(add(u, t, -dot(u, t)));

class Curve {
  constructor(given) {
    Object.assign(this, given);
    this.vertices = places(given);
    this.n = this.vertices.length / 3;
    this.curvature = shares(given.curvature, 1);
    this.pairs = pairs(given.pairs, this.n);
    this.pressing = shares(given.pressing, given.strongest);
    this.component = this.sizes.flatMap((size, c) => Array(size).fill(c));
    this.first = this.sizes.map((_, c) => this.sizes.slice(0, c).reduce((a, b) => a + b, 0));
    this.measureAlong();
    this.sumForces();
    this.centre = this.mean();
    this.extent = 1 + Math.max(...this.sizes.map((_, c) => this.reach(c)));
  }

  vertex(i) {
    return [...this.vertices.subarray(3 * i, 3 * i + 3)];
  }

  /** Return the vertex k places after i, or before it, on the same component. */
  along(i, k) {
    const first = this.first[this.component[i]], size = this.sizes[this.component[i]];
    return first + ((((i - first + k) % size) + size) % size);
  }

  /** Reckon the arclength of each vertex, through all components, and where each component ends. */
  measureAlong() {
    this.arclength = new Float32Array(this.n);
    this.edge = new Float32Array(this.n);
    this.ends = [];
    let s = 0;
    for (let i = 0; i < this.n; i++) {
      this.arclength[i] = s;
      this.edge[i] = Math.hypot(...sub(this.vertex(this.along(i, 1)), this.vertex(i)));
      s += this.edge[i];
      if (this.component[i + 1] !== this.component[i]) this.ends.push(s);
    }
    this.length = s;
  }

  /** Sum up what presses on each vertex, over the length of rope that the vertex stands for. */
  sumForces() {
    this.force = new Float32Array(this.n);
    this.pressing.forEach((force, k) => {
      for (const i of [this.pairs[2 * k], this.pairs[2 * k + 1]]) {
        this.force[i] += (2 * force) / (this.edge[i] + this.edge[this.along(i, -1)]);
      }
    });
  }

  mean() {
    let sum = [0, 0, 0];
    for (let i = 0; i < this.n; i++) sum = add(sum, this.vertex(i));
    return scaled(sum, 1 / this.n);
  }

  reach(c) {
    let far = 0;
    for (let i = this.first[c]; i < this.first[c] + this.sizes[c]; i++) {
      far = Math.max(far, Math.hypot(...sub(this.vertex(i), this.centre)));
    }
    return far;
  }

  /** Return the vertex at an arclength, by halving. */
  at(s) {
    let low = 0, high = this.n;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.arclength[middle] <= s) low = middle;
      else high = middle;
    }
    return s - this.arclength[low] > this.edge[low] / 2 ? this.along(low, 1) : low;
  }

  /** Return how long a component is. */
  round(c) {
    return this.ends[c] - (c ? this.ends[c - 1] : 0);
  }

  /** Return how many vertices of a component there are to a ring. */
  stride(c) {
    return Math.max(1, Math.floor((RING * this.sizes[c]) / this.round(c)));
  }

  /**
   * Return the rings of the tube, a list a component: centre, a frame across the axis, and the vertex.
   *
   * The axis is smooth: at each vertex a parabola from the middle of one edge to that of the next, which it
   * touches there as the inscribed arc does.
   */
  rings() {
    if (!this.made) this.made = this.sizes.map((_, c) => closedUp(this.axis(c)));
    return this.made;
  }

  axis(c) {
    const edge = this.round(c) / this.sizes[c], stride = this.stride(c);
    const pieces = Math.min(16, Math.ceil(edge / Math.max(RING, this.length / RINGS)));
    const axis = [];
    for (let i = this.first[c]; i < this.first[c] + this.sizes[c]; i += stride) {
      const here = this.vertex(i);
      const before = scaled(add(this.vertex(this.along(i, -1)), here), 0.5);
      const after = scaled(add(this.vertex(this.along(i, 1)), here), 0.5);
      for (let k = 0; k < pieces; k++) {
        const t = k / pieces, one = mix(before, here, t), two = mix(here, after, t);
        const tangent = unit(sub(two, one));
        axis.push({ centre: mix(one, two, t), tangent, vertex: i, place: i + t - 0.5 });
      }
    }
    return axis;
  }
}

/** Give rings frames that turn as little as they can, and the rest evenly, so that the last meets the first. */
function closedUp(axis) {
  let u = across(axis[0].tangent);
  for (const ring of axis) ring.u = u = turnedAcross(u, ring.tangent);
  const { tangent, u: start } = axis[0], end = turnedAcross(u, tangent);
  const missing = Math.atan2(dot(cross(end, start), tangent), dot(end, start));
  axis.forEach((ring, k) => {
    const angle = (missing * k) / axis.length, v = cross(ring.tangent, ring.u);
    ring.u = add(scaled(ring.u, Math.cos(angle)), v, Math.sin(angle));
    ring.v = cross(ring.tangent, ring.u);
  });
  return axis;
}
