// The rope without WebGL2: strokes on a plain canvas, the far ones first, each on a dark edge.

/** Length of a stroke along the rope, in radii: short enough that each is in front of others, or behind, as a whole. */
const STROKE = 0.8;

class FlatPainter {
  constructor(canvas) {
    this.pen = canvas.getContext("2d", WITHOUT_CARD);
  }

  draw(scene) {
    const { pen } = this, { width, height } = pen.canvas, { lens } = scene.look;
    pen.fillStyle = css(scene.back);
    pen.fillRect(0, 0, width, height);
    pen.lineJoin = "round";
    const depth = ({ points }) => points.reduce((sum, p) => sum + p[2] / points.length, 0);
    const flat = ([x, y, z]) => [0.5 * width * (1 - (lens[0] * x) / z), 0.5 * height * (1 + (lens[1] * y) / z)];
    for (const line of this.lines(scene).sort((a, b) => depth(a) - depth(b))) {
      const wide = Math.max(1.5, (line.thickness * lens[1] * height) / -depth(line));
      this.drawLine(line.points.map(flat), wide, line.colour, line.points.length > 2 ? "butt" : "round");
    }
  }

  /** Draw a line on its dark edge, which has no ends where the rope goes on. */
  drawLine(points, wide, colour, ends) {
    const { pen } = this, path = new Path2D();
    points.forEach((p, k) => (k ? path.lineTo(...p) : path.moveTo(...p)));
    Object.assign(pen, { lineWidth: wide, lineCap: ends, strokeStyle: css(scaled(colour, 0.45)) });
    pen.stroke(path);
    Object.assign(pen, { lineWidth: 0.88 * wide, lineCap: "round", strokeStyle: css(colour) });
    pen.stroke(path);
  }

  /** Return all there is to draw, as lines in the picture's space. */
  lines({ curve, colours, look, beads, thin, radius, marks }) {
    const straight = (rods, size) => rods.map(([a, b]) => ({
      points: [a.centre, b.centre], thickness: size * Math.hypot(...a.u), colour: a.colour.map((x) => x ** (1 / 2.2)),
    }));
    return [
      ...(beads ? this.balls(curve, colours, radius) : this.axis(curve, colours, radius)),
      ...straight(thin ? contactRods(curve) : [], 1),
      ...straight(marks.map(({ vertex, colour }) => sleeve(curve, vertex, colour)), 1.1 * radius),
    ].map((line) => ({ ...line, points: line.points.map(look.seen) }));
  }

  balls(curve, colours, thickness) {
    return colours.map((colour, i) => ({ points: [curve.vertex(i), curve.vertex(i)], thickness, colour }));
  }

  axis(curve, colours, thickness) {
    return curve.rings().flatMap((rings, c) => {
      const pieces = Math.ceil(curve.round(c) / STROKE);
      return Array.from({ length: pieces }, (_, k) => {
        const [from, to] = [k, k + 1].map((piece) => Math.round((piece * rings.length) / pieces));
        const points = Array.from({ length: to - from + 2 }, (_, j) => rings[(from + j) % rings.length].centre);
        return { points, thickness, colour: colours[rings[from].vertex] };
      });
    });
  }
}
