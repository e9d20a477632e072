"""Records of ropes: of the very files, counts that are counted, and resumed with the run."""

import hashlib
import json
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Sono

import sono as package
from sono import formats, naming
from sono.tightening import Run, Stopped

KINDS = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": int | float,
    "boolean": bool,
    "null": type(None),
}


def schema() -> Any:
    return json.loads(resources.files("sono").joinpath("data", "record.schema.json").read_text())


def follows(document: Any, rule: Any) -> bool:
    """Tell whether a document follows a schema, of the kinds of rules that this one has."""
    rule = schema()["$defs"][rule["$ref"].rsplit("/", 1)[1]] if "$ref" in rule else rule
    types = rule.get("type", [])
    ok = not types or any(isinstance(document, KINDS[t]) for t in np.atleast_1d(types))
    ok &= document in rule.get("enum", [document]) and document == rule.get("const", document)
    if isinstance(document, dict):
        properties, others = rule.get("properties", {}), rule["additionalProperties"]
        ok &= set(rule.get("required", [])) <= set(document)
        ok &= bool(others) or set(document) <= set(properties)
        ok = ok and all(follows(document[key], properties.get(key, others)) for key in document)
    if isinstance(document, list):
        ok &= rule["minItems"] <= len(document) <= rule.get("maxItems", len(document))
        ok &= all(follows(item, rule["items"]) for item in document)
    if isinstance(document, int | float):
        ok &= document >= rule.get("minimum", document) and document > rule.get("exclusiveMinimum", -np.inf)
    return bool(ok)


def record_of(path: str) -> Any:
    """Read the record beside a file of vertices, which is of this file and follows the schema."""
    found = json.loads(Path(path).with_suffix(".record.json").read_text())
    assert follows(found, schema())
    assert found["output"]["file"] == Path(path).name
    assert found["output"]["sha256"] == hashlib.sha256(Path(path).read_bytes()).hexdigest()
    curve = formats.read(path).components
    text = b"".join(component.astype("<f8").tobytes() + b"end of component" for component in curve)
    assert found["output"]["vertices"] == hashlib.sha256(text).hexdigest()
    assert found["output"]["components"] == list(map(len, curve))
    return found


def test_the_record_of_a_file(folder: Path, sono: Sono) -> None:
    sono("start", "4_1", "-o", "knot.txt")
    assert sono("tighten", "knot.txt", "-n", "60,120", "--trials", "2", "--record").exit_code == 0
    for n in (60, 120):
        found = record_of(f"knot.n{n}.txt")
        assert found["input"]["sha256"] == hashlib.sha256(Path("knot.txt").read_bytes()).hexdigest()
        assert (found["input"]["given"], found["begins_with"]) == ("knot.txt", "input")
        assert found["type"]["agree"]
        assert found["type"]["input"] == found["type"]["output"]
        assert (found["type"]["input"]["name"], found["type"]["input"]["known"]) == ("4_1", "proven")
        stages = [work["stage"] for work in found["path"]]
        assert stages[:3] == ["collapse", "anneal", "trial"]
        assert stages[-1] == "polish"
        assert len({work["trial"] for work in found["path"][:3]}) == 1
        assert found["path"][-1]["n"] == n
        assert all(work["margin"] > 1 and work["moves"] > 0 for work in found["path"])
        for key in ("sweeps", "steps", "moves"):
            assert 0 < sum(work[key] for work in found["path"]) < found["total"][key]
    verdict = naming.verify(*(formats.read(name).components for name in ("knot.txt", "knot.n120.txt")))
    assert verdict.verdict == "same"


def test_the_record_of_a_name(folder: Path, sono: Sono) -> None:
    assert sono("tighten", "Hopf", "-n", "40,200", "--record", "-o", "out/").exit_code == 0
    coarse, fine = (record_of(f"out/Hopf.n{n}.txt") for n in (40, 200))
    assert coarse["input"]["file"] is coarse["input"]["sha256"] is None
    assert coarse["input"]["components"] == [len(part) for part in package.start("Hopf")]
    assert (coarse["begins_with"], fine["begins_with"]) == ("input", "atlas")
    assert [work["stage"] for work in fine["path"]] == ["polish"]
    assert coarse["type"]["output"]["linking"] in ([1], [-1])


@pytest.mark.parametrize(
    "more",
    [
        ("-o", "-"),
        ("--cluster", "tcp://localhost:1"),
        ("--resume", "--force"),
        ("--contacts", "-", "-o", "-"),
    ],
)
def test_where_there_can_be_no_record(folder: Path, sono: Sono, more: tuple[str, ...]) -> None:
    before = sorted(folder.iterdir())
    result = sono("tighten", "3_1", "-n", "30", "--record", *more)
    assert result.exit_code == 2
    assert "--" in result.stderr
    assert sorted(folder.iterdir()) == before


def test_a_record_is_not_written_over(folder: Path, sono: Sono) -> None:
    Path("3_1.n30.record.json").write_text("mine")
    result = sono("tighten", "3_1", "-n", "30", "--record")
    assert result.exit_code == 2
    assert "3_1.n30.record.json exists; --force starts anew" in result.stderr
    assert Path("3_1.n30.record.json").read_text() == "mine"


def test_what_is_kept_has_its_record(folder: Path, sono: Sono) -> None:
    arguments = ("tighten", "3_1", "-n", "30", "--trials", "1", "--record")
    assert sono(*arguments).exit_code == 0
    written = Path("3_1.n30.record.json").read_bytes()
    assert sono(*arguments, "--resume").exit_code == 0
    assert Path("3_1.n30.record.json").read_bytes() == written
    for damaged in (written.replace(b'"sha256": "', b'"sha256": "0'), b"[]", b"\xff", None):
        if damaged is None:
            Path("3_1.n30.record.json").unlink()
        else:
            Path("3_1.n30.record.json").write_bytes(damaged)
        result = sono(*arguments, "--resume")
        assert result.exit_code == 1
        assert "its record 3_1.n30.record.json is missing, or of another file" in result.stderr


@pytest.mark.parametrize(("name", "n", "method"), [("6_3", 28, "sono"), ("4_1", 20, "both")])
def test_what_is_undone_is_counted(name: str, n: int, method: Any) -> None:
    """Ropes so coarse that strands almost fit between beads: sweeps are undone, and steps are refused."""
    hot = {"anneal_sweeps": 20_000, "anneal_tolerance": 0.5}
    tight = package.tighten(name, n, method=method, trials=2, known=False, settings=hot)
    assert tight.total["undone"] > 0
    assert (tight.total["lost"] > 0) == (method == "sono")
    assert tight.total["lost"] <= tight.total["sweeps"]
    assert sum(work.undone for work in tight.path) <= tight.total["undone"]
    assert all(work.margin is None or work.margin > 1 for work in tight.path)
    assert naming.verify(list(package.start(name)), list(tight.curve)).verdict == "same"


def test_loosening_is_counted() -> None:
    thin = [np.asarray([[0, 0, 0], [1e6, 0, 1], [1e6, -1, 0], [1e6 + 1, 0.5, 2], [1e6, 1, 0], [0, 0.1, 0]])]
    tight = package.tighten(thin, 24, trials=2)
    assert tight.loosened
    first, then = tight.path[:2]
    assert (first.stage, then.stage) == ("loosen", "collapse")
    assert first.moved > 0
    assert tight.total["moved"] == first.moved
    assert [work.trial for work in tight.path if work.stage == "anneal"] == [then.trial]


@pytest.mark.usefixtures("slices")
def test_a_run_that_is_resumed_counts_on() -> None:
    curve = package.start("3_1")
    settings = {"anneal_sweeps": 20_000}
    whole = Run(list(curve), [60], settings, trials=2).tighten()
    run, stops = Run(list(curve), [60], settings, trials=2), 0

    class Stop(Stopped):
        pass

    while True:
        looks = iter(range(4))

        def watch(_: object, looks: Any = looks) -> None:
            if next(looks) == 3:
                raise Stop

        try:
            tight = run.tighten(watch)
            break
        except Stop:
            stops += 1
            run = Run.restore(json.loads(json.dumps(run.state())))
    assert stops > 3
    assert [work.to_dict() for work in tight.path] == [work.to_dict() for work in whole.path]
    assert tight.total == whole.total


def test_a_stopped_rope_has_a_record(folder: Path, sono: Sono) -> None:
    assert (
        sono("tighten", "10_3", "-n", "480", "--start", "drawn", "--time-limit", "0.2", "--record").exit_code
        == 1
    )
    found = record_of("10_3.n480.best.txt")
    assert found["status"] == "stopped"
    assert found["type"]["agree"]
