"""Signatures from a projection, by the faces round its crossings."""

import math

import numpy as np

from sono.invariants.crossings import Crossings, Ints, entered


def signature(found: Crossings, t: complex) -> int:
    """Return the Levine-Tristram signature for |t| = 1; at -1 it is -2 for the right-handed trefoil.

    A mirror changes its sign. It comes from the faces of the projection: R. Kashaev, arXiv:1801.04632, proved
    by J. Liu, arXiv:2311.01923.
    """
    faces = _faces(found)
    x, y = math.sqrt((1 + t.real) / 2), t.real
    corner = np.array([[y, x, 1, x], [x, 1, x, 1], [1, x, y, x], [x, 1, x, 1]])
    form = np.zeros(2 * [faces.max(initial=-1) + 1])
    np.add.at(form, (faces[:, None], faces[None]), corner[:, :, None] * found.sign)
    values = np.linalg.eigvalsh(form)
    return int(np.sign(values[abs(values) > 1e-9]).sum() - found.sign.sum()) // 2


def _faces(found: Crossings) -> Ints:
    """Return the faces (4, m), numbered from 0, round each crossing, first that between the incoming strands.

    Pieces of a split projection keep their faces apart.
    """
    place = np.concatenate([found.under, found.over])
    order = np.argsort(place)
    rank = np.argsort(order)
    entering = entered(found, place[order])
    under_out, over_out = np.split(rank, 2)
    under_in, over_in = entering[under_out], entering[over_out]
    # An edge has two sides. A corner joins the sides of two; what is joined all the way round is a face.
    left = np.where(found.sign > 0, 0, 1)
    right = 1 - left
    one = 2 * np.stack([under_in, under_in, under_out, under_out]) + np.stack([left, right, right, left])
    two = 2 * np.stack([over_in, over_out, over_out, over_in]) + np.stack([right, right, left, left])
    face = np.arange(2 * len(place))
    while (face[one] != face[two]).any():
        low = np.minimum(face[one], face[two])
        np.minimum.at(face, one, low)
        np.minimum.at(face, two, low)
    return np.unique(face[one], return_inverse=True)[1].reshape(one.shape)
