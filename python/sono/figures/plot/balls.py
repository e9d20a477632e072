"""Pictures of ropes as unions of balls, seen from above: each pixel shows the ball that is highest there.

A bead rope is a union of balls as it is. A smooth tube is the envelope of balls along its axis: at a spacing
of a tenth of their radius it is short of it by a thousandth, and its normals are those of the balls without
their part along the axis. Nothing else is needed for strands to hide each other as they do.
"""

from dataclasses import dataclass
from typing import Any

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
"""Points to a pixel, each way. Where all of them see one ball, one is lit for all."""


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
    height: NDArray[np.float32]
    ball: NDArray[np.int32]

    @classmethod
    def of(cls, balls: Balls, corner: Floats, step: float, shape: tuple[int, int]) -> "Surface":
        """Look at balls at `shape` points, `step` apart from a lower left `corner` on."""
        seen = cls(corner, step, np.full(shape, -np.inf, np.float32), np.zeros(shape, np.int32))
        for k, centre in enumerate(balls.centres):
            seen._put(k, centre, balls.radius)
        return seen

    def _put(self, k: int, centre: Floats, radius: float) -> None:
        """Put one more ball among the others."""
        low = np.ceil((centre[:2] - radius - self.corner) / self.step).astype(int).clip(0)
        high = np.floor((centre[:2] + radius - self.corner) / self.step).astype(int) + 1
        high = np.minimum(high, self.height.shape[::-1])
        near = (self.corner[i] + self.step * np.arange(low[i], high[i]) - centre[i] for i in (0, 1))
        x, y = (apart.astype(np.float32) for apart in near)
        place = slice(low[1], low[1] + len(y)), slice(low[0], low[0] + len(x))
        with np.errstate(invalid="ignore"):  # beside the ball
            height = np.sqrt((radius**2 - y**2)[:, None] - x**2) + float(centre[2])
            above = height > self.height[place]
        np.copyto(self.height[place], height, where=above)
        np.copyto(self.ball[place], k, where=above)

    def points(self, which: NDArray[np.bool_]) -> Floats:
        """Return those points (m, 3) that are seen in some places (h, w)."""
        rows, columns = np.nonzero(which)
        flat = (self.corner[0] + self.step * columns, self.corner[1] + self.step * rows)
        return np.column_stack([*flat, self.height[which]])

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
    there, edges = seen.height > -np.inf, seen.edges(OUTLINE * balls.radius)
    lit = there & _needed(seen.ball, there & ~edges)
    colours = np.zeros((*there.shape, 3), np.float32)
    colours[lit] = _lit(balls, seen.points(lit), seen.ball[lit], step)
    colours[edges] *= 0.2
    return _averaged(colours, lit, there)


def _needed(ball: NDArray[np.int32], plain: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tell which points (h, w) are to be lit: the first of a pixel if all of it is plain and of one ball."""
    one = _of_pixels(plain).all(axis=0) & (np.ptp(_of_pixels(ball), axis=0) == 0)
    needed = np.repeat(np.repeat(~one, FINER, axis=0), FINER, axis=1)
    needed[::FINER, ::FINER] = True
    return needed


def _lit(balls: Balls, points: Floats, owner: NDArray[np.int32], step: float) -> Floats:
    """Return the colours (m, 3) of points of balls."""
    normals = _normals(balls, points, owner)
    lit = 1 - SHADE * _shadow(balls, points + SOFT * balls.radius * normals, step)
    direct = lit * ((normals @ LIGHT + WRAPPED) / (1 + WRAPPED)).clip(0)
    half = LIGHT + np.array([0, 0, 1])
    shine = SHINE * lit * (normals @ (half / np.linalg.norm(half))).clip(0) ** 40
    colours: Floats = balls.colours[owner] * (AMBIENT + DIFFUSE * direct)[:, None] + shine[:, None]
    return colours.clip(0, 1)


def _normals(balls: Balls, points: Floats, owner: NDArray[np.int32]) -> Floats:
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


def _averaged(colours: NDArray[np.float32], lit: NDArray[np.bool_], there: NDArray[np.bool_]) -> Floats:
    """Return pixels (h, w, 4): the mean colour of the points that are lit, and how many there are of all."""
    weights = _of_pixels(lit).sum(axis=0)[..., None]
    pixels = _of_pixels(colours).sum(axis=0) / np.where(weights, weights, 1)
    return np.concatenate([pixels, _of_pixels(there).mean(axis=0)[..., None]], axis=-1)


def _of_pixels(values: NDArray[Any]) -> NDArray[Any]:
    """Return the values (FINER^2, h, w, ...) of the points of each pixel."""
    return np.stack([values[i::FINER, j::FINER] for i in range(FINER) for j in range(FINER)])
