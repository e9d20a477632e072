// The rope without WebGL2: strokes on a plain canvas, the far ones first, each on a dark edge.

/** Strokes at most, so that turning stays smooth. */
const DETAIL = 900;

class FlatPainter {
  constructor(canvas) {
    this.pen = canvas.getContext("2d", WITHOUT_CARD);
  }

  draw(scene) {
    const { pen } = this, { width, height } = pen.canvas;
    pen.fillStyle = css(scene.back);
    pen.fillRect(0, 0, width, height);
    for (const { from, to, thickness, colour } of this.strokes(scene).sort((a, b) => a.from[2] - b.from[2])) {
      const [one, other] = [from, to].map((p) => this.flat(scene, p, width, height));
      const wide = Math.max(1.5, (thickness * scene.look.lens[1] * height) / -from[2]);
      this.stroke(one, other, wide, css(scaled(colour, 0.45)), "butt");
      this.stroke(one, other, 0.86 * wide, css(colour), "round");
    }
  }

  flat({ look }, p, width, height) {
    return [0.5 * width * (1 - (look.lens[0] * p[0]) / p[2]), 0.5 * height * (1 + (look.lens[1] * p[1]) / p[2])];
  }

  stroke(one, other, width, colour, cap) {
    Object.assign(this.pen, { lineWidth: width, lineCap: cap, strokeStyle: colour });
    stroke(this.pen, one, other);
  }

  strokes({ curve, colours, look, beads, thin, radius, marks }) {
    const rope = beads ? this.beads(curve, colours, look, radius) : this.axis(curve, colours, look, radius);
    const contacts = thin ? contactRods(curve) : [];
    const sleeves = marks.map(({ vertex, colour }) => sleeve(curve, vertex, colour));
    const rods = (list, size) => list.map(([a, b]) => ({
      from: look.seen(a.centre), to: look.seen(b.centre), thickness: size * Math.hypot(...a.u), colour: a.colour.map((x) => x ** (1 / 2.2)),
    }));
    return [...rope, ...rods(contacts, 1), ...rods(sleeves, 1.1 * radius)];
  }

  beads(curve, colours, look, thickness) {
    return colours.map((colour, i) => {
      const from = look.seen(curve.vertex(i));
      return { from, to: from, thickness, colour };
    });
  }

  axis(curve, colours, look, thickness) {
    const step = Math.max(1, Math.ceil(curve.rings().flat().length / DETAIL));
    return curve.rings().flatMap((axis) => {
      const rings = axis.filter((_, k) => k % step === 0);
      const places = rings.map(({ centre }) => look.seen(centre));
      return rings.map(({ vertex }, k) => ({ from: places[k], to: places[(k + 1) % places.length], thickness, colour: colours[vertex] }));
    });
  }
}
