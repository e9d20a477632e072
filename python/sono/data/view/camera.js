// Where a curve is seen from: a turn, a shift across the picture, and a zoom.

/** The distance at which 2 units fill the height of the picture. */
const LENS = 3.2;

const times = (a, b) => [0, 1, 2].map((r) => [0, 1, 2].map((c) => a[r][0] * b[0][c] + a[r][1] * b[1][c] + a[r][2] * b[2][c]));
const applied = (a, p) => a.map((row) => dot(row, p));

/** The turn by an angle about the axis across the picture's direction (x, y), or about the line of sight. */
function turnBy(x, y) {
  const angle = Math.hypot(x, y);
  if (!angle) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const [a, b] = [-y / angle, x / angle], c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
  return [[c + a * a * d, a * b * d, b * s], [a * b * d, c + b * b * d, -a * s], [-b * s, a * s, c]];
}

function rollBy(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [[c, -s, 0], [s, c, 0], [0, 0, 1]];
}

class Camera {
  constructor() {
    this.reset();
  }

  reset() {
    this.turn = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    this.shift = [0, 0];
    this.zoom = 1;
  }

  rotate(x, y) {
    this.turned(turnBy(x, y));
  }

  roll(angle) {
    this.turned(rollBy(angle));
  }

  /** Turn, and undo what rounding has done to the right angles. */
  turned(by) {
    const [x, y] = times(by, this.turn), one = unit(x), two = turnedAcross(y, one);
    this.turn = [one, two, cross(one, two)];
  }

  /** Move by shares of the picture's height. */
  pan(x, y) {
    this.shift = [this.shift[0] + (2 * x) / this.zoom, this.shift[1] + (2 * y) / this.zoom];
  }

  magnify(factor) {
    this.zoom = Math.max(0.3, Math.min(25, this.zoom * factor));
  }

  /** Return what a painter must know to show a curve in a picture of this width over height. */
  look(curve, aspect) {
    const size = curve.extent, fit = 1.1 * size * Math.max(1, 1 / aspect);
    const turn = times(this.turn, curve.frame), far = (LENS * fit) / this.zoom + size * 0.3;
    const reach = size * 1.1;
    return {
      turn, centre: curve.centre, shift: [this.shift[0] * fit, this.shift[1] * fit, -far],
      lens: [LENS / aspect, LENS], near: Math.max(far - reach, 0.02 * far), far: far + reach,
      seen: (p) => add(applied(turn, sub(p, curve.centre)), [this.shift[0] * fit, this.shift[1] * fit, -far]),
    };
  }
}

/** Return the vertex of the ring that is hit first by the line of sight through (x, y), from -1 to 1; null if none is. */
function struck(curve, look, x, y, radius) {
  const sight = unit([x / look.lens[0], y / look.lens[1], -1]);
  let nearest = Infinity, found = null;
  for (const ring of curve.rings().flat()) {
    const p = look.seen(ring.centre), ahead = dot(p, sight), off = dot(p, p) - ahead * ahead;
    const hit = ahead - Math.sqrt(Math.max(0, radius * radius - off));
    if (off < radius * radius && hit < nearest && ahead > 0) [nearest, found] = [hit, ring];
  }
  return found && abreast(curve, found, scaled(sight, nearest), look);
}

/** Return which of the vertices that a ring stands for is most nearly abreast of a place in the picture's space. */
function abreast(curve, { vertex, tangent }, place, look) {
  const along = applied(look.turn, tangent), stride = curve.stride(curve.component[vertex]);
  const off = (i) => Math.abs(dot(sub(look.seen(curve.vertex(i)), place), along));
  const near = Array.from({ length: 2 * stride - 1 }, (_, k) => curve.along(vertex, k + 1 - stride));
  return near.reduce((a, b) => (off(b) < off(a) ? b : a));
}
