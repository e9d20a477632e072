// The contact map: a dot for each contact, at the arclengths of the two vertices that press on each other.

/** Many small strokes are drawn faster without a graphics card, above all where there is none. */
const WITHOUT_CARD = { willReadFrequently: true };

/** Pixels left of the map and below it, for the numbers. */
const MARGIN = 30;

class ContactMap {
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d", WITHOUT_CARD);
    this.dots = document.createElement("canvas");
    this.drawn = "";
  }

  place(s) {
    return (this.side * s) / this.curve.length;
  }

  /** Draw the contacts if they are others than before, and over them the lines of up to two vertices. */
  draw(curve, marks, inks) {
    const dense = Math.min(devicePixelRatio || 1, 2), size = this.canvas.clientWidth, { pen, canvas } = this;
    const wanted = JSON.stringify([size, dense, inks, marks]);
    if (curve === this.curve && wanted === this.drawn) return;
    const anew = curve !== this.curve || canvas.width !== Math.round(size * dense) || inks.line !== this.theme;
    [this.curve, this.drawn, this.theme, this.side] = [curve, wanted, inks.line, size - MARGIN - 4];
    if (anew) this.drawContacts(Math.round(size * dense), dense, inks);
    pen.resetTransform();
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(this.dots, 0, 0);
    const [one, other = one] = marks;
    if (!one) return;
    this.fit(pen, dense);
    this.drawCross(pen, one, other, inks);
  }

  fit(pen, dense) {
    pen.scale(dense, dense);
    pen.translate(MARGIN, 4);
  }

  drawContacts(pixels, dense, inks) {
    for (const canvas of [this.canvas, this.dots]) canvas.width = canvas.height = pixels;
    const pen = this.dots.getContext("2d", WITHOUT_CARD);
    this.fit(pen, dense);
    this.drawAxes(pen, inks);
    this.drawDots(pen);
  }

  drawAxes(pen, { line, soft }) {
    const { side, curve } = this;
    pen.strokeStyle = line;
    pen.strokeRect(0.5, 0.5, side - 1, side - 1);
    for (const end of curve.ends.slice(0, -1)) {
      const x = Math.round(this.place(end)) + 0.5;
      for (const [a, b] of [[[x, 0], [x, side]], [[0, side - x], [side, side - x]]]) stroke(pen, a, b);
    }
    pen.fillStyle = soft;
    pen.font = "11px system-ui, sans-serif";
    const step = roundStep(curve.length / 4);
    for (let s = 0; s <= curve.length; s += step) {
      const label = String(+s.toFixed(6));
      pen.textAlign = "center";
      pen.fillText(label, Math.min(this.place(s), side + 4 - pen.measureText(label).width / 2), side + 14);
      pen.textAlign = "right";
      pen.fillText(label, -5, side - this.place(s) + 4);
    }
    pen.textAlign = "right";
    pen.fillText("s / R", side, side + 26);
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
    stroke(pen, [x, 0], [x, side]);
    pen.strokeStyle = one === other ? mark : second;
    stroke(pen, [0, side - y], [side, side - y]);
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

function stroke(pen, from, to) {
  pen.beginPath();
  pen.moveTo(...from);
  pen.lineTo(...to);
  pen.stroke();
}

/** Return the round number nearest above x: 1, 2 or 5, and zeros. */
function roundStep(x) {
  const ten = 10 ** Math.floor(Math.log10(x));
  return ten * [1, 2, 5, 10].find((k) => k * ten >= x);
}
