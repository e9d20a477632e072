"""What `import sono` offers: calls that take curves or names, and give records.

A curve is an (n, 3) array of vertices, a sequence of such arrays, one for each component, a `Curve`, or the
name of a knot. It is closed, and its last vertex does not repeat the first. Lengths are in the unit of the
vertices, ropelengths are lengths over the RADIUS of the rope.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeAlias, cast

from sono import _core, curve, formats, naming, shape, starts
from sono.curve import Curve as Curve
from sono.curve import CurveLike, Forces, Measures, as_components
from sono.formats.closing import WAYS, Close
from sono.jobs.workers import Threads
from sono.naming import Identity, Verdict
from sono.searching.minima import Minimum, merged
from sono.searching.search import KEPT, Search
from sono.searching.trials import FINE_EDGE, Source, Watch, finish, unwatched
from sono.shape import Descriptors
from sono.tightening import Method, Progress, Run, Tight
from sono.tightening.once import best_of, changed
from sono.tightening.settings import LEAST_DL, MOST, MOST_DL, TRIALS, Changes, Settings, whole

DEFAULT_N = 480

AnyCurve: TypeAlias = "CurveLike | str"
"""A curve, or the name of a knot."""

Rope: TypeAlias = "AnyCurve | Tight | Minimum"
"""A curve, or what a tightening or a search gave."""


def unseen(progress: Progress) -> None:
    """Watch nothing."""


def read(path: str | os.PathLike[str], close: Close | None = None) -> Curve:
    """Read a curve from a file; "FILE:KEY" is one of a file that holds several, such as "traj.xyz:12".

    Open chains are an error unless `close` says how their ends are joined: "direct" by an edge, "sphere" by
    way of a sphere round the chain. A last vertex that repeats the first is dropped; lengths keep the file's
    unit. Raises `FormatError`, a `ValueError` that names file and line.

    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "square.txt")
    >>> write(path, [[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    >>> read(path)
    Curve(4 vertices)
    """
    return Curve(formats.read(path, _way(close)).components)


def read_all(path: str | os.PathLike[str], close: Close | None = None) -> dict[str, Curve]:
    """Read all curves of a file, such as the frames of a simulation, by their keys.

    The key of an only curve may be empty. As for `read`, whose errors it raises.

    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "square.txt")
    >>> write(path, [[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    >>> read_all(path)
    {'': Curve(4 vertices)}
    """
    return {file.key: Curve(file.components) for file in formats.read_all(path, _way(close))}


def write(path: str | os.PathLike[str], curve: Rope, comments: str | Sequence[str] = ()) -> None:
    """Write a curve to a file whose suffix names the format; .txt, .dat or none are rows of x y z.

    Coordinates keep every digit, and the file appears whole or not at all; the `comments` come first. Raises
    `FormatError` where it cannot be written.

    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "hopf.vect")
    >>> write(path, "Hopf", "a Hopf link")
    >>> path.read_text().splitlines()[:3]
    ['VECT', '# a Hopf link', '2 96 0']
    """
    formats.write(path, Curve(_components(curve)), [comments] if isinstance(comments, str) else comments)


def names() -> list[str]:
    """Return the names that are built in; others are torus types "T(p,q)", codes and more.

    docs/reference/names.md has all kinds.

    >>> names()[:3], "Hopf" in names()
    (['3_1', '4_1', '5_1'], True)
    """
    return starts.names()


def start(name: str, variant: int = 0, *, known: bool = False) -> Curve:
    """Return a loose conformation of the knot of this name, in units of about one rope radius.

    A name may be a code, such as "pd:[(1,5,2,4),(3,1,4,6),(5,3,6,2)]", "dt:4 6 2" or "gauss:1 -2 3 -1 2 -3";
    docs/reference/names.md has all kinds. Each `variant` is another conformation of the same type, drawn from
    a planar diagram if it is negative. If `known`, it is the rope that the atlas has of the knot or link
    instead, tight at R_s = 1 on edges of about 0.2. Raises `ValueError`, with the nearest known name, for
    others.

    >>> start("3_1"), len(start("P(-2,3,7)")), len(start("gauss:1 -2 | 2 -1")), start("3_1", known=True)
    (Curve(69 vertices), 1, 2, Curve(164 vertices))
    """
    if not isinstance(name, str):
        raise ValueError(f"{name!r} is no name of a knot")
    if known:
        if variant:
            raise ValueError(f"variant = {variant}: the atlas has one rope of a knot")
        return Curve(_known(name))
    return Curve(starts.start(name, whole("variant", variant, -(10**12))))


def measure(vertices: Rope, /) -> Measures:
    """Measure a curve at the scale it has; a name stands for the atlas's rope of the knot.

    Raises `CurveError`, a `ValueError`, for one that is no embedded closed curve. Source: J. Baranska,
    P. Pieranski, E. J. Rawdon, "Ropelength of tight polygonal knots", section 2; for unequal edges L_c stays
    an upper bound.

    >>> square = [[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]]
    >>> measure(square).n, round(measure(square).l_p, 6)
    (4, 8.0)
    """
    return curve.measure(rope_of(vertices))


def descriptors(vertices: Rope, /, *, closed: bool = True) -> Descriptors:
    """Describe the shape of a curve: writhe, size, bends and contacts; see `Descriptors`.

    A name stands for the atlas's rope of the knot. Chains are open if they are not `closed`, and described as
    they are. All pairs of edges are summed: 2,000 vertices take a part of a second, 20,000 some seconds, and
    open chains ten times that. Raises `CurveError` for a curve that is not embedded.

    >>> found = descriptors("3_1")
    >>> round(found.writhe, 1), round(found.acn, 1), found.total_curvature > 4 * math.pi
    (3.4, 4.3, True)
    >>> round(descriptors([[0, 0, 0], [1, 0, 0], [2, 0, 0]], closed=False).radius_of_gyration ** 2, 3)
    0.333
    """
    return shape.descriptors(rope_of(vertices), closed)


def forces(vertices: Rope, /) -> Forces:
    """Find the forces that come nearest to balance on a curve, scaled to R_s = 1; see `Forces`.

    A name stands for the atlas's rope of the knot. Raises `CurveError` for a curve that is not embedded.

    >>> forces(tighten("3_1", 60)).residual < 1e-6
    True
    """
    return curve.forces(rope_of(vertices))


def identify(vertices: Rope, /) -> Identity:
    """Name the knot or link that a curve is, of any scale; see `Identity`.

    Raises `CurveError` for a curve that is not embedded, `TooEntangledError`, a `ValueError`, where over 1000
    crossings are left in its diagram, unless it is a torus link that is seen to be a closed braid.

    >>> identify("T(3,4)").name, identify("4_1#m3_1").name, identify("T(30,60)").name
    ('8_19', 'm3_1#4_1', 'T(30,60)')
    """
    return naming.identify(_components(vertices))


def verify(one: Rope, other: Rope, /) -> Verdict:
    """Tell whether two curves, of any scales, are the same knot or link; see `Verdict`.

    Raises `CurveError` for a curve that is not embedded, `TooEntangledError`, a `ValueError`, where over 1000
    crossings are left in a diagram, as for `identify`.

    >>> verify("T(3,4)", start("8_19", 3)).verdict, verify("Hopf", "L2a1{0}").verdict
    ('same', 'mirror images')
    """
    return naming.verify(_components(one), _components(other))


def tighten(
    vertices: Rope,
    /,
    n: int | None = None,
    *,
    dl: float | None = None,
    method: Method = "both",
    trials: int = TRIALS,
    seed: int | None = None,
    known: bool = True,
    time_limit: float | None = None,
    settings: Settings | Changes | None = None,
    watch: Callable[[Progress], object] = unseen,
) -> Tight:
    """Tighten a curve of any scale to a rope of radius 1.

    The rope has `n` vertices, all components together, 480 by default; or its edges are `dl` radii long, at
    most 1, as far as n is a whole number. With the method "both" SONO finds shapes in up to `trials` trials
    and the polish makes the best one exact; "sono" and "polish" do without the other. `settings` are the
    parameters of both engines, or some of them by name; the seed is one. A knot by its name begins with the
    rope that the atlas has of it, without any trials; if `known` is False, with the loose one of `start`.

    `watch` is called about ten times a second. If it returns True, and after `time_limit` seconds, the best
    state so far is returned, with `converged` False; what it raises ends the run and passes through.

    Raises `CurveError` for a curve that cannot be tightened (with so few vertices), `ValueError` for a wrong
    n, dl, method or setting. A rope of another knot type than the curve is never returned: `KnotTypeError`.

    >>> round(tighten("3_1", 60).measures.l_a, 3), round(tighten("3_1", dl=0.2).measures.dl, 2)
    (32.719, 0.2)
    """
    if time_limit is not None and not time_limit >= 0:
        raise ValueError(f"time_limit = {time_limit} is no number of seconds")
    if n is not None and dl is not None:
        raise ValueError("give the number n of vertices or the length dl of edges, not both")
    target = float(dl) if dl is not None else whole("n", DEFAULT_N if n is None else n)
    curve, changes = _components(vertices), changed(settings, seed)
    shape = starts.known(vertices) if known and isinstance(vertices, str) else None
    run = Run(curve, [target], changes, method, whole("trials", trials), shape)
    return best_of(run, math.inf if time_limit is None else time_limit, watch)


def refine(vertices: Rope, /, n: int) -> Curve:
    """Return n vertices on the inscribed knot K_P of a rope, with equal edges on each component.

    Raises `CurveError` where there are too few for the curve, `ValueError` for n below 3 a component or above
    500,000.

    >>> refine(tighten("3_1", 60), 240)
    Curve(240 vertices)
    """
    return Curve(_core.refine(_components(vertices), whole("n", n, 3, MOST)))


def search(
    knot: AnyCurve,
    /,
    trials: int = 64,
    *,
    jobs: int = 1,
    seed: int = 0,
    minima: int = 5,
    dl: float = FINE_EDGE,
    watch: Watch = unwatched,
) -> list[Minimum]:
    """Search for the shortest tight ropes of a knot; return the `minima` shortest, the best one first.

    So many `trials` begin with other conformations and end in local minima, whose edges are `dl` radii long.
    They are made by so many `jobs`, threads, on which nothing depends. `watch` is called about ten times a
    second by each of them; what it raises ends the search and passes through.

    >>> best, *others = search("3_1", trials=2)
    >>> best.converged, round(best.length, 3)
    (True, 32.743)
    """
    trials, minima = whole("trials", trials, 1), whole("minima", minima, 1)
    jobs, seed = whole("jobs", jobs, 1, 256), whole("seed", seed, 0, 10**6)
    if not (isinstance(dl, int | float) and LEAST_DL <= dl <= MOST_DL):
        raise ValueError(f"dl = {dl} is no edge length from {LEAST_DL:g} to {MOST_DL:g} radii")
    source = Source.of(_components(knot), knot if isinstance(knot, str) else None, watch)
    found = Search(seed, max(KEPT, minima))
    with Threads(jobs) as workers:

        def submit(function: Callable[..., Any], *args: Any, rank: int | None = None) -> Callable[[], Any]:
            return workers.submit(function, *args, watch=watch, rank=-1 if rank is None else rank)

        for _ in found.run(source, trials, submit, jobs):
            pass
        best = found.minima[:minima]
        if dl != FINE_EDGE:
            waiting = [submit(finish, minimum, round(minimum.length / dl)) for minimum in best]
            finer = [found.confirmed(minimum(), source) for minimum in waiting]
            best = merged(filter(None, finer))
    return [replace(minimum, curve=Curve(minimum.curve)) for minimum in best]


def rope_of(rope: Rope) -> list[Any]:
    """Return the components of a rope; a name is the atlas's rope of the knot. Raises `ValueError`."""
    return as_components(start(rope, known=True) if isinstance(rope, str) else cast("CurveLike", rope))


def _known(name: str) -> list[Any]:
    """Return the atlas's rope of a knot. Raises `ValueError` if there is none."""
    if (shape := starts.known(name)) is None:
        starts.start(name)  # says what is wrong with it, if it is no name at all
        raise ValueError(f"the atlas has no rope of {name!r}")
    return list(shape)


def _way(close: Close | None) -> Close | None:
    """Refuse another way to close chains."""
    if close not in (None, *WAYS):
        raise ValueError(f"close = {close!r}: give {' or '.join(map(repr, WAYS))}")
    return close


def _components(vertices: Rope) -> list[Any]:
    """Return the components of whatever stands for a curve."""
    if not isinstance(vertices, str):
        return as_components(cast("CurveLike", vertices))
    if not starts.knows(vertices) and (os.path.exists(vertices) or os.path.splitext(vertices)[1]):
        raise ValueError(f"{vertices!r} is no name of a knot; sono.read reads a file")
    return list(starts.drawn(vertices))
