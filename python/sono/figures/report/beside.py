"""What stands beside a rope on its page, below its measures: bounds, published lengths, and files."""

from collections.abc import Iterable
from decimal import ROUND_CEILING, Decimal
from html import escape
from urllib.parse import quote

from sono.certificates import Certificate
from sono.tables import COLUMNS, Row, Value, published
from sono.tables.reference import sources


def beside(at: str, row: Row, proof: Certificate | str) -> str:
    """Return the HTML of a rope whose files are `at` a place in the report, by its row and its proof.

    Where nothing is proven, the proof is the reason.
    """
    stem = at.rpartition("/")[2]
    return "\n".join([_bounds(row, proof), _published(row), _files(stem, isinstance(proof, Certificate))])


def _bounds(row: Row, proof: Certificate | str) -> str:
    if isinstance(proof, str):
        return f"<h2>Proven bound</h2>\n<p>None: {escape(proof)}</p>"
    terms = [("ropelength ≤", proof.rounded()), ("R is held by a", str(proof.decided_by))]
    if row["l_c_fine"] is not None:
        terms.append((f"with {row['n_fine']} vertices ≤", f"{rounded_up(row['l_c_fine']):.6f}"))
    lines = "".join(f"<dt>{escape(term)}</dt><dd>{escape(text)}</dd>" for term, text in terms)
    return f"<h2>Proven bound</h2>\n<dl>{lines}</dl>"


def rounded_up(bound: Value) -> float | None:
    """Return a bound with as many digits as tables show."""
    return None if bound is None else float(Decimal(bound).quantize(Decimal("1e-6"), ROUND_CEILING))


def _published(row: Row) -> str:
    """List what is published, the shortest that counts first, with the difference of our L_a."""
    rows = [each for each in published.beside_all(row) if each["published"] is not None]
    if not rows:
        return "<h2>Published</h2>\n<p>No ropelength of this type is in sono's table.</p>"
    heads = "".join(
        f'<th scope="col">{head}</th>' for head in ("length / R", "kind", "source", "L<sub>a</sub> − it")
    )
    lines = "".join(_line(each) for each in rows)
    table = f'<table id="published"><thead><tr>{heads}</tr></thead><tbody>{lines}</tbody></table>'
    return f"<h2>Published</h2>\n{table}\n{_sources(str(each['source']) for each in rows)}"


def _line(row: Row) -> str:
    cells = (_shown("published", row["published"]), row["kind"], row["source"])
    texts = "".join(f'<td class="text">{escape(str(cell))}</td>' for cell in cells)
    return f"<tr>{texts}<td>{_shown('l_a_difference', row['l_a_difference'])}</td></tr>"


def _sources(names: Iterable[str]) -> str:
    found = [sources()[name] for name in dict.fromkeys(names)]
    lines = "".join(
        f"<p><b>{escape(source.source)}</b>: {escape(source.citation)}, over the {source.per}: "
        f"{escape(source.place)}. Checked: {escape(source.checked)}.</p>"
        for source in found
    )
    return f"<details><summary>Sources</summary>{lines}</details>"


def _files(stem: str, proven: bool) -> str:
    files = {".txt": "vertices, rows of x y z"} | ({".certificate.json": "certificate"} if proven else {})
    lines = "".join(
        f'<li><a href="{quote(stem + suffix)}" download>{escape(stem + suffix)}</a>: {text}</li>'
        for suffix, text in files.items()
    )
    check = (
        "<p><small>sono certify --check CERTIFICATE VERTICES proves the bound anew.</small></p>"
        if proven
        else ""
    )
    return f"<h2>Files</h2>\n<ul>{lines}</ul>\n{check}"


def _shown(key: str, value: Value) -> str:
    return "–" if value is None else format(value, COLUMNS[key].spec)
