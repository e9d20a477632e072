"""Pictures of ropes as unions of balls, seen from above: each pixel shows the ball that is highest there.

A bead rope is a union of balls as it is. A smooth tube is the envelope of balls along its axis: at a spacing
of a tenth of their radius it is short of it by a thousandth, and its normals are those of the balls without
their part along the axis. Nothing else is needed for strands to hide each other as they do.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sono.curve import Floats

LIGHT = np.array([-0.42, 0.5, 0.76]) / np.linalg.norm([-0.42, 0.5, 0.76])
"""Where light comes from: x to the right, y upward, z to the eye."""

_RIGHT = np.cross([0, 1, 0], LIGHT) / np.linalg.norm(np.cross([0, 1, 0], LIGHT))

FROM_LIGHT = np.array([_RIGHT, np.cross(LIGHT, _RIGHT), LIGHT])
"""The rotation after which the eye is where light comes from."""

AMBIENT, DIFFUSE, SHINE = 0.42, 0.68, 0.22
"""Shares of light: from everywhere, from `LIGHT`, and of the highlight."""

WRAPPED = 0.25
"""How far light reaches round a rope: to where the cosine of its angle is as far below 0."""

SHADE = 0.6
"""What a shadow takes of the light from `LIGHT`."""

SOFT = 0.07
"""How wide the edges of shadows are, in radii."""

_AROUND = np.sqrt(np.arange(18) / 17)[:, None] * np.array(
    [(np.cos(2.4 * k), np.sin(2.4 * k)) for k in range(18)]
)
"""Where light is looked for round a point, in `SOFT`: a sunflower, in which no two are in line, so that the
edge of a shadow has as many shades, and no bands."""

OUTLINE = 0.4
"""By so many radii a strand rises above what is behind it where its outline is drawn."""

FINER = 2
"""Pixels are first drawn so many times finer, each way, and then averaged."""


@dataclass(frozen=True)
class Balls:
    """Balls of one `radius`: `centres` (k, 3), `colours` (k, 3) from 0 to 1, and the axes (k, 3) of a tube.

    The axes are unit vectors along it, or 0 for balls that are no tube.
    """

    centres: Floats
    radius: float
    colours: Floats
    axes: Floats

    def turned(self, rotation: Floats) -> "Balls":
        """Return them as seen along the rows (3, 3) of a rotation."""
        return Balls(self.centres @ rotation.T, self.radius, self.colours, self.axes @ rotation.T)

    def bounds(self) -> tuple[Floats, Floats]:
        """Return the corners (2,) of their picture."""
        flat = self.centres[:, :2]
        return flat.min(axis=0) - 1.1 * self.radius, flat.max(axis=0) + 1.1 * self.radius


@dataclass(frozen=True)
class Surface:
    """What a grid of points sees: heights (h, w), -inf where there is nothing, and the ball (h, w) on top."""

    corner: Floats
    step: float
    height: Floats
    ball: NDArray[np.int64]

    @classmethod
    def of(cls, balls: Balls, corner: Floats, step: float, shape: tuple[int, int]) -> "Surface":
        """Look at balls at `shape` points, `step` apart from a lower left `corner` on."""
        seen = cls(corner, step, np.full(shape, -np.inf), np.zeros(shape, np.int64))
        for k, centre in enumerate(balls.centres):
            seen._put(k, centre, balls.radius)
        return seen

    def _put(self, k: int, centre: Floats, radius: float) -> None:
        """Put one more ball among the others."""
        low = np.ceil((centre[:2] - radius - self.corner) / self.step).astype(int).clip(0)
        high = np.floor((centre[:2] + radius - self.corner) / self.step).astype(int) + 1
        x, y = (
            self.corner[i] + self.step * np.arange(low[i], min(high[i], self.height.shape[1 - i])) - centre[i]
            for i in (0, 1)
        )
        place = slice(low[1], low[1] + len(y)), slice(low[0], low[0] + len(x))
        with np.errstate(invalid="ignore"):  # beside the ball
            height = np.sqrt((radius**2 - y**2)[:, None] - x**2) + centre[2]
            above = height > self.height[place]
        np.copyto(self.height[place], height, where=above)
        np.copyto(self.ball[place], k, where=above)

    def points(self) -> Floats:
        """Return the points (h, w, 3) that are seen."""
        rows, columns = np.indices(self.height.shape)
        flat = (self.corner[0] + self.step * columns, self.corner[1] + self.step * rows)
        return np.stack([*flat, self.height], axis=-1)

    def edges(self, drop: float) -> NDArray[np.bool_]:
        """Tell the points (h, w) beside which the height falls by more than this."""
        found = np.zeros(self.height.shape, bool)
        for axis in (0, 1):
            for side in (1, -1):
                with np.errstate(invalid="ignore"):  # nothing beside nothing
                    found |= self.height - np.roll(self.height, side, axis) > drop
        return found


def picture(balls: Balls, corner: Floats, step: float, shape: tuple[int, int]) -> Floats:
    """Return the picture (h, w, 4) of balls: red, green, blue and opacity from 0 to 1, the lowest row first.

    Its pixels are `step` apart, from a lower left `corner` on.
    """
    seen = Surface.of(balls, corner, step / FINER, (FINER * shape[0], FINER * shape[1]))
    there = seen.height > -np.inf
    points, owner = seen.points()[there], seen.ball[there]
    normals = _normals(balls, points, owner)
    lit = 1 - SHADE * _shadow(balls, points + SOFT * balls.radius * normals, step)
    direct = lit * ((normals @ LIGHT + WRAPPED) / (1 + WRAPPED)).clip(0)
    half = LIGHT + np.array([0, 0, 1])
    shine = SHINE * lit * (normals @ (half / np.linalg.norm(half))).clip(0) ** 40
    fine = np.zeros((*there.shape, 4))
    fine[there, :3] = balls.colours[owner] * (AMBIENT + DIFFUSE * direct)[:, None] + shine[:, None]
    fine[there, 3] = 1
    fine[there & seen.edges(OUTLINE * balls.radius), :3] *= 0.2
    return _averaged(fine.clip(0, 1))


def _normals(balls: Balls, points: Floats, owner: NDArray[np.int64]) -> Floats:
    """Return the unit normals (m, 3) of what is seen at points."""
    arms, axes = points - balls.centres[owner], balls.axes[owner]
    arms -= (arms * axes).sum(axis=1)[:, None] * axes
    normals: Floats = arms / np.linalg.norm(arms, axis=1)[:, None]
    return normals


def _shadow(balls: Balls, points: Floats, step: float) -> Floats:
    """Return how much of the light is kept from each of the points (m,), by what it meets before."""
    lit = balls.turned(FROM_LIGHT)
    low, high = lit.bounds()
    width, height = (np.ceil((high - low) / step) + 1).astype(int)
    seen = Surface.of(lit, low, step, (height, width))
    where = points @ FROM_LIGHT.T
    column, row = np.rint((where[:, :2] - low) / step).astype(int).T
    reach = SOFT * balls.radius / step
    shadow = np.zeros(len(points))
    for right, up in np.rint(reach * _AROUND).astype(int):
        met = seen.height[(row + up).clip(0, height - 1), (column + right).clip(0, width - 1)]
        shadow += met > where[:, 2] + SOFT * balls.radius
    return shadow / len(_AROUND)


def _averaged(fine: Floats) -> Floats:
    """Average the pixels (h, w, 4) of a finer picture, by their opacity."""
    fine[..., :3] *= fine[..., 3:]
    pixels: Floats = fine.reshape(fine.shape[0] // FINER, FINER, -1, FINER, 4).mean(axis=(1, 3))
    pixels[..., :3] /= np.where(pixels[..., 3:] > 0, pixels[..., 3:], 1)
    return pixels
