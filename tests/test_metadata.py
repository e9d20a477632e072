"""What is written twice about the project agrees, and names no place that nobody knows."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

HOME = Path(__file__).parent.parent

pytestmark = pytest.mark.skipif(not (HOME / "Cargo.toml").is_file(), reason="needs the source tree")


def text(name: str) -> str:
    path = HOME / name
    if not path.is_file():
        pytest.skip(f"{name} is left out of archives")
    return path.read_text(encoding="utf-8")


def toml(name: str) -> dict[str, Any]:
    return tomllib.loads(text(name))


def test_the_version_is_one() -> None:
    version = toml("Cargo.toml")["package"]["version"]
    assert f"\nversion: {version}\n" in text("CITATION.cff")
    assert f'"version": "{version}"' in text(".zenodo.json")
    assert re.search(
        rf"^## \[{re.escape(version)}\] - \d{{4}}-\d\d-\d\d$", text("CHANGELOG.md"), re.MULTILINE
    )


def test_the_changelog_begins_with_what_is_not_released() -> None:
    versions = re.findall(r"^## (.*)$", text("CHANGELOG.md"), re.MULTILINE)
    assert versions[0] == "[Unreleased]"
    assert len({*versions}) == len(versions)


def test_what_is_cited_is_what_the_citation_file_says() -> None:
    page, citation = text("docs/cite.md"), text("CITATION.cff")
    fields = dict(
        re.findall(r"^ +(\w+) += \{+(.*?)\}+,?$", page, re.MULTILINE)
    )  # of the paper, which is last
    (program, authors), (_, of_paper) = (
        (block, re.findall(r"family-names: (.*)\n +given-names: (.*)", block))
        for block in citation.split("references:")
    )
    assert fields["author"] == " and ".join(map(", ".join, of_paper))
    assert f"title: {fields['title']}\n" in citation
    assert f"year: {fields['year']}\n" in citation
    own = dict(re.findall(r"^ +(\w+) += \{+(.*?)\}+,?$", page.split("## The paper")[0], re.MULTILINE))
    assert not authors
    assert f"  - name: {own['author']}\n" in program
    assert f"\nversion: {own['version']}\n" in program
    assert f"\ntitle: {own['title']}\n" in program
    assert f"\ndate-released: {own['year']}-" in program


def test_keywords_agree() -> None:
    zenodo = json.loads(text(".zenodo.json"))
    assert all(f"  - {keyword}\n" in text("CITATION.cff") for keyword in zenodo["keywords"])
    assert {*zenodo["keywords"]} <= {*toml("pyproject.toml")["project"]["keywords"]}
    assert (
        zenodo["license"]
        == toml("Cargo.toml")["package"]["license"]
        == toml("pyproject.toml")["project"]["license"]
    )


def test_the_oldest_python_is_told_once() -> None:
    oldest = toml("pyproject.toml")["project"]["requires-python"].removeprefix(">=")
    assert f"abi3-py{oldest.replace('.', '')}" in text("Cargo.toml")
    for workflow in ("ci.yml", "release.yml"):
        assert f'"{oldest}"' in text(f".github/workflows/{workflow}")


@pytest.mark.parametrize("workflow", ["ci.yml", "release.yml"])
def test_actions_have_major_versions_and_few_rights(workflow: str) -> None:
    content = text(f".github/workflows/{workflow}")
    uses = re.findall(r"uses: (\S+)", content)
    assert uses
    assert all(re.search(r"@(release/)?v\d+$", action) for action in uses)
    assert "permissions:\n  contents: read\n" in content
    assert "secrets." not in content
    assert content.count("persist-credentials: false") == content.count("actions/checkout@")
