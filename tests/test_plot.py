"""`sono.plot`: that pictures show what they say."""

import sys
from typing import Any

import numpy as np
import pytest

import sono
from sono.figures.plot import along, atlas, sheet
from sono.figures.plot.balls import FROM_LIGHT, LIGHT, Balls, picture
from sono.figures.plot.convergence import Fit
from sono.figures.plot.curvature import torsion
from sono.figures.turning import facing
from sono.shape import curvature

pytest.importorskip("matplotlib")

RED, BLUE, NONE = np.array([0.9, 0.1, 0.1]), np.array([0.1, 0.1, 0.9]), np.zeros(3)

CIRCLE = np.arange(0, 2 * np.pi, 2 * np.pi / 200)


@pytest.fixture(autouse=True)
def few_dots(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw ropes of few dots, which takes less time."""
    monkeypatch.setattr("sono.figures.plot.knot.PIXELS", 200)


@pytest.fixture
def axes() -> Any:
    """Axes that no window shows, in the style of a paper."""
    with sono.plot.style("light"):
        yield sheet.sheet(1, 1, (3.4, 3.0))[1][0]


@pytest.fixture
def pair() -> Any:
    with sono.plot.style("light"):
        yield sheet.sheet(2, 1, (3.4, 2.0))[1]


def helix(radius: float, rise: float) -> Any:
    """One long turn after the other, closed by an edge that is of no interest."""
    t = np.linspace(0, 6 * np.pi, 1200)
    return np.column_stack([radius * np.cos(t), radius * np.sin(t), rise * t])


def two_balls(upper: float) -> Any:
    """See a red ball at this height, and a blue one at height 0, half of which it covers or is covered by."""
    centres = np.array([[0.0, 0, upper], [1, 0, 0]])
    balls = Balls(centres, 1.0, np.array([RED, BLUE]), np.zeros((2, 3)))
    return picture(balls, np.array([-1.5, -1.5]), 0.05, (60, 80))


def at(image: Any, x: float, y: float) -> Any:
    return image[round((y + 1.5) / 0.05), round((x + 1.5) / 0.05)]


@pytest.mark.parametrize("upper", [-3.0, -0.5, 0.5, 3.0])
def test_what_is_higher_hides_what_is_lower(upper: float) -> None:
    image = two_balls(upper)
    assert image.shape == (60, 80, 4)
    middle = at(image, 0.5, 0.2)
    assert (middle[0] > middle[2]) == (upper > 0)
    assert at(image, -0.5, 0)[0] > at(image, -0.5, 0)[2]
    assert at(image, 1.5, 0)[2] > at(image, 1.5, 0)[0]
    assert at(image, -1.4, 1.4)[3] == 0
    assert middle[3] == 1


def test_balls_at_one_height_meet_half_way() -> None:
    image = two_balls(0.0)
    for y in (-0.5, 0.0, 0.5):
        assert at(image, 0.3, y)[0] > at(image, 0.3, y)[2]
        assert at(image, 0.7, y)[2] > at(image, 0.7, y)[0]


def test_light_comes_from_where_it_says() -> None:
    ball = Balls(np.zeros((1, 3)), 1.0, np.array([[0.5, 0.5, 0.5]]), np.zeros((1, 3)))
    grey = picture(ball, np.array([-1.5, -1.5]), 0.05, (60, 60))[..., 0]
    row, column = np.unravel_index(grey.argmax(), grey.shape)
    assert column < 30 < row  # the upper left, rows going upward
    assert np.allclose(FROM_LIGHT @ FROM_LIGHT.T, np.eye(3))
    assert np.linalg.det(FROM_LIGHT) == pytest.approx(1)
    assert np.allclose(FROM_LIGHT @ LIGHT, [0, 0, 1])


def test_a_ball_throws_a_shadow_on_a_wall_of_balls() -> None:
    x, y = np.meshgrid(np.arange(-4, 4.1, 0.25), np.arange(-4, 4.1, 0.25))
    wall = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    away = -LIGHT / LIGHT[2] * 4  # where on the wall what is 4 above it is dark
    centres = np.vstack([wall, [0, 0, 4]])
    balls = Balls(centres, 1.0, np.full((len(centres), 3), 0.5), np.zeros_like(centres))
    grey = picture(balls, np.array([-4.0, -4.0]), 0.1, (80, 80))[..., 0]
    column, row = np.rint((away[:2] + 4) / 0.1).astype(int)
    lit = np.median(grey)
    assert grey[row - 2 : row + 3, column - 2 : column + 3].mean() < 0.75 * lit


def test_the_view_is_a_rotation_that_lays_a_curve_flat() -> None:
    rng = np.random.default_rng(5)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    curve = list(sono.start("8_20", known=True))
    one, other = facing(curve), facing([component @ turn.T + 7 for component in curve])
    for before, after, again in zip(curve, one, other, strict=True):
        assert np.linalg.norm(np.diff(before, axis=0), axis=1) == pytest.approx(
            np.linalg.norm(np.diff(after, axis=0), axis=1)
        )
        assert np.allclose(after, again, atol=1e-6)
    assert sono.verify(curve, one).verdict == "same"
    assert sono.identify(one).name == sono.identify(curve).name  # not its mirror image
    spans = np.ptp(np.vstack(one), axis=0)
    assert spans[2] == spans.min()


@pytest.mark.parametrize("name", ["3_1", "m3_1"])
def test_the_picture_of_a_crossing_has_the_upper_strand_in_front(name: str) -> None:
    """Colour each vertex by whether it is high up; where strands cross, high ones are seen."""
    (rope,) = facing(sono.start(name, known=True))
    high = rope[:, 2] > 0
    colours = np.where(high[:, None], RED, BLUE)
    low, top = rope[:, :2].min(axis=0) - 1, rope[:, :2].max(axis=0) + 1
    shape = tuple(np.ceil((top - low) / 0.1).astype(int)[::-1])
    image = picture(Balls(rope, 1.0, colours, np.zeros_like(rope)), low, 0.1, shape)
    over = [
        place
        for place, here in zip(rope, high, strict=True)
        if here and (np.linalg.norm(rope[~high, :2] - place[:2], axis=1) < 0.5).any()
    ]
    assert len(over) > 5
    for x, y, _ in over:
        column, row = np.floor((np.array([x, y]) - low) / 0.1).astype(int)
        assert image[row, column, 0] > image[row, column, 2]


def test_a_link_shows_its_components_in_their_colours(axes: Any) -> None:
    sono.plot.knot("Hopf", axes=axes)
    image = np.asarray(axes.images[0].get_array())
    there = image[image[..., 3] == 1][:, :3]
    assert 0.2 < len(there) / image[..., 0].size < 0.95
    for colour in sheet.COLOURS["light"][:2]:
        hue = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)])
        share = (np.argmax(there, axis=1) == hue.argmax()).mean()
        assert 0.2 < share < 0.8


def test_ropes_side_by_side_have_one_scale(axes: Any) -> None:
    sono.plot.knot(
        "3_1", 7 * np.array(sono.start("3_1", known=True)[0]), "8_18", axes=axes, labels=["a", "$", "b"]
    )
    spans = [np.ptp(np.reshape(image.get_extent(), (2, 2)), axis=1) for image in axes.images]
    assert spans[0] == pytest.approx(spans[1], rel=0.01)
    assert spans[2].max() > 1.1 * spans[0].max()
    low, high = axes.get_xlim()
    assert all(low - 0.2 <= edge <= high + 0.2 for image in axes.images for edge in image.get_extent()[:2])
    rights = [image.get_extent()[1] for image in axes.images[:2]]
    assert rights[0] <= axes.images[1].get_extent()[0]


def test_beads_and_tube_differ(axes: Any) -> None:
    rope = sono.tighten("3_1", 30)
    sono.plot.knot(rope, axes=axes)
    rope.plot(axes=axes, beads=True)
    smooth, beads = (np.asarray(image.get_array())[..., 3].mean() for image in axes.images)
    assert beads != smooth


def test_a_thin_curve_is_seen(axes: Any) -> None:
    sono.plot.knot(
        np.column_stack([1000 * np.cos(CIRCLE), 1000 * np.sin(CIRCLE), 5 * np.sin(7 * CIRCLE)]), axes=axes
    )
    assert np.asarray(axes.images[0].get_array())[..., 3].mean() > 0.005


def test_a_fit_finds_the_polynomial_that_is_there() -> None:
    dl = np.array([0.01, 0.02, 0.05, 0.1, 0.3])
    fit = Fit.of(dl, 32.7 - 0.01 * dl + 3.2 * dl**2)
    assert fit.coefficients == pytest.approx([32.7, -0.01, 3.2], rel=1e-9)
    assert fit.error == pytest.approx(0, abs=1e-9)


def test_the_standard_error_of_a_fit_is_how_far_it_is_off() -> None:
    rng = np.random.default_rng(2)
    dl = np.linspace(0.05, 0.5, 12)
    fits = [Fit.of(dl, 10 + dl - 2 * dl**2 + 0.01 * rng.normal(size=12)) for _ in range(400)]
    spread = np.std([fit.limit for fit in fits])
    assert np.mean([fit.error for fit in fits]) == pytest.approx(spread, rel=0.1)


def test_three_points_have_no_error_and_two_no_fit() -> None:
    dl = np.array([0.1, 0.2, 0.3])
    assert Fit.of(dl, 1 + dl).error is None
    assert Fit.of(dl, 1 + dl).shown() == "1.00000"
    with pytest.raises(ValueError, match="takes 3 lengths of edges, and these are 2"):
        Fit.of(np.array([0.1, 0.2, 0.2, 0.1]), np.ones(4))


def test_convergence_has_the_limits_in_its_legend(axes: Any) -> None:
    rows = [
        {"n": n, "l_p": 30 - dl**2, "l_c": 30 + 4 * dl**2, "l_a": 30.0}
        for n in (100, 200, 400, 800)
        if (dl := 30 / n)
    ]
    sono.plot.convergence(rows, axes=axes)
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert [text.split()[0] for text in texts] == ["$L_p$", "$L_a$", "$L_c$"]
    assert all(abs(float(text.split()[2]) - 30) < 1e-3 for text in texts)
    assert axes.lines[0].get_xdata()[0] == pytest.approx(rows[0]["l_p"] / 100)


def test_convergence_takes_ropes_of_any_scale_and_measures(axes: Any) -> None:
    ropes = [sono.tighten("3_1", n) for n in (60, 120, 240, 480)]
    points: list[Any] = [ropes[0], 5 * ropes[1].curve[0], ropes[2].measures, ropes[3]]
    sono.plot.convergence(points, axes=axes)
    dl = axes.lines[0].get_xdata()
    assert dl == pytest.approx([rope.measures.dl for rope in ropes])
    limit = float(axes.get_legend().get_texts()[1].get_text().split()[2])
    assert limit == pytest.approx(32.743, abs=0.01)


def test_coarse_ropes_have_points_without_a_bound(axes: Any) -> None:
    rows = [{"n": n, "l_p": 30.0, "l_c": None if n < 30 else 31.0, "l_a": None} for n in (15, 20, 30)]
    sono.plot.convergence(rows, axes=axes)
    assert len(axes.get_legend().get_texts()) == 2


def test_contacts_are_symmetric_and_of_the_forces(axes: Any) -> None:
    rope = sono.tighten("Hopf", 60)
    assert rope.forces is not None
    sono.plot.contacts(rope, axes=axes)
    places = {tuple(place) for place in np.asarray(axes.collections[0].get_offsets()).round(6)}
    assert places == {(y, x) for x, y in places}
    shown = axes.collections[0].get_array()
    assert shown.max() == pytest.approx(rope.forces.pressing.max())
    half = rope.measures.l_p / 2
    assert all((x < half - 0.01) != (y < half - 0.01) for x, y in places)  # one ring against the other
    assert axes.get_xlim() == pytest.approx((0, rope.measures.l_p))


def test_a_rope_without_contacts(axes: Any) -> None:
    sono.plot.contacts(np.column_stack([np.cos(CIRCLE), np.sin(CIRCLE), 0 * CIRCLE]), axes=axes)
    assert axes.collections[0].get_offsets().shape[0] % 2 == 0


@pytest.mark.parametrize("radius", [0.5, 1.0, 3.0])
@pytest.mark.parametrize("rise", [0.3, -1.0])
def test_curvature_and_torsion_of_a_helix(radius: float, rise: float) -> None:
    curve = helix(radius, rise)
    inner = slice(200, 800)
    square = radius**2 + rise**2
    assert curvature(curve)[inner] == pytest.approx(radius / square, rel=1e-3)
    assert torsion(curve)[inner] == pytest.approx(rise / square, rel=0.06)


def test_a_flat_circle_has_no_torsion_and_a_line_none_to_speak_of() -> None:
    circle = np.column_stack([2 * np.cos(CIRCLE), 2 * np.sin(CIRCLE), 0 * CIRCLE])
    assert curvature(circle) == pytest.approx(0.5, rel=1e-3)
    assert torsion(circle) == pytest.approx(0, abs=1e-9)
    line = np.column_stack([np.linspace(0, 50, 500), np.zeros(500), np.zeros(500)])
    assert np.isnan(torsion(line)[100:300]).all()


def test_curvature_is_at_most_that_of_the_rope(axes: Any) -> None:
    sono.plot.curvature(sono.tighten("3_1", 240), axes=axes)
    line = next(line for line in axes.lines if line.get_label() == "curvature")
    assert 0.8 < max(line.get_ydata()) < 1.01
    assert axes.get_ylim()[1] > 1


def test_arclength_goes_on_from_one_component_to_the_next(axes: Any) -> None:
    square = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])
    components = [square, 3 * square + 9]
    one, other = along.arclength(components)
    assert one.tolist() == [0, 2, 4, 6]
    assert other.tolist() == [8, 14, 20, 26]
    along.mark(components, axes, "xy")
    assert axes.get_xlim() == axes.get_ylim() == (0, 32)
    assert len(axes.lines) == 2


def test_the_model_is_as_the_paper_has_it(pair: Any) -> None:
    deviations, weight = sono.plot.model(axes=pair)
    ends = {line.get_label(): line.get_ydata()[-1] for line in deviations.lines}
    assert ends["$dL_p$"] < 0 < ends["$dL_a$"] < ends["$dL_c$"]
    assert weight.lines[0].get_ydata()[-1] == pytest.approx(sono.model.weight(1.0))
    assert weight.lines[1].get_ydata()[-1] == pytest.approx(4 + 353 / 480)


def test_minima_are_stems_beside_what_is_published(axes: Any) -> None:
    rows: list[Any] = [{"knot": "6_1", "l_a": 56.70, "hits": 13}, {"knot": "6_1", "l_a": 56.73, "hits": 4}]
    sono.plot.minima(rows, "6_1", axes=axes)
    published, stems = axes.lines
    assert published.get_xdata()[0] == pytest.approx(56.7058)
    assert list(zip(*stems.get_data(), strict=True)) == [(56.70, 13), (56.73, 4)]
    assert [text.get_text() for text in axes.texts] == ["13", "4"]


def test_the_atlas_is_drawn_whole(pair: Any) -> None:
    lengths, differences = sono.plot.atlas(axes=pair)
    drawn = {line.get_label(): len(line.get_xdata()) for line in lengths.lines}
    assert {*drawn} == {*atlas.MARKERS}
    assert sum(drawn.values()) == len(atlas.rows())
    knots = next(line for line in lengths.lines if line.get_label() == "knots")
    places = dict(zip(np.round(knots.get_xdata(), 2), knots.get_ydata(), strict=True))
    assert places[3.0] == pytest.approx(32.743, abs=0.001)
    assert differences.lines


@pytest.mark.parametrize(
    ("name", "crossings"),
    [
        ("3_1", 3),
        ("m8_20", 8),
        ("12a_1288", 12),
        ("L10n113", 10),
        ("L6a4{0,1}", 6),
        ("T(2,2)", 2),
        ("T(30,60)", 1740),
        ("4_1#5_2#3_1", 12),
        ("3_1#mine", None),
        ("Borromean", 6),
        ("figure eight", 4),
        ("9^2_57", 9),
        ("P(-2,3,7)", None),
        ("", None),
    ],
)
def test_crossing_numbers_of_names(name: str, crossings: int | None) -> None:
    assert atlas.crossing_number(name) == crossings


def test_styles_differ_and_keep_to_themselves() -> None:
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    grounds = []
    for style in sheet.STYLES:
        with sono.plot.style(style):
            figure, (axes,) = sheet.sheet(1, 1, (2, 2))
            sono.plot.curvature("Hopf", axes=axes)
            grounds.append(figure.get_facecolor())
            assert axes.xaxis.get_ticklabels()[0].get_color() == sheet.PAPER[style][1]
    assert sum(grounds[0][:3]) == 3
    assert sum(grounds[1][:3]) < 0.5
    assert dict(mpl.rcParams) == before
    with pytest.raises(ValueError, match="give 'light' or 'dark'"):
        sono.plot.style("blue")  # type: ignore[arg-type]


def test_the_same_plot_is_the_same_bytes() -> None:
    def made(suffix: str) -> bytes:
        with sono.plot.style("light"):
            figure, (axes,) = sheet.sheet(1, 1, (1, 1))
            axes.plot([0, 1], label="$L_p$")
            return sheet.saved(figure, suffix)

    for suffix, magic in ((".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF")):
        one = made(suffix)
        assert one.startswith(magic)
        assert one == made(suffix)


def test_wrong_calls_say_why() -> None:
    with pytest.raises(ValueError, match="the atlas has no rope of 'T\\(2,103\\)'"):
        sono.plot.curvature("T(2,103)")
    with pytest.raises(ValueError, match="as many labels"):
        sono.plot.knot("3_1", labels=["a", "b"])
    with pytest.raises(ValueError, match="one rope at least"):
        sono.plot.knot()


def test_without_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.setitem(sys.modules, name, None)
    for draw in (sono.plot.model, sono.plot.style, lambda: sono.plot.knot("3_1")):
        with pytest.raises(ImportError, match=r"pip install 'sono\[plot\]'"):
            draw()
