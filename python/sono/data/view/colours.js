// Colours that the colour-blind can tell apart, as shares of 1: of Okabe and Ito, and of matplotlib (CC0).

const hex = (text) => [0, 2, 4].map((k) => parseInt(text.slice(k, k + 2), 16) / 255);
const css = (colour) => `rgb(${colour.map((x) => Math.round(255 * x)).join(" ")})`;

const COMPONENTS = ["0072b2", "d55e00", "009e73", "e69f00", "cc79a7", "56b4e9", "7f7f7f"].map(hex);

const stops = (text) => text.match(/.{6}/g).map(hex);
const VIRIDIS = stops("440154472d7b3b528b2c728e21918c28ae805ec962addc30fde725");
/** Without its darkest eighth, which a dark page would swallow. */
const PLASMA = stops("4903a07501a89e199dbf3984d9586aed7a52fb9f3afdca26f0f921");
const TWILIGHT = stops("e2d9e2b3c6ce7ba1c26276ba5e43a54e186f2f14365816478e2c50b25652c68a6dd4bcace2d9e2");

/** Return the colour of a scale at t, from 0 to 1. */
function tint(scale, t) {
  const x = Math.max(0, Math.min(1, t)) * (scale.length - 1), k = Math.min(Math.floor(x), scale.length - 2);
  return mix(scale[k], scale[k + 1], x - k);
}

const gradient = (scale) => `linear-gradient(to right, ${scale.map(css).join(", ")})`;
const componentColour = (c) => COMPONENTS[c % COMPONENTS.length];

/** Return what one in twenty of the values above 0 exceeds, so that a few peaks do not darken all others. */
function usualMost(values) {
  const above = values.filter((x) => x > 0).sort();
  return above[Math.floor(0.95 * above.length)] ?? 0;
}

/** What the colours of a rope may tell: a scale, the value of a vertex, and the values at its ends. */
const DYES = {
  component: { label: "Component" },
  curvature: { label: "Curvature", of: "curvature × R", scale: VIRIDIS, value: (c, i) => c.curvature[i], most: () => 1 },
  force: {
    label: "Contact force", of: "contact force / tension, per R", scale: PLASMA, value: (c, i) => c.force[i],
    most: (c) => usualMost(c.force), above: "≥ ",
  },
  arclength: {
    label: "Arclength", of: "arclength / R, each component", scale: TWILIGHT,
    value: (c, i) => c.arclength[i] - c.arclength[c.first[c.component[i]]],
    most: (c, k) => c.round(k),
  },
};

/** Return the colour of each vertex. */
function dyed(curve, dye) {
  const { scale, value, most } = DYES[dye];
  return curve.component.map((c, i) => (scale ? tint(scale, value(curve, i) / (most(curve, c) || 1)) : componentColour(c)));
}
