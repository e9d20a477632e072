// The rope by WebGL2: rods between two rings each (rope, contacts, marks), and balls that are traced pixel by pixel.

/** Sides of the rope, and of a contact, which is thin. */
const SIDES = 24, FEW_SIDES = 8;

const SEEN = `#version 300 es
precision highp float;
uniform mat3 turn; uniform vec3 centre, shift; uniform vec4 lens; uniform float radius;
vec3 seen(vec3 p) { return turn * (p - centre) + shift; }
vec4 shown(vec3 p) { return vec4(lens.xy * p.xy, lens.z * p.z + lens.w, -p.z); }
`;

const LIT = `
uniform vec3 back; uniform vec2 depth; uniform float alpha; out vec4 pixel;
vec4 lit(vec3 colour, vec3 n, vec3 p, float cover) {
  vec3 eye = normalize(-p), sun = normalize(vec3(-0.5, 0.75, 0.8));
  float facing = max(dot(n, eye), 0.0);
  float light = 0.30 + 0.18 * n.y + 0.62 * max(dot(n, sun), 0.0) + 0.12 * facing;
  float shine = 0.22 * pow(max(dot(n, normalize(sun + eye)), 0.0), 40.0);
  vec3 all = colour * light * mix(0.35, 1.0, smoothstep(0.0, 0.42, facing)) + shine;
  float haze = 0.3 * smoothstep(depth.x, depth.y, -p.z);
  return vec4(pow(mix(all, back, haze), vec3(1.0 / 2.2)), alpha * cover);
}
`;

const ROD = [`${SEEN}
in vec2 at; in vec3 c0, u0, v0, dye0, c1, u1, v1, dye1;
out vec3 dye, normal, place;
void main() {
  vec3 side = cos(at.y) * mix(u0, u1, at.x) + sin(at.y) * mix(v0, v1, at.x);
  dye = mix(dye0, dye1, at.x);
  normal = turn * normalize(side);
  place = seen(mix(c0, c1, at.x) + radius * side);
  gl_Position = shown(place);
}`, `#version 300 es
precision highp float;
in vec3 dye, normal, place;
${LIT}
void main() { pixel = lit(dye, normalize(normal), place, 1.0); }`];

const BALL = [`${SEEN}
in vec2 at; in vec3 c0, dye0;
out vec3 dye, middle, place;
void main() {
  dye = dye0;
  middle = seen(c0);
  float far = length(middle);
  vec3 to = middle / far, x = normalize(cross(to, vec3(0.0, 1.0, 0.1))), y = cross(x, to);
  float half_width = 1.02 * far * radius / sqrt(max(far * far - radius * radius, 1e-6));
  place = middle + half_width * (at.x * x + at.y * y);
  gl_Position = shown(place);
}`, `${SEEN}
in vec3 dye, middle, place;
${LIT}
void main() {
  vec3 sight = normalize(place);
  float ahead = dot(middle, sight), under = radius * radius - dot(middle, middle) + ahead * ahead;
  float cover = clamp(0.5 + under / fwidth(under), 0.0, 1.0); // of the pixel, for smooth edges
  if (cover == 0.0) discard;
  vec3 hit = (ahead - sqrt(max(under, 0.0))) * sight;
  vec4 position = shown(hit);
  gl_FragDepth = 0.5 + 0.5 * position.z / position.w;
  pixel = lit(dye, normalize(hit - middle), hit, cover);
}`];

const linear = (colour) => colour.map((x) => x ** 2.2);

/** Lay rods out for the card: both rings of each, their centres, frames and colours. */
function laidOut(rods) {
  return new Float32Array(rods.flatMap((rod) => rod.flatMap(({ centre, u, v, colour }) => [...centre, ...u, ...v, ...colour])));
}

/** The rope as rods. The colour of a ring is between those of the two vertices that are nearest, or the mean of all that it stands for. */
function ropeRods(curve, colours) {
  const dyes = colours.map(linear);
  return curve.rings().flatMap((axis, c) => {
    const stride = curve.stride(c);
    const rings = axis.map((ring) => {
      const behind = ring.place < ring.vertex, share = behind ? ring.place - ring.vertex + 1 : ring.place - ring.vertex;
      const one = behind ? curve.along(ring.vertex, -1) : ring.vertex;
      const near = Array.from({ length: stride }, (_, k) => dyes[curve.along(ring.vertex, k - (stride >> 1))]);
      const mean = () => scaled(near.reduce((a, b) => add(a, b)), 1 / stride);
      return { ...ring, colour: stride > 1 ? mean() : mix(dyes[one], dyes[curve.along(one, 1)], share) };
    });
    return rings.map((ring, k) => [ring, rings[(k + 1) % rings.length]]);
  });
}

/** A straight rod. */
function rod(from, to, thickness, colour) {
  const t = unit(sub(to, from)), u = across(t), v = cross(t, u);
  const ring = { u: scaled(u, thickness), v: scaled(v, thickness), colour: linear(colour) };
  return [{ ...ring, centre: from }, { ...ring, centre: to }];
}

/** The contacts as rods, the thicker the more they bear. */
function contactRods(curve) {
  return Array.from(curve.pressing, (force, k) => {
    const share = force / curve.strongest;
    const [i, j] = [curve.pairs[2 * k], curve.pairs[2 * k + 1]].map((i) => curve.vertex(i));
    return rod(i, j, 0.012 + 0.05 * Math.sqrt(share), tint(PLASMA, share));
  });
}

/** A sleeve round the rope at a vertex. */
function sleeve(curve, i, colour) {
  const t = unit(sub(curve.vertex(curve.along(i, 1)), curve.vertex(curve.along(i, -1))));
  return rod(add(curve.vertex(i), t, -0.13), add(curve.vertex(i), t, 0.13), 1, colour);
}

class Painter {
  constructor(canvas) {
    const gl = (this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false }));
    if (!gl) throw new Error("there is no WebGL2 here");
    this.round = this.strip(SIDES);
    this.angular = this.strip(FEW_SIDES);
    this.square = { buffer: this.buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1])), corners: 4 };
    this.rods = this.program(...ROD);
    this.balls = this.program(...BALL);
    this.kept = {};
    gl.enable(gl.DEPTH_TEST);
    gl.cullFace(gl.FRONT); // the insides of rods, whose outsides are clockwise
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** The corners of a rod: at which end, and at which angle. */
  strip(sides) {
    const corners = Array.from({ length: 2 * sides + 2 }, (_, k) => [k % 2, (2 * Math.PI * (k >> 1)) / sides]);
    return { buffer: this.buffer(new Float32Array(corners.flat())), corners: corners.length };
  }

  buffer(data) {
    const { gl } = this, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    return buffer;
  }

  program(...sources) {
    const { gl } = this, program = gl.createProgram();
    sources.forEach((source, k) => {
      const shader = gl.createShader(k ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  /** Return rods on the card, made anew if what they are `made of` has changed. */
  onCard(name, madeOf, make) {
    const old = this.kept[name];
    if (old && old.madeOf.every((part, k) => part === madeOf[k])) return old;
    if (old) this.gl.deleteBuffer(old.buffer);
    const data = make();
    return (this.kept[name] = { madeOf, buffer: this.buffer(data), count: data.length / 24 });
  }

  /** Draw a scene: curve, colours, look, beads, thin, radius, marks, and the background's colour. */
  draw(scene) {
    const { gl } = this, { curve, colours } = scene;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(...scene.back, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (scene.beads) {
      const balls = this.onCard("balls", [curve, colours], () => laidOut(colours.map((colour, i) => rod(curve.vertex(i), curve.vertex(i), 1, colour))));
      gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      this.pass(this.balls, this.square, balls, scene, scene.radius);
      gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    }
    if (!scene.beads || scene.thin) {
      const rope = this.onCard("rope", [curve, colours], () => laidOut(ropeRods(curve, colours)));
      gl.enable(gl.CULL_FACE);
      this.pass(this.rods, this.round, rope, scene, scene.beads ? 0.4 * scene.radius : scene.radius);
      gl.disable(gl.CULL_FACE);
    }
    if (scene.thin) {
      const contacts = this.onCard("contacts", [curve], () => laidOut(contactRods(curve)));
      this.pass(this.rods, this.angular, contacts, scene, 1);
    }
    this.mark(scene);
  }

  /** Draw the sleeves, and faintly what of them the rope hides. */
  mark(scene) {
    if (!scene.marks.length) return;
    const { gl } = this;
    const sleeves = this.onCard("marks", [scene.marks], () => laidOut(scene.marks.map(({ vertex, colour }) => sleeve(scene.curve, vertex, colour))));
    const radius = Math.max(1.05 * scene.radius, scene.radius + 0.05);
    this.pass(this.rods, this.round, sleeves, scene, radius);
    gl.enable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    this.pass(this.rods, this.round, sleeves, scene, radius, 0.3);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
  }

  pass(program, shape, rods, scene, radius, alpha = 1) {
    const { gl } = this, { turn, centre, shift, lens, near, far } = scene.look;
    gl.useProgram(program);
    const at = (name) => gl.getUniformLocation(program, name);
    gl.uniformMatrix3fv(at("turn"), true, turn.flat());
    gl.uniform3fv(at("centre"), centre);
    gl.uniform3fv(at("shift"), shift);
    gl.uniform4f(at("lens"), ...lens, (near + far) / (near - far), (2 * near * far) / (near - far));
    gl.uniform1f(at("radius"), radius);
    gl.uniform3fv(at("back"), linear(scene.back));
    gl.uniform2f(at("depth"), -shift[2] - 0.5 * scene.curve.extent, -shift[2] + 1.6 * scene.curve.extent);
    gl.uniform1f(at("alpha"), alpha);
    this.attribute(program, "at", shape.buffer, 2, 0, 0, 0);
    ["c0", "u0", "v0", "dye0", "c1", "u1", "v1", "dye1"].forEach((name, k) => this.attribute(program, name, rods.buffer, 3, 96, 12 * k, 1));
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, shape.corners, rods.count);
  }

  attribute(program, name, buffer, size, stride, offset, divisor) {
    const { gl } = this, index = gl.getAttribLocation(program, name);
    if (index < 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(index);
    gl.vertexAttribPointer(index, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(index, divisor);
  }
}
