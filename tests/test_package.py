"""What the package says of itself: requirements, links, and what a release needs."""

import json
import re
import runpy
import subprocess
import sys
import tomllib
from itertools import accumulate
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml

from rpscli.version import VERSION

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
RECIPE = yaml.safe_load((ROOT / ".ci/conda/recipe.yaml").read_text("utf-8"))
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))


def bounds(requirements):
    found = [re.split(r" ?>=", each) for each in requirements]
    return {name.replace("matplotlib-base", "matplotlib"): bound for name, bound in found}


def test_the_conda_recipe_is_of_this_version_with_the_same_requirements():
    assert RECIPE["context"]["version"] == VERSION
    _, *run = RECIPE["requirements"]["run"]  # Python first
    assert bounds(run) == bounds(PROJECT["project"]["dependencies"])
    assert f">={RECIPE['context']['python_min']}" == PROJECT["project"]["requires-python"]
    scripts = dict(
        each.split(" = ") for each in RECIPE["build"]["python"]["entry_points"]
    )
    assert scripts == PROJECT["project"]["scripts"]


def test_the_lock_has_what_the_project_needs():
    text = (ROOT / ".ci/lock.txt").read_text("utf-8")
    locked = dict(re.findall(r"^([\w.-]+)==([\w.]+)", text, re.MULTILINE))
    wanted = bounds(
        PROJECT["project"]["dependencies"]
        + PROJECT["project"]["optional-dependencies"]["records"]
    )
    numbers = {name: [int(n) for n in locked[name].split(".")] for name in wanted}
    low = {
        n: b
        for n, b in wanted.items()
        if numbers[n] < [int(part) for part in b.split(".")]
    }
    assert low == {}


def test_every_action_is_pinned_and_every_workflow_has_few_permissions():
    for path in WORKFLOWS:
        text = path.read_text("utf-8")
        uses = re.findall(r"uses: (\S+)(.*)", text)
        assert uses
        assert [
            u for u, v in uses if not re.search(r"@[0-9a-f]{40}$", u) or "# v" not in v
        ] == []
        workflow = yaml.safe_load(text)
        assert workflow["permissions"] == {"contents": "read"}
        assert workflow["concurrency"]["group"]
    publish = yaml.safe_load((WORKFLOWS[0].parent / "release.yml").read_text("utf-8"))[
        "jobs"
    ]
    assert publish["publish"]["permissions"] == {
        "id-token": "write",
        "attestations": "write",
    }
    assert "secrets." not in (WORKFLOWS[0].parent / "release.yml").read_text("utf-8")


@pytest.mark.posix
def test_what_is_not_ready_is_not_published():
    """As it stands the owner of the repository is to be named, and the changelog to be dated."""
    refused = subprocess.run(
        [ROOT / ".ci/package", "--publishable", "v9.9", "somebody/rps"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert refused.returncode == 1
    assert f"the tag v9.9 is not that of version {VERSION}" in refused.stderr


def test_links_of_the_readme_lead_to_the_repository(monkeypatch):
    # What builds the package is not among what tests need.
    base = SimpleNamespace(MetadataHookInterface=object)
    parts = ("hatchling", "metadata", "plugin", "interface")
    for name in accumulate(parts, "{}.{}".format):
        monkeypatch.setitem(sys.modules, name, base)
    space = runpy.run_path(str(ROOT / ".ci/readme.py"))
    source = PROJECT["project"]["urls"]["Source"]
    metadata = {"urls": {"Source": source}, "version": VERSION}
    readme = space["Readme"]()
    readme.root = str(ROOT)
    readme.update(metadata)
    text = metadata["readme"]["text"]
    links = re.findall(r"\]\(([^)\s]+)", text)
    assert len(links) > 5
    assert [link for link in links if not link.startswith(("https://", "#"))] == []
    assert f"]({source}/blob/v{VERSION}/rpscli/GUIDE.md" in text
    assert f"]({source}/raw/v{VERSION}/cases/pictures/" in text
    for link in links:
        here = re.sub(
            rf"^{re.escape(source)}/(blob|raw)/v{re.escape(VERSION)}/", "", link
        )
        assert here == link or (ROOT / here.partition("#")[0]).exists()


def test_codemeta_is_what_the_citation_says():
    space = runpy.run_path(str(ROOT / ".github/codemeta.py"))
    citation = yaml.safe_load(space["CITATION"].read_text("utf-8"))
    made = space["codemeta"](citation)
    assert space["PLACE"].read_text("utf-8") == made, "write it: .github/codemeta.py"
    person = {
        "given-names": "Ada",
        "family-names": "Byron",
        "orcid": "https://orcid.org/0",
    }
    dated = {
        **citation,
        "authors": [person],
        "doi": "10.1/2",
        "date-released": "2026-12-01",
    }
    told = json.loads(space["codemeta"](dated))
    assert told["author"] == [
        {
            "@type": "Person",
            "@id": "https://orcid.org/0",
            "givenName": "Ada",
            "familyName": "Byron",
        }
    ]
    assert (told["identifier"], told["datePublished"]) == (
        "https://doi.org/10.1/2",
        "2026-12-01",
    )
    assert (told["version"], told["name"]) == (VERSION, citation["title"])


def test_forms_ask_for_what_an_answer_needs():
    """Each kind of report, as GitHub reads it; what cannot be answered without is required."""
    folder = ROOT / ".github/ISSUE_TEMPLATE"
    required = {
        "wrong_number": {"case", "command", "expected", "doctor"},
        "crash": {"command", "case", "doctor"},
        "question": {"question"},
    }
    forms = {
        path.stem: yaml.safe_load(path.read_text("utf-8"))
        for path in folder.glob("*.yml")
    }
    config = forms.pop("config")
    assert config["blank_issues_enabled"] is False
    assert {*forms} == {*required}
    for name, form in forms.items():
        assert {"name", "description", "body"} <= {*form}
        fields = [each for each in form["body"] if each["type"] != "markdown"]
        assert len({each["id"] for each in fields}) == len(fields)
        asked = {f["id"] for f in fields if f.get("validations", {}).get("required")}
        assert asked == required[name]
    text = (ROOT / ".github/PULL_REQUEST_TEMPLATE.md").read_text("utf-8")
    assert "How it is shown to be right" in text
