// The contact map: a dot for each contact, at the arclengths of the two vertices that press on each other.

const MARGIN = 30;
/** Pixels left of the map and below it, for the numbers. */

class ContactMap {
  constructor(canvas) {
    this.canvas = canvas;
  }

  /** Fit the canvas to the page; return its pen and the side of the map. */
  prepared() {
    const dense = Math.min(devicePixelRatio || 1, 2), size = this.canvas.clientWidth;
    this.canvas.width = this.canvas.height = Math.round(size * dense);
    const pen = this.canvas.getContext("2d");
    pen.scale(dense, dense);
    return [pen, size - MARGIN - 4];
  }

  place(s) {
    return (this.side * s) / this.curve.length;
  }

  draw(curve, marks, inks) {
    this.curve = curve;
    const [pen, side] = this.prepared();
    this.side = side;
    pen.translate(MARGIN, 4);
    this.drawAxes(pen, inks);
    this.drawDots(pen);
    const [one, other = one] = marks;
    if (one) this.drawCross(pen, one, other, inks);
  }

  drawAxes(pen, { line, soft }) {
    const { side, curve } = this;
    pen.strokeStyle = line;
    pen.strokeRect(0.5, 0.5, side - 1, side - 1);
    for (const end of curve.ends.slice(0, -1)) {
      const x = Math.round(this.place(end)) + 0.5;
      for (const [a, b] of [[[x, 0], [x, side]], [[0, side - x], [side, side - x]]]) this.line(pen, a, b);
    }
    pen.fillStyle = soft;
    pen.font = "11px system-ui, sans-serif";
    const step = roundStep(curve.length / 4);
    for (let s = 0; s <= curve.length; s += step) {
      pen.textAlign = "center";
      pen.fillText(+s.toFixed(6), this.place(s), side + 14);
      pen.textAlign = "right";
      pen.fillText(+s.toFixed(6), -5, side - this.place(s) + 4);
    }
    pen.textAlign = "right";
    pen.fillText("s / R", side, side + 26);
  }

  line(pen, from, to) {
    pen.beginPath();
    pen.moveTo(...from);
    pen.lineTo(...to);
    pen.stroke();
  }

  /** Draw the weakest contacts first. */
  drawDots(pen) {
    const { curve, side } = this, { pairs, pressing, arclength } = curve;
    const size = Math.max(1.2, Math.min(3, 300 / Math.sqrt(pressing.length + 1) / 5));
    for (const k of [...pressing.keys()].sort((a, b) => pressing[a] - pressing[b])) {
      const share = pressing[k] / curve.strongest, radius = size * (0.55 + 0.75 * Math.sqrt(share));
      const [x, y] = [pairs[2 * k], pairs[2 * k + 1]].map((i) => this.place(arclength[i]));
      pen.fillStyle = css(tint(PLASMA, share));
      for (const [a, b] of [[x, y], [y, x]]) {
        pen.beginPath();
        pen.arc(a, side - b, radius, 0, 7);
        pen.fill();
      }
    }
  }

  drawCross(pen, one, other, { mark, other: second }) {
    const { side, curve } = this;
    const [x, y] = [one, other].map(({ vertex }) => this.place(curve.arclength[vertex]));
    pen.strokeStyle = mark;
    this.line(pen, [x, 0], [x, side]);
    pen.strokeStyle = one === other ? mark : second;
    this.line(pen, [0, side - y], [side, side - y]);
  }

  /** Return the contact nearest to a point of the map, or else the two vertices that the point stands for. */
  under(x, y) {
    const { curve, side } = this;
    const [a, b] = [x - MARGIN, side + 4 - y].map((p) => (Math.max(0, Math.min(side, p)) * curve.length) / side);
    const reach = (7 * curve.length) / side;
    let [nearest, found] = [reach, [curve.at(a), curve.at(b)]];
    for (let k = 0; k < curve.pressing.length; k++) {
      const pair = [curve.pairs[2 * k], curve.pairs[2 * k + 1]];
      for (const [i, j] of [pair, [pair[1], pair[0]]]) {
        const off = Math.hypot(curve.arclength[i] - a, curve.arclength[j] - b);
        if (off < nearest) [nearest, found] = [off, [i, j]];
      }
    }
    return found;
  }
}

/** Return the round number nearest above x: 1, 2 or 5, and zeros. */
function roundStep(x) {
  const ten = 10 ** Math.floor(Math.log10(x));
  return ten * [1, 2, 5, 10].find((k) => k * ten >= x);
}
